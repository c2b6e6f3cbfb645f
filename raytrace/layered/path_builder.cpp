#include "raytrace/layered/path_builder.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "raytrace/layered/simd_reflection.h"
#include "raytrace/math/integer_power.h"
#include "raytrace/ocean/tube_amplitude.h"

namespace asdic::detail {
namespace {

/// A ray that turns beside a maximum of c spreads so much that no number leads to the receiver: its
/// path is left out, at 10⁻⁸ of the others' amplitude and less [m].
constexpr double furthest_miss = 1.0;

double grazing_at(const RayParameter& ray, double speed) {
  return std::atan2(std::sqrt(std::max(0.0, ray.sine2(speed))), ray.slowness * speed);
}

/// Multiplies what so many bounces leave. Nothing where the boundary is smooth.
void reflect_roughly(const Roughness& rough, double sine, const WaterAtBoundary& water, int bounces,
                     RoughReflection& left) noexcept {
  if (rough.smooth() || bounces == 0) return;
  const RoughReflection one =
      rough_reflection(rough, sine, 2.0 * pi * water.frequency / water.speed);
  left.coherent *= std::pow(one.coherent, bounces);
  left.energy *= std::pow(one.energy, bounces);
}

}  // namespace

PathBuilder::PathBuilder(const Environment& environment, const Column& column, double frequency)
    : environment_(environment),
      column_(column),
      absorption_db_per_metre_(1e-3 * (absorption_db_per_km(environment.absorption, frequency) +
                                       environment.attenuation_db_per_km.at(0.0))),
      frequency_(frequency),
      any_rough_(!environment.surface.roughness.smooth() || !environment.bottom.roughness.smooth()),
      water_at_surface_{.speed = column.surface_speed(),
                        .density = environment.water_density.at(environment.surface.depth),
                        .frequency = frequency},
      water_at_bottom_{.speed = column.bottom_speed(),
                       .density = environment.water_density.at(environment.bottom.depth),
                       .frequency = frequency} {}

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
  return tube_amplitude(
      Spreading::cylindrical,
      {.speed = column_.receiver_speed(), .q = q, .range = range, .launch_slowness = ray.slowness});
}

PathBuilder::SimdPaths PathBuilder::simd_paths(const FanInterval& interval, const SimdTasks& tasks,
                                               const FoundRays& roots) const noexcept {
  const auto& [traced, legs] = roots;
  const auto& [up, middle, down, turns_above, turns_below] = legs;
  const double c_ref = traced.reference_speed;
  SimdPaths p;
  p.range_per_slowness = tasks.of(up.d_range, middle.d_range, down.d_range);

  // The ray traced misses the receiver by a millimetre at most. Its neighbour does not, by one more
  // step of Newton's method, in the smaller of σ = sin θ and k = cos θ.
  const Rays miss = tasks.range - traced.slowness * tasks.of(up.per_slowness, middle.per_slowness,
                                                             down.per_slowness);
  p.miss = miss;
  const Rays k_traced = traced.slowness * c_ref;
  Rays k_step = miss * c_ref / p.range_per_slowness;  // dr/dk = (dr/dξ)/c_ref
  Rays sigma_step = -k_step * k_traced / traced.sigma;
  where(
      !(abs(miss) < 1e-2 && abs(sigma_step) < 1e-3 * traced.sigma && abs(k_step) < 1e-3 * k_traced),
      k_step) = 0.0;
  where(k_step == 0.0, sigma_step) = 0.0;
  SimdRays rays = traced;
  rays.sigma += sigma_step;
  rays.slowness += k_step / c_ref;
  const auto steep = traced.sigma > 0.7;
  where(steep, rays.sigma) =
      sqrt(max((1.0 - rays.slowness * c_ref) * (1.0 + rays.slowness * c_ref), Rays(0.0)));
  where(!steep, rays.slowness) = sqrt((1.0 - rays.sigma) * (1.0 + rays.sigma)) / c_ref;

  p.slowness = rays.slowness;
  const auto angle_at = [&](double c) { return angle_of(rays.sine(c), rays.slowness * c); };
  p.launch = angle_at(column_.source_speed());
  p.arrival = angle_at(column_.receiver_speed());
  const double c_surface = column_.surface_speed(), c_bottom = column_.bottom_speed();
  p.surface_grazing = interval.turns_above ? Rays(0.0) : angle_at(c_surface);
  p.bottom_grazing = interval.turns_below ? Rays(0.0) : angle_at(c_bottom);
  std::array<int, rays_at_once> tops{}, bottoms{};
  for (std::size_t i = 0; i < rays_at_once; ++i) {
    if (!interval.turns_above) tops[i] = tasks.task[i]->piece->branch.top_vertices();
    if (!interval.turns_below) bottoms[i] = tasks.task[i]->piece->branch.bottom_vertices();
  }
  p.reflection =
      reflections_of(environment_.surface.material, water_at_surface_, rays.sine(c_surface),
                     rays.slowness * c_surface, p.surface_grazing, tops) *
      reflections_of(environment_.bottom.material, water_at_bottom_, rays.sine(c_bottom),
                     rays.slowness * c_bottom, p.bottom_grazing, bottoms);

  if (any_rough_)
    for (std::size_t i = 0; i < rays_at_once; ++i) {
      RoughReflection left;
      reflect_roughly(environment_.surface.roughness, std::sin(p.surface_grazing[i]),
                      water_at_surface_, tops[i], left);
      reflect_roughly(environment_.bottom.roughness, std::sin(p.bottom_grazing[i]),
                      water_at_bottom_, bottoms[i], left);
      const double mirror =
          p.reflection.real[i] * p.reflection.real[i] + p.reflection.imag[i] * p.reflection.imag[i];
      p.scattered[i] = mirror * std::max(0.0, left.energy - left.coherent * left.coherent);
      p.reflection.real[i] *= left.coherent;
      p.reflection.imag[i] *= left.coherent;
    }

  // q = ∂n/∂θ₀ = |dr/dθ₀|·sin θ_r, and dξ/dθ₀ = −sin θ₀/c_s
  p.q = abs(p.range_per_slowness) * rays.sine(column_.source_speed()) / column_.source_speed() *
        rays.sine(column_.receiver_speed());
  // tube_amplitude() of as many rays at once; held to it by tests/raytrace/property/layered.cpp
  p.spreading =
      sqrt(column_.receiver_speed() * rays.slowness / (max(tasks.range, Rays(1e-6)) * p.q));

  // Along the wavefront's normal dτ/dr = ξ, so the delay is corrected to first order, and the
  // length as if it were the delay times a mean speed.
  p.delay =
      tasks.of(up.intercept, middle.intercept, down.intercept) + traced.slowness * tasks.range;
  p.length = tasks.of(up.length, middle.length, down.length);
  p.length += p.length / p.delay * traced.slowness * miss;

  // Vertices follow one another at half cycles.
  p.half_cycle = traced.slowness * (up.per_slowness + middle.per_slowness + down.per_slowness);
  const bool upper = column_.source_is_upper();
  p.first_up = traced.slowness * (upper ? up.per_slowness : up.per_slowness + middle.per_slowness);
  p.first_down =
      traced.slowness * (upper ? down.per_slowness + middle.per_slowness : down.per_slowness);
  return p;
}

void PathBuilder::build(const FanInterval& interval, const SimdTasks& tasks, const FoundRays& roots,
                        double faintest, std::span<Arrivals> found) const {
  // Where the paths will stand is memory not touched for long: it comes while they are computed.
  for (std::size_t i = 0; i < tasks.count; ++i) {
    const Arrivals& here = found[tasks.task[i]->receiver];
    const auto* const line = reinterpret_cast<const std::byte*>(here.data() + here.size());
    for (std::size_t k = 0; k < sizeof(Arrival); k += 64) __builtin_prefetch(line + k, 1);
  }
  const SimdPaths traced = simd_paths(interval, tasks, roots);
  const Rays nepers = (std::log(10.0) / 20.0 * absorption_db_per_metre_) * traced.length;
  const Rays absorbed = exponential(max(-nepers, Rays(-700.0)));
  for (std::size_t i = 0; i < tasks.count; ++i) {
    const Branch& branch = tasks.task[i]->piece->branch;
    if (!std::isfinite(traced.delay[i]) || !std::isfinite(traced.spreading[i])) continue;
    if (!(std::abs(traced.miss[i]) < furthest_miss)) continue;
    const std::complex<double> reflection(traced.reflection.real[i], traced.reflection.imag[i]);
    if (std::norm(reflection) + traced.scattered[i] < faintest * faintest) continue;

    Arrival& path = found[tasks.task[i]->receiver].emplace_back();
    const int tops = branch.top_vertices(), bottoms = branch.bottom_vertices();
    (interval.turns_above ? path.upper_turns : path.surface_bounces) = tops;
    (interval.turns_below ? path.lower_turns : path.bottom_bounces) = bottoms;
    path.launch_elevation = branch.starts_up ? traced.launch[i] : -traced.launch[i];
    path.arrival_elevation = branch.arrives_upward() ? traced.arrival[i] : -traced.arrival[i];
    path.horizontal_slowness = traced.slowness[i];
    path.delay = traced.delay[i];
    path.spreading = traced.spreading[i];
    path.reflection = reflection;
    path.caustics =
        caustics_passed(path.upper_turns + path.lower_turns, traced.range_per_slowness[i]);
    path.q = path.caustics % 2 == 0 ? traced.q[i] : -traced.q[i];
    path.path_length = traced.length[i];
    path.absorption_db = absorption_db_per_metre_ * path.path_length;
    path.amplitude = path_amplitude(path.spreading, absorbed[i], reflection, path.caustics);
    path.scattered = scattered_power(path.spreading, absorbed[i], traced.scattered[i]);

    // Vertices that are bounces are recorded.
    const double first = branch.starts_up ? traced.first_up[i] : traced.first_down[i];
    path.bounces.reserve(static_cast<std::size_t>(path.surface_bounces + path.bottom_bounces));
    for (int k = 0; k < branch.vertices; ++k) {
      const bool top = branch.starts_up == (k % 2 == 0);
      if (top ? interval.turns_above : interval.turns_below) continue;
      path.bounces.push_back({.boundary = top ? BoundaryKind::surface : BoundaryKind::bottom,
                              .grazing = top ? traced.surface_grazing[i] : traced.bottom_grazing[i],
                              .range = first + k * traced.half_cycle[i]});
    }
  }
}

std::complex<double> PathBuilder::mirrors(const RayParameter& ray, int surface_bounces,
                                          int bottom_bounces) const noexcept {
  std::complex<double> product = 1.0;
  const auto reflect = [&](const Boundary& boundary, const WaterAtBoundary& water, int bounces) {
    if (bounces == 0) return;
    const double grazing = grazing_at(ray, water.speed);
    product *= integer_power(reflection_coefficient(boundary.material, grazing, water), bounces);
  };
  reflect(environment_.surface, water_at_surface_, surface_bounces);
  reflect(environment_.bottom, water_at_bottom_, bottom_bounces);
  return product;
}

RoughReflection PathBuilder::rough(const RayParameter& ray, int surface_bounces,
                                   int bottom_bounces) const noexcept {
  RoughReflection left;
  if (!any_rough_) return left;
  const auto reflect = [&](const Boundary& boundary, const WaterAtBoundary& water, int bounces) {
    reflect_roughly(boundary.roughness, std::sin(grazing_at(ray, water.speed)), water, bounces,
                    left);
  };
  reflect(environment_.surface, water_at_surface_, surface_bounces);
  reflect(environment_.bottom, water_at_bottom_, bottom_bounces);
  return left;
}

std::complex<double> PathBuilder::reflections(const RayParameter& ray, int surface_bounces,
                                              int bottom_bounces) const noexcept {
  const std::complex<double> product = mirrors(ray, surface_bounces, bottom_bounces);
  return any_rough_ ? product * rough(ray, surface_bounces, bottom_bounces).coherent : product;
}

std::complex<double> PathBuilder::all_reflected(const RayParameter& ray, int surface_bounces,
                                                int bottom_bounces) const noexcept {
  const std::complex<double> product = mirrors(ray, surface_bounces, bottom_bounces);
  return any_rough_ ? product * std::sqrt(rough(ray, surface_bounces, bottom_bounces).energy)
                    : product;
}

}  // namespace asdic::detail
