#include "study/reader/vary_laws.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/quantities.h"
#include "core/text.h"
#include "io/scenario/scenario_reader.h"
#include "io/text/csv_table.h"
#include "study/reader/vary_climatology.h"
#include "study/reader/vary_data.h"
#include "study/reader/vary_given.h"
#include "study/reader/vary_profiles.h"

namespace asdic::detail::study {
namespace {

constexpr Quantity any{};
constexpr Quantity positive{.low = 0.0, .above = true};

/// \throws InputError unless exactly one of the keys stands there
void require_one(TomlTable& table, const std::string& a, const std::string& b) {
  if (table.has(a) && table.has(b)) throw table.fault(b, "no " + in_quotes(b) + " beside " + a);
  if (!table.has(a) && !table.has(b)) throw table.fault(a, "a number above 0, or " + in_quotes(b));
}

ContinuousLaw read_continuous(const std::string& name, TomlTable& table) {
  if (name == "uniform") {
    const double low = table.number("low", any);
    return Uniform{low, table.number("high", {.low = low, .above = true})};
  }
  if (name == "normal") {
    const double mean = table.number("mean", any);
    return Normal{mean, table.number("deviation", positive)};
  }
  if (name == "log_normal") {
    const double median = table.number("median", positive);
    return LogNormal{median, table.number("log_deviation", positive)};
  }
  if (name == "triangular") {
    const double low = table.number("low", any);
    const double high = table.number("high", {.low = low, .above = true});
    return Triangular{low, table.number("mode", {.low = low, .high = high}), high};
  }
  require_one(table, "mean", "scale");
  if (name == "rayleigh") {
    if (table.has("mean")) return Weibull::rayleigh(table.number("mean", positive));
    // Of the density x/σ²·exp(−x²/2σ²).
    return Weibull{2.0, std::numbers::sqrt2 * table.number("scale", positive)};
  }
  const double shape = table.number("shape", {.low = 0.1, .high = 100.0});
  if (table.has("mean")) return Weibull::of_mean(shape, table.number("mean", positive));
  return Weibull{shape, table.number("scale", positive)};
}

NumberLaw read_number_law(const std::string& name, TomlTable& table) {
  const ContinuousLaw law = read_continuous(name, table);
  const double low = table.has("min") ? table.number("min", any) : -infinity;
  const double high = table.has("max") ? table.number("max", any) : infinity;
  if (!(low < high)) throw table.fault("max", "a number above min, " + to_text(low));
  const CutLaw cut(law, low, high);
  if (!(cut.share() > 0.0))
    throw table.fault(table.has("min") ? "min" : "max", "limits within which the law has values");
  return {cut};
}

/// The keys that each continuous law has; of two in one entry, one alone.
struct KeysOfLaw {
  std::string_view law;
  std::vector<std::vector<std::string>> keys;
};
const std::vector<KeysOfLaw>& keys_of_laws() {
  static const std::vector<KeysOfLaw> all{{"uniform", {{"low"}, {"high"}}},
                                          {"normal", {{"mean"}, {"deviation"}}},
                                          {"log_normal", {{"median"}, {"log_deviation"}}},
                                          {"triangular", {{"low"}, {"mode"}, {"high"}}},
                                          {"rayleigh", {{"mean", "scale"}}},
                                          {"weibull", {{"shape"}, {"mean", "scale"}}}};
  return all;
}

/// A law one of whose parameters is a formula.
ParametricLaw read_parametric(const std::string& name, TomlTable& table, Variable& variable,
                              const Others& others) {
  ParametricLaw law{.kind = name};
  const auto add = [&](const std::string& key) {
    ParametricLaw::Parameter parameter{.name = key};
    if (table.is_text(key))
      parameter.formula = read_formula(table, key, variable, others, parameter.names);
    else
      parameter.number = table.number(key, any);
    law.parameters.push_back(std::move(parameter));
  };
  for (const KeysOfLaw& one : keys_of_laws()) {
    if (one.law != name) continue;
    for (const std::vector<std::string>& keys : one.keys) {
      if (keys.size() > 1) require_one(table, keys[0], keys[1]);
      add(keys.size() > 1 && table.has(keys[1]) ? keys[1] : keys[0]);
    }
  }
  for (const char* limit : {"min", "max"})
    if (table.has(limit)) add(limit);
  // What is no formula must make a law whatever the others are: numbers by themselves.
  for (const ParametricLaw::Parameter& parameter : law.parameters) {
    const bool above_zero = parameter.name == "deviation" || parameter.name == "log_deviation" ||
                            parameter.name == "median" || parameter.name == "scale" ||
                            (parameter.name == "mean" && name != "normal");
    if (!parameter.formula && above_zero && !(parameter.number > 0.0))
      throw table.fault(parameter.name, "a number above 0");
    if (!parameter.formula && parameter.name == "shape" &&
        !(parameter.number >= 0.1 && parameter.number <= 100.0))
      throw table.fault(parameter.name, "a number from 0.1 to 100");
  }
  return law;
}

/// Equal weights, or those that stand there, summed up to 1.
std::vector<double> read_weights(TomlTable& table, std::size_t choices) {
  std::vector<double> weights(choices, 1.0);
  if (table.has("weights")) {
    weights = table.numbers("weights", {.noun = "weight", .low = 0.0});
    if (weights.size() != choices)
      throw table.fault("weights",
                        "as many weights as there are values, " + std::to_string(choices));
  }
  std::vector<double> cumulative(choices);
  std::partial_sum(weights.begin(), weights.end(), cumulative.begin());
  if (!(cumulative.back() > 0.0)) throw table.fault("weights", "a weight above 0");
  for (double& share : cumulative) share /= cumulative.back();
  cumulative.back() = 1.0;
  return cumulative;
}

/// from, to, count: evenly spaced, or in equal ratios.
std::vector<std::vector<TomlValue>> read_steps(TomlTable& table, const std::string& origin) {
  const bool ratios = table.choice("spacing", {"linear", "log"}, "linear") == "log";
  const double from = table.number("from", ratios ? positive : any);
  const double to = table.number("to", {.low = from, .above = true});
  const auto count = table.integer("count", 2, 1'000'000);
  std::vector<std::vector<TomlValue>> values;
  for (std::int64_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    const double x = ratios ? from * std::pow(to / from, share) : std::lerp(from, to, share);
    values.push_back({{.data = i + 1 == count ? to : x, .origin = origin}});
  }
  return values;
}

/// values = [..], one for all keys, or rows = [[..], ..], one for each.
ChoiceLaw read_values(TomlTable& table, const TomlValue& value, const Variable& variable,
                      bool steps) {
  ChoiceLaw law;
  law.by_row = table.has("rows");
  const std::string key = law.by_row ? "rows" : "values";
  if (law.by_row && table.has("values")) throw table.fault("values", "no \"values\" beside rows");
  if (steps && !law.by_row && !table.has("values")) {
    law.values = read_steps(table, variable.origin);
  } else {
    const TomlValue* given = table.has(key) ? value.find(key) : nullptr;
    const auto* items = given == nullptr ? nullptr : std::get_if<TomlValue::Array>(&given->data);
    if (items == nullptr || items->empty())
      throw table.fault(key,
                        steps ? "an array of values, or from, to and count" : "an array of values");
    for (std::size_t i = 0; i < items->size(); ++i) {
      const auto* row = std::get_if<TomlValue::Array>(&(*items)[i].data);
      if (law.by_row && (row == nullptr || row->size() != variable.keys.size()))
        throw table.fault("rows[" + std::to_string(i) + "]",
                          "an array of a value for each of the " +
                              std::to_string(variable.keys.size()) + " keys");
      law.values.push_back(law.by_row ? *row : TomlValue::Array{(*items)[i]});
    }
  }
  return law;
}

/// Names of what is no number: as given, or the text itself, or counted from 1.
void read_labels(TomlTable& table, const TomlValue& value, ChoiceLaw& law) {
  std::vector<std::string> given;
  if (table.has("labels")) {
    const auto* items = std::get_if<TomlValue::Array>(&value.find("labels")->data);
    for (std::size_t i = 0; items != nullptr && i < items->size(); ++i)
      if (const auto* label = std::get_if<std::string>(&(*items)[i].data)) given.push_back(*label);
    if (given.size() != law.values.size())
      throw table.fault(
          "labels", "a string for each of the " + std::to_string(law.values.size()) + " values");
  }
  for (std::size_t k = 0; k < law.values.front().size(); ++k) {
    std::vector<std::string> names;
    const bool numbers =
        given.empty() && std::all_of(law.values.begin(), law.values.end(), [&](const auto& row) {
          return number_of(row[k]).has_value();
        });
    for (std::size_t i = 0; !numbers && i < law.values.size(); ++i) {
      const auto* text = std::get_if<std::string>(&law.values[i][k].data);
      names.push_back(!given.empty() ? given[i] : text != nullptr ? *text : std::to_string(i + 1));
    }
    law.labels.push_back(std::move(names));
  }
}

ChoiceLaw read_choice(const std::string& name, TomlTable& table, const TomlValue& value,
                      const Variable& variable, Design design) {
  ChoiceLaw law = read_values(table, value, variable, name == "grid");
  // Of Sobol' points, one half of the cube has the even indices: so would a list's values be.
  if (name == "list" && design == Design::sobol && law.values.size() % 2 == 0)
    throw table.fault("law",
                      "\"categorical\" or \"grid\" for an even number of values in a Sobol' "
                      "design, whose points go to and fro with the index as a list does");
  if (name == "list" && design == Design::saltelli)
    throw table.fault("law",
                      "\"categorical\" or \"grid\" in Saltelli's design, whose values are "
                      "all drawn");
  if (name == "list") law.kind = ChoiceLaw::Kind::in_turn;
  if (name == "categorical")
    law.cumulative = read_weights(table, law.values.size());
  else
    for (std::size_t i = 1; i <= law.values.size(); ++i)
      law.cumulative.push_back(static_cast<double>(i) / static_cast<double>(law.values.size()));
  read_labels(table, value, law);
  return law;
}

/// A number, or two of them.
Span read_span(TomlTable& table, const std::string& key, const Quantity& quantity, Span fallback) {
  if (!table.has(key)) return fallback;
  if (!table.is_array(key)) {
    const double x = table.number(key, quantity);
    return {x, x};
  }
  const std::vector<double> ends = table.numbers(key, quantity);
  if (ends.size() != 2 || !(ends[0] <= ends[1]))
    throw table.fault(key, "a number, or [least, greatest]");
  return {ends[0], ends[1]};
}

TrackLaw read_track(TomlTable& table, const Variable& variable, const Study& study) {
  TrackLaw law;
  const Scenario scenario = scenario_of(study.scenario, study.scenario_path);
  law.centre = scenario.platforms[0].track.at(0.0).position.head<2>();
  if (table.has("centre")) {
    const std::vector<double> centre = table.numbers("centre", quantity::coordinate);
    if (centre.size() != 2) throw table.fault("centre", "[east, north] in m");
    law.centre = {centre[0], centre[1]};
  }
  const Quantity length{.noun = "range", .unit = "m", .low = 0.0, .high = 1e7};
  require_one(table, "range", "radius");
  law.even_in_area = table.has("radius");
  law.range = law.even_in_area ? Span{0.0, table.number("radius", length)}
                               : read_span(table, "range", length, {});
  const Quantity turn{.noun = "bearing", .unit = "degrees", .low = -360.0, .high = 720.0};
  const Span bearing = read_span(table, "bearing_deg", turn, {0.0, 360.0});
  law.bearing = {radians(bearing.low), radians(bearing.high)};
  std::optional<Span> start;  // as deep as the scenario has it
  for (std::size_t t = 0; t < scenario.targets.size(); ++t) {
    const double z = scenario.targets[t].track.at(0.0).position.z();
    if (variable.keys.front() == "target." + std::to_string(t)) start = Span{z, z};
  }
  if (!start && !table.has("depth")) throw table.fault("depth", quantity::depth.expected());
  law.depth = read_span(table, "depth", quantity::depth, start.value_or(Span{}));
  if (table.has("speed"))
    law.speed =
        read_span(table, "speed", {.noun = "speed", .unit = "m/s", .low = 0.0, .high = 100.0}, {});
  const Span course = read_span(table, "course_deg", turn, {0.0, 360.0});
  law.course = {radians(course.low), radians(course.high)};
  return law;
}

/// A law with values where the input's own has them.
LawInstead read_law_instead(TomlTable& entry, TomlTable table, const CutLaw& own) {
  const std::string name =
      table.choice("law", {"uniform", "normal", "log_normal", "triangular", "rayleigh", "weibull"});
  const CutLaw asked = read_number_law(name, table).law;
  table.finish();
  const Span ends = own.ends();
  const CutLaw cut(asked.law(), std::max(asked.low(), ends.low), std::min(asked.high(), ends.high));
  // Beyond, the probability that is left has no digits.
  constexpr double rest = 1e-15;
  const double middle = cut.share() > 0.0 ? own.distribution(cut.quantile(0.5)) : 0.0;
  if (!(middle > rest && middle < 1.0 - rest))
    throw entry.fault("proposal",
                      "a law whose middle lies where the input itself has values, from " +
                          to_text(own.quantile(rest)) + " to " + to_text(own.quantile(1.0 - rest)));
  return {.law = own, .instead = cut};
}

/// { weights = [..] } of the same choices.
WeightsInstead read_weights_instead(TomlTable table, const ChoiceLaw& own) {
  if (!table.has("weights"))
    throw table.fault("weights",
                      "weights of the input's " + std::to_string(own.values.size()) + " values");
  WeightsInstead made{.cumulative = own.cumulative,
                      .instead = read_weights(table, own.values.size())};
  const auto weight = [](const std::vector<double>& cumulative, std::size_t i) {
    return cumulative[i] - (i > 0 ? cumulative[i - 1] : 0.0);
  };
  for (std::size_t i = 0; i < own.values.size(); ++i)
    if (weight(made.instead, i) > 0.0 && !(weight(made.cumulative, i) > 0.0))
      throw table.fault("weights[" + std::to_string(i) + "]",
                        "0, as the input itself never takes this value");
  table.finish();
  return made;
}

}  // namespace

CoordinateDraw read_proposal(TomlTable& table, const AnyLaw& law) {
  if (const auto* number = std::get_if<NumberLaw>(&law))
    return read_law_instead(table, table.table("proposal"), number->law);
  const auto* choice = std::get_if<ChoiceLaw>(&law);
  if (choice != nullptr && choice->kind == ChoiceLaw::Kind::weighted)
    return read_weights_instead(table.table("proposal"), *choice);
  throw table.fault("proposal",
                    "none: a continuous law may have one, and a choice by weights; all others are "
                    "drawn by [[rare.component]]");
}

AnyLaw read_law(TomlTable& table, const TomlValue& value, Variable& variable, const Study& study,
                const Others& others, bool in_branch) {
  if (table.has("given")) return read_conditional(table, value, variable, study, others);
  const std::string name =
      table.choice("law", {"uniform", "normal", "log_normal", "triangular", "rayleigh", "weibull",
                           "categorical", "list", "grid", "track", "profile_eof", "profile_casts",
                           "table", "time_series", "climatology", "expression"});
  if (variable.keys.empty() &&
      (name == "track" || name == "profile_eof" || name == "profile_casts" ||
       name == "climatology" || table.has("rows")))
    throw table.fault("keys", "a key to write: this law draws no single number");
  if (in_branch && name == "list")
    throw table.fault("law",
                      "\"categorical\" or \"grid\": a list goes by the number of the realisation, "
                      "whichever of the laws it takes");
  if (name == "categorical" || name == "list" || name == "grid")
    return read_choice(name, table, value, variable, study.design);
  if (name == "profile_eof") return read_modes(table, study);
  if (name == "profile_casts") {
    ChoiceLaw casts = read_casts(table, value, variable, study);
    casts.cumulative = read_weights(table, casts.values.size());
    return casts;
  }
  if (name == "climatology") {
    ChoiceLaw months = read_climatology(table, value, variable, study);
    months.cumulative = read_weights(table, months.values.size());
    return months;
  }
  if (name == "track") return read_track(table, variable, study);
  if (name == "table") return read_table_law(table, value, variable, study, in_branch);
  if (name == "time_series") return read_time_series(table, value, variable, study);
  if (name == "expression") return read_expression(table, variable, others);
  const std::vector<std::string>& parameters = parameter_keys();
  if (std::any_of(parameters.begin(), parameters.end(), [&](const std::string& key) {
        return table.has_quietly(key) && table.is_text(key);
      }))
    return read_parametric(name, table, variable, others);
  return read_number_law(name, table);
}

}  // namespace asdic::detail::study
