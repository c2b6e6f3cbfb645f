// Part of propagation.h: [run].
#include <algorithm>
#include <cmath>
#include <string>

#include "core/quantities.h"
#include "core/text.h"
#include "io/scenario/propagation.h"
#include "io/settings/reader.h"

namespace asdic::detail::scenario {
namespace {

constexpr AngleQuantity launch_elevation{.noun = "elevation", .low_deg = -360.0, .high_deg = 360.0};
constexpr Quantity receiver_depth{.noun = "depth", .unit = "m", .low = -1e6, .high = 1e6};
constexpr Quantity receiver_range{.noun = "range", .unit = "m", .low = -1e10, .high = 1e10};
constexpr Quantity limit{.noun = "limit", .unit = "m", .low = 0.0, .high = 1e10};
constexpr Quantity case_frequency{.noun = "frequency", .unit = "Hz", .low = 1e-3, .high = 1e8};
constexpr std::int64_t most_beams = 10'000'000;

/// Where a list first falls, or does not rise. \return its element: "range[3]"; "" if nowhere
std::string out_of_order(const std::string& key, const std::vector<double>& values, bool rising) {
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] < values[i - 1] || (rising && values[i] == values[i - 1]))
      return key + "[" + std::to_string(i) + "]";
  return "";
}

void require_not_falling(Fields& field, const std::string& key, const std::vector<double>& values) {
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] < values[i - 1])
      field.fault(key + "[" + std::to_string(i) + "]",
                  "a value not below the one before it, " + to_text(values[i - 1]) + " m");
}

/// Level over launch angle: `amplitude`, or `level_db` = 20·log₁₀ of it.
struct PatternTable {
  SourcePattern pattern;

  void describe(Fields& field) {
    field(required("elevation"), pattern.elevation, launch_elevation,
          "at which the pattern is given");
    Fields::Ways ways;
    if (const auto way = field.way(ways, {"level_db"}, false)) {
      std::vector<double> level;
      field(required("level_db"), level,
            {.noun = "level", .unit = "dB", .low = -1000.0, .high = 1000.0},
            "re that of a source without a pattern");
      if (field.reads()) pattern.amplitude.assign(level.size(), 0.0);
      if (field.reads())
        std::transform(level.begin(), level.end(), pattern.amplitude.begin(), amplitude_from_db);
    }
    if (const auto way = field.otherwise(ways, {"amplitude"}))
      field(required("amplitude"), pattern.amplitude,
            {.noun = "amplitude", .low = 0.0, .high = 1e50},
            "re that of a source without a pattern; straight between elevations");
    if (field.checks()) check(field, std::string(ways.chosen.front()));
  }
  void check(Fields& field, const std::string& strength) const {
    if (pattern.amplitude.size() != pattern.elevation.size())
      field.fault(strength,
                  "as many values as elevations, " + std::to_string(pattern.elevation.size()));
    const std::string at = out_of_order("elevation_deg", pattern.elevation, true);
    if (!at.empty()) field.fault(at, "an elevation above the one before it");
  }
};

struct SourceTable {
  PropagationCase& run;

  void describe(Fields& field) {
    const SettingKey depth = by_default("depth", "the platform's; required without a sonar");
    field.axis(run.source_depths.empty() ? required(depth) : depth, run.source_depths,
               receiver_depth, "of the sources");
    field("kind", run.beams.source, "a point's sound spreads across the plane, a line's does not");
    std::optional<PatternTable> pattern;
    if (run.beams.pattern) pattern = PatternTable{*run.beams.pattern};
    field("pattern", pattern, "its strength over launch elevation");
    if (!field.reads()) return;
    run.beams.pattern.reset();
    if (pattern) run.beams.pattern = pattern->pattern;
  }
};

struct ReceiversTable {
  ReceiverGrid& grid;
  bool wanted;  ///< rays need none
  static constexpr std::string_view unless_rays = "required but of task = \"rays\"";

  void describe(Fields& field) {
    field(seldom("irregular"), grid.irregular,
          "receiver i is at the i-th range and depth; else they are at all ranges and depths");
    const SettingKey depth = by_default("depth", unless_rays),
                     range = by_default("range", unless_rays);
    field.axis(wanted ? required(depth) : depth, grid.depths, receiver_depth, "of receivers");
    field.axis(wanted || !grid.depths.empty() ? required(range) : range, grid.ranges,
               receiver_range, "of receivers from the source");
    if (field.checks()) check(field);
  }
  void check(Fields& field) const {
    if (grid.depths.empty() && !grid.ranges.empty())
      field.fault("depth", receiver_depth.expected());
    if (grid.irregular) {
      if (grid.depths.size() != grid.ranges.size())
        field.fault("depth", "one for each of the " + std::to_string(grid.ranges.size()) +
                                 " ranges of an irregular set");
      return;
    }
    require_not_falling(field, "depth", grid.depths);
    require_not_falling(field, "range", grid.ranges);
    if (double(grid.depths.size()) * double(grid.ranges.size()) > 1e9)
      field.fault("range", "at most 1e9 receivers");
  }
};

struct FanTable {
  BeamSettings& beams;

  void describe(Fields& field) {
    field("elevations", beams.elevations, launch_elevation,
          "of exactly these rays, positive up, in place of lowest and highest");
    if (field.reads() && !beams.elevations.empty()) {
      const std::string at = out_of_order("elevations_deg", beams.elevations, false);
      if (!at.empty()) field.fault(at, "an elevation not below the one before it");
      beams.lowest = beams.elevations.front();
      beams.highest = beams.elevations.back();
    }
    field("lowest", beams.lowest, launch_elevation, "of the lowest ray that leaves the source");
    field("highest", beams.highest, launch_elevation, "of the highest ray");
    if (field.checks() && beams.highest < beams.lowest)
      field.fault("highest_deg", "not below the lowest elevation");
    field("count", beams.count, 0, most_beams,
          "rays of a ray run, the least number of beams otherwise; 0: by our own rule");
  }
};

struct CervenyTable {
  CervenyBeams beams;

  void describe(Fields& field) {
    field("width", beams.width, "how wide a beam begins");
    field("curvature", beams.curvature, "of the jump of p at a reflection");
    field("component", beams.component, "of the field that is computed");
    field("width_multiplier", beams.width_multiplier, {.noun = "factor", .low = -1e9, .high = 1e9},
          "on the width");
    field("loop_range", beams.loop_range, receiver_range,
          "where a minimum-width beam is narrowest");
    field("images", beams.images, 1, 3,
          "1: the ray; 2: and over the surface; 3: and under the bottom");
    field("window", beams.window, 0, 1'000'000, "half-width of the beam, in its own widths");
  }
};

struct BeamsTable {
  BeamSettings& beams;

  void describe(Fields& field) {
    field("kind", beams.kind, "shape of a beam across its ray, where a field is made of beams");
    field(seldom("displacement"), beams.displacement,
          "whether beams are displaced along the boundary at a reflection");
    std::optional<CervenyTable> cerveny;
    if (beams.cerveny) cerveny = CervenyTable{*beams.cerveny};
    const bool of_them =
        beams.kind == BeamKind::cerveny_cartesian || beams.kind == BeamKind::cerveny_ray_centred;
    if (field.reads() && of_them && !cerveny) cerveny.emplace();
    if (of_them && cerveny)
      field("cerveny", *cerveny, "what only Cerveny beams know");
    else
      field("cerveny", cerveny, "what only Cerveny beams know");
    if (!field.reads()) return;
    beams.cerveny.reset();
    if (cerveny) beams.cerveny = cerveny->beams;
  }
};

struct LiteralTable {
  LiteralSettings& literal;

  void describe(Fields& field) {
    field.remark("obeyed by --like-bellhop alone");
    field("step", literal.step, limit, "of the marching; 0: a tenth of the depth");
    field("beams", literal.beams, 0, most_beams, "0: by BELLHOP's rule");
    field("single_beam", literal.single_beam, 1, most_beams, "trace this one only, counted from 1");
  }
};

/// Where rays need not be followed any further: a little behind the last receiver, or, where the
/// bottom goes on to rise behind it and sound may turn round there, where it ends to rise, at twice
/// that range at most [m].
double usual_box_range(const Boundary& bottom, double furthest) {
  double last = furthest, shallowest = bottom.depth_at(furthest);
  if (bottom.shape)
    for (std::size_t i = 0; i < bottom.shape->ranges().size(); ++i)
      if (const double range = bottom.shape->ranges()[i];
          range > furthest && bottom.shape->depths()[i] < shallowest)
        last = range, shallowest = bottom.shape->depths()[i];
  return 1.01 * std::min(last, 2.0 * furthest);
}

/// Rays end at a range of their own, and under the deepest bottom.
void describe_box(Fields& field, PropagationCase& run) {
  double furthest = 0.0;
  for (const double r : run.receivers.ranges) furthest = std::max(furthest, std::abs(r));
  if (field.reads()) {
    const Boundary& bottom = run.environment.bottom;
    const double deepest = bottom.shape ? bottom.shape->deepest() : bottom.depth;
    run.box_range = usual_box_range(bottom, furthest);
    run.box_depth = 1.01 * std::abs(deepest) + 1.0;
  }
  const SettingKey range =
      by_default("box_range", "just behind the last receiver; required without one");
  field(furthest > 0.0 ? range : required(range), run.box_range, limit,
        "from the source, at which rays end");
  field(by_default("box_depth", "just under the deepest bottom"), run.box_depth, limit,
        "below and above depth 0, at which rays end");
}

}  // namespace

void RunTable::describe(Fields& field) {
  field("task", run.task, "what is computed");
  field("dimension", run.dimension, 2, 3,
        "3: rays are turned out of their vertical planes, too; a field is the sum of its paths");
  field(seldom("off_transect"), run.off_transect,
        AngleQuantity{.noun = "angle", .low_deg = -180.0, .high_deg = 180.0},
        "of the line on which the receivers lie, clockwise from the transect");
  field("field", run.field, "how a field adds its paths");
  field("solver", run.solver, "what a coherent field is made of; other fields are made of beams");
  field(by_default("frequency", "the middle of the pulse; required without a sonar"), run.frequency,
        case_frequency, "of the sound");
  SourceTable source{run};
  ReceiversTable receivers{run.receivers, run.task != Task::rays};
  FanTable fan{run.beams};
  BeamsTable beams{run.beams};
  LiteralTable literal{run.literal};
  field("source", source, "where the sound comes from");
  field("receivers", receivers, "where the field is wanted");
  field("fan", fan, "the rays that leave the source");
  field("beams", beams, "what is around them");
  field("literal", literal, "what an input file of BELLHOP says and only a literal run obeys");
  describe_box(field, run);
}

void describe_memory(Fields& field, double& bytes) {
  field(by_default("memory", "half of what the process may have"), bytes, quantity::memory,
        "that any command takes at most");
}

double read_memory(TomlTable& table) {
  double bytes = 0.0;
  KnownSettings known;
  TomlReader reader(table, known);
  describe_memory(reader, bytes);
  return bytes;
}

void read_run(TomlTable table, PropagationCase& run) {
  static_cast<void>(read_memory(table));  // of the process, not of the run: budget_of()
  run.solver = FieldSolver::automatic;
  KnownSettings known;
  RunTable settings{run};
  read_settings(std::move(table), settings, known);
}

}  // namespace asdic::detail::scenario
