#include "sonar/enough_bounces.h"

#include <algorithm>
#include <cmath>

namespace asdic {
namespace {

// Bounces that are tried at most: within a time, without its end, over slopes.
constexpr int most_ever = 768, most_for_ever = 48, most_over_slopes = 24;

/// What is missing of a whole, in dB of it.
double missing_db(double missing, double all) {
  return missing < all ? -db_from_power(1.0 - missing / all) : infinity;
}

}  // namespace

void Bounces::include(const Bounces& other) noexcept {
  surface = std::max(surface, other.surface);
  bottom = std::max(bottom, other.bottom);
  left_out_db = std::fmax(left_out_db, other.left_out_db);
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

EnergyByBounces::EnergyByBounces(std::size_t stretches, double latest, int most, double floor)
    : latest_(latest),
      most_(most),
      floor_(floor),
      energy_(stretches * static_cast<std::size_t>(most + 1), 0.0) {}

void EnergyByBounces::add(double delay, int bounces, double energy) {
  if (delay > latest_) return;
  const std::size_t row = static_cast<std::size_t>(most_) + 1, stretches = energy_.size() / row;
  const double share = std::isfinite(latest_) ? delay / latest_ : 0.0;
  const auto stretch = static_cast<std::size_t>(share * static_cast<double>(stretches));
  energy_[std::min(stretch, stretches - 1) * row +
          static_cast<std::size_t>(std::clamp(bounces, 0, most_))] += energy;
}

double EnergyByBounces::left_out_db(int bounces) const {
  const auto row = static_cast<std::ptrdiff_t>(most_) + 1;
  double worst = 0.0;
  for (auto stretch = energy_.begin(); stretch != energy_.end(); stretch += row) {
    double kept = 0.0, missing = 0.0;
    for (int n = 0; n <= most_; ++n) (n <= bounces ? kept : missing) += stretch[n];
    if (missing > floor_) worst = std::max(worst, missing_db(missing, kept + missing));
  }
  return worst;
}

int EnergyByBounces::enough(double db) const {
  int bounces = std::min(fewest_bounces, most_);
  while (bounces < most_ && left_out_db(bounces) > db) ++bounces;
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

Bounces enough_bounces(const PropagationPaths& paths, const PropagationSettings& settings,
                       const Vec3& from, const Vec3& to, double frequency, double latest,
                       bool judged) {
  constexpr double of_a_leg = 0.5 * negligible_db;  // an echo has two
  const bool numbers = in_numbers(settings), timed = std::isfinite(latest);
  if (numbers && !(judged && paths.layered())) return as_asked(settings);
  const int limit = !paths.layered() ? most_over_slopes : timed ? most_ever : most_for_ever;
  for (int most = 2 * fewest_bounces;; most *= 2) {
    PathLimits limits = limits_of(unlimited(settings), most);
    limits.max_delay = latest;
    limits.diffraction = false;  // it has no bounces
    const Bounces asked = as_asked(settings, most);
    EnergyByBounces heard(1, latest, most, 0.0), by_numbers(1, latest, 1, 0.0);
    for (const Arrival& a : paths.find(from, to, frequency, limits)) {
      const bool beyond = a.surface_bounces > asked.surface || a.bottom_bounces > asked.bottom;
      const double energy = std::norm(a.amplitude) + a.scattered;
      heard.add(a.delay, std::max(a.surface_bounces, a.bottom_bounces), energy);
      by_numbers.add(a.delay, beyond ? 1 : 0, energy);
    }
    const bool converged = heard.converged(of_a_leg);
    if (!converged && most < limit) continue;
    Bounces followed = numbers ? asked : as_asked(settings, heard.enough(of_a_leg));
    followed.left_out_db =
        numbers ? by_numbers.left_out_db(0) : heard.estimate_db(heard.enough(of_a_leg), converged);
    return followed;
  }
}

}  // namespace asdic
