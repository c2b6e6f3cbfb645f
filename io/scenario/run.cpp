#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/text.h"
#include "io/scenario/angles.h"
#include "io/scenario/propagation.h"

namespace asdic {

std::string_view name(Task task) noexcept {
  constexpr std::string_view names[] = {"rays", "eigenrays", "arrivals", "eigenrays-and-arrivals",
                                        "field"};
  return names[static_cast<int>(task)];
}

std::string_view name(FieldKind kind) noexcept {
  constexpr std::string_view names[] = {"coherent", "incoherent", "semi-coherent"};
  return names[static_cast<int>(kind)];
}

std::string_view name(FieldSolver solver) noexcept {
  constexpr std::string_view names[] = {"auto", "beams", "waves"};
  return names[static_cast<int>(solver)];
}

std::string_view name(BeamKind kind) noexcept {
  constexpr std::string_view names[] = {"hat",
                                        "gaussian",
                                        "ray-centred-hat",
                                        "ray-centred-gaussian",
                                        "simple-gaussian",
                                        "cerveny-cartesian",
                                        "cerveny-ray-centred"};
  return names[static_cast<int>(kind)];
}

std::string_view name(SourceKind kind) noexcept {
  return kind == SourceKind::point ? "point" : "line";
}

std::string_view name(CervenyBeams::Width width) noexcept {
  constexpr std::string_view names[] = {"space-filling", "minimum", "wkb", "cerveny"};
  return names[static_cast<int>(width)];
}

std::string_view name(CervenyBeams::Curvature curvature) noexcept {
  constexpr std::string_view names[] = {"standard", "doubled", "zero"};
  return names[static_cast<int>(curvature)];
}

std::string_view name(CervenyBeams::Component component) noexcept {
  constexpr std::string_view names[] = {"pressure", "vertical", "horizontal"};
  return names[static_cast<int>(component)];
}

namespace scenario {
namespace {

constexpr AngleQuantity elevation{.noun = "elevation", .low_deg = -360.0, .high_deg = 360.0};
constexpr Quantity receiver_depth{.noun = "depth", .unit = "m", .low = -1e6, .high = 1e6};
constexpr Quantity receiver_range{.noun = "range", .unit = "m", .low = -1e10, .high = 1e10};
constexpr Quantity limit{.noun = "limit", .unit = "m", .low = 0.0, .high = 1e10};
constexpr std::int64_t most_beams = 10'000'000;

/// One of the first `count` values of an enumeration, by its name; the fallback's where absent.
template <class Enum>
Enum one_of(TomlTable& table, const std::string& key, int count, Enum fallback) {
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) names.emplace_back(name(static_cast<Enum>(i)));
  const std::string chosen = table.choice(key, names, std::string(name(fallback)));
  const auto found = std::find(names.begin(), names.end(), chosen) - names.begin();
  return static_cast<Enum>(found);
}

/// A number, an array of numbers, or evenly spaced ones: { first, last, count }.
std::vector<double> read_axis(TomlTable& table, const std::string& key, const Quantity& quantity) {
  if (table.is_array(key)) return table.numbers(key, quantity);
  if (!table.is_table(key)) return {table.number(key, quantity)};
  TomlTable even = table.table(key);
  const double first = even.number("first", quantity), last = even.number("last", quantity);
  const auto count = even.integer("count", 1, 10'000'000);
  even.finish();
  return evenly_spaced(first, last, static_cast<std::size_t>(count));
}

void require_order(const TomlTable& table, const std::string& key,
                   const std::vector<double>& values) {
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] < values[i - 1])
      throw table.fault(key + "[" + std::to_string(i) + "]",
                        "a value not below the one before it, " + to_text(values[i - 1]) + " m");
}

/// Level over launch angle: `amplitude`, or `level_db` = 20·log₁₀ of it.
SourcePattern read_pattern(TomlTable table) {
  SourcePattern pattern;
  pattern.elevation = read_angles(table, "elevation", elevation);
  const bool in_db = table.has("level_db");
  const std::string key = in_db ? "level_db" : "amplitude";
  if (in_db && table.has("amplitude"))
    throw table.fault("amplitude", "no \"amplitude\" beside level_db");
  pattern.amplitude = table.numbers(key, {.noun = in_db ? "level" : "amplitude",
                                          .low = in_db ? -1000.0 : 0.0,
                                          .high = in_db ? 1000.0 : 1e50});
  if (in_db)
    for (double& x : pattern.amplitude) x = amplitude_from_db(x);
  if (pattern.amplitude.size() != pattern.elevation.size())
    throw table.fault(key,
                      "as many values as elevations, " + std::to_string(pattern.elevation.size()));
  for (std::size_t i = 1; i < pattern.elevation.size(); ++i)
    if (pattern.elevation[i] <= pattern.elevation[i - 1])
      throw table.fault(angle_key(table, "elevation") + "[" + std::to_string(i) + "]",
                        "an elevation above the one before it");
  table.finish();
  return pattern;
}

void read_source(TomlTable table, PropagationCase& run) {
  if (table.has("depth") || run.source_depths.empty())
    run.source_depths = read_axis(table, "depth", receiver_depth);
  run.beams.source = one_of(table, "kind", 2, run.beams.source);
  if (table.has("pattern")) run.beams.pattern = read_pattern(table.table("pattern"));
  table.finish();
}

void read_receivers(TomlTable table, PropagationCase& run) {
  ReceiverGrid& grid = run.receivers;
  grid.irregular = table.flag("irregular", false);
  const bool has_depth = table.has("depth"), has_range = table.has("range");
  if (run.task != Task::rays || has_depth || has_range) {  // rays need none
    grid.depths = read_axis(table, "depth", receiver_depth);
    grid.ranges = read_axis(table, "range", receiver_range);
  }
  if (grid.irregular) {
    if (grid.depths.size() != grid.ranges.size())
      throw table.fault("depth", "one for each of the " + std::to_string(grid.ranges.size()) +
                                     " ranges of an irregular set");
  } else {
    require_order(table, "depth", grid.depths);
    require_order(table, "range", grid.ranges);
    if (double(grid.depths.size()) * double(grid.ranges.size()) > 1e9)
      throw table.fault("range", "at most 1e9 receivers");
  }
  table.finish();
}

void read_fan(TomlTable table, BeamSettings& beams) {
  if (has_angle(table, "elevations")) {
    beams.elevations = read_angles(table, "elevations", elevation);
    const std::string key = angle_key(table, "elevations");
    for (std::size_t i = 1; i < beams.elevations.size(); ++i)
      if (beams.elevations[i] < beams.elevations[i - 1])
        throw table.fault(key + "[" + std::to_string(i) + "]",
                          "an elevation not below the one before it");
    beams.lowest = beams.elevations.front();
    beams.highest = beams.elevations.back();
  }
  beams.lowest = read_angle(table, "lowest", elevation, beams.lowest);
  beams.highest = read_angle(table, "highest", elevation, beams.highest);
  if (beams.highest < beams.lowest)
    throw table.fault(angle_key(table, "highest"), "not below the lowest elevation");
  beams.count = static_cast<int>(table.integer("count", 0, most_beams, beams.count));
  table.finish();
}

CervenyBeams read_cerveny(TomlTable table) {
  CervenyBeams beams;
  beams.width = one_of(table, "width", 4, beams.width);
  beams.curvature = one_of(table, "curvature", 3, beams.curvature);
  beams.component = one_of(table, "component", 3, beams.component);
  beams.width_multiplier = table.number(
      "width_multiplier", {.noun = "factor", .low = -1e9, .high = 1e9}, beams.width_multiplier);
  beams.loop_range = table.number("loop_range", receiver_range, beams.loop_range);
  beams.images = static_cast<int>(table.integer("images", 1, 3, beams.images));
  beams.window = static_cast<int>(table.integer("window", 0, 1'000'000, beams.window));
  table.finish();
  return beams;
}

void read_beams(TomlTable table, BeamSettings& beams) {
  beams.kind = one_of(table, "kind", 7, beams.kind);
  beams.displacement = table.flag("displacement", beams.displacement);
  const bool cerveny =
      beams.kind == BeamKind::cerveny_cartesian || beams.kind == BeamKind::cerveny_ray_centred;
  if (table.has("cerveny") || cerveny) beams.cerveny = read_cerveny(table.table("cerveny"));
  table.finish();
}

void read_literal(TomlTable table, LiteralSettings& literal) {
  literal.step = table.number("step", limit, literal.step);
  literal.beams = static_cast<int>(table.integer("beams", 0, most_beams, literal.beams));
  if (table.has("single_beam"))
    literal.single_beam = static_cast<int>(table.integer("single_beam", 1, most_beams));
  table.finish();
}

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
void set_box(TomlTable& table, PropagationCase& run) {
  double furthest = 0.0;
  for (const double r : run.receivers.ranges) furthest = std::max(furthest, std::abs(r));
  const Boundary& bottom = run.environment.bottom;
  const double deepest = bottom.shape ? bottom.shape->deepest() : bottom.depth;
  const bool known = furthest > 0.0;
  run.box_range = known ? table.number("box_range", limit, usual_box_range(bottom, furthest))
                        : table.number("box_range", limit);
  run.box_depth = table.number("box_depth", limit, 1.01 * std::abs(deepest) + 1.0);
}

}  // namespace

std::vector<double> evenly_spaced(double first, double last, std::size_t count) {
  std::vector<double> values(count, first);
  for (std::size_t i = 1; i < count; ++i)
    values[i] = i + 1 == count ? last
                               : first + (last - first) * static_cast<double>(i) /
                                             static_cast<double>(count - 1);
  return values;
}

double read_memory(TomlTable& table) {
  constexpr Quantity memory{.noun = "memory", .unit = "bytes", .low = 1e6, .high = 1e18};
  if (!table.is_text("memory")) return table.number("memory", memory, 0.0);
  const std::string text = table.text("memory");
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  while (unit.starts_with(' ')) unit.remove_prefix(1);
  constexpr std::pair<std::string_view, double> units[] = {
      {"MB", 1e6},        {"GB", 1e9},           {"TB", 1e12},
      {"MiB", 1048576.0}, {"GiB", 1073741824.0}, {"TiB", 1099511627776.0}};
  for (const auto& [name, scale] : units)
    if (error == std::errc{} && unit == name && memory.holds(value * scale)) return value * scale;
  throw table.fault("memory", memory.expected() + ", or a text such as \"4 GB\" or \"512 MiB\"");
}

void read_run(TomlTable table, PropagationCase& run) {
  static_cast<void>(read_memory(table));  // of the process, not of the run: budget_of()
  run.task = one_of(table, "task", 5, run.task);
  run.field = one_of(table, "field", 3, run.field);
  run.solver = one_of(table, "solver", 3, FieldSolver::automatic);
  constexpr Quantity frequency{
      .noun = "frequency", .unit = "Hz", .low = 0.0, .high = 1e8, .above = true};
  run.frequency = table.number("frequency", frequency, run.frequency);
  read_source(table.table("source"), run);
  read_receivers(table.table("receivers"), run);
  read_fan(table.table("fan"), run.beams);
  read_beams(table.table("beams"), run.beams);
  read_literal(table.table("literal"), run.literal);
  set_box(table, run);
  table.finish();
}

}  // namespace scenario
}  // namespace asdic
