#include "raytrace/ocean/sound_speed.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

#include "core/error.h"
#include "raytrace/ocean/cubic_slopes.h"
#include "raytrace/ocean/number_text.h"
#include "raytrace/ocean/samples.h"

namespace asdic::detail {
namespace {

void check_samples(std::span<const double> depth, std::span<const double> speed) {
  check_count(depth.size(), "depth", 1);
  check_as_many(speed.size(), "speed", depth.size(), "depths");
  for (std::size_t i = 0; i < depth.size(); ++i) {
    check_place(depth, i, "depth", "a depth below");
    check_speed(speed[i], element("speed", i));
  }
}

/// The cubics with these speeds and slopes at the samples (Hermite).
std::vector<IntervalLaw> hermite_laws(std::span<const double> depth, std::span<const double> speed,
                                      const CubicSamples& s, const std::vector<double>& slope) {
  std::vector<IntervalLaw> laws;
  for (std::size_t i = 0; i < s.width.size(); ++i) {
    const double h = s.width[i], delta = s.secant[i];
    laws.push_back({.z0 = depth[i],
                    .a = {speed[i], slope[i], (3.0 * delta - 2.0 * slope[i] - slope[i + 1]) / h,
                          (slope[i] + slope[i + 1] - 2.0 * delta) / (h * h)}});
  }
  return laws;
}

std::vector<double> slopes_by(Interpolation interpolation, const CubicSamples& samples) {
  if (interpolation == Interpolation::spline) return spline_slopes(samples);
  if (interpolation == Interpolation::pchip) return pchip_slopes(samples);
  return limited_spline_slopes(samples);
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
    case Interpolation::pchip_spline_slopes:
      return "pchip-spline-slopes";
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
    const CubicSamples samples(depth, speed);
    profile.law_ = hermite_laws(depth, speed, samples, slopes_by(interpolation, samples));
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
  check_speed(speed, "speed");
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

}  // namespace asdic::detail
