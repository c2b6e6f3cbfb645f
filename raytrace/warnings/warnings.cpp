#include "raytrace/warnings/warnings.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include "raytrace/ocean/absorption_validity.h"
#include "raytrace/ocean/strongest_reflection.h"

namespace asdic::detail::checks {

std::string profile_reach(double first, double last, const Environment& ocean,
                          const std::string& beyond) {
  const double top = ocean.surface.shape ? ocean.surface.shape->shallowest() : ocean.surface.depth;
  const double bottom = ocean.bottom.shape ? ocean.bottom.shape->deepest() : ocean.bottom.depth;
  const double slack = 0.01 * (bottom - top);  // of casts that begin below the hull
  if (first <= top + slack && last >= bottom - slack) return "";
  char text[256];
  std::snprintf(text, sizeof text,
                "environment.sound_speed: levels from %g to %g m stand for water from %g to %g m; "
                "above and below them %s",
                first, last, top, bottom, beyond.c_str());
  return text;
}

std::string profile_reach(const Environment& ocean) {
  const std::span<const double> depth =
      ocean.section ? ocean.section->depths() : ocean.water.depths();
  if (depth.size() < 2) return "";  // a law, or the same speed everywhere
  return profile_reach(depth.front(), depth.back(), ocean,
                       "the law of the first and last interval goes on");
}

namespace {

constexpr ValidRange bubble_ranges[] = {{"frequency", "Hz", 1e4, 1e5}};
constexpr Validity bubble_validity{"the surface bubble loss", "APL-UW TR 9407, 1994",
                                   bubble_ranges};

}  // namespace

std::string bubble_range(const Environment& ocean, double lowest, double highest) {
  if (!(ocean.surface.roughness.bubble_wind > 0.0)) return "";
  const std::array<Asked, 1> asked{{{"frequency", lowest, highest}}};
  const std::string text = asdic::detail::outside(bubble_validity, asked);
  return text.empty() ? "" : "environment.surface.bubbles: " + text;
}

std::string absorption_range(const Environment& ocean, double lowest, double highest) {
  const std::optional<Validity> law = validity(ocean.absorption, highest);
  if (!law) return "";
  std::vector<Asked> asked{{"frequency", lowest, highest}};
  for_each_water_property(ocean.absorption, [&](std::string_view quantity, double value) {
    asked.push_back({quantity, value, value});
  });
  const std::string text = asdic::detail::outside(*law, asked);
  return text.empty() ? "" : "environment.absorption: " + text;
}

namespace {

/// \param where  "environment.bottom"   \param range, depth  where the water is taken [m]
std::string of_material(const char* where, const BoundaryMaterial& material,
                        const Environment& ocean, double range, double depth) {
  if (!std::holds_alternative<ElasticHalfSpace>(material)) return "";  // fluids only lose
  const WaterAtBoundary water{.speed = sound_speed(ocean, range, depth).c,
                              .density = ocean.water_density.at(depth)};
  const StrongestReflection most = strongest_reflection(material, water);
  if (most.magnitude <= most_reflection) return "";
  char text[200];
  std::snprintf(text, sizeof text,
                "%s: its solid at range %g m reflects more than comes in, %.4g times at %.1f "
                "degrees: its shear waves lose too much beside its compressional ones",
                where, range, most.magnitude, degrees(most.grazing));
  return text;
}

std::string of_boundary(const char* where, const Boundary& boundary, const Environment& ocean) {
  if (!boundary.shape || boundary.shape->materials().empty())
    return of_material(where, boundary.material, ocean, 0.0, boundary.depth_at(0.0));
  const BoundaryShape& shape = *boundary.shape;
  for (std::size_t i = 0; i < shape.materials().size(); ++i) {
    std::string text =
        of_material(where, shape.materials()[i], ocean, shape.ranges()[i], shape.depths()[i]);
    if (!text.empty()) return text;
  }
  return "";
}

}  // namespace

std::string gaining_boundary(const Environment& ocean) {
  std::string text = of_boundary("environment.surface", ocean.surface, ocean);
  return text.empty() ? of_boundary("environment.bottom", ocean.bottom, ocean) : text;
}

namespace {

/// The setting that leaves the beams no width; null: they have one.
const char* without_width(const CervenyBeams& beams, const ReceiverGrid& receivers) {
  if (beams.width_multiplier == 0.0) return "width_multiplier = 0";
  if (beams.window == 0) return "window = 0";
  if (beams.width == CervenyBeams::Width::minimum && beams.loop_range <= 0.0)
    return "width = \"minimum\" without a loop_range above 0";
  const bool at_source = !receivers.ranges.empty() && receivers.ranges.back() == 0.0;
  if (beams.width == CervenyBeams::Width::cerveny && at_source)
    return "width = \"cerveny\" with receivers at range 0 alone";
  return nullptr;
}

}  // namespace

std::string silent_beams(const PropagationCase& run_case) {
  const BeamKind kind = run_case.beams.kind;
  if (run_case.task != Task::field ||
      (kind != BeamKind::cerveny_cartesian && kind != BeamKind::cerveny_ray_centred))
    return "";
  const char* const setting =
      without_width(run_case.beams.cerveny.value_or(CervenyBeams{}), run_case.receivers);
  if (setting == nullptr) return "";
  return std::string("run.beams.cerveny: ") + setting +
         " makes beams of no width: no sound reaches any receiver";
}

}  // namespace asdic::detail::checks

namespace asdic::detail {

void add_warnings(const std::vector<std::string>& more, std::vector<std::string>& all) {
  for (const std::string& one : more)
    if (!one.empty() && std::find(all.begin(), all.end(), one) == all.end()) all.push_back(one);
}

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
  add_warnings({checks::silent_beams(run_case)}, all);
  return all;
}

}  // namespace asdic::detail
