#include "study/summary/summary.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "study/summary/intervals.h"
#include "study/summary/own_columns.h"
#include "study/summary/summary_parts.h"
#include "study/summary/weighted_mean.h"

namespace asdic::detail::study {
namespace {

/// Rows that fall into bins, or few enough of them to be taken value by value: both ways of naming
/// columns are seen.
Table made_up(const std::vector<Column>& columns, std::size_t rows) {
  Table table{.columns = columns};
  table.values.resize(columns.size());
  for (std::size_t row = 0; row < rows; ++row) {
    table.index.push_back(row);
    table.valid.push_back(1);
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const std::size_t labels = columns[c].labels.size();
      const bool proportion = is_proportion(columns[c]);
      table.values[c].push_back(static_cast<double>(labels > 0   ? row % labels
                                                    : proportion ? row % 2
                                                                 : row));
    }
  }
  return table;
}

/// The first name that stands there twice, "" if none does.
std::string twice(const std::vector<Column>& columns) {
  for (std::size_t i = 0; i < columns.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (columns[i].name == columns[j].name) return columns[i].name;
  return "";
}

/// Where an entry of `by` stands: "study.toml:12: summary.by[1]".
std::string place_of(const Study& study, std::size_t entry) {
  const TomlValue* summary = study.document.find("summary");
  const TomlValue* by = summary == nullptr ? nullptr : summary->find("by");
  const auto* items = by == nullptr ? nullptr : std::get_if<TomlValue::Array>(&by->data);
  if (items == nullptr || entry >= items->size())
    return study.path.string() + ": summary.by (every input by itself)";
  return (*items)[entry].origin + ": summary.by[" + std::to_string(entry) + "]";
}

}  // namespace

void check_summary_names(const Study& study) {
  const std::vector<Column> all = answer_columns(study);
  if (const std::string name = twice(all); !name.empty())
    throw InputError({.where = study.path.string() + ": [vary] and [measure]",
                      .got = "two columns \"" + name + "\"",
                      .expected = "names that differ (name = \"...\" of a variable or a target)"});
  std::map<std::string, std::size_t> made_by;  // table: entry of `by`
  for (std::size_t entry = 0; entry < study.summary.by.size(); ++entry) {
    std::vector<std::string> names;  // of this entry's tables
    for (const std::size_t rows : {std::size_t{2}, std::size_t{300}})
      for (const SummaryTable& table :
           tables_by(study, study.summary.by[entry], made_up(all, rows))) {
        if (const std::string name = twice(table.columns); !name.empty())
          throw InputError(
              {.where = place_of(study, entry),
               .got = "an axis that gives " + table.name + " two columns \"" + name + "\"",
               .expected = "axes that differ from one another and from the measures "
                           "along them"});
        if (std::find(names.begin(), names.end(), table.name) == names.end())
          names.push_back(table.name);
      }
    for (const std::string& name : names)
      if (const auto [at, is_new] = made_by.emplace(name, entry); !is_new)
        throw InputError(
            {.where = place_of(study, entry),
             .got = "a second table \"" + name + "\", as of by[" + std::to_string(at->second) + "]",
             .expected = "every axis, or pair of axes, once"});
  }
}

bool is_proportion(const Column& column) noexcept {
  if (!column.formula.empty()) return column.event;
  const auto is = [&](std::string_view name) {
    return column.name == name || column.name.starts_with(std::string(name) + '_');
  };
  return column.role == Column::Role::measure &&
         (is("detected") || is("false_alarm") || is("initiated") || is("tracked") ||
          column.name == rare_event_column);
}

std::string proportion_name(const Column& column) {
  if (!column.formula.empty()) return "p_" + column.name;
  if (column.name == rare_event_column) return rare_event_probability;
  struct Word {
    std::string_view of_column, of_tables;
  };
  for (const Word& word : {Word{"detected", "pd"}, Word{"false_alarm", "pfa"},
                           Word{"initiated", "ptrack"}, Word{"tracked", "ptracked"}})
    if (column.name.starts_with(word.of_column))
      return std::string(word.of_tables) + column.name.substr(word.of_column.size());
  return column.name;
}

std::optional<std::size_t> first_question(std::span<const Column> columns) noexcept {
  std::optional<std::size_t> first;
  for (std::size_t c = 0; c < columns.size(); ++c)
    if (columns[c].name == rare_event_column) return c;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (is_proportion(columns[c])) return c;
    if (columns[c].role == Column::Role::measure && !first) first = c;
  }
  return first;
}

std::string quantile_name(double probability) {
  std::array<char, 400> fixed{};
  const auto end = std::to_chars(fixed.data(), fixed.data() + fixed.size(), probability,
                                 std::chars_format::fixed)
                       .ptr;
  std::string digits(fixed.data(), end);
  std::erase(digits, '.');
  return "q" + digits + std::string(4 - std::min<std::size_t>(4, digits.size()), '0');
}

bool counts(const Table& table, std::size_t row, std::size_t column) noexcept {
  return table.valid[row] != 0 && std::isfinite(table.values[column][row]);
}

bool is_weighted(const Table& table) noexcept {
  return std::any_of(table.columns.begin(), table.columns.end(),
                     [](const Column& column) { return column.role == Column::Role::weight; });
}

std::vector<double> weights_of(const Table& table) {
  std::vector<double> weights;
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (table.columns[c].name == log_weight_column)
      for (const double log_weight : table.values[c]) weights.push_back(std::exp(log_weight));
  return weights;
}

SummaryTable statistics_table(const Study& study, const Table& table) {
  const SummaryPlan& plan = study.summary;
  const Clusters clusters = clusters_of(study);
  const bool by_filter =
      study.measure.detection && study.measure.detection->by == DetectionPlan::By::matched_filter;
  // Of false alarms: what was found, once more by its name, beside what is set.
  const bool set = by_filter && std::isfinite(study.measure.false_alarm_probability());
  SummaryTable made{.name = "statistics",
                    .title = "Every column over all valid realisations, in its own unit",
                    .axes = {"quantity"}};
  const auto column = [&](const std::string& name, const std::string& unit,
                          const std::string& meaning) {
    made.columns.push_back({.name = name, .unit = unit, .meaning = meaning});
    made.values.emplace_back();
  };
  const std::string of;  // as many units as rows: none
  column("quantity", "1", "column of the rows");
  column("count", "1", "finite values");
  column("mean", of, "mean");
  column("deviation", of, "standard deviation");
  column("mean_low", of, "confidence interval of the mean");
  column("mean_high", of, "confidence interval of the mean");
  column("least", of, "least value");
  column("greatest", of, "greatest value");
  for (const double p : plan.quantiles) {
    column(quantile_name(p), of, "quantile at " + to_text(p));
  }
  if (set) {
    column("pfa", "1", "of false alarms: the rate that was found");
    column("pfa_low", "1", "confidence interval (Clopper & Pearson)");
    column("pfa_high", "1", "confidence interval (Clopper & Pearson)");
    column("pfa_set", "1", "false-alarm probability that is set");
  }
  const std::vector<double> weights = weights_of(table);
  const bool weighted = !weights.empty();
  if (weighted) {
    column("effective", "1", "(sum of weights)^2 over sum of their squares");
    column("effective_of_event", "1", "the same of the rows in which the rarer outcome happened");
    column("largest_share", "1", "of the rarer outcome's probability that one row alone has");
  }
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (table.columns[c].role == Column::Role::weight) continue;
    const bool proportion = is_proportion(table.columns[c]);
    RowMean moments(clusters, weighted, WeightedMean::Of::all_rows);
    std::vector<double> sorted;
    std::vector<std::pair<double, double>> with_weights;
    sorted.reserve(table.index.size());
    for (std::size_t row = 0; row < table.index.size(); ++row) {
      const double weight = weighted ? weights[row] : 1.0;
      if (!counts(table, row, c)) {
        moments.leave_out(table.index[row], weight);
        continue;
      }
      moments.add(table.index[row], table.values[c][row], weight);
      sorted.push_back(table.values[c][row]);
      if (weighted) with_weights.emplace_back(table.values[c][row], weight);
    }
    table.values[c].rest();
    std::sort(sorted.begin(), sorted.end());
    std::sort(with_weights.begin(), with_weights.end());
    const double none = std::nan("");
    const Interval interval = moments.interval(proportion, plan.interval, plan.confidence);
    made.columns[0].labels.push_back(table.columns[c].name);
    std::vector<double> row{static_cast<double>(made.columns[0].labels.size() - 1),
                            moments.count(),
                            moments.value(proportion),
                            moments.deviation(),
                            interval.low,
                            interval.high,
                            sorted.empty() ? none : sorted.front(),
                            sorted.empty() ? none : sorted.back()};
    for (const double p : plan.quantiles)
      row.push_back(sorted.empty() ? none
                    : weighted     ? weighted_quantile(with_weights, p)
                                   : sample_quantile(sorted, p));
    if (set) {
      const bool alarms = proportion && table.columns[c].name.starts_with("false_alarm");
      const double n = moments.count();
      const Interval found =
          weighted ? interval
                   : clopper_pearson(n > 0.0 ? std::round(moments.value(proportion) * n) : 0.0, n,
                                     plan.confidence);
      if (alarms)
        row.insert(row.end(), {moments.value(proportion), found.low, found.high,
                               study.measure.false_alarm_probability()});
      else
        row.insert(row.end(), 4, none);
    }
    if (weighted) {
      const WeightedMean& weighed = moments.weighted();
      row.insert(row.end(), {weighed.effective(), proportion ? weighed.effective_of_event() : none,
                             proportion ? weighed.largest_share() : none});
    }
    for (std::size_t i = 0; i < row.size(); ++i) made.values[i].push_back(row[i]);
  }
  return made;
}

std::vector<SummaryTable> summarise(const Study& study, const Table& table) {
  return summary_of(study, table).tables;
}

namespace {

std::string_view name_of(ProportionInterval interval) {
  return interval == ProportionInterval::wilson ? "Wilson" : "Clopper and Pearson";
}

/// How intervals of means and proportions are had: of `what`, in words.
std::string method_of(const Study& study) {
  const Clusters clusters = clusters_of(study);
  if (is_weighted(study))
    return "of weighted rows: proportions by Fay and Feuer's gamma interval, means by the normal "
           "distribution and linearisation, Student's t, " +
           (clusters.kind == Clusters::Kind::replicates
                ? "from the scatter between " + std::to_string(clusters.size) +
                      " independent scrambles"
            : study.design == Design::random ? std::string("of independent rows")
                                             : std::string("of rows taken for independent (rather "
                                                           "too wide)"));
  const std::string proportions(name_of(study.summary.interval));
  if (clusters.kind == Clusters::Kind::rows)
    return "proportions by " + proportions + ", means by the normal distribution, of " +
           (study.design == Design::random ? "independent rows"
                                           : "rows taken for independent (rather too wide)");
  const std::string size = std::to_string(clusters.size);
  return (clusters.kind == Clusters::Kind::replicates
              ? "from the scatter between " + size + " independent scrambles"
              : "from the scatter between independent blocks of " + size + " rows") +
         ", Student's t; proportions by " + proportions +
         " of as many independent rows as scatter alike";
}

/// What first-order indices leave out, where it is much: of the measure that the study is about.
std::string unexplained_note(const Study& study, const Table& table,
                             const std::vector<SummaryTable>& sensitivity) {
  constexpr double much = 0.3;  // of the variance
  const std::optional<std::size_t> question = first_question(table.columns);
  if (study.design == Design::saltelli || sensitivity.empty() || !question) return "";
  const SummaryTable& made = sensitivity.front();
  const auto column = [&](const std::string& name) -> const std::vector<double>& {
    for (std::size_t c = 0; c < made.columns.size(); ++c)
      if (made.columns[c].name == name) return made.values[c];
    return made.values.front();
  };
  const std::string& name = table.columns[*question].name;
  for (std::size_t row = 0; row < made.values[0].size(); ++row) {
    if (made.columns[0].labels[static_cast<std::size_t>(made.values[0][row])] != name) continue;
    const double left = column("unexplained")[row];
    if (column("count")[row] < 100.0 || !(left > much)) return "";
    return std::to_string(static_cast<int>(std::lround(100.0 * std::min(1.0, left)))) +
           " % of the variance of " + name +
           " is of no input by itself: it is interaction of inputs, or chance; design = "
           "\"saltelli\" tells which";
  }
  return "";
}

/// Tables that know no weights, and so are not made; "": none is missing.
std::string left_out_of(const Study& study, const Table& table) {
  const bool roc = study.summary.roc &&
                   std::any_of(table.columns.begin(), table.columns.end(),
                               [](const Column& c) { return c.name.starts_with("snr_absent_db"); });
  if (!roc && !study.summary.sensitivity) return "";
  const std::string tables = !roc                        ? "sensitivity is"
                             : study.summary.sensitivity ? "roc, roc_area and sensitivity are"
                                                         : "roc and roc_area are";
  return tables + " left out: rows are drawn from a proposal, and such tables know no weights";
}

}  // namespace

namespace {

/// \param table  with its own columns
Summary summary_of_answers(const Study& study, const Table& table) {
  const SummaryPlan& plan = study.summary;
  std::string intervals = "as of independent draws";
  const bool weighted = is_weighted(study);
  if (clusters_of(study).kind != Clusters::Kind::rows || weighted)
    intervals = method_of(study);
  else if (study.design != Design::random)
    intervals += ": of this design, " + std::string(name(study.design)) +
                 ", rather too wide than too narrow (docs/theory/studies.md)";
  Summary made{.confidence = plan.confidence,
               .proportion_interval =
                   plan.interval == ProportionInterval::wilson ? "wilson" : "clopper_pearson",
               .intervals = std::move(intervals)};
  const auto add = [&](std::vector<SummaryTable> more, const std::string& method) {
    for (SummaryTable& one : more) {
      if (one.intervals.empty()) one.intervals = method;
      made.tables.push_back(std::move(one));
    }
  };
  const std::string method = method_of(study);
  add({statistics_table(study, table)}, method);
  for (const std::vector<SummaryAxis>& axes : plan.by) add(tables_by(study, axes, table), method);
  const bool blocks = study.design == Design::saltelli;
  if (plan.roc && !weighted)
    add(roc_tables(plan, blocks ? independent_rows(study, table) : table),
        "proportions by " + std::string(name_of(plan.interval)) +
            ", areas by Hanley and McNeil, of " +
            (blocks                           ? "the rows A and B of every block alone"
             : study.design == Design::random ? "independent rows"
                                              : "rows taken for independent (rather too wide)"));
  add(map_tables(study, table), method);
  if (study.measure.run) add(ping_tables(study, table), method);
  add(cell_tables(study, table), "docs/theory/studies.md, false-alarm rates");
  if (plan.convergence) add(convergence_table(study, table), method);
  made.laws = law_tables(study);
  made.densities = row_densities(study, table);
  made.warnings = rate_warnings(study, made.tables);
  for (std::string& one : alarm_warnings(study, table)) made.warnings.push_back(std::move(one));
  if (study.measure.wants("localisation_ellipse") && is_weighted(table))
    made.warnings.emplace_back(
        "localisation_ellipse: no ellipses of errors of place: they are of rows that count alike, "
        "and these have weights");
  if (weighted) {
    add(drawn_from_table(study, table), "none");
    for (std::string& one : weight_warnings(study, table)) made.warnings.push_back(std::move(one));
    made.left_out = left_out_of(study, table);
    if (!made.left_out.empty()) made.notes.push_back(made.left_out);
    return made;
  }
  if (!plan.sensitivity) return made;
  std::vector<SummaryTable> sensitivity =
      blocks ? saltelli_tables(study, table) : sensitivity_table(study, table);
  if (std::string note = unexplained_note(study, table, sensitivity); !note.empty())
    made.notes.push_back(std::move(note));
  add(std::move(sensitivity), method);
  return made;
}

}  // namespace

Summary summary_of(const Study& study, const Table& rows) {
  if (study.summary.own.empty()) return summary_of_answers(study, rows);
  const Table table = with_own(study, rows);
  Summary made = summary_of_answers(study, table);
  const auto first = static_cast<std::ptrdiff_t>(table.columns.size() - study.summary.own.size());
  made.own.columns.assign(table.columns.begin() + first, table.columns.end());
  made.own.values.assign(table.values.begin() + first, table.values.end());
  return made;
}

RunningEstimate::RunningEstimate(const Study& study)
    : level_(study.summary.confidence),
      mean_(clusters_of(study), is_weighted(study), WeightedMean::Of::all_rows),
      own_(study) {
  const std::vector<Column> all = answer_columns(study);
  const std::optional<std::size_t> question = first_question(all);
  column_ = question.value_or(all.size());
  weight_ = all.size();
  for (std::size_t c = 0; c < all.size(); ++c)
    if (all[c].name == log_weight_column) weight_ = c;
  interval_ = study.summary.interval;
  if (!question) return;
  proportion_ = is_proportion(all[column_]);
  name_ = proportion_ ? proportion_name(all[column_]) : all[column_].name;
  unit_ = all[column_].unit;
}

void RunningEstimate::add(const Row& row) {
  if (own_.empty()) return take(row, row.values);
  std::vector<double> values = row.values;
  own_.append(values, row.valid);
  take(row, values);
}

void RunningEstimate::take(const Row& row, const std::vector<double>& values) {
  if (column_ >= values.size()) return;
  const double weight = weight_ < values.size() ? std::exp(values[weight_]) : 1.0;
  if (!row.valid || !std::isfinite(values[column_])) {
    if (row.valid) ++left_out_;
    if (row.valid && unknown_.empty()) unknown_ = row.unknown;
    mean_.leave_out(row.index, weight);
    return;
  }
  mean_.add(row.index, values[column_], weight);
}

std::optional<Estimate> RunningEstimate::estimate() const {
  if (mean_.count() < 2.0) return std::nullopt;
  const Interval interval = mean_.interval(proportion_, interval_, level_);
  return Estimate{.name = name_,
                  .unit = unit_,
                  .value = mean_.value(proportion_),
                  .low = interval.low,
                  .high = interval.high,
                  .level = level_,
                  .count = static_cast<std::uint64_t>(mean_.count())};
}

}  // namespace asdic::detail::study
