#include "raytrace/places/propagation_paths.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>
#include <utility>

#include "core/geometry.h"
#include "raytrace/ocean/slice.h"
#include "raytrace/paths/energy_bound.h"
#include "raytrace/places/followed_path.h"
#include "raytrace/volume/volume_eigenrays.h"
#include "raytrace/waves/caustics.h"
#include "raytrace/waves/cycles.h"
#include "raytrace/waves/diffraction.h"
#include "raytrace/waves/put_roughness.h"

namespace asdic::detail {
namespace {

// Of a sequence by itself. Schedules that come back to a place or a waveform do so sooner.
constexpr std::size_t own_bytes = std::size_t{448} << 20;
constexpr std::uint64_t own_pings = 64;

std::uint64_t next_identity() {
  static std::atomic<std::uint64_t> next{0};
  return next++;
}

std::size_t bytes_of_arrivals(const Arrivals& arrivals) {
  std::size_t bytes = sizeof(Arrivals) + arrivals.capacity() * sizeof(Arrival);
  for (const Arrival& a : arrivals) bytes += a.bounces.capacity() * sizeof(Bounce);
  return bytes;
}

/// Of a solver of a range-dependent ocean and its tracer, roughly: they hold the section's speeds
/// and the boundaries' nodes a few times, with derivatives.
std::size_t bytes_of_slice(const Environment& slice) {
  constexpr std::size_t doubles_a_sample = 16;
  std::size_t samples = 256 + slice.water.depths().size();
  if (slice.section) samples += slice.section->speeds().size();
  for (const Boundary* boundary : {&slice.surface, &slice.bottom})
    if (boundary->shape) samples += boundary->shape->ranges().size();
  return samples * doubles_a_sample * sizeof(double);
}

/// Somewhat beyond where sound is followed to, for what a slope beyond sends back; in steps of
/// 19 %, so that ends that move find the plane that is kept.
double reach_in_steps(double range) {
  constexpr double least = 2000.0, more = 1.05;
  return std::exp2(std::ceil(4.0 * std::log2(more * range + least)) / 4.0);
}

void sort_by_delay(Arrivals& arrivals) {
  std::stable_sort(arrivals.begin(), arrivals.end(),
                   [](const Arrival& a, const Arrival& b) { return a.delay < b.delay; });
}

bool same_history(const Arrival& a, const Arrival& b) noexcept {
  return a.surface_bounces == b.surface_bounces && a.bottom_bounces == b.bottom_bounces &&
         a.upper_turns == b.upper_turns && a.lower_turns == b.lower_turns;
}

/// No wider than paths that were known a moment before ask for: their bounces, and launch angles up
/// to a degree beyond, five at least: those that leave almost level turn most (same_path in
/// moving_paths.h).
PathLimits limits_around(std::span<const Arrival> known, PathLimits limits) {
  PathLimits needed{.max_surface_bounces = 0, .max_bottom_bounces = 0, .max_launch_angle = 0.0};
  for (const Arrival& path : known) {
    needed.max_surface_bounces = std::max(needed.max_surface_bounces, path.surface_bounces);
    needed.max_bottom_bounces = std::max(needed.max_bottom_bounces, path.bottom_bounces);
    needed.max_launch_angle =
        std::max(needed.max_launch_angle, std::abs(path.launch_elevation) + radians(10.0));
  }
  limits.max_surface_bounces = std::min(limits.max_surface_bounces, needed.max_surface_bounces);
  limits.max_bottom_bounces = std::min(limits.max_bottom_bounces, needed.max_bottom_bounces);
  limits.max_launch_angle = std::min(limits.max_launch_angle, needed.max_launch_angle);
  return limits;
}

/// Gives a ray that was followed the amplitude of waves that it had, where that has hardly changed:
/// two wavelengths further it has by some per cent. \return false: it must be found anew
bool keeps_amplitude(const Arrival& known, Arrival& followed, double frequency) {
  constexpr double periods = 0.25;
  if (!(std::abs(followed.delay - known.delay) * frequency < periods)) return false;
  followed.kind = known.kind;
  followed.amplitude = known.amplitude;
  followed.spreading = known.spreading;
  followed.scattered = known.scattered;
  return true;
}

/// The same ray of another range; null if there is none.
const Arrival* same_ray(const Arrivals& leg, const Arrival& ray) {
  const Arrival* nearest = nullptr;
  const auto off = [&](const Arrival& other) {
    return std::abs(other.horizontal_slowness - ray.horizontal_slowness);
  };
  for (const Arrival& other : leg)
    if (other.kind != ArrivalKind::diffracted && same_history(other, ray) &&
        other.caustics == ray.caustics &&
        (other.launch_elevation < 0.0) == (ray.launch_elevation < 0.0) &&
        (nearest == nullptr || off(other) < off(*nearest)))
      nearest = &other;
  return nearest;
}

/// Gives a ray of a layered ocean the amplitude that waves have between ranges of a grid, where
/// legs are found once for all places nearby: by a cubic, or by a line where a family of rays
/// begins. \param ray  none, on the dark side of its caustic: it is found between them as well
/// \param known  the same elsewhere   \param leg_at  shared_ptr<const Arrivals>(range [m])
/// \return false: it has to be found by itself
template <class LegAt>
bool put_from_grid(std::optional<Arrival>& ray, const Arrival& known, double range,
                   double wavelength, const LegAt& leg_at) {
  constexpr double wavelengths = 6.0;                    // between ranges of the grid
  constexpr double nearest = 10.0;                       // of the grid's steps
  constexpr double tolerable = 0.02, of_the_leg = 1e-3;  // what the cubic adds to a parabola
  constexpr double of_third_difference = 1.0 / 16.0, of_difference = 1.0 / 8.0;
  const double step = wavelengths * wavelength, place = range / step,
               first = std::floor(place) - 1.0, t = place - first;
  if (!(first > nearest)) return false;
  std::array<std::shared_ptr<const Arrivals>, 4> legs;
  std::array<const Arrival*, 4> there{};
  for (std::size_t i = 0; i < legs.size(); ++i) {
    legs[i] = leg_at((first + double(i)) * step);
    there[i] = same_ray(*legs[i], ray ? *ray : known);
  }
  if (there[1] == nullptr || there[2] == nullptr) return false;
  const bool cubic = there[0] != nullptr && there[3] != nullptr;
  if (!cubic) there[0] = there[1], there[3] = there[2];
  // Lagrange's polynomials.
  const std::array<double, 4> weight =
      cubic ? std::array{-(t - 1.0) * (t - 2.0) * (t - 3.0) / 6.0, t * (t - 2.0) * (t - 3.0) / 2.0,
                         -t * (t - 1.0) * (t - 3.0) / 2.0, t * (t - 1.0) * (t - 2.0) / 6.0}
            : std::array{0.0, 2.0 - t, t - 1.0, 0.0};
  const auto between = [&](const auto& of) {
    return weight[0] * of(*there[0]) + weight[1] * of(*there[1]) + weight[2] * of(*there[2]) +
           weight[3] * of(*there[3]);
  };
  const auto a = [&](std::size_t i) { return there[i]->amplitude; };
  const std::complex<double> amplitude = between([](const Arrival& x) { return x.amplitude; });
  const double error = cubic ? of_third_difference * std::abs(a(3) - a(0) + 3.0 * (a(1) - a(2)))
                             : of_difference * std::abs(a(2) - a(1));
  double energy = 0.0;
  for (const Arrival& other : *legs[1]) energy += std::norm(other.amplitude);
  if (error > tolerable * std::abs(amplitude) + of_the_leg * std::sqrt(energy)) return false;
  if (!ray) {
    ray = *there[1];
    ray->launch_elevation = between([](const Arrival& x) { return x.launch_elevation; });
    ray->arrival_elevation = between([](const Arrival& x) { return x.arrival_elevation; });
    ray->delay = between([](const Arrival& x) { return x.delay; });
    ray->horizontal_slowness = between([](const Arrival& x) { return x.horizontal_slowness; });
    ray->path_length = between([](const Arrival& x) { return x.path_length; });
    ray->absorption_db = between([](const Arrival& x) { return x.absorption_db; });
  }
  ray->kind = ArrivalKind::caustic;
  ray->amplitude = amplitude;
  ray->spreading = between([](const Arrival& x) { return x.spreading; });
  ray->scattered = std::max(0.0, between([](const Arrival& x) { return x.scattered; }));
  return true;
}

}  // namespace

void add_path(ExactKey& key, const Arrival& path) {
  key.add_all(path.kind, path.launch_elevation, path.launch_deflection, path.horizontal_slowness,
              path.surface_bounces, path.bottom_bounces, path.upper_turns, path.lower_turns,
              path.caustics);
}

void add_to(ExactKey& key, const CycleNeed& need) {
  // Every member by name: one more does not compile until it is here.
  const auto& [source_depth, receiver_depth, frequency, furthest, without_surface, without_bottom] =
      need;
  key.add_all(source_depth, receiver_depth, frequency, furthest, without_surface, without_bottom);
}

void add_to(ExactKey& key, const BranchNeed& need) {
  const auto& [upper, lower, frequency, furthest, steepest] = need;  // every member by name
  key.add_all(upper, lower, frequency, furthest, steepest);
}

void add_to(ExactKey& key, const CausticsNeed& need) {
  const auto& [source_depth, receiver_depth, frequency, nearest, furthest] = need;  // all members
  key.add_all(source_depth, receiver_depth, frequency, nearest, furthest);
}

void add_to(ExactKey& key, const PathLimits& limits) {
  // Every member by name: one more does not compile until it is here.
  const auto& [surface_bounces, bottom_bounces, launch_angle, vertices, fewest, diffraction,
               faintest, delay, home_slowness] = limits;
  key.add_all(surface_bounces, bottom_bounces, launch_angle, vertices, fewest, diffraction,
              faintest, delay, home_slowness);
}

void add_to(ExactKey& key, const Plane& plane, bool area) {
  if (area)
    key.add_all(plane.place, plane.bearing, plane.reach);
  else
    key.add_all(plane.origin, plane.cos_beta);
}

PropagationPaths::PropagationPaths(const Environment& ocean, const Transect& transect,
                                   std::shared_ptr<const Area> area,
                                   std::shared_ptr<PropagationMemory> memory,
                                   std::shared_ptr<const VolumeOcean> volume)
    : along_(ocean),
      transect_(transect),
      area_(std::move(area)),
      layered_(is_layered(ocean) && !area_),
      identity_(next_identity()),
      memory_(memory ? std::move(memory)
                     : std::make_shared<PropagationMemory>(own_bytes, own_pings)),
      volume_(std::move(volume)) {}

Plane PropagationPaths::plane(const Vec3& from, double bearing, double reach) const noexcept {
  return {.origin = along(from),
          .cos_beta = std::cos(bearing - transect_.bearing),
          .place = from.head<2>(),
          .bearing = bearing,
          .reach = reach_in_steps(reach)};
}

Plane PropagationPaths::plane(const Vec3& from, const Vec3& to) const noexcept {
  const Separation way = separation(from, to);
  return plane(from, way.bearing, way.range);
}

Environment PropagationPaths::environment_of(const Plane& plane) const {
  if (area_) return area_->section(plane.place, plane.bearing, plane.reach);
  return slice(along_.environment(), plane.origin, plane.cos_beta);
}

double PropagationPaths::surface_depth(const Vec3& place) const {
  return on_map().surface_depth(place);
}

double PropagationPaths::bottom_depth(const Vec3& place) const {
  return on_map().bottom_depth(place);
}

double PropagationPaths::speed_at(const Vec3& place) const {
  if (layered_) return along_.environment().water.at(place.z()).c;
  return on_map().speed_at(place);
}

std::shared_ptr<const EigenraySolver> PropagationPaths::solver(const Plane& plane) const {
  if (layered_) return layered_solver();
  ExactKey own = key(Kept::slice);
  add_to(own, plane, area_ != nullptr);
  return memory_->remember(
      own, [&] { return std::make_shared<EigenraySolver>(environment_of(plane)); },
      [](const EigenraySolver& made) { return bytes_of_slice(made.environment()); });
}

std::shared_ptr<const EigenraySolver> PropagationPaths::layered_solver() const {
  return {std::shared_ptr<void>(), &along_};  // not owned
}

std::shared_ptr<const EigenraySolver> PropagationPaths::between_mirrors() const {
  return memory_->remember(
      key(Kept::slice),
      [&] { return std::make_shared<EigenraySolver>(without_roughness(along_.environment())); },
      [](const EigenraySolver& made) { return bytes_of_slice(made.environment()); });
}

/// All that a search depends on: in a layered ocean depths and range, otherwise the plane, too.
ExactKey PropagationPaths::leg_key(Kept kind, const Vec3& from, const Vec3& to, double frequency,
                                   const PathLimits& limits) const {
  ExactKey leg = key(kind, from.z(), to.z(), separation(from, to).range, frequency, limits);
  if (layered_) return leg;
  if (volume()) return leg.add_all(from.x(), from.y(), to.x(), to.y());
  add_to(leg, plane(from, to), area_ != nullptr);
  return leg;
}

namespace {

/// Keeps the earliest of direct rays that all leave within half a Fresnel zone of the straight
/// line: the water bends them by less than a wave notices, so together they are one. About a depth
/// of least speed there are two, or many that cross it again and again. \param wavelength  [m]
void keep_one_level_ray(const Vec3& from, const Vec3& to, double wavelength, Arrivals& found) {
  const Vec3 line = to - from;
  const double length = line.norm(), elevation = std::asin(-line.z() / length),
               zone = std::sqrt(wavelength / length);
  const auto is_direct = [](const Arrival& ray) {
    return ray.kind == ArrivalKind::ray && ray.surface_bounces + ray.bottom_bounces == 0;
  };
  Arrivals direct;
  for (const Arrival& ray : found) {
    if (!is_direct(ray)) continue;
    if (!(std::hypot(ray.launch_elevation - elevation, ray.launch_deflection) < 0.5 * zone)) return;
    direct.push_back(ray);
  }
  if (direct.size() < 2) return;
  const auto kept = std::ranges::min_element(direct, {}, &Arrival::delay);
  std::erase_if(found, is_direct);
  found.push_back(std::move(*kept));
  sort_by_delay(found);
}

}  // namespace

Arrivals PropagationPaths::search(const Vec3& from, const Vec3& to, double frequency,
                                  const PathLimits& limits) const {
  if (const VolumeOcean* ocean = volume()) {
    VolumeSearchReport report;
    Arrivals found = volume_eigenrays(VolumeTracer(*ocean, frequency), from, to, limits, &report,
                                      search_plane(from, to, frequency, limits));
    if (report.given_up > 0) memory_->count_ended_search();
    if (limits.diffraction) keep_one_level_ray(from, to, speed_at(from) / frequency, found);
    return bounded(std::move(found), from, to, frequency, limits);
  }
  Arrivals found = search_plane(from, to, frequency, limits);
  if (!layered_ && limits.diffraction)
    keep_one_level_ray(from, to, speed_at(from) / frequency, found);
  return bounded(std::move(found), from, to, frequency, limits);
}

Arrivals PropagationPaths::bounded(Arrivals found, const Vec3& from, const Vec3& to,
                                   double frequency, const PathLimits& limits) const {
  // Rays alone have no bound at a caustic. Where diffraction is on, waves replace them there.
  if (layered_ && !limits.diffraction) return found;
  ensure_bounded(found, along_.environment(),
                 {.source_depth = from.z(),
                  .receiver_depth = to.z(),
                  .range = separation(from, to).range,
                  .frequency = frequency,
                  .layered = layered_,
                  .in_volume = volume() != nullptr});
  return found;
}

Arrivals PropagationPaths::search_plane(const Vec3& from, const Vec3& to, double frequency,
                                        const PathLimits& limits) const {
  const double range = separation(from, to).range;
  if (layered_) {
    const bool rough = limits.diffraction && is_rough(along_.environment());
    const std::shared_ptr<const EigenraySolver> solver =
        rough ? between_mirrors() : layered_solver();
    Arrivals found = solver->find(from.z(), to.z(), range, frequency, limits);
    if (limits.diffraction) {
      put_caustics(*solver, from.z(), to.z(), range, frequency, limits, found,
                   [&](const CausticsNeed& need, const CausticsMaker& make) {
                     return memory_->remember(key(Kept::caustics, need, limits), make,
                                              [](const Caustics& made) { return bytes_of(made); });
                   });
      const bool bottom_held = put_waves(
          *solver, from.z(), to.z(), range, frequency, limits, found,
          [&](const CycleNeed& need, const CyclesMaker& make) {
            return memory_->remember(key(Kept::cycle_waves, need), make);
          },
          [&](const BranchNeed& need, const BranchMaker& make) {
            return memory_->remember(key(Kept::branch_waves, need), make);
          });
      if (rough) put_roughness(along_.environment(), frequency, limits.faintest, found);
      const OceanMemory kept{*memory_, identity_};
      auto more = diffracted_arrival(along_.environment(), from.z(), to.z(), range, frequency,
                                     found, &kept, !bottom_held);
      if (more && std::abs(more->launch_elevation) <= limits.max_launch_angle)
        found.push_back(std::move(*more));
    }
    sort_by_delay(found);
    return found;
  }
  return solver(plane(from, to))->find(from.z(), to.z(), range, frequency, limits);
}

Arrivals PropagationPaths::find_in_plane(const Vec3& from, const Vec3& to, double frequency,
                                         const PathLimits& limits) const {
  if (!volume()) return find(from, to, frequency, limits);
  const Plane line = plane(from, to);
  return *memory_->remember(
      key(Kept::legs, from.z(), to.z(), separation(from, to).range, frequency, limits, line.origin,
          line.cos_beta),
      [&] { return std::make_shared<Arrivals>(search_plane(from, to, frequency, limits)); },
      bytes_of_arrivals);
}

Arrivals PropagationPaths::find(const Vec3& from, const Vec3& to, double frequency,
                                const PathLimits& limits, Reuse* reuse) const {
  bool known = false;
  const auto found = leg(from, to, frequency, limits, &known);
  if (reuse != nullptr) reuse->count_legs(known);
  return *found;
}

std::shared_ptr<const Arrivals> PropagationPaths::leg(const Vec3& from, const Vec3& to,
                                                      double frequency, const PathLimits& limits,
                                                      bool* known) const {
  return memory_->remember(
      leg_key(Kept::legs, from, to, frequency, limits),
      [&] { return std::make_shared<Arrivals>(search(from, to, frequency, limits)); },
      bytes_of_arrivals, known);
}

Arrivals PropagationPaths::follow(std::span<const Arrival> paths, const Vec3& from, const Vec3& to,
                                  double frequency, const PathLimits& limits, Reuse* reuse) const {
  ExactKey key = leg_key(Kept::followed_legs, from, to, frequency, limits);
  for (const Arrival& path : paths) {
    add_path(key, path);
    if (path.kind == ArrivalKind::caustic)
      key.add_all(path.delay, path.amplitude.real(), path.amplitude.imag());
  }
  bool known = false;
  const auto found = memory_->remember(
      key, [&] { return std::make_shared<Arrivals>(followed(paths, from, to, frequency, limits)); },
      bytes_of_arrivals, &known);
  if (reuse != nullptr) reuse->count_legs(known);
  return *found;
}

Arrivals PropagationPaths::followed(std::span<const Arrival> known, const Vec3& from,
                                    const Vec3& to, double frequency,
                                    const PathLimits& limits) const {
  const double range = separation(from, to).range;
  std::optional<VolumeTracer> in_volume;
  if (volume()) in_volume.emplace(*volume(), frequency);
  std::optional<RayTracer> tracer;
  if (!layered_ && !volume()) tracer.emplace(environment_of(plane(from, to)), frequency);
  const OceanMemory kept{*memory_, identity_};
  const auto leg_at = [&](double other_range) {
    return leg({0.0, 0.0, from.z()}, {other_range, 0.0, to.z()}, frequency, limits);
  };
  Arrivals found;
  std::vector<const Arrival*> lost;  // over a map
  for (const Arrival& path : known) {
    std::optional<Arrival> same;
    if (path.kind == ArrivalKind::diffracted)
      same = diffracted_arrival(along_.environment(), from.z(), to.z(), range, frequency, &kept,
                                path.reflection != 1.0);
    else if (layered_)
      same = along_.follow(path, from.z(), to.z(), range, frequency, limits);
    else if (in_volume)
      same = followed_volume_path(*in_volume, path, from, to);
    else
      same = followed_path(*tracer, path, from.z(), to.z(), range);
    if (path.kind == ArrivalKind::caustic &&
        !((same && keeps_amplitude(path, *same, frequency)) ||
          put_from_grid(same, path, range, speed_at(from) / frequency, leg_at)))
      return find(from, to, frequency, limits);  // that of all rays of its term
    if (!same && tracer && area_) {
      lost.push_back(&path);
      continue;
    }
    // Waves need all rays of their term: a part of the leg would have the amplitudes of rays.
    if (!same && layered_ && limits.diffraction) return find(from, to, frequency, limits);
    if (!same) return search(from, to, frequency, limits_around(known, limits));
    found.push_back(std::move(*same));
  }
  // Over rough ground some of hundreds always part: those alone are looked for, where they were.
  // If they were loud, all are searched for.
  constexpr double same_ray = 1e-6;  // [rad]
  constexpr double loud = 1e-2;      // of the energy of all
  double parted = 0.0;
  for (const Arrival* path : lost) {
    std::optional<Arrival> same = path_beside(*tracer, *path, from.z(), to.z(), range);
    if (same && std::none_of(found.begin(), found.end(), [&](const Arrival& other) {
          return same_history(other, *same) &&
                 std::abs(other.launch_elevation - same->launch_elevation) < same_ray;
        }))
      found.push_back(std::move(*same));
    else
      parted += std::norm(path->amplitude);
  }
  if (parted > 0.0 && known.size() > 1) {  // one path alone is not worth a search
    double all = 0.0;
    for (const Arrival& path : known) all += std::norm(path.amplitude);
    if (parted > loud * all) return search(from, to, frequency, limits_around(known, limits));
  }
  sort_by_delay(found);
  return bounded(std::move(found), from, to, frequency, limits);
}

}  // namespace asdic::detail
