#include "raytrace/ocean/sound_speed.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <sstream>
#include <string>

#include "core/error.h"

namespace asdic {
namespace {

std::string with_unit(double value, const char* unit) {
  std::ostringstream text;
  text << value << ' ' << unit;
  return text.str();
}

std::string element(const char* array, std::size_t i) {
  return std::string(array) + '[' + std::to_string(i) + ']';
}

void check_samples(std::span<const double> depth, std::span<const double> speed) {
  if (depth.empty())
    throw InputError({.where = "depth", .got = "no samples", .expected = "at least one"});
  if (speed.size() != depth.size())
    throw InputError({.where = "speed",
                      .got = std::to_string(speed.size()) + " values",
                      .expected = "as many as depths: " + std::to_string(depth.size())});
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (!std::isfinite(depth[i]))
      throw InputError({.where = element("depth", i),
                        .got = with_unit(depth[i], "m"),
                        .expected = "a finite depth"});
    if (i > 0 && depth[i] <= depth[i - 1])
      throw InputError(
          {.where = element("depth", i),
           .got = with_unit(depth[i], "m"),
           .expected = "a depth below the one before, " + with_unit(depth[i - 1], "m")});
    if (!std::isfinite(speed[i]) || speed[i] <= 0.0)
      throw InputError({.where = element("speed", i),
                        .got = with_unit(speed[i], "m/s"),
                        .expected = "a speed above 0 m/s"});
  }
}

/// Samples and what both cubic rules need of them: n ≥ 2 samples, n − 1 intervals.
struct Samples {
  std::vector<double> width;   // h_i = z_{i+1} − z_i [m]
  std::vector<double> secant;  // δ_i = (c_{i+1} − c_i)/h_i [1/s]

  Samples(std::span<const double> depth, std::span<const double> speed) {
    for (std::size_t i = 0; i + 1 < depth.size(); ++i) {
      width.push_back(depth[i + 1] - depth[i]);
      secant.push_back((speed[i + 1] - speed[i]) / width.back());
    }
  }
};

/// Slopes of the parabola through three samples.
std::vector<double> parabola_slopes(const Samples& s) {
  const double curvature = (s.secant[1] - s.secant[0]) / (s.width[0] + s.width[1]);  // c″/2
  return {s.secant[0] - curvature * s.width[0], s.secant[0] + curvature * s.width[0],
          s.secant[1] + curvature * s.width[1]};
}

/// Slopes of the cubic spline that is one and the same cubic over its first two, and over its last
/// two, intervals ("not-a-knot"). de Boor, A Practical Guide to Splines (2001), ch. IV.
///
/// Unknown slopes m_i. c″ is continuous at every inner sample,
///   h_i·m_{i−1} + 2(h_{i−1} + h_i)·m_i + h_{i−1}·m_{i+1} = 3(h_i·δ_{i−1} + h_{i−1}·δ_i),
/// and so is c‴ at the second; with c″ there, m_2 eliminated:
///   h_1·m_0 + (h_0 + h_1)·m_1 = [(3h_0 + 2h_1)·h_1·δ_0 + h_0²·δ_1]/(h_0 + h_1);
/// likewise, mirrored, at the last but one. A tridiagonal system, solved without pivoting.
std::vector<double> spline_slopes(const Samples& s) {
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

/// One-sided three-point slope at an end whose own interval is (h0, δ0) and whose next is (h1, δ1),
/// held back where it would break monotony. Fritsch & Carlson, SIAM J. Numer. Anal. 17, 238 (1980).
double pchip_end_slope(double h0, double h1, double delta0, double delta1) {
  const double slope = ((2.0 * h0 + h1) * delta0 - h0 * delta1) / (h0 + h1);
  if (slope * delta0 <= 0.0) return 0.0;
  if (delta0 * delta1 <= 0.0 && std::abs(slope) > 3.0 * std::abs(delta0)) return 3.0 * delta0;
  return slope;
}

/// Weighted harmonic mean of the neighbouring secants; 0 at an extremum.
/// Fritsch & Butland, SIAM J. Sci. Stat. Comput. 5, 300 (1984).
std::vector<double> pchip_slopes(const Samples& s) {
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

/// The cubics with these speeds and slopes at the samples (Hermite).
std::vector<IntervalLaw> hermite_laws(std::span<const double> depth, std::span<const double> speed,
                                      const Samples& s, const std::vector<double>& slope) {
  std::vector<IntervalLaw> laws;
  for (std::size_t i = 0; i < s.width.size(); ++i) {
    const double h = s.width[i], delta = s.secant[i];
    laws.push_back({.z0 = depth[i],
                    .a = {speed[i], slope[i], (3.0 * delta - 2.0 * slope[i] - slope[i + 1]) / h,
                          (slope[i] + slope[i + 1] - 2.0 * delta) / (h * h)}});
  }
  return laws;
}

/// Straight lines through `value` (c, or 1/c²) at the samples.
std::vector<IntervalLaw> linear_laws(std::span<const double> depth, std::span<const double> value) {
  std::vector<IntervalLaw> laws;
  for (std::size_t i = 0; i + 1 < depth.size(); ++i) {
    const double slope = (value[i + 1] - value[i]) / (depth[i + 1] - depth[i]);
    laws.push_back({.z0 = depth[i], .a = {value[i], slope, 0.0, 0.0}});
  }
  return laws;
}

/// A spline may overshoot its samples, but not as far as this.
void check_swing(const IntervalLaw& law, double width, double lowest, double highest) {
  const double a = 3.0 * law.a[3], b = 2.0 * law.a[2], c = law.a[1];  // p′(t) = a·t² + b·t + c
  const double discriminant = b * b - 4.0 * a * c;
  if (discriminant < 0.0) return;  // monotone between its samples
  const double w = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  for (const double t : {a != 0.0 ? w / a : -1.0, w != 0.0 ? c / w : -1.0}) {
    if (t <= 0.0 || t >= width) continue;
    const double extreme = law.a[0] + t * (law.a[1] + t * (law.a[2] + t * law.a[3]));
    if (extreme < lowest || extreme > highest)
      throw InputError({.where = "interpolation",
                        .got = "a spline that swings to " + with_unit(extreme, "m/s") + " at " +
                               with_unit(law.z0 + t, "m"),
                        .expected = "a smoother profile, or pchip, which never overshoots"});
  }
}

/// Munk's law and its derivatives, in closed form.
SoundSpeed munk_speed(const MunkParameters& m, double depth) noexcept {
  const double eta = 2.0 * (depth - m.axis_depth) / m.scale_depth;
  const double per_metre = 2.0 / m.scale_depth;  // dη/dz
  const double decay = std::exp(-eta);
  const double strength = m.axis_speed * m.perturbation;
  return {.c = m.axis_speed + strength * (eta - 1.0 + decay),
          .dc_dz = strength * (1.0 - decay) * per_metre,
          .d2c_dz2 = strength * decay * per_metre * per_metre};
}

}  // namespace

std::string_view name(Interpolation interpolation) noexcept {
  switch (interpolation) {
    case Interpolation::c_linear:
      return "c-linear";
    case Interpolation::n2_linear:
      return "n2-linear";
    case Interpolation::spline:
      return "spline";
    case Interpolation::pchip:
      return "pchip";
  }
  return "";
}

SoundSpeedProfile SoundSpeedProfile::table(std::span<const double> depth,
                                           std::span<const double> speed,
                                           Interpolation interpolation) {
  check_samples(depth, speed);
  SoundSpeedProfile profile;
  profile.interpolation_ = interpolation;
  profile.depth_.assign(depth.begin(), depth.end());
  profile.speed_.assign(speed.begin(), speed.end());
  profile.lowest_ = 0.5 * *std::min_element(speed.begin(), speed.end());
  profile.highest_ = 2.0 * *std::max_element(speed.begin(), speed.end());

  std::vector<double> inverse_square;  // 1/c², what n2_linear draws its lines through
  for (const double c : speed) inverse_square.push_back(1.0 / (c * c));
  const bool n2 = interpolation == Interpolation::n2_linear;
  const std::span<const double> value = n2 ? std::span<const double>(inverse_square) : speed;

  if (depth.size() == 1) {
    profile.law_ = {{.z0 = depth[0], .a = {value[0], 0.0, 0.0, 0.0}}};
  } else if (n2 || interpolation == Interpolation::c_linear) {
    profile.law_ = linear_laws(depth, value);
  } else {
    const Samples samples(depth, speed);
    const bool spline = interpolation == Interpolation::spline;
    profile.law_ = hermite_laws(depth, speed, samples,
                                spline ? spline_slopes(samples) : pchip_slopes(samples));
    for (std::size_t i = 0; i < profile.law_.size(); ++i)
      check_swing(profile.law_[i], samples.width[i], profile.lowest_, profile.highest_);
  }
  return profile;
}

SoundSpeedProfile SoundSpeedProfile::munk(const MunkParameters& m) {
  const auto require = [](bool good, const char* where, double got, const char* expected) {
    if (!good || !std::isfinite(got))
      throw InputError({.where = where, .got = with_unit(got, ""), .expected = expected});
  };
  require(m.axis_speed > 0.0, "axis_speed", m.axis_speed, "a speed above 0 m/s");
  require(true, "axis_depth", m.axis_depth, "a finite depth [m]");
  require(m.scale_depth > 0.0, "scale_depth", m.scale_depth, "a depth above 0 m");
  require(m.perturbation >= 0.0, "perturbation", m.perturbation, "a number not below 0");
  SoundSpeedProfile profile;
  profile.munk_ = m;
  return profile;
}

SoundSpeedProfile SoundSpeedProfile::isovelocity(double speed) {
  if (!std::isfinite(speed) || speed <= 0.0)
    throw InputError(
        {.where = "speed", .got = with_unit(speed, "m/s"), .expected = "a speed above 0 m/s"});
  const double surface = 0.0;
  return table({&surface, 1}, {&speed, 1}, Interpolation::c_linear);
}

std::size_t SoundSpeedProfile::interval(double depth) const noexcept {
  assert(!law_.empty());
  if (law_.size() == 1) return 0;
  // The inner samples divide the intervals: as many of them as are not below `depth`.
  const auto first = depth_.begin() + 1, last = depth_.end() - 1;
  return static_cast<std::size_t>(std::upper_bound(first, last, depth) - first);
}

SoundSpeed SoundSpeedProfile::at(double depth, std::size_t i) const noexcept {
  assert(i < law_.size());
  const IntervalLaw& law = law_[i];
  const auto& a = law.a;
  const double t = depth - law.z0;
  if (interpolation_ == Interpolation::n2_linear) {
    const double c = 1.0 / std::sqrt(a[0] + a[1] * t);
    const double dc_dz = -0.5 * c * c * c * a[1];  // c′ = −c³/2·d(1/c²)/dz
    return {.c = c, .dc_dz = dc_dz, .d2c_dz2 = 3.0 * dc_dz * dc_dz / c};  // c″ = 3c′²/c
  }
  return {.c = a[0] + t * (a[1] + t * (a[2] + t * a[3])),
          .dc_dz = a[1] + t * (2.0 * a[2] + t * 3.0 * a[3]),
          .d2c_dz2 = 2.0 * a[2] + 6.0 * a[3] * t};
}

SoundSpeed SoundSpeedProfile::at(double depth) const noexcept {
  if (munk_) return munk_speed(*munk_, depth);
  const SoundSpeed speed = at(depth, interval(depth));
  if (depth >= depth_.front() && depth <= depth_.back()) return speed;
  if (speed.c >= lowest_ && speed.c <= highest_) return speed;
  // Past 1/c² = 0 the law gives NaN, which fails both comparisons above and this one.
  return {.c = speed.c < lowest_ ? lowest_ : highest_, .dc_dz = 0.0, .d2c_dz2 = 0.0};
}

}  // namespace asdic
