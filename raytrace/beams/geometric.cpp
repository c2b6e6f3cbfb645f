#include "raytrace/beams/geometric.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "raytrace/beams/crossing.h"
#include "raytrace/beams/foot.h"

namespace asdic::detail::beams {

namespace {

/// A beam across its ray at the foot of a receiver: the ray's amplitude there times the share of
/// the beam in it. Zero width means that the receiver is outside.
struct Cut {
  double amplitude = 0.0;  ///< coherent: A·W; otherwise A²·W
  bool inside = false;
};

/// A = √(1/|q|) and W = 1 − n/L, L = |q|·Δα.
Cut hat(double n, double q, double spacing, bool coherent) noexcept {
  const double half_width = std::abs(q) * spacing;
  if (!(n < half_width)) return {};
  const double weight = 1.0 - n / half_width;
  return {weight * (coherent ? 1.0 / std::sqrt(std::abs(q)) : 1.0 / std::abs(q)), true};
}

/// W = Δα·|q|/(σ√2π)·exp(−n²/2σ²), σ = max(Δα·|q|, least); A·W and A²·W are finite where q = 0.
Cut gaussian(double n, double q, double spacing, double least, bool coherent) noexcept {
  const double sigma = std::max(std::abs(q) * spacing, least);
  if (!(n < 4.0 * sigma)) return {};
  const double u = n / sigma;
  const double share = spacing / (sigma * std::sqrt(2.0 * pi)) * std::exp(-0.5 * u * u);
  return {share * (coherent ? std::sqrt(std::abs(q)) : 1.0), true};
}

}  // namespace

double gaussian_least_width(double frequency, double time, double speed) noexcept {
  return std::min(0.2 * frequency * time, pi * speed / frequency);
}

void add_crossing(const BeamSetting& setting, const BeamLaunch& launch, double launched,
                  double source_speed, const Crossing& x, std::span<const double> depths,
                  const AddTo& add_to) {
  if (x.q == 0.0) return;
  const double omega = 2.0 * pi * setting.frequency;
  const bool is_hat = setting.kind == BeamKind::hat;
  const double root = launched * std::sqrt(x.speed / source_speed);
  const double least = gaussian_least_width(setting.frequency, x.time, x.speed);
  const bool even = launch.higher == 0.0 && launch.lower == 0.0;
  const auto add = [&](std::size_t k) {
    const double dz = depths[k] - x.depth;
    const double spacing = even                            ? setting.spacing
                           : dz * x.toward_higher() >= 0.0 ? launch.higher
                                                           : launch.lower;
    const double n = std::abs(dz * x.cosine), s = dz * x.sine;
    const double q = x.q + x.dq_ds * s;
    const bool beyond = q * x.q < 0.0;  // a caustic lies between the ray and the foot
    if (beyond && is_hat) return false;
    const Cut cut = is_hat ? hat(n, q, spacing, setting.coherent)
                           : gaussian(n, q, spacing, least, setting.coherent);
    if (!cut.inside) return false;
    if (setting.coherent) {
      const std::complex<double> loss = beyond ? x.loss * caustic_phase(s > 0.0 ? 1 : -1) : x.loss;
      add_to(k, loss * std::polar(root * cut.amplitude, -omega * (x.time + s / x.speed)));
    } else {
      add_to(k, std::norm(x.loss) * root * root * cut.amplitude);
    }
    return true;
  };
  const auto first = static_cast<std::size_t>(
      std::lower_bound(depths.begin(), depths.end(), x.depth) - depths.begin());
  for (std::size_t k = first; k < depths.size() && add(k); ++k) {
  }
  for (std::size_t k = first; k > 0 && add(k - 1); --k) {
  }
}

void add_cartesian(const BeamSetting& setting, const BeamLaunch& launch, const RayTrajectory& ray,
                   FieldSum& field) {
  const double launched = launch_factor(setting, launch, ray.source_speed);
  for (const RaySegment& segment : ray.segments)
    for_each_crossing(segment, field.ranges, [&](std::size_t column, const RayState& state) {
      std::complex<double>* sum = field.column(column);
      add_crossing(setting, launch, launched, ray.source_speed,
                   crossing_of(setting, segment, state), field.column_depths(column),
                   [sum](std::size_t k, std::complex<double> p) { sum[k] += p; });
    });
}

void visit_ray_centred(const BeamSetting& setting, double launched, const RayTrajectory& ray,
                       FieldSum& field, const VisitFoot& visit) {
  const double omega = 2.0 * pi * setting.frequency;
  const bool is_hat = setting.kind == BeamKind::ray_centred_hat;
  const auto reach = [&](const RaySegment& segment) {
    const double q =
        std::max(std::abs(segment.begin.q), std::abs(segment.end.q)) +
        0.25 * (segment.end.length - segment.begin.length) *
            std::abs(segment.c_end * segment.end.p - segment.c_begin * segment.begin.p);
    const double hat_reach = q * setting.spacing;
    if (is_hat) return hat_reach;
    return 4.0 *
           std::max(hat_reach, gaussian_least_width(setting.frequency, segment.end.time,
                                                    std::max(segment.c_begin, segment.c_end)));
  };
  for_each_foot(ray, field, reach, std::identity{}, [&](const Foot& foot) {
    const RayState& state = foot.state;
    if (state.q == 0.0 && is_hat) return;
    const Crossing x = crossing_of(setting, *foot.segment, state);
    const double least = gaussian_least_width(setting.frequency, x.time, x.speed);
    const Cut cut = is_hat
                        ? hat(std::abs(foot.n), x.q, setting.spacing, setting.coherent)
                        : gaussian(std::abs(foot.n), x.q, setting.spacing, least, setting.coherent);
    if (!cut.inside) return;
    const double root = launched * std::sqrt(x.speed / ray.source_speed);
    visit(foot, x,
          setting.coherent ? x.loss * std::polar(root * cut.amplitude, -omega * x.time)
                           : std::norm(x.loss) * root * root * cut.amplitude);
  });
}

void add_ray_centred(const BeamSetting& setting, const BeamLaunch& launch, const RayTrajectory& ray,
                     FieldSum& field) {
  visit_ray_centred(
      setting, launch_factor(setting, launch, ray.source_speed), ray, field,
      [](const Foot& foot, const Crossing&, std::complex<double> p) { *foot.sum += p; });
}

void add_simple_crossing(const BeamSetting& setting, double launched, const Crossing& x,
                         std::span<const double> depths, const AddTo& add_to) {
  // Each beam is down to β where the next ray but one's half way is: exp(−A·(Δα/2)²) = β.
  constexpr double beta = 0.98;
  const double sharpness = -4.0 * std::log(beta) / (setting.spacing * setting.spacing);  // A
  const double norm = setting.spacing * std::sqrt(sharpness / pi);  // the beams' weights add to 1
  const double widest = std::sqrt(16.0 / sharpness);                // e^−16: nothing is left
  const double omega = 2.0 * pi * setting.frequency;
  if (x.length == 0.0) return;
  const auto add = [&](std::size_t k) {
    const double dz = depths[k] - x.depth;
    const double s = dz * x.sine;
    const double length = x.length + s;
    if (length <= 0.0) return false;
    const double theta = std::atan2(std::abs(dz * x.cosine), length);
    if (theta > widest) return false;
    const double amplitude =
        launched * norm * std::exp(-sharpness * theta * theta) / std::sqrt(length);
    if (setting.coherent)
      add_to(k, x.loss * std::polar(amplitude, -omega * (x.time + s / x.speed)));
    else  // A²·W with W = norm·exp(−Aθ²)
      add_to(k, std::norm(x.loss) * amplitude * amplitude * std::exp(sharpness * theta * theta) /
                    norm);
    return true;
  };
  const auto first = static_cast<std::size_t>(
      std::lower_bound(depths.begin(), depths.end(), x.depth) - depths.begin());
  for (std::size_t k = first; k < depths.size() && add(k); ++k) {
  }
  for (std::size_t k = first; k > 0 && add(k - 1); --k) {
  }
}

void add_simple_gaussian(const BeamSetting& setting, const BeamLaunch& launch,
                         const RayTrajectory& ray, FieldSum& field) {
  const double launched = launch_factor(setting, launch, ray.source_speed);
  for (const RaySegment& segment : ray.segments)
    for_each_crossing(segment, field.ranges, [&](std::size_t column, const RayState& state) {
      std::complex<double>* sum = field.column(column);
      add_simple_crossing(setting, launched, crossing_of(setting, segment, state),
                          field.column_depths(column),
                          [sum](std::size_t k, std::complex<double> p) { sum[k] += p; });
    });
}

}  // namespace asdic::detail::beams
