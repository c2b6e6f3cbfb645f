#include "raytrace/waves/wave_field.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "core/memory_budget.h"
#include "core/units.h"
#include "raytrace/waves/wave_integral.h"

namespace asdic::detail {
namespace {

constexpr double most_wave_bytes = 1e9;
constexpr double edge_of_fan = 1e-12;  // elevations there belong to it [rad]
constexpr double nearest_range = 0.1;  // receivers nearer than this in range are there [m]

/// The distinct ones, increasing.
std::vector<double> distinct(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

std::size_t place_of(double value, const std::vector<double>& in) {
  return std::size_t(std::lower_bound(in.begin(), in.end(), value) - in.begin());
}

std::string note_of_waves(const WaveIntegral& waves, const WaveColumn& column) {
  char text[160];
  std::snprintf(text, sizeof text,
                "the field is that of the wave equation, shadows, caustics and leakage included: "
                "%zu wavenumbers, %zu layers",
                waves.wavenumbers(), column.layers());
  return text;
}

std::string note_of_rays(const std::string& why) {
  return "a field of rays, " + why +
         ": sound in shadows, beyond caustics and out of ducts is left out (docs/theory/waves.md)";
}

}  // namespace

std::string why_no_waves(const PropagationCase& run_case) {
  const Environment& ocean = run_case.environment;
  const BeamSettings& beams = run_case.beams;
  const bool within_box =
      !(run_case.box_depth > 0.0) ||
      (run_case.box_depth >= ocean.bottom.depth && -run_case.box_depth <= ocean.surface.depth);
  const auto& ranges = run_case.receivers.ranges;
  if (!is_layered(ocean)) return "since water or boundaries vary with range, or losses with depth";
  if (run_case.field != FieldKind::coherent) return "since intensities are added";
  if (beams.kind != BeamKind::hat && beams.kind != BeamKind::ray_centred_hat)
    return "since beams of a width of their own are asked for";
  if (beams.source != SourceKind::point) return "since the source is a line";
  if (beams.pattern) return "since the source has a pattern";
  if (beams.displacement) return "since beams are displaced";
  if (!beams.elevations.empty() || beams.lowest > -0.5 * pi + edge_of_fan ||
      beams.highest < 0.5 * pi - edge_of_fan)
    return "since the fan is limited";
  if (!within_box) return "since the box cuts the water";
  if (*std::min_element(ranges.begin(), ranges.end()) < 0.0)
    return "since a receiver is behind the source";
  return "";
}

std::optional<ConvergedField> wave_field(const PropagationCase& run_case, double source_depth,
                                         const Progress& progress, std::string& note) {
  if (run_case.solver == FieldSolver::beams) return std::nullopt;
  const bool asked = run_case.solver == FieldSolver::waves;
  if (const std::string why = why_no_waves(run_case); !why.empty()) {
    if (asked)
      throw InputError({"solver", "\"waves\", " + why,
                        "\"auto\" or \"beams\": waves are for coherent fields of a point source in "
                        "stratified water"});
    if (run_case.field == FieldKind::coherent) note = note_of_rays(why);
    return std::nullopt;
  }
  const ReceiverGrid& grid = run_case.receivers;
  std::vector<double> ranges = grid.ranges;
  for (double& r : ranges) r = std::max(r, nearest_range);
  ranges = distinct(std::move(ranges));
  const std::vector<double> depths = distinct(grid.depths);
  const Environment& ocean = run_case.environment;
  const WaveColumn column(ocean, run_case.frequency, source_depth, depths);
  const WaveIntegral waves(column, depths.size(), ocean.bottom.depth - ocean.surface.depth, ranges);
  if (waves.bytes() > most_wave_bytes && asked)
    throw InputError({"receivers",
                      std::to_string(depths.size()) + " depths by " +
                          std::to_string(ranges.size()) + " ranges, " + bytes_text(waves.bytes()),
                      "at most " + bytes_text(most_wave_bytes) + " with solver = \"waves\""});
  if (!asked && (waves.steps() > most_wave_steps || waves.bytes() > most_wave_bytes)) {
    char why[160];
    std::snprintf(why, sizeof why,
                  "since the wave equation would take %.2g steps and %s, above %.2g or %s "
                  "(solver = \"waves\" takes them)",
                  waves.steps(), bytes_text(waves.bytes()).c_str(), most_wave_steps,
                  bytes_text(most_wave_bytes).c_str());
    note = note_of_rays(why);
    return std::nullopt;
  }
  const std::vector<std::complex<double>> all = waves.field(progress);
  ConvergedField result;
  result.waves = true;
  result.note = note_of_waves(waves, column);
  result.field.reserve(grid.size());
  for (std::size_t i = 0; i < grid.rows(); ++i)
    for (std::size_t j = 0; j < grid.ranges.size(); ++j) {
      const double range = grid.ranges[j];
      const std::size_t row = place_of(grid.depths[grid.irregular ? j : i], depths);
      const std::size_t at = place_of(std::max(range, nearest_range), ranges);
      const bool beyond = run_case.box_range > 0.0 && range > run_case.box_range;
      result.field.push_back(beyond ? 0.0 : all[row * ranges.size() + at]);
    }
  return result;
}

}  // namespace asdic::detail
