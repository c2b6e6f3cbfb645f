#include "study/reader/correlation_reader.h"

#include <algorithm>
#include <cmath>

#include "core/text.h"
#include "study/expression/names.h"
#include "study/reader/vary_laws.h"

namespace asdic::detail::study {
namespace {

std::string entry(std::size_t i, std::size_t j) {
  return "matrix[" + std::to_string(i) + "][" + std::to_string(j) + "]";
}

/// A few digits: it is to be compared, not to be copied.
std::string rounded(double x) { return to_text(std::round(x * 1e4) / 1e4); }

std::vector<std::size_t> read_inputs(TomlTable& table, const TomlValue& value,
                                     const std::vector<Variable>& variables) {
  std::vector<std::string> fit;
  for (const Variable& variable : variables)
    if (is_continuous(variable.law)) fit.push_back(variable.name);
  const std::string expected =
      fit.size() < 2 ? "at least two inputs of continuous laws (uniform, normal, weibull, …); of "
                       "these the study has " +
                           std::to_string(fit.size())
                     : "at least two inputs of continuous laws, of " + list_of(fit);
  const TomlValue* given = table.has("inputs") ? value.find("inputs") : nullptr;
  const auto* items = given == nullptr ? nullptr : std::get_if<TomlValue::Array>(&given->data);
  if (items == nullptr || items->size() < 2) throw table.fault("inputs", expected);
  std::vector<std::size_t> inputs;
  for (std::size_t i = 0; i < items->size(); ++i) {
    const std::string key = "inputs[" + std::to_string(i) + "]";
    const auto* name = std::get_if<std::string>(&(*items)[i].data);
    if (name == nullptr || std::find(fit.begin(), fit.end(), *name) == fit.end()) {
      const std::string nearest = name == nullptr ? "" : nearest_name(*name, fit);
      throw table.fault(
          key, expected + (nearest.empty() ? "" : " (did you mean " + in_quotes(nearest) + "?)"));
    }
    const auto at = static_cast<std::size_t>(
        std::find_if(variables.begin(), variables.end(),
                     [&](const Variable& variable) { return variable.name == *name; }) -
        variables.begin());
    if (std::find(inputs.begin(), inputs.end(), at) != inputs.end())
      throw table.fault(key, "each input once");
    inputs.push_back(at);
  }
  return inputs;
}

}  // namespace

Correlation read_correlation(TomlTable table, const TomlValue& value,
                             const std::vector<Variable>& variables) {
  Correlation made{.inputs = read_inputs(table, value, variables)};
  const std::size_t n = made.inputs.size();
  const auto named = [&](std::size_t i) { return in_quotes(variables[made.inputs[i]].name); };
  std::vector<std::vector<double>> matrix =
      table.rows("matrix", {.noun = "correlation", .low = -1.0, .high = 1.0});
  if (matrix.size() != n || matrix[0].size() != n)
    throw table.fault("matrix",
                      "a row and a column for each of the " + std::to_string(n) + " inputs",
                      std::to_string(matrix.size()) + " × " + std::to_string(matrix[0].size()));
  for (std::size_t i = 0; i < n; ++i) {
    if (matrix[i][i] != 1.0)
      throw table.fault(entry(i, i), "1, the correlation of " + named(i) + " with itself",
                        to_text(matrix[i][i]));
    for (std::size_t j = 0; j < i; ++j)
      if (matrix[i][j] != matrix[j][i])
        throw table.fault(entry(i, j),
                          to_text(matrix[j][i]) + " as in " + entry(j, i) +
                              ": the correlation of " + named(i) + " and " + named(j),
                          to_text(matrix[i][j]));
  }
  made.of_ranks = table.choice("of", {"normal_scores", "ranks"}, "normal_scores") == "ranks";
  if (made.of_ranks)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        if (i != j) matrix[i][j] = scores_of_ranks(matrix[i][j]);
  made.copula = Copula(matrix);
  if (const auto& fault = made.copula.fault()) {
    const double of_entry = matrix[fault->row][fault->column];
    // Spearman's ρ = 6/π asin(r/2).
    const auto told = [&](double r) {
      return rounded(made.of_ranks ? 6.0 / pi * std::asin(std::clamp(r, -1.0, 1.0) / 2.0) : r);
    };
    throw table.fault(entry(fault->row, fault->column),
                      "a correlation of " + named(fault->row) + " and " + named(fault->column) +
                          " between " + told(fault->low) + " and " + told(fault->high) +
                          ", or others before it: the matrix is to be positive definite",
                      told(of_entry));
  }
  table.finish();
  return made;
}

}  // namespace asdic::detail::study
