#pragma once
#include <cstddef>
#include <functional>
#include <vector>

#include "processing/factor_estimate.h"
#include "processing/matched_filter.h"

namespace asdic::detail {

/// A maximum over time of one beam and filter that stands over its threshold.
struct Peak {
  std::size_t beam = 0, filter = 0, sample = 0;
  float power = 0.0F, background = 0.0F, threshold = 0.0F;
};

/// What an echo leaks into the filters' other cells: |y|² of eq. (3) over differences of sample and
/// filter, both counted from the echo's own. A sweep's lies along its ridge: in a filter of another
/// factor the same echo comes earlier or later.
class LeakTable {
 public:
  /// \param late  the ridge: differences of one filter's factor from another's are told for a
  /// factor of 1, and about another one a long ridge's delays are others
  LeakTable(const Replica& replica, const MatchedFilterBank& bank, const RidgeDelay& late);

  /// \param samples  later than the echo   \param matched, filter  that which it matches, and that
  /// which is asked
  /// \return the largest |y|² within a sample of there, of an echo of power 1
  [[nodiscard]] double at(std::ptrdiff_t samples, std::size_t matched,
                          std::size_t filter) const noexcept;
  [[nodiscard]] std::ptrdiff_t reach() const noexcept { return reach_; }  ///< samples either way

 private:
  RidgeDelay late_;
  double lowest_ = 1.0, step_ = 0.0, rate_ = 0.0;  // factors; of the output [Hz]
  std::ptrdiff_t reach_ = 0, filters_ = 0;
  std::vector<float> values_;  // [2·filters_ − 1][2·reach_ + 1]
};

/// From the loudest down, those that no louder one explains.
/// \param keep       told of each that is kept, in that order (an index of `peaks`), before
///                    beam_leak() is asked about it
/// \param beam_leak  power that the thing behind a kept peak leaves in a beam
/// \param margin     factor of power   \param together  the powers that all louder ones leak add
/// up,
///                    as those of a pulse that answers for long do; else each is asked alone
/// \return indices, loudest first, at most `most`
[[nodiscard]] std::vector<std::size_t> independent_peaks(
    const std::vector<Peak>& peaks, const LeakTable& leaks,
    const std::function<void(std::size_t kept)>& keep,
    const std::function<double(std::size_t kept, std::size_t beam)>& beam_leak, double margin,
    std::size_t most, bool together = false);

}  // namespace asdic::detail
