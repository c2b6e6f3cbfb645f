#include "sonar/synthesis/doppler_ridge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "core/rotate_back.h"
#include "core/units.h"

namespace asdic::detail {
namespace {

constexpr double ridge_error = 1e-4;      // of the pulse, −80 dB
constexpr std::size_t ridge_points = 32;  // Chebyshev points of the factors that are looked at
constexpr int ridge_times = 128;          // of the pulse

/// θ_j of the points cos θ_j.
double chebyshev_angle(std::size_t j) {
  return pi * (static_cast<double>(j) + 0.5) / double{ridge_points};
}

/// Values at Chebyshev points to the coefficients of their polynomials: 2/points·cos(nθ_j).
/// \return [n, j]
std::vector<double> chebyshev_transform() {
  std::vector<double> found(ridge_points * ridge_points);
  for (std::size_t n = 0; n < ridge_points; ++n)
    for (std::size_t j = 0; j < ridge_points; ++j)
      found[n * ridge_points + j] =
          2.0 / double{ridge_points} * std::cos(static_cast<double>(n) * chebyshev_angle(j));
  return found;
}

}  // namespace

/// The κ for which c(η(t + κ(η − 1)))·e^{i2πf_c(η − 1)(t + κ(η − 1))} changes least with η at 1:
/// there its derivative is a + κb, a = t·c′ + i2πf_c·t·c, b = c′, and Σ|a + κb|² is least at
/// −Σ Re(b*a)/Σ|b|².
DopplerRidge::DopplerRidge(const BandLimitedPulse& pulse) : pulse_(pulse) {
  constexpr int times = 512;
  const double apart = 2.0 * pulse.half_duration() / times;
  const double step = 1e-3 / pulse.half_band();
  double product = 0.0, power = 0.0;
  for (int i = 0; i < times; ++i) {
    const double t = (i + 0.5) * apart - pulse.half_duration();
    const std::complex<double> b = (pulse.at(t + step) - pulse.at(t - step)) / (2.0 * step);
    const std::complex<double> rotated(0.0, 2.0 * pi * pulse.centre_frequency() * t);
    product += (std::conj(b) * (t * b + rotated * pulse.at(t))).real();
    power += std::norm(b);
  }
  if (power > 0.0) slope_ = -product / power;
}

/// Of the moved pulses' Chebyshev coefficients over the span, a_n(t), an interpolation through N
/// points loses those from N on and adds them to others: Σ_{n≥N} 2|a_n|² at most, on average.
std::size_t DopplerRidge::nodes_needed(double span) const {
  const double half = 0.5 * span, furthest = std::abs(slope_) * half;
  if (std::abs(slope_) < 0.1 * pulse_.half_duration()) return too_many;
  if (furthest > 0.125 * pulse_.half_duration()) return too_many;
  const std::vector<double> transform = chebyshev_transform();
  std::array<double, ridge_points> shifts;  // η − 1
  for (std::size_t j = 0; j < ridge_points; ++j) shifts[j] = half * std::cos(chebyshev_angle(j));
  std::array<double, ridge_points> lost{}, at, real, imaginary;
  double all = 0.0;
  const double last = pulse_.half_duration() / (1.0 - half) + furthest;
  for (int i = 0; i < ridge_times; ++i) {
    const double time = last * ((2.0 * i + 1.0) / ridge_times - 1.0);
    const auto moved = [&](double shift) { return time + slope_ * shift; };
    for (std::size_t j = 0; j < ridge_points; ++j) at[j] = (1.0 + shifts[j]) * moved(shifts[j]);
    pulse_.at(at, real, imaginary);
    for (std::size_t j = 0; j < ridge_points; ++j) {
      const double cycles = pulse_.centre_frequency() * shifts[j] * moved(shifts[j]);
      rotate_back(-cycles, real[j], imaginary[j]);
      all += (real[j] * real[j] + imaginary[j] * imaginary[j]) / double{ridge_points};
    }
    for (std::size_t n = 0; n < ridge_points; ++n) {
      double a = 0.0, b = 0.0;
      for (std::size_t j = 0; j < ridge_points; ++j) {
        a += transform[n * ridge_points + j] * real[j];
        b += transform[n * ridge_points + j] * imaginary[j];
      }
      lost[n] += 2.0 * (a * a + b * b);
    }
  }
  double beyond = 0.0;
  std::size_t count = ridge_points;
  while (count > 0 && (beyond += lost[count - 1]) <= ridge_error * ridge_error * all) --count;
  return std::clamp<std::size_t>(count, 1, too_many);
}

}  // namespace asdic::detail
