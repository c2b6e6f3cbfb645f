#include "study/reader/rare_reader.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/text.h"

namespace asdic::detail::study {
namespace {

constexpr Quantity above_zero_weight{.low = 0.0, .above = true};
constexpr double farthest_score = 8.0;  // a score beyond which 1 − u has no digits left

/// First coordinates of the variables. \return [variables + 1]
std::vector<std::size_t> coordinates(const Study& study) {
  std::vector<std::size_t> first{0};
  for (const Variable& variable : study.variables)
    first.push_back(first.back() + dimensions_of(variable, false));
  return first;
}

/// centre or deviation: { wind_speed = 3.1, track = [0.0, 1.2, 0.3] }, the others as they are.
std::vector<double> read_scores(TomlTable& component, const std::string& key,
                                const Quantity& quantity, double usual, const Study& study) {
  const std::vector<std::size_t> first = coordinates(study);
  std::vector<double> all(first.back(), usual);
  if (!component.has(key)) return all;
  TomlTable table = component.table(key);
  for (std::size_t v = 0; v < study.variables.size(); ++v) {
    const std::string& name = study.variables[v].name;
    const std::size_t count = first[v + 1] - first[v];
    if (count == 0 || !table.has(name)) continue;
    std::vector<double> values;
    if (table.is_array(name))
      values = table.numbers(name, quantity);
    else
      values.push_back(table.number(name, quantity));
    if (values.size() != count)
      throw table.fault(name, count == 1 ? "one number: this input takes one coordinate"
                                         : "an array of " + std::to_string(count) +
                                               " numbers: so many coordinates this input takes");
    std::copy(values.begin(), values.end(), all.begin() + static_cast<std::ptrdiff_t>(first[v]));
  }
  table.finish();
  return all;
}

/// Of [[rare.component]] one.
ProposalPart read_component(TomlTable& table, const Study& study) {
  ProposalPart part{.share = table.number("weight", above_zero_weight, 1.0)};
  const std::vector<double> centre = read_scores(
      table, "centre", {.noun = "normal score", .low = -farthest_score, .high = farthest_score},
      0.0, study);
  const std::vector<double> deviation =
      read_scores(table, "deviation", {.noun = "deviation", .low = 0.1, .high = 10.0}, 1.0, study);
  for (std::size_t i = 0; i < centre.size(); ++i) {
    CoordinateDraw draw;
    if (centre[i] != 0.0 || deviation[i] != 1.0) draw = ScoreLaw{centre[i], deviation[i]};
    part.draws.push_back(std::move(draw));
  }
  table.finish();
  return part;
}

/// What entries of [vary] say of themselves, as one component; none: nothing.
std::optional<ProposalPart> proposed_by_inputs(const Study& study) {
  ProposalPart part{.name = "proposal"};
  bool any = false;
  for (std::size_t v = 0; v < study.variables.size(); ++v) {
    const Variable& variable = study.variables[v];
    const bool proposed = !std::holds_alternative<std::monostate>(variable.proposal);
    if (proposed && std::find(study.correlation.inputs.begin(), study.correlation.inputs.end(),
                              v) != study.correlation.inputs.end())
      throw InputError({.where = variable.origin + ": vary." + variable.name + ".proposal",
                        .got = "a proposal of an input that stands in [correlation]",
                        .expected = "an input by itself; those that depend on one another are "
                                    "drawn by [[rare.component]]"});
    any = any || proposed;
    for (std::size_t i = dimensions_of(variable, false); i-- > 0;)
      part.draws.push_back(proposed ? variable.proposal : CoordinateDraw());
  }
  return any ? std::optional(std::move(part)) : std::nullopt;
}

/// The mixture of what is proposed, the laws themselves and a wide part of what is proposed.
Proposal mixture(std::vector<ProposalPart> proposed, const RarePlan& plan) {
  std::vector<ProposalPart> parts{{.name = "laws", .share = plan.share, .guards = true}};
  if (plan.wide > 0.0) {
    ProposalPart wide{.name = "wide", .share = plan.wide, .guards = true};
    wide.draws.resize(proposed.front().draws.size());
    for (const ProposalPart& part : proposed)
      for (std::size_t i = 0; i < part.draws.size(); ++i)
        if (!std::holds_alternative<std::monostate>(part.draws[i]) &&
            !std::holds_alternative<WeightsInstead>(part.draws[i]))
          wide.draws[i] = ScoreLaw{0.0, plan.spread};
    parts.push_back(std::move(wide));
  }
  double sum = 0.0;
  for (const ProposalPart& part : proposed) sum += part.share;
  for (ProposalPart& part : proposed) {
    part.share *= (1.0 - plan.share - plan.wide) / sum;
    parts.push_back(std::move(part));
  }
  return Proposal(std::move(parts));
}

/// A comparison at the top of a formula.
struct Comparison {
  std::string left, sign, right;
};
std::optional<Comparison> comparison_in(const std::string& text) {
  std::optional<Comparison> found;
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '(') ++depth;
    if (c == ')') --depth;
    if (depth != 0) continue;
    if (c == '&' || c == '|' || c == '?' || c == '=' || c == '!') return std::nullopt;
    if (c != '<' && c != '>') continue;
    if (found) return std::nullopt;
    const bool or_equal = i + 1 < text.size() && text[i + 1] == '=';
    found = Comparison{.left = text.substr(0, i), .sign = std::string(1, c), .right = ""};
    if (or_equal) found->sign += '=';
    i += or_equal ? 1 : 0;
    found->right = text.substr(i + 1);
  }
  const auto blank = [](const std::string& part) {
    return part.find_first_not_of(' ') == std::string::npos;
  };
  if (!found || blank(found->left) || blank(found->right)) return std::nullopt;
  return found;
}

}  // namespace

void read_proposals(TomlTable& head, TomlTable& table, Study& study) {
  RarePlan& plan = study.rare;
  plan.share = table.number("share", {.noun = "share", .low = 0.001, .high = 0.999}, plan.share);
  plan.wide = table.number("wide", {.noun = "share", .low = 0.0, .high = 0.9}, plan.wide);
  plan.spread = table.number("spread", {.noun = "factor", .low = 1.1, .high = 5.0}, plan.spread);
  if (!(plan.share + plan.wide < 1.0))
    throw table.fault("wide", "less than " + to_text(std::round(1e6 * (1.0 - plan.share)) / 1e6) +
                                  ": share and wide leave something to what is proposed");
  plan.levels = static_cast<int>(table.integer("levels", 1, 100, plan.levels));
  plan.rows_per_level =
      static_cast<int>(table.integer("rows_per_level", 50, 1'000'000, plan.rows_per_level));
  std::vector<ProposalPart> proposed;
  std::vector<TomlTable> components = table.tables("component");
  for (TomlTable& component : components) {
    proposed.push_back(read_component(component, study));
    proposed.back().name = "component " + std::to_string(proposed.size());
  }
  plan.has_components = !components.empty();
  if (std::optional<ProposalPart> part = proposed_by_inputs(study))
    proposed.push_back(std::move(*part));
  if (proposed.empty()) return;
  if (study.design == Design::grid || study.design == Design::saltelli)
    throw head.fault("design",
                     "\"random\", \"latin_hypercube\" or \"sobol\" of inputs that are drawn from a "
                     "proposal: points of the others have no weights");
  study.proposal = mixture(std::move(proposed), plan);
  if (!(plan.wide > 0.0))
    study.warnings.push_back(table.where("wide") +
                             ": 0: where the event has a part that the proposal does not reach, "
                             "nothing will tell");
}

void read_event(TomlTable& table, const std::vector<Column>& columns, Study& study) {
  if (study.measure.cells && is_weighted(study))
    throw InputError({.where = study.path.string() + ": measure.cells",
                      .got = "cells that are counted in rows that are drawn from a proposal",
                      .expected = "one of both: the counts of cells have no weights"});
  if (!table.has("event")) return;
  const std::string text = table.text("event");
  const std::optional<Comparison> found = comparison_in(text);
  if (!found)
    throw table.fault("event",
                      "one comparison by <, <=, > or >= of columns, \"echo_to_background_db > "
                      "12\"; of two conditions min(a, b) > 0 is both, max(a, b) > 0 either");
  std::vector<std::string> names;
  for (const Column& column : columns)
    if (column.labels.empty() && column.role != Column::Role::weight) names.push_back(column.name);
  const bool above = found->sign[0] == '>';
  const std::string excess = "(" + (above ? found->left : found->right) + ") - (" +
                             (above ? found->right : found->left) + ")";
  RareEvent event{.text = text,
                  .excess = Expression(excess, names, table.where("event")),
                  .at_zero = found->sign.size() > 1};
  for (const std::string& name : event.excess.names())
    event.columns.push_back(static_cast<std::size_t>(
        std::find_if(columns.begin(), columns.end(),
                     [&](const Column& column) { return column.name == name; }) -
        columns.begin()));
  study.rare.event = std::move(event);
}

}  // namespace asdic::detail::study
