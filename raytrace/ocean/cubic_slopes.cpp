#include "raytrace/ocean/cubic_slopes.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail {
namespace {

/// Slopes of the parabola through three samples.
std::vector<double> parabola_slopes(const CubicSamples& s) {
  const double curvature = (s.secant[1] - s.secant[0]) / (s.width[0] + s.width[1]);  // c″/2
  return {s.secant[0] - curvature * s.width[0], s.secant[0] + curvature * s.width[0],
          s.secant[1] + curvature * s.width[1]};
}

/// One-sided three-point slope at an end whose own interval is (h0, δ0) and whose next is (h1, δ1),
/// held back where it would break monotony. Fritsch & Carlson, SIAM J. Numer. Anal. 17, 238 (1980).
double pchip_end_slope(double h0, double h1, double delta0, double delta1) {
  const double slope = ((2.0 * h0 + h1) * delta0 - h0 * delta1) / (h0 + h1);
  if (slope * delta0 <= 0.0) return 0.0;
  if (delta0 * delta1 <= 0.0 && std::abs(slope) > 3.0 * std::abs(delta0)) return 3.0 * delta0;
  return slope;
}

/// Slopes of the cubic spline with given slopes at its ends. c″ is continuous at every inner
/// sample,
///   h_i·m_{i−1} + 2(h_{i−1} + h_i)·m_i + h_{i−1}·m_{i+1} = 3(h_i·δ_{i−1} + h_{i−1}·δ_i).
std::vector<double> clamped_spline_slopes(const CubicSamples& s, double first, double last) {
  const std::size_t n = s.width.size() + 1;
  const auto& h = s.width;
  std::vector<double> upper = {0.0}, slope = {first};  // m_i + upper_i·m_{i+1} = slope_i
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double pivot = 2.0 * (h[i - 1] + h[i]) - h[i] * upper.back();
    const double right = 3.0 * (h[i] * s.secant[i - 1] + h[i - 1] * s.secant[i]);
    upper.push_back(h[i - 1] / pivot);
    slope.push_back((right - h[i] * slope.back()) / pivot);
  }
  slope.push_back(last);
  for (std::size_t i = n - 1; i-- > 1;) slope[i] -= upper[i] * slope[i + 1];
  return slope;
}

}  // namespace

CubicSamples::CubicSamples(std::span<const double> depth, std::span<const double> speed) {
  for (std::size_t i = 0; i + 1 < depth.size(); ++i) {
    width.push_back(depth[i + 1] - depth[i]);
    secant.push_back((speed[i + 1] - speed[i]) / width.back());
  }
}

/// Slopes of the cubic spline that is one and the same cubic over its first two, and over its last
/// two, intervals ("not-a-knot"). de Boor, A Practical Guide to Splines (2001), ch. IV.
///
/// Unknown slopes m_i. c″ is continuous at every inner sample,
///   h_i·m_{i−1} + 2(h_{i−1} + h_i)·m_i + h_{i−1}·m_{i+1} = 3(h_i·δ_{i−1} + h_{i−1}·δ_i),
/// and so is c‴ at the second; with c″ there, m_2 eliminated:
///   h_1·m_0 + (h_0 + h_1)·m_1 = [(3h_0 + 2h_1)·h_1·δ_0 + h_0²·δ_1]/(h_0 + h_1);
/// likewise, mirrored, at the last but one. A tridiagonal system, solved without pivoting.
std::vector<double> spline_slopes(const CubicSamples& s) {
  const std::size_t n = s.width.size() + 1;
  if (n == 2) return {s.secant[0], s.secant[0]};
  if (n == 3) return parabola_slopes(s);
  const auto& h = s.width;
  const auto& delta = s.secant;

  // Rows after elimination: m_i + upper_i·m_{i+1} = slope_i.
  std::vector<double> upper = {(h[0] + h[1]) / h[1]};
  std::vector<double> slope = {
      ((3.0 * h[0] + 2.0 * h[1]) * h[1] * delta[0] + h[0] * h[0] * delta[1]) /
      ((h[0] + h[1]) * h[1])};
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double pivot = 2.0 * (h[i - 1] + h[i]) - h[i] * upper.back();
    const double right = 3.0 * (h[i] * delta[i - 1] + h[i - 1] * delta[i]);
    upper.push_back(h[i - 1] / pivot);
    slope.push_back((right - h[i] * slope.back()) / pivot);
  }
  const double a = h[n - 2], b = h[n - 3];  // last and last but one
  const double right = ((3.0 * a + 2.0 * b) * b * delta[n - 2] + a * a * delta[n - 3]) / (a + b);
  slope.push_back((right - (a + b) * slope.back()) / (b - (a + b) * upper.back()));
  for (std::size_t i = n - 1; i-- > 0;) slope[i] -= upper[i] * slope[i + 1];
  return slope;
}

/// Weighted harmonic mean of the neighbouring secants; 0 at an extremum.
/// Fritsch & Butland, SIAM J. Sci. Stat. Comput. 5, 300 (1984).
std::vector<double> pchip_slopes(const CubicSamples& s) {
  const std::size_t n = s.width.size() + 1;
  if (n == 2) return {s.secant[0], s.secant[0]};
  const auto& h = s.width;
  const auto& delta = s.secant;

  std::vector<double> slope(n);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    if (delta[i - 1] * delta[i] <= 0.0) continue;
    const double before = h[i - 1] + 2.0 * h[i], after = 2.0 * h[i - 1] + h[i];
    slope[i] = (before + after) / (before / delta[i - 1] + after / delta[i]);
  }
  slope[0] = pchip_end_slope(h[0], h[1], delta[0], delta[1]);
  slope[n - 1] = pchip_end_slope(h[n - 2], h[n - 3], delta[n - 2], delta[n - 3]);
  return slope;
}

/// The slopes of a clamped spline, each held between 0 and three times the smaller neighbouring
/// secant, within which a cubic is monotone (Fritsch & Carlson 1980); 0 at an extremum.
std::vector<double> limited_spline_slopes(const CubicSamples& s) {
  const std::size_t n = s.width.size() + 1;
  if (n == 2) return {s.secant[0], s.secant[0]};
  const auto& h = s.width;
  const auto& delta = s.secant;
  const double first = pchip_end_slope(h[0], h[1], delta[0], delta[1]);
  const double last = pchip_end_slope(h[n - 2], h[n - 3], delta[n - 2], delta[n - 3]);
  std::vector<double> slope = clamped_spline_slopes(s, first, last);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double a = delta[i - 1], b = delta[i];
    const double most = a * b > 0.0 ? 3.0 * std::min(std::abs(a), std::abs(b)) : 0.0;
    slope[i] = a > 0.0 ? std::clamp(slope[i], 0.0, most) : std::clamp(slope[i], -most, 0.0);
  }
  return slope;
}

}  // namespace asdic::detail
