#pragma once
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "sonar/synthesis/delay_windows.h"
#include "sonar/synthesis/impulse_grid.h"
#include "sonar/synthesis/ordered_returns.h"
#include "sonar/synthesis/synthesis_plan.h"

namespace asdic::detail {

/// Synthesizer::baseband(): a source's returns are made, ordered and gridded batch by batch.
/// Where the grids of all phones, Doppler nodes and frequency responses fit into `most_kept` bytes,
/// they are kept and transformed once; otherwise phone by phone, after every batch, of which only
/// those windows of delay are transformed in which it has returns. Private to the synthesis.
/// docs/theory/synthesis.md, "Memory"
class BlockSynthesis {
 public:
  BlockSynthesis(const Synthesizer::Plan& plan, std::vector<DopplerBand> bands,
                 const ReturnSource& source, std::span<const Vec3> phones);
  [[nodiscard]] Baseband run();
  /// Synthesizer::baseband() of returns that exist, and of a sound that is no pulse.
  [[nodiscard]] static Baseband of_list(const Synthesizer::Plan& plan,
                                        std::span<const Return> returns,
                                        std::span<const Vec3> phones);
  [[nodiscard]] static Baseband of_sound(const BandLimitedPulse& sound, const Recording& recording,
                                         double max_doppler, std::span<const Return> returns,
                                         std::span<const Vec3> phones);
  /// The plan of a synthesizer, for those who ask how large it is.
  [[nodiscard]] static const Synthesizer::Plan& plan_of(const Synthesizer& synthesizer) noexcept {
    return *synthesizer.plan_;
  }

  static constexpr std::size_t most_kept = std::size_t{64} << 20;

 private:
  /// Some of a band's returns at a phone.
  struct Task {
    std::size_t band = 0, channel = 0, response = 0, begin = 0, end = 0;
  };
  struct Batch {
    std::size_t begin = 0, end = 0;  // of the source's blocks
  };
  [[nodiscard]] std::vector<Batch> batches(bool kept) const;
  /// The pulse at every frequency response and node. \return [responses × nodes × (2·highest_bin +
  /// 1)]
  [[nodiscard]] std::vector<std::complex<float>> spectra(const Synthesizer::Plan::Period& on) const;
  /// Several samples of the grid from one node's to the next: no two's taps evict each other.
  [[nodiscard]] static std::size_t grid_stride(std::size_t length);
  /// How far a phone's delays are from those at the array's reference point [samples].
  [[nodiscard]] double array_reach() const;
  /// Impulses beside the period come round, and the grid is transformed. \return its bins
  static std::complex<float>* transformed(const ComplexFft<float>& fft, std::size_t beside,
                                          std::complex<float>* grid);
  void grid_into_kept();
  [[nodiscard]] std::vector<std::size_t> cuts(const OrderedReturns::Band& band) const;
  void grid_and_transform(Baseband& result);
  void transform(bool keep, Baseband& result);
  void add_product(const std::complex<float>* grid, std::size_t response, std::size_t node,
                   std::complex<float>* sum) const;

  /// Finds the windows of the batch in hand. \return whether they are cheaper than the
  /// whole grid; always so once they were
  [[nodiscard]] bool find_windows();
  /// Adds the batch in hand, in time. \param result  rows in time
  void grid_in_windows(Baseband& result);
  [[nodiscard]] std::complex<float>* kept(std::size_t channel, std::size_t response,
                                          std::size_t node) {
    return kept_.data() +
           ((channel * responses_ + response) * returns_.nodes.size() + node) * stride_;
  }

  const Synthesizer::Plan& plan_;
  const ReturnSource& source_;
  std::span<const Vec3> phones_;
  std::size_t responses_, bins_;
  OrderedReturns returns_;
  std::size_t beside_, stride_;  // samples of a grid on either side of the period; from one to next
  ImpulseGrid grid_;
  std::vector<ReturnBlock> blocks_;           // of the batch in hand
  std::vector<std::complex<float>> spectra_;  // [responses × nodes × bins], of windows if used
  DelayWindows windows_;
  std::ptrdiff_t highest_of_window_ = 0;
  FftBuffer<std::complex<float>> kept_;  // [channels × responses × nodes × stride], if it is
};

}  // namespace asdic::detail
