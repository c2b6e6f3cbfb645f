#include "study/measures/sampler.h"

#include <algorithm>

#include "core/error.h"
#include "core/text.h"
#include "io/scenario/scenario_reader.h"

namespace asdic::detail::study {
namespace {

std::size_t dimensions_of(const Study& study) {
  std::size_t sum = 0;
  for (const Variable& variable : study.variables)
    sum += dimensions_of(variable, study.design == Design::grid);
  return sum + study.proposal.dimensions();
}

std::vector<std::string> names_of(const Proposal& proposal) {
  std::vector<std::string> names;
  for (const ProposalPart& part : proposal.parts()) names.push_back(part.name);
  return names;
}

/// [dimensions] to which group of Saltelli's design each coordinate belongs.
std::vector<std::size_t> groups_of(const Study& study) {
  std::vector<std::size_t> of_variable(study.variables.size(), 0);
  const std::vector<SaltelliGroup> all = saltelli_groups(study);
  for (std::size_t g = 0; g < all.size(); ++g)
    for (const std::size_t v : all[g].variables) of_variable[v] = g;
  std::vector<std::size_t> groups;
  for (std::size_t v = 0; v < study.variables.size(); ++v)
    groups.resize(groups.size() + dimensions_of(study.variables[v], false), of_variable[v]);
  return groups;
}

}  // namespace

std::uint64_t grid_points(const std::vector<Variable>& variables) {
  std::uint64_t product = 1;
  for (const Variable& variable : variables)
    product *= std::max<std::uint64_t>(1, choices_of(variable));
  return product;
}

Sampler::Sampler(const Study& study)
    : on_grid_(study.design == Design::grid),
      variables_(study.variables),
      correlation_(study.correlation),
      proposal_(study.proposal),
      design_(study.design, study.seed, study.realisations, dimensions_of(study),
              study.design_options,
              study.design == Design::saltelli ? groups_of(study) : std::vector<std::size_t>()) {
  for (const Variable& variable : variables_) {
    first_column_.push_back(columns_.size());
    for (InputColumn& column : input_columns(variable))
      columns_.push_back({.name = std::move(column.name),
                          .unit = std::move(column.unit),
                          .meaning = std::move(column.meaning),
                          .role = Column::Role::input,
                          .labels = std::move(column.labels)});
  }
  first_column_.push_back(columns_.size());
  std::size_t dimension = 0;
  for (const Variable& variable : variables_) {
    first_dimension_.push_back(dimension);
    dimension += study::dimensions_of(variable, on_grid_);
    given_.emplace_back();
    for (const std::string& name : variable.given)
      given_.back().push_back(static_cast<std::size_t>(
          std::find_if(columns_.begin(), columns_.end(),
                       [&](const Column& column) { return column.name == name; }) -
          columns_.begin()));
  }
  order_ = drawing_order(variables_);
  if (!proposal_.empty())
    columns_.push_back({.name = log_weight_column,
                        .unit = "1",
                        .meaning = "ln of the row's weight: density of the inputs' laws over that "
                                   "from which they were drawn",
                        .role = Column::Role::weight});
  if (!proposal_.empty())
    columns_.push_back({.name = drawn_from_column,
                        .unit = "1",
                        .meaning = "part of the proposal that the row was drawn from",
                        .role = Column::Role::weight,
                        .labels = names_of(proposal_)});
}

Proposal::Drawn Sampler::point(std::uint64_t index, std::span<double> u) const {
  std::vector<double> all(design_.dimensions());
  design_.point(index, all);
  std::copy_n(all.begin(), u.size(), u.begin());
  return proposal_.empty() ? Proposal::Drawn{} : proposal_.draw(all.back(), u);
}

Sampler::Drawn Sampler::draw(std::uint64_t index) const {
  std::vector<double> u(dimensions());
  const Proposal::Drawn from = point(index, u);
  return draw(index, u, from);
}

Sampler::Drawn Sampler::draw(std::uint64_t index, std::span<const double> u,
                             const Proposal::Drawn& from) const {
  std::vector<double> own;  // with the correlation
  if (!correlation_.inputs.empty()) {
    own.assign(u.begin(), u.end());
    std::vector<double> together;
    for (const std::size_t v : correlation_.inputs) together.push_back(own[first_dimension_[v]]);
    correlation_.copula.apply(together);
    for (std::size_t i = 0; i < together.size(); ++i)
      own[first_dimension_[correlation_.inputs[i]]] = together[i];
    u = own;
  }
  Drawn drawn;
  drawn.values.assign(columns_.size(), 0.0);
  drawn.choices.assign(variables_.size(), 0);
  // Of the grid the last variable changes fastest: a number of mixed radix.
  std::uint64_t rest = index;
  for (std::size_t v = variables_.size(); on_grid_ && v-- > 0;)
    if (const std::uint64_t n = choices_of(variables_[v]); n > 0) {
      drawn.choices[v] = rest % n;
      rest /= n;
    }
  std::vector<double> given, values;
  for (const std::size_t v : order_) {
    const Variable& variable = variables_[v];
    const auto mine = u.subspan(first_dimension_[v], study::dimensions_of(variable, on_grid_));
    given.clear();
    for (const std::size_t column : given_[v]) given.push_back(drawn.values[column]);
    const auto* choice = std::get_if<ChoiceLaw>(&variable.law);
    if (choice != nullptr && choice->kind == ChoiceLaw::Kind::in_turn && !on_grid_)
      drawn.choices[v] = design_.turn_of(index) % choice->values.size();
    else if (choice == nullptr || !on_grid_)
      drawn.choices[v] = chosen(variable, mine, given);
    values.clear();
    append_values(variable, mine, given, drawn.choices[v], values);
    std::copy(values.begin(), values.end(),
              drawn.values.begin() + static_cast<std::ptrdiff_t>(first_column_[v]));
  }
  if (!proposal_.empty()) {
    drawn.values[columns_.size() - 2] = from.log_weight;
    drawn.values.back() = static_cast<double>(from.part);
  }
  return drawn;
}

void Sampler::apply(const Drawn& drawn, TomlValue& scenario) const {
  for (std::size_t v = 0; v < variables_.size(); ++v)
    study::apply(
        variables_[v],
        std::span(drawn.values).subspan(first_column_[v], first_column_[v + 1] - first_column_[v]),
        drawn.choices[v], scenario);
}

std::string Sampler::describe(const Drawn& drawn) const {
  std::string text;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (columns_[i].role != Column::Role::input) continue;
    const double x = drawn.values[i];
    text +=
        (i == 0 ? "" : ", ") + columns_[i].name + " = " +
        (columns_[i].labels.empty() ? to_text(x) : columns_[i].labels[static_cast<std::size_t>(x)]);
  }
  return text;
}

InputError told(const InputError& error, const std::filesystem::path& file, std::uint64_t index,
                const std::string& drawn) {
  InputFault fault = error.fault();
  // Faults of a simulator (a rate too slow for a drawn frequency) name no file.
  if (fault.where.find(':') == std::string::npos && !fault.where.starts_with("--set"))
    fault.where = file.string() + ": " + fault.where;
  fault.got += " (realisation " + std::to_string(index) + (drawn.empty() ? "" : ": ") + drawn + ")";
  return InputError(fault);
}

Scenario example_of(const Study& study) {
  const Sampler sampler(study);
  const std::uint64_t tries =
      study.on_error == OnError::stop ? 1 : std::min<std::uint64_t>(100, study.realisations);
  std::optional<InputError> first;
  for (std::uint64_t index = 0; index < tries; ++index) {
    const Sampler::Drawn drawn = sampler.draw(index);
    try {
      TomlValue tree = study.scenario;
      sampler.apply(drawn, tree);
      return scenario_of(tree, study.scenario_path);
    } catch (const InputError& error) {
      if (!first) first = told(error, study.scenario_path, index, sampler.describe(drawn));
    }
  }
  throw InputError(*first);
}

}  // namespace asdic::detail::study
