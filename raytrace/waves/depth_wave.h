#pragma once
#include <complex>

namespace asdic::detail {

/// A piece of depth in which the square of the vertical wavenumber is a line: 1/c² linear.
struct WaveLayer {
  double thickness = 0.0;      ///< [m]
  std::complex<double> k2[2];  ///< (ω/c − iα)² at its upper and its lower edge [1/m²]
};

/// A solution of u″ + q(z)·u = 0 at one depth, q = (ω/c − iα)² − ξ², with its derivative in the
/// direction in which it is followed. Both are to be multiplied by e^growth: behind a turning point
/// it grows without end.
struct DepthWave {
  std::complex<double> u = 0.0, du = 1.0;  ///< du [1/m]
  double growth = 0.0;
};

/// What the wave becomes behind a piece in which q goes from `q_from` to `q_to` in a line. Exact
/// but for rounding and 1e-8: Airy's functions by their series for large arguments, about a turning
/// point by the power series of the equation itself. Stable in the direction in which the wave
/// grows, which is that away from the boundary that it starts from. docs/theory/waves.md
/// \param q_from, q_to  Im ≤ 0 [1/m²]   \param thickness  > 0 [m]
void follow(DepthWave& wave, std::complex<double> q_from, std::complex<double> q_to,
            double thickness) noexcept;

/// A wave that goes down and one that goes up, with their derivatives downwards. Each to a factor
/// of its own.
struct TravellingWaves {
  std::complex<double> down, down_slope, up, up_slope;
};

/// Those of a place where q is a line: of Airy's functions Bi ∓ iAi, so that a turning point beside
/// it turns them into each other without a word; far from one by their series. \param slope  dq/dz,
/// not 0 [1/m³]
[[nodiscard]] TravellingWaves travelling_waves(std::complex<double> q, double slope) noexcept;

/// f·g′ − f′·g, of two solutions with their derivatives.
[[nodiscard]] inline std::complex<double> wronskian(std::complex<double> f,
                                                    std::complex<double> f_slope,
                                                    std::complex<double> g,
                                                    std::complex<double> g_slope) noexcept {
  return f * g_slope - f_slope * g;
}

/// √q with Im ≤ 0: e^{−iwz} goes down, or dies out downwards.
[[nodiscard]] std::complex<double> vertical_wavenumber(std::complex<double> q) noexcept;

}  // namespace asdic::detail
