#include "study/comparison/comparison.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "study/comparison/paired.h"
#include "study/plan/no_value.h"
#include "study/summary/axis.h"
#include "study/summary/summary_parts.h"

namespace asdic::detail::study {
namespace {

const Column* find_column(const Table& table, const std::string& name) {
  const std::size_t at = column_of(table, name);
  return at < table.columns.size() ? &table.columns[at] : nullptr;
}

/// The rows that every table has, in order.
std::vector<std::uint64_t> common_rows(const std::vector<Compared>& studies) {
  std::vector<std::uint64_t> common = studies.front().table.index;
  for (const Compared& other : studies) {
    std::vector<std::uint64_t> both;
    std::set_intersection(common.begin(), common.end(), other.table.index.begin(),
                          other.table.index.end(), std::back_inserter(both));
    common = std::move(both);
  }
  return common;
}

/// A table's rows of these indices alone.
Table only_rows(const Table& table, const std::vector<std::uint64_t>& index) {
  Table kept{.columns = table.columns, .index = index, .valid = {}, .values = {}};
  kept.values.resize(table.values.size());
  std::size_t row = 0;
  for (const std::uint64_t wanted : index) {
    while (table.index[row] != wanted) ++row;
    kept.valid.push_back(table.valid[row]);
    for (std::size_t c = 0; c < table.values.size(); ++c)
      kept.values[c].push_back(table.values[c][row]);
  }
  return kept;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  });
}

/// Studies whose rows lie beside one another.
class Pairing {
 public:
  Pairing(const std::vector<Compared>& studies, const std::vector<std::uint64_t>& index) {
    for (const Compared& one : studies) {
      names_.push_back(one.name);
      tables_.push_back(only_rows(with_own(*one.study, one.table), index));
    }
    for (const Column& column : tables_.front().columns) {
      const auto has = [&](const Table& table) {
        const Column* found = find_column(table, column.name);
        return found != nullptr && found->role == column.role && found->unit == column.unit &&
               found->labels == column.labels && found->event == column.event;
      };
      if (!std::all_of(tables_.begin(), tables_.end(), has)) continue;
      if (column.role == Column::Role::measure) measures.push_back(column.name);
      if (column.role != Column::Role::input) continue;
      const auto alike = [&](const Table& table) {
        return same_bits(values(tables_.front(), column.name), values(table, column.name));
      };
      (std::all_of(tables_.begin(), tables_.end(), alike) ? inputs : unlike).push_back(column.name);
    }
  }

  /// Answers of one measure. \return [studies][rows]
  [[nodiscard]] std::vector<const std::vector<double>*> answers(const std::string& measure) const {
    std::vector<const std::vector<double>*> all;
    all.reserve(tables_.size());
    for (const Table& table : tables_) all.push_back(&values(table, measure));
    return all;
  }
  /// Whether a row has an answer in every study.
  [[nodiscard]] bool counts(std::size_t row, const std::string& measure) const {
    return std::all_of(tables_.begin(), tables_.end(), [&](const Table& table) {
      return study::counts(table, row, column_of(table, measure));
    });
  }
  [[nodiscard]] const Table& first() const { return tables_.front(); }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

  std::vector<std::string> inputs, unlike, measures;

 private:
  static const std::vector<double>& values(const Table& table, const std::string& column) {
    return table.values[column_of(table, column)];
  }

  std::vector<std::string> names_;
  std::vector<Table> tables_;
};

/// The columns of one measure's answers and of what they differ by, and their values of some rows.
class Differences {
 public:
  Differences(const SummaryPlan& plan, const Pairing& pairing) : plan_(plan), pairing_(pairing) {}

  /// \param word  what the answers are called, "pd" \param like  whose unit they have
  void add_columns(SummaryTable& to, const std::string& word, const Column& like) const {
    const auto& names = pairing_.names();
    const auto with_interval = [&](const std::string& name, const std::string& meaning) {
      add_column(to, like, name, meaning);
      add_column(to, like, name + "_low", "confidence interval");
      add_column(to, like, name + "_high", "confidence interval");
    };
    for (const std::string& name : names)
      with_interval(word + '_' + name, "of " + name + ", over the rows that all have");
    const Column number{.unit = "1"};
    for (std::size_t a = 0; a < names.size(); ++a)
      for (std::size_t b = a + 1; b < names.size(); ++b) {
        const std::string pair = names[a] + "_to_" + names[b];
        with_interval(pair, names[b] + " less " + names[a]);
        add_column(to, number, pair + "_p", "p-value of no difference");
      }
    add_column(to, number, "best",
               "the study whose difference from each other is beyond its interval: of errors and "
               "false alarms the least, else the greatest; NaN: none");
    to.columns.back().labels = names;
  }

  /// \param rows  in which all have an answer
  void add_values(SummaryTable& to, const std::string& measure, const Column& column,
                  const std::vector<std::size_t>& rows) const {
    const auto answers = pairing_.answers(measure);
    const bool proportion = is_proportion(column);
    for (const auto* of_study : answers) {
      Moments moments;
      for (const std::size_t row : rows) moments.add((*of_study)[row]);
      Interval interval = moments.mean_interval(plan_.confidence);
      if (proportion)
        interval = proportion_interval(plan_.interval, std::round(moments.mean() * moments.count()),
                                       moments.count(), plan_.confidence);
      put(to, {moments.mean(), interval.low, interval.high});
    }
    const double sign = better(column) == Better::least ? -1.0 : 1.0;
    std::vector<std::size_t> wins(answers.size(), 0);
    for (std::size_t a = 0; a < answers.size(); ++a)
      for (std::size_t b = a + 1; b < answers.size(); ++b) {
        const PairedDifference found = difference(proportion, *answers[a], *answers[b], rows);
        put(to, {found.value, found.interval.low, found.interval.high, found.p_value});
        if (sign * found.interval.low > 0.0 && sign * found.interval.high > 0.0) ++wins[b];
        if (sign * found.interval.low < 0.0 && sign * found.interval.high < 0.0) ++wins[a];
      }
    const auto best = std::find(wins.begin(), wins.end(), answers.size() - 1);
    put(to, {best == wins.end() ? no_value : static_cast<double>(best - wins.begin())});
  }

 private:
  [[nodiscard]] PairedDifference difference(bool proportion, const std::vector<double>& first,
                                            const std::vector<double>& second,
                                            const std::vector<std::size_t>& rows) const {
    if (!proportion) {
      Moments moments;
      for (const std::size_t row : rows) moments.add(second[row] - first[row]);
      return difference_of_means(moments, plan_.confidence);
    }
    PairedCounts pairs;
    for (const std::size_t row : rows) {
      pairs.all += 1.0;
      pairs.only_first += first[row] > second[row] ? 1.0 : 0.0;
      pairs.only_second += second[row] > first[row] ? 1.0 : 0.0;
    }
    return difference_of_proportions(pairs, plan_.confidence);
  }

  const SummaryPlan& plan_;
  const Pairing& pairing_;
};

std::string word_of(const Column& column) {
  return is_proportion(column) ? proportion_name(column) : column.name;
}

Column like_of(const Column& column) {
  Column like{.name = column.name, .unit = is_proportion(column) ? "1" : column.unit};
  return like;
}

/// All realisations, a row a measure: its columns have the unit of none.
SummaryTable differences_table(const Differences& differences, const Pairing& pairing) {
  SummaryTable made{.name = "differences",
                    .title = "What the studies differ by, over all realisations",
                    .axes = {"measure"}};
  add_column(made, {.unit = "1"}, "measure", "column");
  add_column(made, {.unit = "1"}, "count", "realisations in which all have an answer");
  differences.add_columns(made, "value", {.name = "value", .unit = "1"});
  for (const std::string& measure : pairing.measures) {
    const Column& column = *find_column(pairing.first(), measure);
    std::vector<std::size_t> rows;
    for (std::size_t row = 0; row < pairing.first().index.size(); ++row)
      if (pairing.counts(row, measure)) rows.push_back(row);
    made.columns[0].labels.push_back(column.name);
    put(made, {static_cast<double>(made.columns[0].labels.size()) - 1.0,
               static_cast<double>(rows.size())});
    differences.add_values(made, measure, column, rows);
  }
  return made;
}

/// One table a measure along these axes; none where an axis is not all studies'.
std::vector<SummaryTable> tables_along(const Study& study, const std::vector<SummaryAxis>& asked,
                                       const Differences& differences, const Pairing& pairing) {
  std::vector<AxisBins> axes;
  std::string suffix, along;
  for (const SummaryAxis& axis : asked) {
    if (std::find(pairing.inputs.begin(), pairing.inputs.end(), axis.column) ==
        pairing.inputs.end())
      return {};
    axes.push_back(make_axis(axis, pairing.first(), ends_of(study.variables, axis.column)));
    if (axes.back().edges.empty()) return {};  // no valid row
    suffix += (axes.size() > 1 ? "_and_" : "_by_") + axis.column;
    along += (axes.size() > 1 ? " and " : " against ") + axis.column;
  }
  const Cells cells(std::move(axes), pairing.first());
  std::vector<SummaryTable> all;
  for (const std::string& measure : pairing.measures) {
    const Column& column = *find_column(pairing.first(), measure);
    const std::string word = word_of(column);
    SummaryTable made = cells.table(word + suffix, column.meaning + along);
    differences.add_columns(made, word, like_of(column));
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      std::vector<std::size_t> rows;
      for (const std::size_t row : cells.rows(cell))
        if (pairing.counts(row, measure)) rows.push_back(row);
      cells.start_row(made, cell, static_cast<double>(rows.size()));
      differences.add_values(made, measure, column, rows);
    }
    all.push_back(std::move(made));
  }
  return all;
}

}  // namespace

Better better(const Column& measure) noexcept {
  const std::string& name = measure.name;
  if (measure.least_best) return *measure.least_best ? Better::least : Better::greatest;
  if (!measure.formula.empty()) return Better::neither;
  if (name.find("_error") != std::string::npos || name.starts_with("false_alarm"))
    return Better::least;
  for (const char* good : {"detected", "detection_", "snr_matched_db", "echo_level_db",
                           "echo_to_background_db", "signal_excess_db"})
    if (name.starts_with(good)) return Better::greatest;
  return Better::neither;
}

std::vector<std::uint64_t> rounds_of(const Study& study, std::uint64_t count) {
  const Clusters clusters = clusters_of(study);
  std::vector<std::uint64_t> rounds;
  if (clusters.kind == Clusters::Kind::replicates) {
    for (std::uint64_t two = 2; two <= count / clusters.size; two *= 2)
      for (const std::uint64_t each : {two, two / 2 * 3})
        if (each * clusters.size < count && is_look(each * clusters.size, clusters))
          rounds.push_back(each * clusters.size);
  } else {
    for (std::uint64_t ten = 100; ten < count; ten *= 10)
      for (const std::uint64_t digit : {1, 2, 5})
        if (digit * ten < count) rounds.push_back(digit * ten);
  }
  rounds.push_back(count);
  return rounds;
}

Known known_difference(const std::vector<Column>& every, const Comparison& comparison,
                       const std::vector<std::string>& names, const UntilTarget& target) {
  std::string column = target.column;
  if (column.empty())
    if (const std::optional<std::size_t> question = first_question(every))
      column = every[*question].name;
  const auto of_rows =
      std::find_if(every.begin(), every.end(), [&](const Column& c) { return c.name == column; });
  Known known{.name = target.name, .asked = target.half_width};
  if (of_rows != every.end() && known.name.empty()) known.name = word_of(*of_rows);
  if (target.rule) known.rule = target.rule->text();
  const std::string name = target.axes.empty() ? "differences" : target.name;
  const auto table =
      std::find_if(comparison.summary.tables.begin(), comparison.summary.tables.end(),
                   [&](const SummaryTable& one) { return one.name == name; });
  if (table == comparison.summary.tables.end()) return known;
  const auto values = [&](const std::string& of) -> const std::vector<double>& {
    for (std::size_t c = 0; c < table->columns.size(); ++c)
      if (table->columns[c].name == of) return table->values[c];
    return table->values.front();
  };
  const std::vector<double>& count = values("count");
  known.half_width = -1.0;
  known.holds = true;
  for (std::size_t row = 0; row < count.size(); ++row) {
    if (target.axes.empty() && table->columns[0].labels[row] != column) continue;
    for (std::size_t a = 0; a < names.size(); ++a)
      for (std::size_t b = a + 1; b < names.size(); ++b) {
        const std::string pair = names[a] + "_to_" + names[b];
        const RuleValues here{values(pair)[row], values(pair + "_low")[row],
                              values(pair + "_high")[row], count[row]};
        const double half = 0.5 * (here.high - here.low);
        const bool against = target.rule && known.holds && !holds(*target.rule, here);
        const bool widest = !target.rule && !(half <= known.half_width);
        if (against || widest || (target.rule && known.holds)) {
          known.values = here;
          known.where = names[b] + " less " + names[a];
          if (!target.axes.empty()) known.where += ", " + place_in(*table, row);
        }
        if (against) known.holds = false;
        if (widest) known.half_width = std::isfinite(half) ? half : infinity;
      }
  }
  if (known.half_width < 0.0) {
    known.half_width = infinity;
    known.holds = known.holds && target.rule && !known.where.empty();
  }
  if (target.rule && known.holds && !target.axes.empty()) {  // of no bin in particular
    known.values = {no_value, no_value, no_value, 0.0};
    known.where.clear();
  }
  return known;
}

std::vector<std::string> names_of(const std::vector<std::string>& paths) {
  std::vector<std::string> names;
  for (const std::string& path : paths) {
    std::string name;
    for (const char c : std::filesystem::path(path).stem().string()) {
      const auto u = static_cast<unsigned char>(c);
      name += std::isalnum(u) != 0 ? static_cast<char>(std::tolower(u)) : '_';
    }
    const auto taken = [&](const std::string& other) {
      return std::find(names.begin(), names.end(), other) != names.end();
    };
    std::string own = name;
    for (int n = 2; taken(own); ++n) own = name + '_' + std::to_string(n);
    names.push_back(std::move(own));
  }
  return names;
}

void check_comparable(const Study& study) {
  if (is_weighted(study))
    throw InputError({.where = study.path.string(),
                      .got = "inputs that are drawn from a proposal",
                      .expected = "those of the laws alone: pairs of rows have no common weight"});
}

Comparison compare(const std::vector<Compared>& studies) {
  const Study& first = *studies.front().study;
  if (first.design == Design::saltelli)
    throw InputError({.where = first.path.string() + ": study.design",
                      .got = in_quotes(name(first.design)),
                      .expected = "another design to compare by: pairs are taken for independent, "
                                  "and rows of a block are not"});
  for (const Compared& other : studies) check_comparable(*other.study);
  for (const Compared& other : studies)
    if (other.study->design_options.replicates != first.design_options.replicates)
      throw InputError({.where = other.study->path.string() + ": study.replicates",
                        .got = std::to_string(other.study->design_options.replicates),
                        .expected = "that of " + first.path.string() + ", " +
                                    std::to_string(first.design_options.replicates) +
                                    ": studies are compared realisation by realisation"});
  for (const Compared& other : studies)
    if (other.study->seed != first.seed || other.study->design != first.design)
      throw InputError({.where = other.study->path.string() + ": study",
                        .got = "seed " + std::to_string(other.study->seed) + " and design " +
                               in_quotes(name(other.study->design)),
                        .expected = "those of " + first.path.string() + ", " +
                                    std::to_string(first.seed) + " and " +
                                    in_quotes(name(first.design)) +
                                    ": studies are compared realisation by realisation"});
  const Pairing pairing(studies, common_rows(studies));
  Comparison made{.rows = pairing.first().index.size(),
                  .inputs = pairing.inputs,
                  .unlike_inputs = pairing.unlike,
                  .measures = pairing.measures,
                  .better = {},
                  .summary = {}};
  for (const std::string& measure : made.measures)
    made.better.push_back(better(*find_column(pairing.first(), measure)));
  if (made.measures.empty() || made.rows == 0)
    throw InputError({.where = studies.back().study->path.string(),
                      .got = made.rows == 0 ? "no realisation that all studies have"
                                            : "no measure that all studies have",
                      .expected = "the same measures of the same realisations"});
  const Differences differences(first.summary, pairing);
  made.summary = {.tables = {differences_table(differences, pairing)},
                  .confidence = first.summary.confidence,
                  .proportion_interval = first.summary.interval == ProportionInterval::wilson
                                             ? "wilson"
                                             : "clopper_pearson",
                  .intervals = "of differences: of pairs of rows of one index, each bin by itself"};
  std::vector<std::vector<SummaryAxis>> by = first.summary.by;
  if (by.empty())
    for (const std::string& input : pairing.inputs) by.push_back({{.column = input, .edges = {}}});
  for (const auto& axes : by)
    for (SummaryTable& table : tables_along(first, axes, differences, pairing))
      made.summary.tables.push_back(std::move(table));
  return made;
}

}  // namespace asdic::detail::study
