#include "study/summary/law_tables.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "study/measures/sampler.h"

namespace asdic::detail::study {
namespace {

constexpr std::size_t most_values = 200;  // of a column that is taken value by value
constexpr int bins = 100;
constexpr std::uint64_t draws = 50'000;  // of laws without a closed form
constexpr int times = 100'000;           // of a series

LawTable head(const InputColumn& column, const Variable& variable) {
  return {.column = column.name,
          .unit = column.unit,
          .meaning = column.meaning,
          .labels = column.labels,
          .law = variable.text,
          .how = "closed form"};
}

/// Values evenly apart, and others of even probability between them: neither a long tail nor a
/// steep side is left without.
void fill(const CutLaw& law, LawTable& table) {
  constexpr double rest = 1e-5;  // beyond the table, where a law has no end
  constexpr int pieces = 100;
  auto [low, high] = law.ends();
  if (!std::isfinite(low) || !std::isfinite(law.density(low))) low = law.quantile(rest);
  if (!std::isfinite(high)) high = law.quantile(1.0 - rest);
  for (int i = 0; i <= pieces; ++i) {
    table.value.push_back(std::lerp(low, high, static_cast<double>(i) / pieces));
    if (i > 0 && i < pieces) table.value.push_back(law.quantile(static_cast<double>(i) / pieces));
  }
  std::sort(table.value.begin(), table.value.end());
  table.value.erase(std::unique(table.value.begin(), table.value.end()), table.value.end());
  for (const double x : table.value) {
    table.share.push_back(law.density(x));
    table.cumulative.push_back(law.distribution(x));
  }
}

void fill(const Span& span, LawTable& table) {
  if (!span.single()) return fill(CutLaw(Uniform{span.low, span.high}), table);
  table.discrete = true;
  table.value = {span.low};
  table.share = table.cumulative = {1.0};
}

/// Of a sample: value by value where they are few, else in bins. \param weight  [values]
void fill(const std::vector<double>& values, const std::vector<double>& weight, LawTable& table) {
  std::map<double, double> shares;
  double sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    const double w = weight.empty() ? 1.0 : weight[i];
    shares[values[i]] += w;
    sum += w;
  }
  if (shares.empty()) return;
  double before = 0.0;
  table.discrete = shares.size() <= most_values || !table.labels.empty();
  if (table.discrete) {
    for (const auto& [x, share] : shares) {
      before += share / sum;
      table.value.push_back(x);
      table.share.push_back(share / sum);
      table.cumulative.push_back(std::min(before, 1.0));
    }
    return;
  }
  const double low = shares.begin()->first, width = (shares.rbegin()->first - low) / bins;
  std::vector<double> counts(bins);
  for (const auto& [x, share] : shares)
    counts[static_cast<std::size_t>(
        std::clamp(static_cast<int>((x - low) / width), 0, bins - 1))] += share / sum;
  for (int i = 0; i < bins; ++i) {
    const double share = counts[static_cast<std::size_t>(i)];
    table.value.push_back(low + (i + 0.5) * width);  // the middle of the bin
    table.share.push_back(share / width);
    table.cumulative.push_back(std::min(before + 0.5 * share, 1.0));
    before += share;
  }
}

/// Closed forms, or what the data say; nothing of laws that look at others.
struct Tables {
  const Variable& variable;
  const std::vector<InputColumn> columns;
  bool on_grid;

  std::vector<LawTable> of(const NumberLaw& law) const {
    std::vector<LawTable> all{head(columns[0], variable)};
    fill(law.law, all[0]);
    return all;
  }
  std::vector<LawTable> of(const ChoiceLaw& law) const {
    std::vector<LawTable> all;
    std::vector<double> weight(law.values.size(), 1.0);
    if (law.kind == ChoiceLaw::Kind::weighted && !on_grid)
      for (std::size_t i = 0; i < weight.size(); ++i)
        weight[i] = law.cumulative[i] - (i > 0 ? law.cumulative[i - 1] : 0.0);
    for (std::size_t c = 0; c < columns.size(); ++c) {
      std::vector<double> values;
      for (std::size_t i = 0; i < law.values.size(); ++i)
        values.push_back(law.labels[c].empty() ? number_of(law.values[i][c]).value_or(0.0)
                                               : static_cast<double>(i));
      all.push_back(head(columns[c], variable));
      fill(values, weight, all.back());
    }
    return all;
  }
  std::vector<LawTable> of(const TrackLaw& law) const {
    std::vector<LawTable> all;
    for (const InputColumn& column : columns) {
      all.push_back(head(column, variable));
      fill(column.ends, all.back());
    }
    if (!law.even_in_area || law.range.single()) return all;
    const double low = law.range.low, high = law.range.high, area = high * high - low * low;
    for (std::size_t i = 0; i < all[0].value.size(); ++i) {
      const double r = all[0].value[i];
      all[0].share[i] = 2.0 * r / area;
      all[0].cumulative[i] = (r * r - low * low) / area;
    }
    return all;
  }
  std::vector<LawTable> of(const ModesLaw& law) const {
    std::vector<LawTable> all;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      all.push_back(head(columns[k], variable));
      fill(law.amplitudes[k], all.back());
    }
    return all;
  }
  std::vector<LawTable> of(const TableLaw& law) const {
    std::vector<LawTable> all;
    std::vector<double> weight;
    for (std::size_t i = 0; i < law.cumulative.size(); ++i)
      weight.push_back(law.cumulative[i] - (i > 0 ? law.cumulative[i - 1] : 0.0));
    for (std::size_t c = 0; c < columns.size(); ++c) {
      all.push_back(head(columns[c], variable));
      all.back().how = "the rows of the file";
      fill(law.data->columns[c], weight, all.back());
    }
    return all;
  }
  std::vector<LawTable> of(const TimeSeriesLaw&) const {
    std::vector<std::vector<double>> values(columns.size());
    std::vector<double> row;
    for (int i = 0; i < times; ++i) {
      const double u = (i + 0.5) / times;
      row.clear();
      append_values(variable, std::span(&u, 1), {}, 0, row);
      for (std::size_t c = 0; c < columns.size(); ++c) values[c].push_back(row[c]);
    }
    std::vector<LawTable> all;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      all.push_back(head(columns[c], variable));
      if (c == 0) {
        fill(columns[0].ends, all.back());
      } else {
        all.back().how = std::to_string(times) + " times, evenly apart";
        fill(values[c], {}, all.back());
      }
    }
    return all;
  }
  std::vector<LawTable> of(const ExpressionLaw&) const { return {}; }
  std::vector<LawTable> of(const ParametricLaw&) const { return {}; }
  std::vector<LawTable> of(const ConditionalLaw&) const { return {}; }
};

std::vector<LawTable> closed_tables(const Variable& variable, bool on_grid) {
  const Tables tables{variable, input_columns(variable), on_grid};
  return std::visit([&](const auto& law) { return tables.of(law); }, variable.law);
}

/// Those of the branches, as far as they look at nobody. \param before  "season: winter, "
void add_cases(const Variable& variable, const ConditionalLaw& law, const std::string& before,
               std::vector<LawTable>& all) {
  for (const Branch& branch : law.branches) {
    const std::string given = before + variable.given[law.given] + ": " + branch.name;
    if (const auto* inner = std::get_if<ConditionalLaw>(&branch.law)) {
      add_cases(variable, *inner, given + ", ", all);
      continue;
    }
    Variable alone = variable;
    alone.law = branch.law;
    for (LawTable& table : closed_tables(alone, false)) {
      table.given = given;
      all.push_back(std::move(table));
    }
  }
}

}  // namespace

std::vector<LawTable> law_tables(const Study& study) {
  const bool on_grid = study.design == Design::grid;
  std::vector<LawTable> all;
  std::vector<std::vector<double>> drawn;  // [columns], where there is a law without a closed form
  std::size_t column = 0;
  for (const Variable& variable : study.variables) {
    const std::vector<InputColumn> columns = input_columns(variable);
    std::vector<LawTable> own = closed_tables(variable, on_grid);
    if (own.empty()) {
      if (drawn.empty()) {
        Study other = study;  // the same laws, other draws
        if (!on_grid) other.design = Design::random;
        other.seed = ~study.seed;
        other.proposal = {};  // the laws, whatever rows are drawn from
        const Sampler sampler(other);
        drawn.resize(sampler.columns().size());
        for (std::uint64_t i = 0; i < draws; ++i) {
          const Sampler::Drawn row = sampler.draw(i);
          for (std::size_t c = 0; c < drawn.size(); ++c) drawn[c].push_back(row.values[c]);
        }
      }
      for (std::size_t c = 0; c < columns.size(); ++c) {
        own.push_back(head(columns[c], variable));
        own.back().how = std::to_string(draws) + " draws of another seed";
        fill(drawn[column + c], {}, own.back());
      }
      if (const auto* conditional = std::get_if<ConditionalLaw>(&variable.law))
        add_cases(variable, *conditional, "", own);
    }
    for (LawTable& table : own) all.push_back(std::move(table));
    column += columns.size();
  }
  return all;
}

std::vector<RowDensity> row_densities(const Study& study, const Table& table) {
  std::vector<RowDensity> all;
  const auto place = [&](const std::string& name) {
    return static_cast<std::size_t>(
        std::find_if(table.columns.begin(), table.columns.end(),
                     [&](const Column& column) { return column.name == name; }) -
        table.columns.begin());
  };
  for (const Variable& variable : study.variables) {
    if (!has_formulae(variable.law)) continue;
    const InputColumn column = input_columns(variable).front();
    std::vector<std::size_t> given;
    for (const std::string& name : variable.given) given.push_back(place(name));
    const std::size_t own = place(column.name);
    RowDensity made{.column = column.name, .unit = column.unit, .density = {}};
    std::vector<double> drawn(given.size());
    for (std::size_t row = 0; row < table.index.size(); ++row) {
      for (std::size_t g = 0; g < given.size(); ++g) drawn[g] = table.values[given[g]][row];
      made.density.push_back(density_given(variable, drawn, table.values[own][row]));
    }
    all.push_back(std::move(made));
  }
  return all;
}

}  // namespace asdic::detail::study
