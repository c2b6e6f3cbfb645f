#pragma once
#include <complex>
#include <cstddef>
#include <vector>

#include "raytrace/waves/wave_column.h"

namespace asdic::detail {

/// The wavenumbers that stay in the water at one range, evenly spaced above the real axis: those up
/// to an angle at the fastest depth. Steeper ones fade out over half of that angle more.
struct WaterWindow {
  double spacing = 0.0, offset = 0.0;        ///< [1/m]
  double begin = 0.0, end = 0.0;             ///< real parts [1/m]
  double low_width = 0.0, high_width = 0.0;  ///< of its edges [1/m]
  std::size_t count = 0;

  [[nodiscard]] std::complex<double> at(std::size_t j) const noexcept {
    return {begin + (double(j) + 0.5) * spacing, offset};
  }
  /// From nothing to one and back. \param s  wavenumber [1/m]
  [[nodiscard]] double weight(double s) const noexcept;
  /// Factor of g(ξ) at any range, and the factors of all wavenumbers at a range: the sum over the
  /// window of g times both is p(r). \param range  > 0 [m]
  [[nodiscard]] std::complex<double> factor(std::complex<double> xi) const noexcept;
  [[nodiscard]] std::vector<std::complex<double>> factors(double range) const;
};

/// Angle at the fastest depth beyond which waves beside rays need not be looked for, neither where
/// rays turn nor in their shadows: six times (2c′/ω)^{1/3}, what Airy's function spreads for the
/// steepest gradient, at least 4° [rad]
[[nodiscard]] double angle_of_spreading(const Environment& ocean, double frequency);

/// Angle at the fastest depth beyond which the water itself returns less than 1e-3 of a wave: it
/// turns none, and what its corners and bends reflect has died out. There waves are rays.
/// \param most  angle_of_spreading() [rad]   \return 4° … most [rad]
[[nodiscard]] double angle_of_the_returned(const WaveColumn& column, double most);

/// \param angle  the steepest at the fastest depth [rad]   \param range  the furthest [m]
[[nodiscard]] WaterWindow water_window(const WaveColumn& column, double angle, double range);

}  // namespace asdic::detail
