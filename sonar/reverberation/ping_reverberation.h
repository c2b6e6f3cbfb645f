#pragma once
#include <memory>
#include <vector>

#include "core/propagation_memory.h"
#include "reverb/fields/met_scatterer.h"
#include "reverb/fields/scattering_field.h"
#include "reverb/power/expected_reverberation.h"
#include "reverb/power/patch_rows.h"
#include "sonar/paths/return_source.h"
#include "sonar/reverberation/reverberation_context.h"
#include "sonar/reverberation/sector_returns.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail {

struct ReverberationCovariance;
struct ReverberationStreams;

/// Reverberation of surface and bottom in one ping at one array: every scatterer of the fields with
/// its own delay, direction, Doppler factor and complex Gaussian weight, by all pairs of outgoing
/// and returning paths. Source and receiver may be anywhere; monostatic is the same place twice.
/// docs/theory/reverberation.md
class PingReverberation final : public ReturnSource {
 public:
  PingReverberation(const Scenario& scenario, const ReverberationContext& context,
                    std::vector<ScatteringField> fields,
                    std::shared_ptr<const ExpectedReverberation> expected,
                    std::shared_ptr<const ReverberationCovariance> covariance = nullptr,
                    std::shared_ptr<const ReverberationStreams> streams = nullptr);

  /// What the array's reference point receives. The weakest pairs are left out as long as all that
  /// is left out stays 50 dB below what is received at its time. More than the scenario's most
  /// returns are replaced by those of sectors.
  [[nodiscard]] Returns returns() const;
  /// One return for every scatterer and pair of paths.
  [[nodiscard]] Returns plain_returns() const;
  /// The statistical equivalent by sectors.
  [[nodiscard]] Returns sector_returns() const;
  /// returns() in blocks: some rings, or a sector, of a field each.
  [[nodiscard]] std::size_t blocks() const override { return blocks_.size(); }
  [[nodiscard]] std::size_t expected(std::size_t block) const override {
    return blocks_[block].expected;
  }
  void make(std::size_t block, ReturnBlock& into) const override;
  [[nodiscard]] std::vector<DopplerSpan> dopplers() const override;
  /// Of the fields that are received by it, and are not among the blocks; null: none is.
  [[nodiscard]] const ReverberationCovariance* covariance() const noexcept {
    return covariance_.get();
  }
  /// The same as streams of noise.
  [[nodiscard]] const ReverberationStreams* streams() const noexcept { return streams_.get(); }
  /// That were followed, the most of all fields.
  [[nodiscard]] Bounces bounces() const;
  /// Whether any is drawn anew although its weights last (ScatteringField::drawn_anew).
  [[nodiscard]] bool drawn_anew() const noexcept;
  /// How many plain_returns() are, more or less.
  [[nodiscard]] double expected_returns() const noexcept { return expected_->returns; }
  /// How many of them are gridded one by one; none where sectors, a covariance or streams
  /// stand for them.
  [[nodiscard]] double one_by_one() const noexcept { return by_sectors_ ? 0.0 : one_by_one_; }

  /// Expected level at time t since the ping [dB re 1 µPa, peak envelope/√2]: SL + 10·log₁₀ Σ_cells
  /// |Σ_pairs A·D·s(t − τ)|², the mean over weights. −∞ where there is none.
  [[nodiscard]] double expected_db(double t) const;

  /// Expected power as the mean over steps of time: the peak envelope's square over that of the
  /// source at 1 m. \param first  beginning of the first step, since the ping [s]
  /// \param step  [s]   \param memory  keeps it for pings whose sea is the same   \return [count]
  [[nodiscard]] std::vector<double> mean_power(double first, double step, std::size_t count,
                                               PropagationMemory& memory) const;

  /// \param most  rows   \param memory  of what is kept; null: none
  [[nodiscard]] PatchRows rows(std::size_t most, PropagationMemory* memory = nullptr) const;

  [[nodiscard]] const std::vector<ScatteringField>& fields() const noexcept { return fields_; }

 private:
  using Block = ExpectedReverberation::Block;
  [[nodiscard]] ScattererMeeting meeting() const;
  [[nodiscard]] SectorReturns sectors() const;
  /// Adds the returns of a block, of rings or of sectors.
  void add(const Block& block, bool by_sectors, ReturnBlock& into) const;
  [[nodiscard]] Returns collect(const std::vector<Block>& blocks, bool by_sectors) const;

  const Scenario& scenario_;
  ReverberationContext context_;
  std::vector<ScatteringField> fields_;
  std::shared_ptr<const ExpectedReverberation> expected_;
  std::shared_ptr<const ReverberationCovariance> covariance_;
  std::shared_ptr<const ReverberationStreams> streams_;
  double one_by_one_ = 0.0;
  bool by_sectors_;
  std::vector<Block> blocks_;  // those of returns()
};

}  // namespace asdic::detail
