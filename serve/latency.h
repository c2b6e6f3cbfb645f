#pragma once
#include <array>
#include <cstddef>

namespace asdic::detail::serve {

/// How long answers took: of the latest thousand, and of all. Memory does not grow.
class LatencyLog {
 public:
  void add(double seconds) noexcept;

  [[nodiscard]] std::size_t count() const noexcept { return count_; }  ///< of all
  [[nodiscard]] double longest() const noexcept { return longest_; }   ///< of all [s]
  /// The share `p` of the latest thousand took no longer [s]; 0 before the first.
  [[nodiscard]] double percentile(double p) const;

 private:
  std::array<double, 1000> latest_{};
  std::size_t count_ = 0;
  double longest_ = 0.0;
};

}  // namespace asdic::detail::serve
