#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>

// Where taps meet samples. What is read between samples is gathered, what is laid between them is
// deposited; taps of either kind are made by windowed_sinc.h, interpolation_taps.h and
// synthesis/delay_kernel.h.
namespace asdic::detail {

/// Σ_k weight(k)·sample(k, j) of samples j that lie side by side, tap after tap. A sample is what a
/// weight multiplies: a number, a complex number, or channels in lanes, each of which then is what
/// it is as a number.
template <class Sample, std::size_t taps, std::size_t side, class WeightAt, class SampleAt>
[[nodiscard, gnu::always_inline]] inline std::array<Sample, side> gather(
    const WeightAt& weight, const SampleAt& sample) noexcept {
  std::array<Sample, side> sum{};
#pragma GCC unroll 24
  for (std::size_t k = 0; k < taps; ++k)
    for (std::size_t j = 0; j < side; ++j) sum[j] += weight(k) * sample(k, j);
  return sum;
}

/// The same of one channel with its taps in lanes, in which they are summed: to rounding.
/// \param samples  under the taps
template <class Weights>
[[nodiscard, gnu::always_inline]] inline typename Weights::Scalar gather(
    const Weights& weights, const typename Weights::Scalar* samples) noexcept {
  return (weights * Eigen::Map<const Weights>(samples)).sum();
}

/// The adjoint, onto grids that lie side by side: samples[j·stride + k] += Σ_r
/// shares[r·row + j]·taps[r][k], over impulses r between the same two samples. The sum is in
/// registers. \param shares  of the first impulse on each grid
template <std::size_t side, class Weights>
[[gnu::always_inline]] inline void deposit(const Weights* taps, std::size_t impulses,
                                           const typename Weights::Scalar* shares, std::size_t row,
                                           typename Weights::Scalar* samples,
                                           std::size_t stride) noexcept {
  std::array<Weights, side> sum;
  for (std::size_t j = 0; j < side; ++j) sum[j].setZero();
  for (std::size_t r = 0; r < impulses; ++r)
    for (std::size_t j = 0; j < side; ++j) sum[j] += shares[r * row + j] * taps[r];
  for (std::size_t j = 0; j < side; ++j) Eigen::Map<Weights>(samples + j * stride) += sum[j];
}

}  // namespace asdic::detail
