#pragma once
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace asdic::detail {

/// Σ_j a_j·e^{−i·j·δ·r} at any ranges r, for j of a block evenly spaced by δ: a fast Fourier
/// transform twice as long, and between its samples a window of twelve (A. H. Barnett, J. F.
/// Magland and L. af Klinteberg, SIAM J. Sci. Comput. 41, C479 (2019)). The error is 1e-9 of
/// Σ|a_j|. Const: shared by threads.
class RangeSum {
 public:
  static constexpr std::size_t block = 2048;

  /// \param spacing  δ [1/m]   \param ranges  [n] ≥ 0, δ·r < 2π [m]
  RangeSum(double spacing, std::span<const double> ranges);

  /// What one thread works in.
  struct Memory {
    std::vector<std::complex<double>> in, out;
  };

  /// \param a  [block]; \return in sum [n], what it was is overwritten. Phases count from the
  /// middle of the block, j = block/2.
  void sum(std::span<const std::complex<double>> a, Memory& memory,
           std::span<std::complex<double>> sum) const;

 private:
  static constexpr std::size_t window = 12;
  static constexpr std::size_t fine = 2 * block;

  std::vector<double> correction_;  // [block] one over the window's transform
  std::vector<std::size_t> first_;  // [n] first sample under the window
  std::vector<double> weight_;      // [n × window]
};

}  // namespace asdic::detail
