#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/memory_budget.h"
#include "reverb/fields/scattering_field.h"
#include "reverb/pairs/boundary_fans.h"
#include "reverb/pairs/transmit_pattern.h"
#include "reverb/power/expected_reverberation.h"
#include "reverb/power/patch_rows.h"
#include "sonar/paths/return_source.h"
#include "sonar/scenario/carried.h"
#include "sonar/scenario/ping_geometry.h"
#include "sonar/scenario/scenario.h"
#include "sonar/signal/pulse.h"

namespace asdic::detail {

struct ReverberationCovariance;
struct ReverberationStreams;

/// One ping as one array receives it.
struct ReverberationContext {
  PingGeometry geometry;
  const TransmitPattern& pattern;
  const Pulse& pulse;
  int array = 0;  ///< that receives it, an index
  /// Of a part of the array that receives it by itself; none: all about reverberation_point().
  std::optional<Carried> point = {};
  double latest = 0.0;     ///< end of the record, since the ping [s]
  Reuse* reuse = nullptr;  ///< is told what had to be traced or worked out
  /// From where it is received [m]; none: nothing is received by its covariance, all of it one by
  /// one.
  std::span<const Vec3> phones = {};
  std::span<const BandPoint> band = {};  ///< returns get an amplitude for each; none: the centre's
  MemoryBudget* budget = nullptr;        ///< is asked before pairs are collected; null: nobody is
  bool plane_waves = true;               ///< fit all of the phones, whatever is received
  /// Whether a sea that every ping draws anew may lie around the source, wherever that is.
  bool drifts = false;
  /// Whether no other ping and no other array receives these scatterers: the world is this ping's.
  bool received_once = false;
  bool level_alone = false;  ///< nothing but the expected level is asked for
  bool judged = false;       ///< what numbers of bounces leave out is estimated

  /// The key of weights that last one ping.
  [[nodiscard]] std::uint32_t ping() const noexcept {
    return static_cast<std::uint32_t>(geometry.ping());
  }
};

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
  /// The statistical equivalent: the scatterers of a sector, received within one bin of delay out
  /// of the same range of elevations, are one return with the power of all, a Gaussian weight of
  /// its own, and delay, direction and Doppler factor of one of them, chosen with the chances of
  /// their powers. Reciprocal pairs share a weight. docs/theory/reverberation.md
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
  /// How many plain_returns() are, more or less.
  [[nodiscard]] double expected_returns() const noexcept { return expected_->returns; }
  /// How many of them are gridded one by one; none where sectors, a covariance or streams
  /// stand for them.
  [[nodiscard]] double one_by_one() const noexcept { return by_sectors_ ? 0.0 : one_by_one_; }

  /// Expected level at time t since the ping [dB re 1 µPa, peak envelope/√2]: SL + 10·log₁₀ Σ_cells
  /// |Σ_pairs A·D·s(t − τ)|², the mean over weights. −∞ where there is none.
  [[nodiscard]] double expected_db(double t) const;

  /// \param most  rows   \param memory  of what is kept; null: none
  [[nodiscard]] PatchRows rows(std::size_t most, PropagationMemory* memory = nullptr) const;

  [[nodiscard]] const std::vector<ScatteringField>& fields() const noexcept { return fields_; }

 private:
  using Block = ExpectedReverberation::Block;
  /// A scatterer of a cell with what belongs to it alone.
  struct Met {
    std::complex<double> strength = 0.0;  // √(area·texture), times the weight if asked for
    double bragg = 0.0;
    Vec3 velocity = Vec3::Zero();
  };
  /// Its pairs of paths into `pairs`; nothing if there are none.
  Met meet(const ScatteringField& field, const ScattererKey& key, std::uint64_t entity,
           PathPairs& pairs) const;
  /// Calls visit(key, entity, met) for every scatterer of a cell; its pairs are in `pairs` then.
  template <class Visit>
  void for_each_scatterer(const ScatteringField& field, std::uint32_t ring, int sector,
                          PathPairs& pairs, Visit&& visit) const {
    const std::uint32_t copies = field.copies_of(ring, sector);
    for (std::uint32_t copy = 0; copy < copies; ++copy) {
      const ScattererKey key{.ring = ring,
                             .sector = static_cast<std::uint32_t>(sector),
                             .copies = copies,
                             .copy = copy};
      const std::uint64_t entity = key.entity(field.grid.identity);
      const Met met = meet(field, key, entity, pairs);
      if (!pairs.found.empty()) visit(key, entity, met);
    }
  }
  /// Adds what is received of a pair, with its frequency responses.
  void receive(const ScatteringField& field, const PathPairs& pairs, const PathPair& pair,
               const Met& met, std::complex<double> weight, ReturnBlock& into) const;
  void add_sector(const ScatteringField& field, int sector, ReturnBlock& into) const;
  void add_rings(const ScatteringField& field, std::uint32_t begin, std::uint32_t end,
                 ReturnBlock& into) const;
  [[nodiscard]] std::vector<Block> sector_blocks() const;
  /// Half of 1/B, or as much as the limit of returns asks for [s].
  [[nodiscard]] double sector_bin(const ScatteringField& field) const;
  [[nodiscard]] Returns collect(const std::vector<Block>& blocks, bool sectors) const;

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

/// Speed of sound at the surface over a scenario's first platform's first place [m/s].
[[nodiscard]] double speed_at_surface(const Scenario& scenario, const PropagationPaths& paths);

/// Makes the reverberation of any ping at any array of a scenario. Built once; shared by threads.
class ReverberationModel {
 public:
  /// \param scenario, paths  must outlive this   \param widest  of the pulses: it sets the grid
  ReverberationModel(const Scenario& scenario, const PropagationPaths& paths, const Pulse& widest);

  [[nodiscard]] PingReverberation ping(const ReverberationContext& context) const;
  /// What ping() would ask the context's budget for, though it may be known: takes it.
  void take_memory(const ReverberationContext& context) const;
  [[nodiscard]] double ground_spacing() const noexcept { return spacing_; }  ///< [m]
  /// Of everything that scatters.
  [[nodiscard]] std::vector<ScatteringSheet::Law> laws() const;
  /// That a ping's paths follow, the most of all boundaries and layers.
  [[nodiscard]] Bounces bounces(const ReverberationContext& context) const;

 private:
  /// Of a boundary or a layer: what scatters, and where.
  struct Part {
    GroundLevel level;
    ScatteringSheet::Law law;
    ScattererField field;
    Draw weights;
    std::uint64_t id;
    double thickness = 0.0;
  };
  /// How finely the paths to a boundary are known.
  enum class Ground {
    scatterers,  ///< for each scatterer by itself: cells of the grid
    means        ///< for means over many: wider cells where they are far away
  };
  /// All that a ping receives.
  [[nodiscard]] std::vector<ScatteringField> fields(const ReverberationContext& context,
                                                    Ground ground) const;
  /// Those fields with the paths to each scatterer, as far as they are received one by one.
  [[nodiscard]] std::vector<ScatteringField> in_detail(std::vector<ScatteringField> fields,
                                                       const ReverberationContext& context) const;
  /// Whether nothing tells where in the world a part of the sea lies: each ping has weights of its
  /// own, there is one array, and the ocean is the same everywhere.
  [[nodiscard]] bool forgets_places(const Part& part, const ReverberationContext& context) const;
  /// Bounces after which a segment of the record lacks next to nothing, found on a coarse grid.
  [[nodiscard]] Bounces enough(const Part& part, const SheetEnds& ends, BoundaryFans::Settings fan,
                               const ReverberationContext& context) const;
  [[nodiscard]] double inaudible(const ReverberationContext& context) const;
  /// Cells for means over many scatterers: places that a level, a covariance or streams look at lie
  /// further apart [m].
  [[nodiscard]] static double wide_cells(const Pulse& pulse) noexcept;
  /// Adds the fields of a part that a ping receives, one for every anchor.
  void meet(Part part, const ReverberationContext& context, Ground ground,
            std::vector<ScatteringField>& fields) const;
  /// Whether it can be received that pairs of ends with other anchors receive other seas: of
  /// weights that outlast a ping, or if one ping is received from several platforms.
  [[nodiscard]] bool seas_compared(const ScattererField& field) const;
  [[nodiscard]] std::vector<Part> parts() const;
  /// Of a ring: as many as are resolved, but no more scatterers in all rings than twice the most
  /// returns, and no fewer sectors than the scenario says. \param reach  of the rings [m]
  [[nodiscard]] int sectors(double reach) const;
  [[nodiscard]] std::shared_ptr<const ExpectedReverberation> expected(
      std::span<const ScatteringField> fields, const ReverberationContext& context) const;
  [[nodiscard]] std::shared_ptr<const ReverberationCovariance> covariance(
      std::span<ScatteringField> fields, const ExpectedReverberation& expected,
      const ReverberationContext& context) const;
  [[nodiscard]] std::shared_ptr<const ReverberationStreams> streams(
      std::span<ScatteringField> fields, const ExpectedReverberation& expected,
      const ReverberationContext& context) const;

  const Scenario& scenario_;
  const PropagationPaths& paths_;
  BoundaryFans fans_;
  double spacing_, fastest_water_;
  int resolved_sectors_;
};

}  // namespace asdic::detail
