#include "study/placement/placement_reader.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/quantities.h"
#include "core/text.h"
#include "io/scenario/document.h"
#include "io/scenario/scenario_reader.h"
#include "io/text/csv_table.h"
#include "io/text/toml_table.h"
#include "study/plan/target_keys.h"
#include "study/reader/correlation_reader.h"
#include "study/reader/vary_reader.h"

namespace asdic::detail::study {
namespace {

constexpr Quantity step_of_grid{
    .noun = "step", .unit = "m", .low = 0.0, .high = 1e7, .above = true};
constexpr Quantity weight_of_cell{.noun = "weight", .low = 0.0, .high = 1e9};
constexpr Quantity reach_of_map{
    .noun = "reach", .unit = "m", .low = 0.0, .high = 1e6, .above = true};
constexpr Quantity false_alarm{.noun = "probability", .low = 0.0, .high = 0.5, .above = true};
constexpr std::size_t most_cells = 1'000'000, most_places = 10'000;

/// The middles of a grid's cells.
struct Grid {
  std::vector<Vec2> points;
  double step = 0.0;
};

/// [low, high] of a key.
Span read_span(TomlTable& table, const std::string& key) {
  std::array<double, 2> ends{};
  table.components(key, quantity::coordinate, "[least, greatest]", ends);
  if (!(ends[1] >= ends[0]))
    throw table.fault(key, "[least, greatest], the second not below the first");
  return {ends[0], ends[1]};
}

/// Even points between two ends; both are among them if the step divides what is between.
std::vector<double> even(const Span& span, double step) {
  std::vector<double> points;
  const double count = std::floor((span.high - span.low) / step * (1.0 + 1e-12));
  for (double i = 0.0; i <= count; i += 1.0) points.push_back(span.low + i * step);
  return points;
}

/// Places: the nodes of a grid. \param least  in the middle of the cells instead
Grid read_grid(TomlTable& table, std::size_t most, bool middles) {
  const Span east = read_span(table, "east"), north = read_span(table, "north");
  Grid grid{.points = {}, .step = table.number("step", step_of_grid)};
  const auto along = [&](const Span& span, const char* key) {
    if (!middles) return even(span, grid.step);
    const double cells = std::round((span.high - span.low) / grid.step);
    if (cells < 1.0 || std::abs(cells * grid.step - (span.high - span.low)) > 1e-6 * grid.step)
      throw table.fault(key, "whole cells of step = " + to_text(grid.step) + " m",
                        to_text(span.high - span.low) + " m");
    std::vector<double> points;
    for (double i = 0.0; i < cells; i += 1.0) points.push_back(span.low + (i + 0.5) * grid.step);
    return points;
  };
  const double rows = (north.high - north.low) / grid.step + 1.0;
  if (rows * ((east.high - east.low) / grid.step + 1.0) > double(most))
    throw table.fault("step", "a step that makes at most " + std::to_string(most) + " of them");
  for (const double y : along(north, "north"))
    for (const double x : along(east, "east")) grid.points.emplace_back(x, y);
  return grid;
}

std::vector<Vec2> read_points(TomlTable& table) {
  std::vector<Vec2> points;
  for (const std::vector<double>& row : table.rows("points", quantity::coordinate)) {
    if (row.size() != 2) throw table.fault("points", "[[east, north], ...]");
    points.emplace_back(row[0], row[1]);
  }
  return points;
}

/// A grid, or points.
Grid read_places(TomlTable table, std::size_t most, bool middles) {
  Grid grid;
  if (table.has("points"))
    grid.points = read_points(table);
  else
    grid = read_grid(table, most, middles);
  table.finish();
  return grid;
}

void read_cells(TomlTable table, PlacementPlan& plan) {
  std::vector<double> weights;
  Grid grid;
  if (table.has("points")) {
    grid.points = read_points(table);
    if (table.has("weights")) {
      weights = table.numbers("weights", weight_of_cell);
      if (weights.size() != grid.points.size())
        throw table.fault("weights", "as many as points, " + std::to_string(grid.points.size()),
                          std::to_string(weights.size()) + " weights");
    }
  } else {
    grid = read_grid(table, most_cells, true);
  }
  plan.cells = std::move(grid.points);
  plan.cell_size = grid.step;
  if (weights.empty()) weights.assign(plan.cells.size(), 1.0);
  plan.weights = std::move(weights);
  table.finish();
}

/// Rectangles whose cells weigh otherwise; of several the last one counts.
void read_zones(std::vector<TomlTable> zones, PlacementPlan& plan) {
  for (TomlTable& zone : zones) {
    const Span east = read_span(zone, "east"), north = read_span(zone, "north");
    const double weight = zone.number("weight", weight_of_cell);
    zone.finish();
    bool any = false;
    for (std::size_t c = 0; c < plan.cells.size(); ++c) {
      const Vec2& at = plan.cells[c];
      if (at.x() < east.low || at.x() > east.high || at.y() < north.low || at.y() > north.high)
        continue;
      plan.weights[c] = weight;
      any = true;
    }
    if (!any) throw zone.fault("east", "a zone with the middle of a cell in it");
  }
}

/// Keys of the scenario, by their paths. \param where  the table itself, for messages
void set_keys(const TomlValue* set, const std::string& where, TomlValue& scenario) {
  if (set == nullptr) return;
  static_cast<void>(TomlTable(*set, where));  // must be a table
  for (const TomlEntry& entry : std::get<TomlValue::Table>(set->data))
    value_at(scenario, entry.key, entry.value.origin) = entry.value;
}

/// What an option's scenario is, before the plan's inputs are drawn.
void read_scenario_of(PlacementOption& option, const TomlValue& document, const TomlValue* own,
                      const std::string& where, const std::vector<std::string>& overrides) {
  if (!std::filesystem::exists(option.path))
    throw InputError({.where = where,
                      .got = "no such file \"" + option.path.string() + '"',
                      .expected = "a scenario file"});
  option.text = read_text_file(option.path);
  std::vector<std::string> includes;
  for (const std::string& one : overrides)
    if (one.starts_with("include=")) includes.push_back(one);
  option.scenario = scenario::read_document(option.text, option.path, includes);
  set_keys(document.find("set"), "set", option.scenario);
  set_keys(own, where, option.scenario);
  for (const std::string& one : overrides) apply_override(option.scenario, one);
}

void read_options(TomlTable& table, const TomlValue& document, PlacementPlan& plan,
                  const std::vector<std::string>& overrides) {
  const std::filesystem::path folder = plan.path.parent_path();
  const std::string common = table.has("scenario") ? table.text("scenario") : "";
  std::vector<TomlTable> entries = table.tables("option");
  const TomlValue* array = document.find("placement")->find("option");
  if (entries.empty()) {
    if (common.empty())
      throw table.fault("scenario", "the scenario file of the sensor, or [[placement.option]]",
                        "none");
    PlacementOption option{.name = std::filesystem::path(common).stem().string(),
                           .path = folder / common};
    read_scenario_of(option, document, nullptr, table.where("scenario"), overrides);
    plan.options.push_back(std::move(option));
    return;
  }
  for (std::size_t i = 0; i < entries.size(); ++i) {
    TomlTable& entry = entries[i];
    const bool own = entry.has("scenario");
    if (!own && common.empty())
      throw entry.fault("scenario", "a scenario file, here or as placement.scenario", "none");
    PlacementOption option{.name = entry.text("name", "option " + std::to_string(i + 1)),
                           .path = folder / (own ? entry.text("scenario") : common)};
    for (const PlacementOption& before : plan.options)
      if (before.name == option.name) throw entry.fault("name", "names that differ");
    if (entry.has("transmitter")) option.transmitter = entry.text("transmitter");
    if (entry.has("array")) option.array = entry.text("array");
    static_cast<void>(entry.has("set"));
    entry.finish();
    const auto* items = std::get_if<TomlValue::Array>(&array->data);
    read_scenario_of(option, document, (*items)[i].find("set"), entry.where("set"), overrides);
    plan.options.push_back(std::move(option));
  }
}

void read_targets(TomlTable& table, PlacementPlan& plan) {
  if (table.has("target_depths")) plan.depths = table.numbers("target_depths", quantity::depth);
  plan.depth_weights.assign(std::max<std::size_t>(1, plan.depths.size()), 1.0);
  if (table.has("depth_weights")) {
    plan.depth_weights = table.numbers("depth_weights", weight_of_cell);
    if (plan.depth_weights.size() != plan.depths.size())
      throw table.fault("depth_weights", "one for each of target_depths");
  }
  if (table.has("target_strength_db"))
    plan.wishes.strength_db = table.number("target_strength_db", quantity::level);
  if (table.has("fluctuation"))
    plan.wishes.fluctuation = table.choice(
        "fluctuation", {"none", "swerling-1", "swerling-2", "swerling-3", "swerling-4"});
  plan.wishes.false_alarm_probability = table.number("false_alarm_probability", false_alarm, 1e-4);
  plan.wishes.reference_cells =
      table.number("reference_cells", {.noun = "number of cells", .low = 0.0, .high = 1e6}, 24.0);
  if (table.has("reach")) plan.wishes.reach = table.number("reach", reach_of_map);
  plan.wishes.bearings = static_cast<int>(table.integer("bearings", 4, 3600, 72));
  plan.wishes.ranges = static_cast<int>(table.integer("ranges", 4, 10'000, 200));
}

void read_draws(TomlTable& table, const TomlValue& document, PlacementPlan& plan) {
  plan.map_error =
      MapError(std::find(std::begin(map_error_words), std::end(map_error_words),
                         table.choice("map_error", {"none", "cells", "maps"}, "none")) -
               std::begin(map_error_words));
  const bool random = plan.map_error != MapError::none || document.find("vary") != nullptr;
  for (const char* key : {"draws", "judging_draws"})
    if (table.has(key) && !random)
      throw table.fault(key, "[vary] or map_error beside it: without them nothing is drawn");
  constexpr std::int64_t most = 100'000;
  if (random) {
    plan.draws = static_cast<std::size_t>(table.integer("draws", 2, most, 20));
    plan.judging = static_cast<std::size_t>(
        table.integer("judging_draws", 2, most, static_cast<std::int64_t>(plan.draws)));
  }
  plan.inputs.seed = static_cast<std::uint64_t>(
      table.integer("seed", 0, std::numeric_limits<std::int64_t>::max(), 1));
  plan.inputs.realisations = plan.draws + plan.judging;
  plan.confidence =
      table.number("confidence", {.noun = "probability", .low = 0.5, .high = 0.999999}, 0.95);
}

void read_search(TomlTable& table, PlacementPlan& plan) {
  plan.search.method = PlacementMethod(
      std::find(std::begin(placement_method_words), std::end(placement_method_words),
                table.choice("search", {"auto", "swap", "exhaustive"}, "auto")) -
      std::begin(placement_method_words));
  plan.search.starts = static_cast<int>(table.integer("starts", 0, 10'000, 10));
  plan.search.seed = plan.inputs.seed;
}

/// The laws of what is drawn, with the first option's scenario to look at.
void read_inputs(const TomlValue& document, PlacementPlan& plan) {
  Study& inputs = plan.inputs;
  inputs.path = plan.path;
  inputs.scenario_path = plan.options.front().path;
  inputs.scenario_text = plan.options.front().text;
  inputs.scenario = plan.options.front().scenario;
  inputs.document = document;
  inputs.variables = read_vary(document, inputs);
  for (const Variable& variable : inputs.variables)
    for (const std::string& note : variable.notes)
      plan.warnings.push_back(variable.origin + ": vary." + variable.name + ": " + note);
  TomlTable root(document);
  if (root.has("correlation"))
    inputs.correlation = read_correlation(root.table("correlation"), *document.find("correlation"),
                                          inputs.variables);
  for (PlacementOption& option : plan.options)
    make_room(inputs.variables, option.path, option.scenario);
}

}  // namespace

PlacementPlan read_placement(const std::filesystem::path& path,
                             std::span<const std::string> overrides) {
  constexpr std::array<std::string_view, 5> own_tables{"title", "placement", "set", "vary",
                                                       "correlation"};
  PlacementPlan plan;
  plan.path = path;
  plan.text = read_text_file(path, "a placement plan");
  plan.overrides.assign(overrides.begin(), overrides.end());
  TomlValue document = parse_toml(plan.text, path.string());
  std::vector<std::string> of_scenarios;
  for (const std::string& one : overrides) {
    const auto head = std::string_view(one).substr(0, one.find_first_of(".="));
    if (std::find(own_tables.begin(), own_tables.end(), head) != own_tables.end())
      apply_override(document, one);
    else
      of_scenarios.push_back(one);
  }
  TomlTable root(document);
  if (!root.has("placement"))
    throw root.fault("placement", "a [placement] with sensors, places and cells: a plan",
                     "no [placement]");
  for (const char* key : {"set", "vary", "correlation"}) static_cast<void>(root.has(key));
  plan.title = root.text("title", "");
  TomlTable table = root.table("placement");
  root.finish();
  plan.sensors = static_cast<std::size_t>(table.integer("sensors", 1, 1000));
  plan.multistatic = table.flag("multistatic", false);
  if (table.has("across_options") && !plan.multistatic)
    throw table.fault("across_options", "multistatic = true beside it");
  plan.across_options = table.flag("across_options", false);
  const auto most =
      static_cast<std::int64_t>(plan.multistatic ? plan.sensors * plan.sensors : plan.sensors);
  plan.at_least = static_cast<std::size_t>(table.integer("at_least", 1, most, 1));
  plan.clearance = table.number(
      "clearance", {.noun = "distance", .unit = "m", .low = 0.0, .high = 12000.0}, 1.0);
  plan.least_water = table.number("least_water", quantity::depth, 0.0);
  read_targets(table, plan);
  read_draws(table, document, plan);
  read_search(table, plan);
  read_options(table, document, plan, of_scenarios);
  plan.places = read_places(table.table("places"), most_places, false).points;
  read_cells(table.table("cells"), plan);
  read_zones(table.tables("zone"), plan);
  table.finish();
  read_inputs(document, plan);
  return plan;
}

}  // namespace asdic::detail::study
