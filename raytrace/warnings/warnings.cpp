#include "raytrace/warnings/warnings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "core/units.h"

namespace asdic {

void add_warnings(const std::vector<std::string>& more, std::vector<std::string>& all) {
  for (const std::string& one : more)
    if (!one.empty() && std::find(all.begin(), all.end(), one) == all.end()) all.push_back(one);
}

namespace checks {
namespace {

/// What goes on along a path of 10 degrees beside the mean field, of one bounce [dB].
double scattered_on_db(const Roughness& roughness, double speed, double frequency) {
  const RoughReflection left =
      rough_reflection(roughness, std::sin(radians(10.0)), 2.0 * pi * frequency / speed);
  return db_from_power(left.energy / (left.coherent * left.coherent));
}

}  // namespace

std::string beside_the_mean_field(const Environment& ocean, double frequency) {
  const auto of = [&](const Boundary& boundary) {
    return scattered_on_db(boundary.roughness, sound_speed(ocean, 0.0, boundary.depth_at(0.0)).c,
                           frequency);
  };
  const double surface_db = of(ocean.surface), bottom_db = of(ocean.bottom);
  if (!(std::max(surface_db, bottom_db) > 0.1)) return "";
  char text[120];
  std::snprintf(text, sizeof text,
                "the rough %s scatters forward, %.2g dB of a bounce at 10 degrees,",
                surface_db > bottom_db ? "surface" : "bottom", std::max(surface_db, bottom_db));
  return text;
}

std::string mean_field_alone(const PropagationCase& run_case) {
  if (run_case.task != Task::field || run_case.field == FieldKind::coherent) return "";
  const std::string missing = beside_the_mean_field(run_case.environment, run_case.frequency);
  if (missing.empty()) return "";
  return std::string("run.field: ") +
         (run_case.field == FieldKind::incoherent ? "an incoherent" : "a semi-coherent") +
         " field adds up the mean field alone: what " + missing + " is left out";
}

}  // namespace checks

std::vector<std::string> warnings(const Environment& ocean, double lowest, double highest) {
  std::vector<std::string> all;
  add_warnings({checks::profile_reach(ocean), checks::absorption_range(ocean, lowest, highest),
                checks::bubble_range(ocean, lowest, highest), checks::gaining_boundary(ocean)},
               all);
  return all;
}

std::vector<std::string> warnings(const PropagationCase& run_case) {
  std::vector<std::string> all =
      warnings(run_case.environment, run_case.frequency, run_case.frequency);
  add_warnings({checks::silent_beams(run_case), checks::mean_field_alone(run_case)}, all);
  return all;
}

}  // namespace asdic
