#include "study/sampling/variable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "core/text.h"

namespace asdic::detail::study {
namespace {

std::string last_name(std::string_view key) { return std::string(key.substr(key.rfind('.') + 1)); }

TomlValue array_of(std::span<const double> numbers, const std::string& origin) {
  TomlValue::Array items;
  for (const double x : numbers) items.push_back({.data = x, .origin = origin});
  return {.data = std::move(items), .origin = origin};
}

NumberAtKey number_at(const Variable& v, std::size_t key) {
  return key < v.numbers.size() ? v.numbers[key] : NumberAtKey{.meaning = v.keys.at(key)};
}

// What each law takes and makes.

std::size_t dimensions(const NumberLaw&) { return 1; }
std::size_t dimensions(const ParametricLaw&) { return 1; }
std::size_t dimensions(const ChoiceLaw& law) { return law.kind == ChoiceLaw::Kind::weighted; }
std::size_t dimensions(const TrackLaw& law) { return law.speed ? 5 : 3; }
std::size_t dimensions(const ModesLaw& law) { return law.modes.size(); }
std::size_t dimensions(const TableLaw&) { return 1; }
std::size_t dimensions(const TimeSeriesLaw&) { return 1; }
std::size_t dimensions(const ExpressionLaw&) { return 0; }
/// Those of the branch with the most: one is drawn, out of the same coordinates.
std::size_t dimensions(const ConditionalLaw& law) {
  std::size_t most = 0;
  for (const Branch& branch : law.branches)
    most = std::max(most, std::visit([](const auto& l) { return dimensions(l); }, branch.law));
  return most;
}

/// How many different ways there are to draw a law's values out of a list; 0: it has no list.
std::size_t ways(const AnyLaw& law) {
  if (const auto* choice = std::get_if<ChoiceLaw>(&law)) return choice->values.size();
  const auto* conditional = std::get_if<ConditionalLaw>(&law);
  if (conditional == nullptr) return 0;
  std::size_t sum = 0;
  for (const Branch& branch : conditional->branches)
    sum += std::max<std::size_t>(1, ways(branch.law));
  return sum;
}

/// One of the ways of a conditional law: which branch, and which of that one's ways.
struct Way {
  std::size_t branch = 0, choice = 0;
};
Way way_of(const ConditionalLaw& law, std::size_t choice) {
  Way way{.choice = choice};
  for (; way.branch + 1 < law.branches.size(); ++way.branch) {
    const std::size_t here = std::max<std::size_t>(1, ways(law.branches[way.branch].law));
    if (way.choice < here) break;
    way.choice -= here;
  }
  return way;
}

std::size_t branch_at(const ConditionalLaw& law, double x) {
  if (!law.edges.empty() || law.values.empty())
    return static_cast<std::size_t>(std::upper_bound(law.edges.begin(), law.edges.end(), x) -
                                    law.edges.begin());
  const auto it = std::find(law.values.begin(), law.values.end(), x);
  return it == law.values.end() ? 0
                                : law.branch_of[static_cast<std::size_t>(it - law.values.begin())];
}

std::size_t choose(const ChoiceLaw& law, std::span<const double> u, std::span<const double>) {
  const auto& cumulative = law.cumulative;
  const auto it = std::upper_bound(cumulative.begin(), cumulative.end() - 1, u[0]);
  return static_cast<std::size_t>(it - cumulative.begin());
}

std::size_t choose(const TableLaw& law, std::span<const double> u) {
  const std::size_t n = law.data->rows();
  if (law.cumulative.empty())
    return std::min(n - 1, static_cast<std::size_t>(u[0] * static_cast<double>(n)));
  const auto it = std::upper_bound(law.cumulative.begin(), law.cumulative.end() - 1, u[0]);
  return static_cast<std::size_t>(it - law.cumulative.begin());
}

std::size_t choose(const ConditionalLaw& law, std::span<const double> u,
                   std::span<const double> given) {
  const std::size_t branch = branch_at(law, given[law.given]);
  std::size_t before = 0;
  for (std::size_t b = 0; b < branch; ++b)
    before += std::max<std::size_t>(1, ways(law.branches[b].law));
  const AnyLaw& own = law.branches[branch].law;
  if (const auto* choice = std::get_if<ChoiceLaw>(&own)) return before + choose(*choice, u, given);
  if (const auto* inner = std::get_if<ConditionalLaw>(&own))
    return before + choose(*inner, u, given);
  return before;
}

std::vector<InputColumn> columns(const NumberLaw& law, const Variable& v) {
  return {{.name = v.name,
           .unit = number_at(v, 0).unit,
           .meaning = number_at(v, 0).meaning,
           .ends = law.law.ends()}};
}

std::vector<InputColumn> columns(const ChoiceLaw& law, const Variable& v) {
  std::vector<InputColumn> made;
  for (std::size_t k = 0; k < law.labels.size(); ++k)  // a choice among names is a number of it
    made.push_back({.name = !law.names.empty() ? law.names[k]
                            : law.by_row       ? v.name + '_' + last_name(v.keys[k])
                                               : v.name,
                    .unit = law.labels[k].empty() ? number_at(v, k).unit : "1",
                    .meaning = number_at(v, k).meaning,
                    .labels = law.labels[k]});
  return made;
}

std::vector<InputColumn> columns(const TrackLaw& law, const Variable& v) {
  const std::string& key = v.keys.front();
  std::vector<InputColumn> made{{.name = v.name + "_range",
                                 .unit = "m",
                                 .meaning = key + ": horizontal, from the centre",
                                 .ends = law.range},
                                {.name = v.name + "_bearing_deg",
                                 .unit = "degrees",
                                 .meaning = key + ": true bearing from the centre",
                                 .ends = {degrees(law.bearing.low), degrees(law.bearing.high)}},
                                {.name = v.name + "_depth",
                                 .unit = "m",
                                 .meaning = key + ": depth at the start",
                                 .ends = law.depth}};
  if (law.speed) {
    made.push_back(
        {.name = v.name + "_speed", .unit = "m/s", .meaning = key + ": speed", .ends = *law.speed});
    made.push_back({.name = v.name + "_course_deg",
                    .unit = "degrees",
                    .meaning = key + ": course, true",
                    .ends = {degrees(law.course.low), degrees(law.course.high)}});
  }
  return made;
}

std::vector<InputColumn> columns(const ModesLaw& law, const Variable& v) {
  std::vector<InputColumn> made;
  for (std::size_t k = 0; k < law.modes.size(); ++k)
    made.push_back({.name = v.name + '_' + std::to_string(k + 1),
                    .unit = "m/s",
                    .meaning = "amplitude of mode " + std::to_string(k + 1)});
  return made;
}

/// Columns of data: those of keys have their units.
void append_columns(const DataRows& data, const Variable& v, std::vector<InputColumn>& made) {
  for (std::size_t c = 0; c < data.columns.size(); ++c) {
    const auto [least, greatest] =
        std::minmax_element(data.columns[c].begin(), data.columns[c].end());
    const bool keyed = c < v.keys.size();
    made.push_back({.name = data.columns.size() == 1 ? v.name : v.name + '_' + data.names[c],
                    .unit = keyed && data.labels_of(c).empty() ? number_at(v, c).unit : "1",
                    .meaning = keyed ? number_at(v, c).meaning : data.names[c] + " of the data",
                    .labels = data.labels_of(c),
                    .ends = {*least, *greatest}});
  }
}

std::vector<InputColumn> columns(const TableLaw& law, const Variable& v) {
  std::vector<InputColumn> made;
  append_columns(*law.data, v, made);
  return made;
}

std::vector<InputColumn> columns(const TimeSeriesLaw& law, const Variable& v) {
  std::vector<InputColumn> made{{.name = v.name + "_time",
                                 .unit = law.unit,
                                 .meaning = "time in the series",
                                 .ends = law.span}};
  if (!law.track) {
    append_columns(*law.data, v, made);
    return made;
  }
  const std::string& key = v.keys.front();
  const auto add = [&](const char* name, const char* unit, const char* meaning) {
    made.push_back({.name = v.name + '_' + name, .unit = unit, .meaning = key + ": " + meaning});
  };
  add("east", "m", "east of the map's origin");
  add("north", "m", "north of the map's origin");
  add("depth", "m", "depth");
  add("speed", "m/s", "horizontal speed");
  add("course_deg", "degrees", "course, true");
  return made;
}

std::vector<InputColumn> columns(const ParametricLaw& law, const Variable& v) {
  Span ends{-infinity, infinity};  // as far as they are the same for all rows
  for (const ParametricLaw::Parameter& parameter : law.parameters) {
    if (parameter.formula) continue;
    const bool least = parameter.name == "min" || parameter.name == "low";
    if (least) ends.low = std::max(ends.low, parameter.number);
    if (parameter.name == "max" || parameter.name == "high")
      ends.high = std::min(ends.high, parameter.number);
  }
  return {{.name = v.name,
           .unit = number_at(v, 0).unit,
           .meaning = number_at(v, 0).meaning,
           .ends = ends}};
}

std::vector<InputColumn> columns(const ExpressionLaw&, const Variable& v) {
  return {{.name = v.name, .unit = number_at(v, 0).unit, .meaning = number_at(v, 0).meaning}};
}

std::vector<InputColumn> columns(const ConditionalLaw& law, const Variable&) { return law.columns; }

void values_of(const NumberLaw& law, std::span<const double> u, std::span<const double>,
               std::size_t, std::vector<double>& values) {
  values.push_back(law.law.quantile(u[0]));
}

void values_of(const ChoiceLaw& law, std::span<const double>, std::span<const double>,
               std::size_t choice, std::vector<double>& values) {
  for (std::size_t k = 0; k < law.labels.size(); ++k)
    values.push_back(law.labels[k].empty() ? number_of(law.values[choice][k]).value_or(0.0)
                                           : static_cast<double>(choice));
}

void values_of(const TrackLaw& law, std::span<const double> u, std::span<const double>, std::size_t,
               std::vector<double>& values) {
  const Span squared{law.range.low * law.range.low, law.range.high * law.range.high};
  values.push_back(law.even_in_area ? std::sqrt(squared.at(u[0])) : law.range.at(u[0]));
  values.push_back(degrees(law.bearing.at(u[1])));
  values.push_back(law.depth.at(u[2]));
  if (!law.speed) return;
  values.push_back(law.speed->at(u[3]));
  values.push_back(degrees(law.course.at(u[4])));
}

void values_of(const ModesLaw& law, std::span<const double> u, std::span<const double>, std::size_t,
               std::vector<double>& values) {
  for (std::size_t k = 0; k < law.amplitudes.size(); ++k)
    values.push_back(law.amplitudes[k].quantile(u[k]));
}

void values_of(const TableLaw& law, std::span<const double> u, std::span<const double>, std::size_t,
               std::vector<double>& values) {
  const std::size_t row = choose(law, u);
  for (const std::vector<double>& column : law.data->columns) values.push_back(column[row]);
}

/// Between which rows a time lies, and how far towards the later one.
struct Between {
  std::size_t row = 0;
  double share = 0.0;
};
Between between(const TimeSeriesLaw& law, double time) {
  const auto after = std::upper_bound(law.time.begin(), law.time.end(), time);
  const auto row =
      static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, after - law.time.begin() - 1));
  if (row + 1 >= law.time.size()) return {row, 0.0};
  return {row, (time - law.time[row]) / (law.time[row + 1] - law.time[row])};
}

/// Velocity of a track at a time: of the piece that it lies in, at the last row of that before it.
Vec3 velocity_at(const TimeSeriesLaw& law, double time) {
  const std::size_t row = std::min(between(law, time).row, law.time.size() - 2);
  const double seconds = (law.time[row + 1] - law.time[row]) * law.seconds;
  Vec3 moves = Vec3::Zero();
  for (int c = 0; c < 3; ++c) {
    const std::vector<double>& x = law.data->columns[static_cast<std::size_t>(c)];
    moves[c] = (x[row + 1] - x[row]) / seconds;
  }
  return moves;
}

void values_of(const TimeSeriesLaw& law, std::span<const double> u, std::span<const double>,
               std::size_t, std::vector<double>& values) {
  const double time = law.span.at(u[0]);
  const auto [row, share] = between(law, time);
  values.push_back(time);
  for (std::size_t c = 0; c < law.data->columns.size(); ++c) {
    const std::vector<double>& x = law.data->columns[c];
    if (law.by_row || row + 1 >= x.size()) {
      values.push_back(x[row]);
      continue;
    }
    double step = x[row + 1] - x[row];
    const bool turns = law.angles[c] && std::abs(step) > 180.0;
    if (turns) step -= std::copysign(360.0, step);
    const double there = x[row] + share * step;
    values.push_back(!turns ? there : there < 0.0 ? there + 360.0 : std::fmod(there, 360.0));
  }
  if (!law.track) return;
  const Vec3 moves = velocity_at(law, time);
  values.push_back(moves.head<2>().norm());
  const double course = degrees(std::atan2(moves.x(), moves.y()));
  values.push_back(course < 0.0 ? course + 360.0 : course);
}

std::optional<CutLaw> law_given(const ParametricLaw& law, std::span<const double> given) {
  std::vector<NamedNumber> parameters;
  for (const ParametricLaw::Parameter& parameter : law.parameters) {
    std::vector<double> named;
    for (const std::size_t name : parameter.names) named.push_back(given[name]);
    parameters.push_back(
        {parameter.name, parameter.formula ? parameter.formula->at(named) : parameter.number});
  }
  return law_of(law.kind, parameters);
}

/// Not a number where the parameters make no law: a fault of the realisation, told by write().
void values_of(const ParametricLaw& law, std::span<const double> u, std::span<const double> given,
               std::size_t, std::vector<double>& values) {
  const std::optional<CutLaw> own = law_given(law, given);
  values.push_back(own ? own->quantile(u[0]) : std::nan(""));
}

void values_of(const ExpressionLaw& law, std::span<const double>, std::span<const double> given,
               std::size_t, std::vector<double>& values) {
  std::vector<double> named;
  for (const std::size_t name : law.names) named.push_back(given[name]);
  values.push_back(law.expression.at(named));
}

void values_of(const ConditionalLaw& law, std::span<const double> u, std::span<const double> given,
               std::size_t choice, std::vector<double>& values) {
  const Way way = way_of(law, choice);
  const Branch& branch = law.branches[way.branch];
  const std::size_t first = values.size();
  std::visit([&](const auto& own) { values_of(own, u, given, way.choice, values); }, branch.law);
  for (std::size_t c = 0; c < branch.label_of.size(); ++c)
    if (!branch.label_of[c].empty())
      values[first + c] =
          static_cast<double>(branch.label_of[c][static_cast<std::size_t>(values[first + c])]);
}

void write(const NumberLaw&, const Variable& v, std::span<const double> values, std::size_t,
           TomlValue& scenario) {
  for (const std::string& key : v.keys)
    value_at(scenario, key, v.origin) = {.data = values[0], .origin = v.origin};
}

void write(const ChoiceLaw& law, const Variable& v, std::span<const double>, std::size_t choice,
           TomlValue& scenario) {
  for (std::size_t k = 0; k < v.keys.size(); ++k)
    value_at(scenario, v.keys[k], v.origin) = law.values[choice][law.by_row ? k : 0];
}

void write(const TrackLaw& law, const Variable& v, std::span<const double> values, std::size_t,
           TomlValue& scenario) {
  const auto along = [](double bearing_deg) {
    return Vec2(std::sin(radians(bearing_deg)), std::cos(radians(bearing_deg)));
  };
  const Vec2 place = law.centre + values[0] * along(values[1]);
  for (const std::string& key : v.keys) {
    const std::array<double, 3> position{place.x(), place.y(), values[2]};
    value_at(scenario, key + ".position", v.origin) = array_of(position, v.origin);
    if (!law.speed) continue;
    const Vec2 moves = values[3] * along(values[4]);
    const std::array<double, 3> velocity{moves.x(), moves.y(), 0.0};
    value_at(scenario, key + ".velocity", v.origin) = array_of(velocity, v.origin);
  }
}

void write(const ModesLaw& law, const Variable& v, std::span<const double> values, std::size_t,
           TomlValue& scenario) {
  std::vector<double> speed = law.mean;
  for (std::size_t k = 0; k < law.modes.size(); ++k)
    for (std::size_t i = 0; i < speed.size(); ++i) speed[i] += values[k] * law.modes[k][i];
  TomlValue::Table table{{"kind", {.data = std::string("table"), .origin = v.origin}},
                         {"interpolation", {.data = law.interpolation, .origin = v.origin}},
                         {"depth", array_of(law.depth, v.origin)},
                         {"speed", array_of(speed, v.origin)}};
  for (const std::string& key : v.keys)
    value_at(scenario, key, v.origin) = {.data = table, .origin = v.origin};
}

/// A number at a key; a whole one where whole ones alone may stand.
void write_number(const Variable& v, std::size_t key, double x, TomlValue& scenario) {
  TomlValue value{.data = x, .origin = v.origin};
  if (number_at(v, key).whole && x == std::round(x) && std::abs(x) < 0x1p53)
    value.data = static_cast<std::int64_t>(x);
  value_at(scenario, v.keys[key], v.origin) = std::move(value);
}

void write(const TableLaw& law, const Variable& v, std::span<const double> values, std::size_t,
           TomlValue& scenario) {
  for (std::size_t k = 0; k < v.keys.size(); ++k) {
    const std::vector<std::string>& labels = law.data->labels_of(k);
    if (labels.empty())
      write_number(v, k, values[k], scenario);
    else
      value_at(scenario, v.keys[k], v.origin) = {
          .data = labels.at(static_cast<std::size_t>(values[k])), .origin = v.origin};
  }
}

void write(const TimeSeriesLaw& law, const Variable& v, std::span<const double> values, std::size_t,
           TomlValue& scenario) {
  if (!law.track) {
    for (std::size_t k = 0; k < v.keys.size(); ++k) write_number(v, k, values[k + 1], scenario);
    return;
  }
  const Vec3 moves = velocity_at(law, values[0]);
  const std::array<double, 3> velocity{moves.x(), moves.y(), moves.z()};
  for (const std::string& key : v.keys) {
    value_at(scenario, key + ".position", v.origin) = array_of(values.subspan(1, 3), v.origin);
    value_at(scenario, key + ".velocity", v.origin) = array_of(velocity, v.origin);
  }
}

void write(const ExpressionLaw& law, const Variable& v, std::span<const double> values, std::size_t,
           TomlValue& scenario) {
  const double x = values[0];
  if (!std::isfinite(x))
    throw InputError({.where = v.origin + ": vary." + v.name,
                      .got = to_text(x) + " of " + in_quotes(law.expression.text()),
                      .expected = "a finite number"});
  for (std::size_t k = 0; k < v.keys.size(); ++k) write_number(v, k, x, scenario);
}

void write(const ParametricLaw& law, const Variable& v, std::span<const double> values, std::size_t,
           TomlValue& scenario) {
  if (!std::isfinite(values[0])) {
    std::string formulae;
    for (const ParametricLaw::Parameter& parameter : law.parameters)
      if (parameter.formula)
        formulae += (formulae.empty() ? "" : ", ") + parameter.name + " = " +
                    in_quotes(parameter.formula->text());
    throw InputError(
        {.where = v.origin + ": vary." + v.name,
         .got = "what makes no law: " + formulae,
         .expected = "parameters of a law " + in_quotes(law.kind) + ", whatever others draw"});
  }
  for (std::size_t k = 0; k < v.keys.size(); ++k) write_number(v, k, values[0], scenario);
}

void write(const ConditionalLaw& law, const Variable& v, std::span<const double> values,
           std::size_t choice, TomlValue& scenario) {
  const Way way = way_of(law, choice);
  std::visit([&](const auto& own) { write(own, v, values, way.choice, scenario); },
             law.branches[way.branch].law);
}

}  // namespace

std::optional<double> number_of(const TomlValue& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value.data))
    return static_cast<double>(*integer);
  if (const auto* real = std::get_if<double>(&value.data)) return *real;
  return std::nullopt;
}

std::vector<InputColumn> input_columns(const Variable& variable) {
  return std::visit([&](const auto& law) { return columns(law, variable); }, variable.law);
}

Span ends_of(std::span<const Variable> variables, std::string_view column) {
  for (const Variable& variable : variables)
    for (const InputColumn& input : input_columns(variable))
      if (input.name == column) return input.ends;
  return InputColumn{}.ends;
}

std::size_t dimensions_of(const Variable& variable, bool on_grid) {
  if (on_grid && choices_of(variable) > 0) return 0;
  return std::visit([](const auto& law) { return dimensions(law); }, variable.law);
}

std::size_t choices_of(const Variable& variable) {
  const auto* choice = std::get_if<ChoiceLaw>(&variable.law);
  return choice == nullptr ? 0 : choice->values.size();
}

bool is_continuous(const AnyLaw& law) {
  if (const auto* conditional = std::get_if<ConditionalLaw>(&law))
    return std::all_of(conditional->branches.begin(), conditional->branches.end(),
                       [](const Branch& branch) { return is_continuous(branch.law); });
  return std::holds_alternative<NumberLaw>(law) || std::holds_alternative<ParametricLaw>(law);
}

bool has_formulae(const AnyLaw& law) {
  if (const auto* conditional = std::get_if<ConditionalLaw>(&law))
    return std::any_of(conditional->branches.begin(), conditional->branches.end(),
                       [](const Branch& branch) { return has_formulae(branch.law); });
  return std::holds_alternative<ParametricLaw>(law);
}

namespace {

double density_of(const AnyLaw& law, std::span<const double> given, double x) {
  if (const auto* number = std::get_if<NumberLaw>(&law)) return number->law.density(x);
  if (const auto* parametric = std::get_if<ParametricLaw>(&law)) {
    const std::optional<CutLaw> own = law_given(*parametric, given);
    return own ? own->density(x) : std::nan("");
  }
  if (const auto* conditional = std::get_if<ConditionalLaw>(&law))
    return density_of(conditional->branches[branch_at(*conditional, given[conditional->given])].law,
                      given, x);
  return std::nan("");
}

}  // namespace

double density_given(const Variable& variable, std::span<const double> given, double x) {
  return density_of(variable.law, given, x);
}

std::optional<CutLaw> law_of(std::string_view kind, std::span<const NamedNumber> parameters) {
  const auto at = [&](std::string_view name, double otherwise = std::nan("")) {
    for (const NamedNumber& one : parameters)
      if (one.name == name) return one.number;
    return otherwise;
  };
  const auto has = [&](std::string_view name) { return !std::isnan(at(name)); };
  for (const NamedNumber& one : parameters)
    if (!std::isfinite(one.number)) return std::nullopt;
  const double low = at("low"), high = at("high"), mean = at("mean"), scale = at("scale");
  std::optional<ContinuousLaw> law;
  if (kind == "uniform" && low < high) law = Uniform{low, high};
  if (kind == "normal" && at("deviation") > 0.0 && has("mean")) law = Normal{mean, at("deviation")};
  if (kind == "log_normal" && at("median") > 0.0 && at("log_deviation") > 0.0)
    law = LogNormal{at("median"), at("log_deviation")};
  if (kind == "triangular" && low < high && low <= at("mode") && at("mode") <= high)
    law = Triangular{low, at("mode"), high};
  if (kind == "rayleigh" && mean > 0.0) law = Weibull::rayleigh(mean);
  if (kind == "rayleigh" && scale > 0.0) law = Weibull{2.0, std::numbers::sqrt2 * scale};
  const double shape = at("shape");
  if (kind == "weibull" && shape >= 0.1 && shape <= 100.0) {
    if (mean > 0.0) law = Weibull::of_mean(shape, mean);
    if (scale > 0.0) law = Weibull{shape, scale};
  }
  const double least = at("min", -infinity), most = at("max", infinity);
  if (!law || !(least < most)) return std::nullopt;
  const CutLaw cut(*law, least, most);
  return cut.share() > 0.0 ? std::optional(cut) : std::nullopt;
}

bool places(const AnyLaw& law) {
  if (const auto* conditional = std::get_if<ConditionalLaw>(&law))
    return std::any_of(conditional->branches.begin(), conditional->branches.end(),
                       [](const Branch& branch) { return places(branch.law); });
  const auto* series = std::get_if<TimeSeriesLaw>(&law);
  return std::holds_alternative<TrackLaw>(law) || (series != nullptr && series->track);
}

std::vector<double> values_of_column(const Variable& variable, std::size_t column) {
  const std::vector<std::string>& labels = input_columns(variable).at(column).labels;
  std::vector<double> all;
  for (std::size_t i = 0; i < labels.size(); ++i) all.push_back(static_cast<double>(i));
  if (!all.empty()) return all;
  const auto* choice = std::get_if<ChoiceLaw>(&variable.law);
  for (std::size_t i = 0; choice != nullptr && i < choice->values.size(); ++i)
    if (const double x = number_of(choice->values[i][column]).value_or(0.0);
        std::find(all.begin(), all.end(), x) == all.end())
      all.push_back(x);
  return all;
}

std::size_t chosen(const Variable& variable, std::span<const double> u,
                   std::span<const double> given) {
  if (const auto* choice = std::get_if<ChoiceLaw>(&variable.law)) return choose(*choice, u, given);
  const auto* conditional = std::get_if<ConditionalLaw>(&variable.law);
  return conditional == nullptr ? 0 : choose(*conditional, u, given);
}

void append_values(const Variable& variable, std::span<const double> u,
                   std::span<const double> given, std::size_t choice, std::vector<double>& values) {
  std::visit([&](const auto& law) { values_of(law, u, given, choice, values); }, variable.law);
}

void apply(const Variable& variable, std::span<const double> values, std::size_t choice,
           TomlValue& scenario) {
  std::visit([&](const auto& law) { write(law, variable, values, choice, scenario); },
             variable.law);
}

std::vector<std::size_t> drawing_order(std::span<const Variable> variables) {
  std::vector<std::size_t> order;
  std::vector<std::string> there;  // columns
  std::vector<bool> drawn(variables.size());
  for (bool more = true; std::exchange(more, false);)
    for (std::size_t v = 0; v < variables.size() && !more; ++v) {
      const auto known = [&](const std::string& name) {
        return std::find(there.begin(), there.end(), name) != there.end();
      };
      const Variable& variable = variables[v];
      if (drawn[v] || !std::all_of(variable.given.begin(), variable.given.end(), known)) continue;
      for (const InputColumn& column : input_columns(variable)) there.push_back(column.name);
      order.push_back(v);
      drawn[v] = more = true;
    }
  return order;
}

}  // namespace asdic::detail::study
