#include "raytrace/layered/path_builder.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace asdic {
namespace {

std::complex<double> integer_power(std::complex<double> base, int exponent) {
  std::complex<double> product = 1.0;
  for (int i = 0; i < exponent; ++i) product *= base;
  return product;
}

double grazing_at(const RayParameter& ray, double speed) {
  return std::atan2(std::sqrt(std::max(0.0, ray.sine2(speed))), ray.slowness * speed);
}

}  // namespace

PathBuilder::PathBuilder(const Environment& environment, const Column& column, double frequency)
    : environment_(environment),
      column_(column),
      absorption_db_per_metre_(1e-3 * (absorption_db_per_km(environment.absorption, frequency) +
                                       environment.attenuation_db_per_km.at(0.0))) {}

double PathBuilder::sine_at_source(const RayParameter& ray) const noexcept {
  return std::sqrt(std::max(ray.sine2(column_.source_speed()), 1e-300));
}

double PathBuilder::sine_at_receiver(const RayParameter& ray) const noexcept {
  return std::sqrt(std::max(ray.sine2(column_.receiver_speed()), 1e-300));
}

double PathBuilder::spreading(const RayParameter& ray, double range,
                              double range_per_slowness) const noexcept {
  // q = ∂n/∂θ₀ = |dr/dθ₀|·sin θ_r, and dξ/dθ₀ = −sin θ₀/c_s
  const double q = std::abs(range_per_slowness) * sine_at_source(ray) / column_.source_speed() *
                   sine_at_receiver(ray);
  return std::sqrt(column_.receiver_speed() * ray.slowness / (range * q));
}

std::complex<double> PathBuilder::reflections(const RayParameter& ray, int surface_bounces,
                                              int bottom_bounces) const noexcept {
  std::complex<double> product = 1.0;
  if (surface_bounces > 0) {
    const double c = column_.surface_speed();
    product *= integer_power(
        reflection_coefficient(
            environment_.surface.material, grazing_at(ray, c),
            {.speed = c, .density = environment_.water_density.at(environment_.surface.depth)}),
        surface_bounces);
  }
  if (bottom_bounces > 0) {
    const double c = column_.bottom_speed();
    product *= integer_power(
        reflection_coefficient(
            environment_.bottom.material, grazing_at(ray, c),
            {.speed = c, .density = environment_.water_density.at(environment_.bottom.depth)}),
        bottom_bounces);
  }
  return product;
}

Arrival PathBuilder::build(const FanInterval& interval, const Branch& branch,
                           const RayParameter& traced, const Column::All& walk,
                           double range) const {
  const BranchWeights w = weights(branch, column_.source_is_upper());
  const auto& [sums, details] = walk;
  const double sigma = traced.sigma;

  Arrival path;
  const int tops = branch.top_vertices(), bottoms = branch.bottom_vertices();
  (interval.turns_above ? path.upper_turns : path.surface_bounces) = tops;
  (interval.turns_below ? path.lower_turns : path.bottom_bounces) = bottoms;
  const double range_per_slowness = w.of(sums.up.d_range, sums.middle.d_range, sums.down.d_range);

  // The ray traced misses the receiver by a millimetre at most. Its neighbour does not, by one more
  // step of Newton's method.
  const double miss = range - w.of(sums.up.range, sums.middle.range, sums.down.range);
  const double slope = range_per_slowness * traced.slowness_per_sigma();
  const double step = std::abs(miss) < 1e-2 && slope != 0.0 ? miss / slope : 0.0;
  const RayParameter ray(
      interval.reference_speed,
      std::abs(step) < 1e-3 * std::min(sigma, 1.0 - sigma) ? sigma + step : sigma);

  const double sine_source = sine_at_source(ray), sine_receiver = sine_at_receiver(ray);
  path.horizontal_slowness = ray.slowness;
  path.launch_elevation = (branch.starts_up ? 1.0 : -1.0) *
                          std::atan2(sine_source, ray.slowness * column_.source_speed());
  path.arrival_elevation = (branch.arrives_upward() ? 1.0 : -1.0) *
                           std::atan2(sine_receiver, ray.slowness * column_.receiver_speed());

  path.caustics = caustics_passed(path.upper_turns + path.lower_turns, range_per_slowness);
  path.q = std::abs(range_per_slowness) * sine_source / column_.source_speed() * sine_receiver *
           (path.caustics % 2 == 0 ? 1.0 : -1.0);
  path.spreading = spreading(ray, std::max(range, 1e-6), range_per_slowness);

  // Along the wavefront's normal dτ/dr = ξ, so the delay is corrected to first order, and the
  // length as if it were the delay times a mean speed.
  path.delay = w.of(details.up.time, details.middle.time, details.down.time) + ray.slowness * miss;
  path.path_length = w.of(details.up.length, details.middle.length, details.down.length);
  path.path_length += path.path_length / path.delay * ray.slowness * miss;
  path.absorption_db = absorption_db_per_metre_ * path.path_length;
  path.reflection = reflections(ray, path.surface_bounces, path.bottom_bounces);

  path.amplitude = path.spreading * amplitude_from_db(-path.absorption_db) * path.reflection *
                   caustic_phase(path.caustics);

  // Vertices follow one another at half cycles; those that are bounces are recorded.
  const double half_cycle = sums.up.range + sums.middle.range + sums.down.range;
  const double first =
      branch.starts_up ? sums.up.range + (column_.source_is_upper() ? 0.0 : sums.middle.range)
                       : sums.down.range + (column_.source_is_upper() ? sums.middle.range : 0.0);
  path.bounces.reserve(static_cast<std::size_t>(path.surface_bounces + path.bottom_bounces));
  const double surface_grazing =
      path.surface_bounces > 0 ? grazing_at(ray, column_.surface_speed()) : 0.0;
  const double bottom_grazing =
      path.bottom_bounces > 0 ? grazing_at(ray, column_.bottom_speed()) : 0.0;
  for (int k = 0; k < branch.vertices; ++k) {
    const bool top = branch.starts_up == (k % 2 == 0);
    if (top ? interval.turns_above : interval.turns_below) continue;
    path.bounces.push_back({.boundary = top ? BoundaryKind::surface : BoundaryKind::bottom,
                            .grazing = top ? surface_grazing : bottom_grazing,
                            .range = first + k * half_cycle});
  }
  return path;
}

}  // namespace asdic
