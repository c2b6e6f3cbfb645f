#include "sonar/paths/enough_bounces.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>

namespace asdic::detail {
namespace {

// Bounces that are tried at most where no time ends.
constexpr int most_for_ever = 48;

/// What is missing of a whole, in dB of it.
double missing_db(double missing, double all) {
  return missing < all ? -db_from_power(1.0 - missing / all) : infinity;
}

}  // namespace

PathLimits limits_of(const PropagationSettings& settings, int enough) noexcept {
  PathLimits limits{.max_surface_bounces = settings.max_surface_bounces.value_or(enough),
                    .max_bottom_bounces = settings.max_bottom_bounces.value_or(enough),
                    .max_launch_angle = settings.max_launch_angle,
                    .diffraction = settings.diffraction};
  const int vertices = 2 * (std::max(limits.max_surface_bounces, limits.max_bottom_bounces) + 1);
  limits.max_vertices = std::max(limits.max_vertices, vertices);
  return limits;
}

bool in_numbers(const PropagationSettings& settings) noexcept {
  return settings.max_surface_bounces && settings.max_bottom_bounces;
}

Bounces as_asked(const PropagationSettings& settings, int enough) noexcept {
  const PathLimits limits = limits_of(settings, enough);
  return {.surface = limits.max_surface_bounces, .bottom = limits.max_bottom_bounces};
}

PathLimits limits_of(const PropagationSettings& settings, const Bounces& enough) noexcept {
  return limits_of(settings, std::max(enough.surface, enough.bottom));
}

EnergyByBounces::EnergyByBounces(std::size_t segments, double latest, int most, double floor)
    : latest_(latest),
      most_(most),
      floor_(floor),
      energy_(segments * static_cast<std::size_t>(most + 1), 0.0) {}

void EnergyByBounces::add(double delay, int bounces, double energy) {
  if (delay > latest_) return;
  // Of many bounces one path stands for those around it, up to a twentieth more (cycles_told_by).
  any_has_most_ = any_has_most_ || bounces >= most_ - most_ / 16;
  const std::size_t row = static_cast<std::size_t>(most_) + 1, segments = energy_.size() / row;
  const double share = std::isfinite(latest_) ? delay / latest_ : 0.0;
  const auto segment = static_cast<std::size_t>(share * static_cast<double>(segments));
  energy_[std::min(segment, segments - 1) * row +
          static_cast<std::size_t>(std::clamp(bounces, 0, most_))] += energy;
}

double EnergyByBounces::left_out_db(int bounces) const {
  const auto row = static_cast<std::ptrdiff_t>(most_) + 1;
  double worst = 0.0;
  for (auto segment = energy_.begin(); segment != energy_.end(); segment += row) {
    double kept = 0.0, missing = 0.0;
    for (int n = 0; n <= most_; ++n) (n <= bounces ? kept : missing) += segment[n];
    if (missing > floor_) worst = std::max(worst, missing_db(missing, kept + missing));
  }
  return worst;
}

int EnergyByBounces::enough(double db) const {
  const auto row = static_cast<std::ptrdiff_t>(most_) + 1;
  int bounces = std::min(fewest_bounces, most_);
  for (auto segment = energy_.begin(); segment != energy_.end(); segment += row) {
    const double all = std::accumulate(segment, segment + row, 0.0);
    double missing = 0.0;  // of those of more bounces than n
    int n = most_;
    for (; n > bounces; --n) {
      const double more = missing + segment[n];
      if (more > floor_ && missing_db(more, all) > db) break;
      missing = more;
    }
    bounces = n;
  }
  return bounces;
}

double EnergyByBounces::estimate_db(int bounces, bool converged) const {
  return std::max(left_out_db(bounces), converged ? 0.0 : left_out_db(most_ / 2));
}

PropagationSettings unlimited(const PropagationSettings& settings) noexcept {
  PropagationSettings open = settings;
  if (in_numbers(settings)) {
    open.max_surface_bounces.reset();
    open.max_bottom_bounces.reset();
  }
  return open;
}

void ReceivedBounces::add(double delay, int surface, int bottom, double energy) {
  const bool beyond = surface > asked_.surface || bottom > asked_.bottom;
  by_most_.add(delay, std::max(surface, bottom), energy);
  by_numbers_.add(delay, beyond ? 1 : 0, energy);
  ++paths_;
}

Bounces search_bounces(const PropagationSettings& settings, const BounceSearch& search,
                       const std::function<void(const PathLimits&, ReceivedBounces&)>& look) {
  const bool numbers = in_numbers(settings);
  int before = fewest_bounces;
  const auto next = [&](int most) {
    before = most;
    return std::min(static_cast<int>(std::ceil(search.growth * most)), search.most);
  };
  for (int most = std::min(search.first, search.most);; most = next(most)) {
    const Bounces asked = as_asked(settings, most);
    ReceivedBounces received(search.segments, search.latest, most, search.floor, asked);
    look(limits_of(unlimited(settings), most), received);
    const EnergyByBounces& by_most = received.by_most();
    const double left_out_by_numbers = numbers ? received.by_numbers().left_out_db(0) : 0.0;
    const bool converged = by_most.converged(search.tolerance_db) ||
                           std::isinf(left_out_by_numbers);  // no more can be
    const bool too_many = !converged && received.paths() > search.most_paths;
    if (!converged && !too_many && most < search.most) continue;
    const int bounces = too_many ? before : by_most.enough(search.tolerance_db);
    Bounces followed = numbers ? asked : as_asked(settings, bounces);
    // The next doubling is taken to add as much as the last one, if that still adds.
    const double beyond = converged ? 0.0 : by_most.left_out_db(most / 2);
    followed.left_out_db =
        numbers ? left_out_by_numbers + beyond : by_most.estimate_db(bounces, converged);
    // Nobody looked beyond the last try, whatever number is asked for.
    if (too_many)
      followed.left_out_db = std::max(followed.left_out_db, by_most.left_out_db(most / 2));
    return followed;
  }
}

Bounces enough_bounces(const PropagationPaths& paths, const PropagationSettings& settings,
                       const Vec3& from, const Vec3& to, double frequency, double latest,
                       bool judged) {
  if (in_numbers(settings) && !judged) return as_asked(settings);
  const bool timed = std::isfinite(latest);
  const bool map = paths.area() != nullptr;
  const BounceSearch search{
      .first = map ? fewest_bounces + 1 : 2 * fewest_bounces,
      .growth = map ? 1.5 : 2.0,
      .most = !timed            ? most_for_ever
              : paths.layered() ? most_between_places
                                : most_over_slopes,
      .most_paths = map ? many_paths : std::numeric_limits<std::size_t>::max(),
      .tolerance_db = 0.5 * negligible_db,  // an echo has two legs
      .latest = latest};
  return search_bounces(settings, search, [&](PathLimits limits, ReceivedBounces& received) {
    limits.max_delay = latest;
    limits.diffraction = false;  // it has no bounces
    for (const Arrival& a : paths.find_in_plane(from, to, frequency, limits))
      received.add(a.delay, a.surface_bounces, a.bottom_bounces,
                   std::norm(a.amplitude) + a.scattered);
  });
}

std::string lacking(const PropagationSettings& settings, const Bounces& followed,
                    const char* sound) {
  if (!(followed.left_out_db > tolerable_db)) return "";
  const char* const key = settings.max_bottom_bounces || !settings.max_surface_bounces
                              ? "propagation.max_bottom_bounces"
                              : "propagation.max_surface_bounces";
  char missing[64] = "all of it at some time";
  if (std::isfinite(followed.left_out_db))
    std::snprintf(missing, sizeof missing, "up to %.2g dB", followed.left_out_db);
  char text[320];
  std::snprintf(text, sizeof text,
                "%s: %s lacks the paths of more than %d bounces off the surface or %d off the "
                "bottom, %s%s",
                key, sound, followed.surface, followed.bottom, missing,
                in_numbers(settings) ? "; \"auto\" follows as many as there is sound in" : "");
  return text;
}

std::string ended_early(std::size_t searches) {
  if (searches == 0) return "";
  return "propagation.dimension: " + std::to_string(searches) +
         (searches == 1 ? " search" : " searches") +
         " for paths in three dimensions ended for the cost, and paths may be missing; fewer "
         "bounces, or planes (dimension = 2), are searched to the end";
}

}  // namespace asdic::detail
