#pragma once
#include <span>
#include <vector>

namespace asdic::detail {

/// Samples and what the cubic rules need of them: n ≥ 2 samples, n − 1 intervals.
struct CubicSamples {
  std::vector<double> width;   ///< h_i = z_{i+1} − z_i
  std::vector<double> secant;  ///< δ_i = (c_{i+1} − c_i)/h_i

  CubicSamples(std::span<const double> depth, std::span<const double> speed);
};

/// Slopes [n] at the samples, from which each interval's cubic follows (Hermite). The rules behind
/// Interpolation::spline, pchip and pchip_spline_slopes; docs/theory/sound-speed.md.
[[nodiscard]] std::vector<double> spline_slopes(const CubicSamples& samples);
[[nodiscard]] std::vector<double> pchip_slopes(const CubicSamples& samples);
[[nodiscard]] std::vector<double> limited_spline_slopes(const CubicSamples& samples);

}  // namespace asdic::detail
