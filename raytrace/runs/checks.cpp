#include "raytrace/runs/checks.h"

#include <cmath>
#include <string>
#include <variant>

#include "core/error.h"

namespace asdic::detail {
namespace {

std::string shown(double value) {
  std::string text = std::to_string(value);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text;
}

}  // namespace

void check_sources(const PropagationCase& run_case) {
  const double top = run_case.environment.surface.depth_at(0.0);
  const double bottom = run_case.environment.bottom.depth_at(0.0);
  if (run_case.source_depths.empty())
    throw InputError({.where = "source_depths", .got = "none", .expected = "at least one depth"});
  for (std::size_t i = 0; i < run_case.source_depths.size(); ++i) {
    const double depth = run_case.source_depths[i];
    if (!(depth >= top && depth <= bottom))
      throw InputError({.where = "source_depths[" + std::to_string(i) + "]",
                        .got = shown(depth) + " m",
                        .expected = "a depth in the water, " + shown(top) + " to " + shown(bottom) +
                                    " m at range 0"});
  }
  const BeamSettings& beams = run_case.beams;
  if (beams.elevations.empty() && !(beams.highest >= beams.lowest))
    throw InputError({.where = "beams.highest",
                      .got = shown(degrees(beams.highest)) + " deg",
                      .expected = "an elevation of at least beams.lowest, " +
                                  shown(degrees(beams.lowest)) + " deg"});
  if (!(run_case.frequency > 0.0))
    throw InputError({.where = "frequency",
                      .got = shown(run_case.frequency) + " Hz",
                      .expected = "a frequency above 0 Hz"});
}

void check_receivers(const PropagationCase& run_case) {
  const ReceiverGrid& grid = run_case.receivers;
  if (grid.size() == 0 || grid.depths.empty())
    throw InputError(
        {.where = "receivers", .got = "none", .expected = "at least one depth and one range"});
  if (grid.irregular && grid.depths.size() != grid.ranges.size())
    throw InputError({.where = "receivers",
                      .got = std::to_string(grid.depths.size()) + " depths and " +
                             std::to_string(grid.ranges.size()) + " ranges",
                      .expected = "as many depths as ranges on an irregular grid"});
}

bool on_vacuum(const Environment& ocean, double depth) noexcept {
  for (const Boundary* wall : {&ocean.surface, &ocean.bottom})
    if (depth == wall->depth_at(0.0) && wall->roughness.smooth() &&
        std::holds_alternative<Vacuum>(wall->material_at(0.0)))
      return true;
  return false;
}

RayTracer tracer_of(const PropagationCase& run_case) {
  return {run_case.environment, run_case.frequency,
          run_case.beams.displacement ? Reflection::displaced : Reflection::on_the_spot};
}

}  // namespace asdic::detail
