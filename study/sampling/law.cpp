#include "study/sampling/law.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/units.h"

namespace asdic::detail::study {
namespace {

Tails tails_of(const Uniform& law, double x) noexcept {
  const double lower = std::clamp((x - law.low) / (law.high - law.low), 0.0, 1.0);
  return {lower, std::clamp((law.high - x) / (law.high - law.low), 0.0, 1.0)};
}

Tails normal_tails(double z) noexcept {
  return {0.5 * std::erfc(-z / std::numbers::sqrt2), 0.5 * std::erfc(z / std::numbers::sqrt2)};
}

Tails tails_of(const Normal& law, double x) noexcept {
  return normal_tails((x - law.mean) / law.deviation);
}

Tails tails_of(const LogNormal& law, double x) noexcept {
  if (!(x > 0.0)) return {0.0, 1.0};
  return normal_tails(std::log(x / law.median) / law.log_deviation);
}

Tails tails_of(const Triangular& law, double x) noexcept {
  const double width = law.high - law.low;
  if (x <= law.low) return {0.0, 1.0};
  if (x >= law.high) return {1.0, 0.0};
  if (x < law.mode) {
    const double lower = (x - law.low) * (x - law.low) / (width * (law.mode - law.low));
    return {lower, 1.0 - lower};
  }
  const double upper = (law.high - x) * (law.high - x) / (width * (law.high - law.mode));
  return {1.0 - upper, upper};
}

Tails tails_of(const Weibull& law, double x) noexcept {
  if (!(x > 0.0)) return {0.0, 1.0};
  const double h = std::pow(x / law.scale, law.shape);
  return {-std::expm1(-h), std::exp(-h)};
}

double quantile_of(const Uniform& law, const Tails& t) noexcept {
  return t.lower <= t.upper ? law.low + t.lower * (law.high - law.low)
                            : law.high - t.upper * (law.high - law.low);
}

double standard_normal(const Tails& t) noexcept {
  return t.lower <= t.upper ? -normal_upper_quantile(t.lower) : normal_upper_quantile(t.upper);
}

double quantile_of(const Normal& law, const Tails& t) noexcept {
  return law.mean + law.deviation * standard_normal(t);
}

double quantile_of(const LogNormal& law, const Tails& t) noexcept {
  return law.median * std::exp(law.log_deviation * standard_normal(t));
}

double quantile_of(const Triangular& law, const Tails& t) noexcept {
  const double width = law.high - law.low;
  if (t.lower * width <= law.mode - law.low)
    return law.low + std::sqrt(t.lower * width * (law.mode - law.low));
  return law.high - std::sqrt(t.upper * width * (law.high - law.mode));
}

double quantile_of(const Weibull& law, const Tails& t) noexcept {
  // −ln of the upper tail, out of whichever tail has the digits.
  const double h = t.lower <= t.upper ? -std::log1p(-t.lower) : -std::log(t.upper);
  return law.scale * std::pow(h, 1.0 / law.shape);
}

double density_of(const Uniform& law, double x) noexcept {
  return x < law.low || x > law.high ? 0.0 : 1.0 / (law.high - law.low);
}

double normal_density(double z) noexcept { return std::exp(-0.5 * z * z) / std::sqrt(2.0 * pi); }

double density_of(const Normal& law, double x) noexcept {
  return normal_density((x - law.mean) / law.deviation) / law.deviation;
}

double density_of(const LogNormal& law, double x) noexcept {
  if (!(x > 0.0)) return 0.0;
  return normal_density(std::log(x / law.median) / law.log_deviation) / (law.log_deviation * x);
}

double density_of(const Triangular& law, double x) noexcept {
  if (x < law.low || x > law.high) return 0.0;
  const double peak = 2.0 / (law.high - law.low);
  if (x < law.mode) return peak * (x - law.low) / (law.mode - law.low);
  return x == law.mode ? peak : peak * (law.high - x) / (law.high - law.mode);
}

double density_of(const Weibull& law, double x) noexcept {
  if (x < 0.0) return 0.0;
  const double r = x / law.scale;
  return law.shape / law.scale * std::pow(r, law.shape - 1.0) * std::exp(-std::pow(r, law.shape));
}

// Where each law ends.

Span support(const Uniform& law) { return {law.low, law.high}; }
Span support(const Triangular& law) { return {law.low, law.high}; }
Span support(const Normal&) { return {-infinity, infinity}; }
Span support(const LogNormal&) { return {0.0, infinity}; }
Span support(const Weibull&) { return {0.0, infinity}; }

}  // namespace

Weibull Weibull::of_mean(double shape, double mean) {
  return {.shape = shape, .scale = mean / std::tgamma(1.0 + 1.0 / shape)};
}

Weibull Weibull::rayleigh(double mean) { return of_mean(2.0, mean); }

Tails tails(const ContinuousLaw& law, double x) noexcept {
  return std::visit([&](const auto& l) { return tails_of(l, x); }, law);
}

double quantile(const ContinuousLaw& law, const Tails& t) noexcept {
  return std::visit([&](const auto& l) { return quantile_of(l, t); }, law);
}

double density(const ContinuousLaw& law, double x) noexcept {
  return std::visit([&](const auto& l) { return density_of(l, x); }, law);
}

double normal_upper_quantile(double p) noexcept {
  if (p >= 0.5) return 0.0;
  if (!(p > 0.0)) return infinity;
  // A rational guess within 4.5e-4 (Abramowitz & Stegun 26.2.23), then Halley's method on the
  // complementary error function, which triples the digits each time.
  const double t = std::sqrt(-2.0 * std::log(p));
  double z = t - (2.515517 + t * (0.802853 + t * 0.010328)) /
                     (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
  for (int i = 0; i < 2; ++i) {
    const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * pi);
    if (density == 0.0) break;
    const double step = (0.5 * std::erfc(z / std::numbers::sqrt2) - p) / density;
    z += step / (1.0 - 0.5 * z * step);
  }
  return z;
}

double normal_score(double u) noexcept {
  return u < 0.5 ? -normal_upper_quantile(u) : normal_upper_quantile(1.0 - u);
}

double normal_share(double score) noexcept {
  return std::clamp(0.5 * std::erfc(-score / std::numbers::sqrt2), 0x1p-54, 1.0 - 0x1p-53);
}

CutLaw::CutLaw(ContinuousLaw law, double low, double high) noexcept
    : law_(law), low_(low), high_(high), at_low_(tails(law, low)), at_high_(tails(law, high)) {}

double CutLaw::share() const noexcept {
  return at_low_.lower < 0.5 ? at_high_.lower - at_low_.lower : at_low_.upper - at_high_.upper;
}

Span CutLaw::ends() const noexcept {
  const auto [low, high] = std::visit([](const auto& law) { return support(law); }, law_);
  return {std::max(low, low_), std::min(high, high_)};
}

double CutLaw::quantile(double u) const noexcept {
  const Tails t{std::lerp(at_low_.lower, at_high_.lower, u),
                std::lerp(at_low_.upper, at_high_.upper, u)};
  return std::clamp(study::quantile(law_, t), low_, high_);
}

double CutLaw::density(double x) const noexcept {
  return x < low_ || x > high_ ? 0.0 : study::density(law_, x) / share();
}

double CutLaw::distribution(double x) const noexcept {
  const Tails t = tails(law_, std::clamp(x, low_, high_));
  return at_low_.lower < 0.5 ? (t.lower - at_low_.lower) / share()
                             : (at_low_.upper - t.upper) / share();
}

}  // namespace asdic::detail::study
