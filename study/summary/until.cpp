#include "study/summary/until.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "study/sampling/design.h"
#include "study/summary/summary_parts.h"

namespace asdic::detail::study {
namespace {

/// "pd_by_range", "pd_by_range_and_wind_speed".
std::string along(const std::string& measure, const std::vector<SummaryAxis>& axes) {
  std::string name = measure + "_by_" + axes.front().column;
  if (axes.size() > 1) name = measure + "_by_" + axes[0].column + "_and_" + axes[1].column;
  return name;
}

std::string shown_name(const Column& column) {
  return is_proportion(column) ? proportion_name(column) : column.name;
}

/// The columns that a map's cells are made of.
std::vector<std::string> columns_of(const SummaryMap& map) {
  std::vector<std::string> all;
  if (map.depth) all.push_back(map.depth->column);
  if (map.range.empty())
    all.insert(all.end(), {map.across.column, map.up.column});
  else
    all.insert(all.end(), {map.range, map.bearing});
  return all;
}

/// All that --until can name: measures, measures along the axes of [summary] or in the cells of its
/// map, indices.
std::vector<UntilTarget> possible(const Study& study) {
  std::vector<UntilTarget> all;
  const std::vector<Column> every = answer_columns(study);
  for (const Column& column : every)
    if (column.role == Column::Role::measure)
      all.push_back({.name = shown_name(column), .column = column.name});
  for (const std::vector<SummaryAxis>& axes : study.summary.by)
    for (const Column& column : every) {
      if (column.role != Column::Role::measure) continue;
      const bool along_itself = std::any_of(axes.begin(), axes.end(), [&](const SummaryAxis& axis) {
        return axis.column == column.name;
      });
      if (along_itself && !is_proportion(column)) continue;
      all.push_back({.name = along(shown_name(column), axes),
                     .column = column.name,
                     .axes = axes,
                     .shown = shown_name(column)});
    }
  if (study.summary.map) {
    const std::vector<std::string> places = columns_of(*study.summary.map);
    for (const Column& column : every)
      if (column.role == Column::Role::measure &&
          std::find(places.begin(), places.end(), column.name) == places.end())
        all.push_back({.name = "map_" + shown_name(column),
                       .column = column.name,
                       .over_map = true,
                       .shown = shown_name(column)});
  }
  const std::optional<std::size_t> question = first_question(every);
  if (study.design != Design::saltelli || !question) return all;
  for (const char* index : {"first_order", "total_order", "second_order"})
    if (std::string_view(index) != "second_order" || study.design_options.second_order)
      all.push_back(
          {.name = index, .column = every[*question].name, .index = index, .shown = index});
  return all;
}

UntilTarget target_of(const Study& study, const std::string& text, const std::string& where) {
  UntilTarget asked = parse_until(text, where);
  if (asked.name.empty() && !asked.rule) return asked;
  std::vector<std::string> names;
  std::string list;
  for (UntilTarget& one : possible(study)) {
    if (one.name == asked.name) {
      one.half_width = asked.half_width;
      one.rule = std::move(asked.rule);
      return std::move(one);
    }
    names.push_back(one.name);
    list += (list.empty() ? "" : ", ") + one.name;
  }
  if (asked.name.empty() && !names.empty()) {  // a rule of the first question
    const std::vector<Column> every = answer_columns(study);
    const std::string first = shown_name(every[*first_question(every)]);
    UntilTarget whole = target_of(study, first + "=1", where);
    whole.half_width = 0.0;
    whole.rule = std::move(asked.rule);
    return whole;
  }
  const std::string nearest = nearest_name(asked.name, names);
  throw InputError(
      {.where = where,
       .got = in_quotes(text),
       .expected = "a number, or with the name of what is to be known: " + list +
                   (nearest.empty() ? "" : " (did you mean " + in_quotes(nearest) + "?)")});
}

const std::vector<double>* values_of(const SummaryTable& table, const std::string& name) {
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (table.columns[c].name == name) return &table.values[c];
  return nullptr;
}

/// The rows of a table that tell of one target: an estimate each, with its interval.
class Answers {
 public:
  Answers(const SummaryTable& table, const UntilTarget& target, const std::string& column)
      : table_(table),
        target_(target),
        mean_(values_of(table, column)),
        low_(values_of(table, column + "_low")),
        high_(values_of(table, column + "_high")),
        count_(values_of(table, "count")) {
    if (const auto* own = values_of(table, column + "_count")) count_ = own;
  }

  [[nodiscard]] bool any() const { return mean_ && low_ && high_ && !low_->empty(); }
  [[nodiscard]] RuleValues at(std::size_t row) const {
    return {(*mean_)[row], (*low_)[row], (*high_)[row], count_ ? (*count_)[row] : no_value};
  }
  /// The widest interval.
  void find_widest(Known& known) const {
    std::optional<std::size_t> widest;
    double half = -1.0;
    for (std::size_t row = 0; row < low_->size(); ++row) {
      if (is_empty(row, known)) continue;
      const double width = 0.5 * ((*high_)[row] - (*low_)[row]);
      const double here = std::isfinite(width) ? width : infinity;
      if (here > half) widest = row;
      half = std::max(half, here);
    }
    if (!widest) return;
    known.half_width = half;
    tell_where(*widest, known);
  }
  /// Whether a rule holds in every row; else where it does not.
  void find_against(Known& known) const {
    std::optional<std::size_t> against;
    for (std::size_t row = 0; row < low_->size(); ++row) {
      if (is_empty(row, known) || against) continue;
      known.holds = true;
      if (!study::holds(*target_.rule, at(row))) against = row;
    }
    known.values = {no_value, no_value, no_value, 0.0};  // of no bin in particular
    if (!against) return;
    known.holds = false;
    known.values = at(*against);
    tell_where(*against, known);
  }

 private:
  /// Cells of a map that no row lies in do not count: a square round a disc has such corners.
  [[nodiscard]] bool is_empty(std::size_t row, Known& known) const {
    if (!target_.over_map) return false;
    ++known.cells;
    const bool empty = count_ == nullptr || !((*count_)[row] > 0.0);
    known.empty += empty ? 1 : 0;
    return empty;
  }
  void tell_where(std::size_t row, Known& known) const {
    known.where = place_in(table_, row);
    if (target_.index.empty() && count_ != nullptr) known.rows = (*count_)[row];
  }

  const SummaryTable& table_;
  const UntilTarget& target_;
  const std::vector<double>*mean_, *low_, *high_, *count_;
};

/// "pd: low > 0.9": the name before the colon; none of "a ? b : c".
std::string name_before_colon(const std::string& text) {
  const auto colon = text.find(':');
  if (colon == std::string::npos) return "";
  std::string name = text.substr(0, colon);
  while (!name.empty() && name.back() == ' ') name.pop_back();
  const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  });
  return plain ? name : "";
}

}  // namespace

std::string place_in(const SummaryTable& table, std::size_t row) {
  std::string text;
  for (const std::string& axis : table.axes)
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      if (table.columns[c].name != axis || axis == "measure") continue;
      const auto& labels = table.columns[c].labels;
      const double x = table.values[c][row];
      const bool named = !labels.empty() && x >= 0.0 && x < static_cast<double>(labels.size());
      text += (text.empty() ? "" : ", ") + axis + ' ' +
              (named ? labels[static_cast<std::size_t>(x)] : to_text(x));
    }
  return text;
}

UntilTarget parse_until(const std::string& text, const std::string& where) {
  UntilTarget target;
  if (const std::string name = name_before_colon(text);
      !name.empty() || text.find_first_of("<>&|!?") != std::string::npos ||
      text.find("==") != std::string::npos) {
    target.name = name;
    const std::string rule = name.empty() ? text : text.substr(text.find(':') + 1);
    target.rule.emplace(rule, names_of_rules(), where);
    return target;
  }
  const auto mark = text.rfind('=');
  const std::string number = text.substr(mark == std::string::npos ? 0 : mark + 1);
  const auto [end, error] =
      std::from_chars(number.data(), number.data() + number.size(), target.half_width);
  if (number.empty() || error != std::errc() || end != number.data() + number.size() ||
      !(target.half_width > 0.0) || !std::isfinite(target.half_width))
    throw InputError({.where = where,
                      .got = in_quotes(text),
                      .expected = "a number above 0, or NAME=NUMBER as in pd_by_range=0.05, or "
                                  "NAME: RULE as in pd: low > 0.9"});
  if (mark != std::string::npos) target.name = text.substr(0, mark);
  return target;
}

const std::vector<std::string>& names_of_rules() {
  static const std::vector<std::string> all{"half_width", "high", "low", "mean", "rows"};
  return all;
}

bool holds(const Expression& rule, const RuleValues& values) {
  std::vector<double> named;
  for (const std::string& name : rule.names()) {
    const double x = name == "mean"   ? values.mean
                     : name == "low"  ? values.low
                     : name == "high" ? values.high
                     : name == "rows" ? values.rows
                                      : 0.5 * (values.high - values.low);
    if (std::isnan(x)) return false;
    named.push_back(x);
  }
  const double value = rule.at(named);
  return value != 0.0 && !std::isnan(value);
}

std::uint64_t looks_until(std::uint64_t count, const Clusters& clusters) {
  std::set<std::uint64_t> looks{count};
  const auto add = [&](std::uint64_t each) {
    if (each <= count / clusters.size && is_look(each * clusters.size, clusters))
      looks.insert(each * clusters.size);
  };
  for (std::uint64_t ten = 1; ten <= count / clusters.size; ten *= 10) {
    for (std::uint64_t digit = 1; digit < 10; ++digit) add(digit * ten);
    if (ten > count / 10) break;
  }
  for (std::uint64_t two = 1; two <= count / clusters.size; two *= 2) {
    add(two);
    add(3 * two);
  }
  return looks.size();
}

double confidence_of_rules(const Study& study) {
  const auto looks = static_cast<double>(looks_until(study.realisations, clusters_of(study)));
  return 1.0 - (1.0 - study.summary.confidence) / looks;
}

bool is_look(std::uint64_t count, const Clusters& clusters) noexcept {
  if (clusters.kind != Clusters::Kind::rows) {
    if (count % clusters.size != 0) return false;
    const std::uint64_t each = count / clusters.size;
    if (clusters.kind == Clusters::Kind::blocks) return is_look(each);
    return count >= 100 && each >= 2 &&
           (std::has_single_bit(each) || (each % 3 == 0 && std::has_single_bit(each / 3)));
  }
  if (count < 100) return false;
  while (count % 10 == 0) count /= 10;
  return count < 10;
}

Until::Until(const Study& study, const std::vector<std::string>& texts, const std::string& where,
             EnoughRows own)
    : own_(std::move(own)) {
  for (const std::string& text : texts) {
    targets_.push_back(target_of(study, text, where));
    const UntilTarget& last = targets_.back();
    for (std::size_t i = 0; i + 1 < targets_.size(); ++i)
      if (targets_[i].name == last.name && targets_[i].rule.has_value() == last.rule.has_value())
        throw InputError({.where = where,
                          .got = in_quotes(text) + " beside " + in_quotes(texts[i]),
                          .expected = "each answer once"});
  }
  if (!has_value()) return;
  study_ = std::make_shared<const Study>(study);
  Study strict = study;
  strict.summary.confidence = confidence_of_rules(study);
  of_rules_ = std::make_shared<const Study>(std::move(strict));
}

std::string Until::text() const {
  std::string text;
  const auto add = [&](const std::string& word) {
    text += (text.empty() ? "--until " : " --until ") + word;
  };
  for (const UntilTarget& target : targets_)
    add(target.rule ? in_quotes(target.name + ":" + target.rule->text())
                    : (target.name.empty() ? "" : target.name + "=") + to_text(target.half_width));
  if (own_) add("(a function)");
  return text;
}

OrderedEstimate::OrderedEstimate(RunningEstimate estimate, std::uint64_t first, const Until& until)
    : estimate_(std::move(estimate)), first_(first), next_(first), until_(until) {
  if (until_.study() == nullptr) return;
  const Study& study = *until_.study();
  own_ = OwnValues(study);
  const std::vector<Column> every = answer_columns(study);
  const auto place = [&](const std::string& name) {
    return static_cast<std::size_t>(
        std::find_if(every.begin(), every.end(),
                     [&](const Column& column) { return column.name == name; }) -
        every.begin());
  };
  const auto takes = [&](const std::string& name) {
    const std::size_t at = place(name);
    if (std::find(taken_.begin(), taken_.end(), at) == taken_.end()) taken_.push_back(at);
  };
  for (const UntilTarget& target : until_.targets()) {
    const std::size_t at = place(target.column);
    means_.push_back(
        {.column = at,
         .proportion = at < every.size() && is_proportion(every[at]),
         .of = RowMean(clusters_of(study), is_weighted(study), WeightedMean::Of::all_rows)});
    if (!target.has_table()) continue;
    takes(target.column);
    for (const SummaryAxis& axis : target.axes) takes(axis.column);
    if (target.over_map)
      for (const std::string& column : columns_of(*study.summary.map)) takes(column);
    if (is_weighted(study)) takes(log_weight_column);
  }
  weight_ = place(log_weight_column);
  if (until_.own())
    for (std::size_t column = 0; column < every.size(); ++column)
      if (std::find(taken_.begin(), taken_.end(), column) == taken_.end()) taken_.push_back(column);
  if (until_.own()) std::sort(taken_.begin(), taken_.end());
  for (const std::size_t column : taken_) rows_.columns.push_back(every[column]);
  rows_.values.resize(taken_.size());
}

std::vector<SummaryTable> OrderedEstimate::tables_of(const Study& study,
                                                     const UntilTarget& target) const {
  if (!target.index.empty()) return saltelli_tables(study, rows_);
  if (target.over_map) return map_tables(study, rows_);
  if (!target.axes.empty()) return tables_by(study, target.axes, rows_);
  return {};
}

Known OrderedEstimate::known_rule(const UntilTarget& target, std::size_t mean) const {
  Known known{.name = target.name, .where = "", .rule = target.rule->text()};
  const Study& study = *until_.of_rules();
  if (target.has_table()) {
    for (const SummaryTable& table : tables_of(study, target))
      if (const Answers answers(table, target, target.shown); answers.any())
        answers.find_against(known);
  } else {
    const SummaryPlan& plan = study.summary;
    const RowMean& of = means_[mean].of;
    const bool proportion = means_[mean].proportion;
    const Interval interval = of.interval(proportion, plan.interval, plan.confidence);
    known.values = {of.value(proportion), interval.low, interval.high, of.count()};
    known.holds = of.count() > 1.0 && holds(*target.rule, known.values);
  }
  return known;
}

Known OrderedEstimate::known(const UntilTarget& target, std::size_t mean) const {
  if (target.rule) return known_rule(target, mean);
  Known known{.name = target.name, .asked = target.half_width, .where = ""};
  if (target.name.empty()) {
    known.name = estimate_.name();
    if (const std::optional<Estimate> now = estimate_.estimate())
      known.half_width = 0.5 * (now->high - now->low);
  } else if (target.has_table()) {
    for (const SummaryTable& table : tables_of(*until_.study(), target))
      if (const Answers answers(table, target, target.shown); answers.any())
        answers.find_widest(known);
  } else {
    const SummaryPlan& plan = until_.study()->summary;
    const RowMean& of = means_[mean].of;
    const Interval interval = of.interval(means_[mean].proportion, plan.interval, plan.confidence);
    if (of.count() > 1.0) known.half_width = 0.5 * (interval.high - interval.low);
  }
  if (!std::isfinite(known.half_width)) known.half_width = infinity;
  return known;
}

std::vector<Known> OrderedEstimate::known() const {
  std::vector<Known> all;
  for (std::size_t i = 0; i < until_.targets().size(); ++i)
    all.push_back(known(until_.targets()[i], i));
  return all;
}

bool OrderedEstimate::all_enough() const {
  for (std::size_t i = 0; i < until_.targets().size(); ++i)
    if (!known(until_.targets()[i], i).enough()) return false;
  return !until_.own() || until_.own()(rows_);
}

void OrderedEstimate::take(const Row& row) {
  if (enough_) return;
  std::vector<double> with_own;
  if (!own_.empty()) {
    with_own = row.values;
    own_.append(with_own, row.valid);
  }
  const std::vector<double>& values = own_.empty() ? row.values : with_own;
  if (own_.empty())
    estimate_.add(row);
  else
    estimate_.take(row, values);
  const double weight = weight_ < values.size() ? std::exp(values[weight_]) : 1.0;
  for (Mean& mean : means_)
    if (row.valid && mean.column < values.size() && std::isfinite(values[mean.column]))
      mean.of.add(row.index, values[mean.column], weight);
    else
      mean.of.leave_out(row.index, weight);
  if (!taken_.empty()) {
    rows_.index.push_back(row.index);
    rows_.valid.push_back(row.valid ? 1 : 0);
    for (std::size_t i = 0; i < taken_.size(); ++i) rows_.values[i].push_back(values.at(taken_[i]));
  }
  if (!row.valid) ++skipped_;
  ++next_;
  if (!until_ || !is_look(next_ - first_, estimate_.clusters())) return;
  if (all_enough()) enough_ = next_ - first_;
}

void OrderedEstimate::add(Row row) {
  if (row.index < next_ || enough_) return;
  if (row.index > next_) {
    row.pressure = {};
    row.cells = {};
    row.kept = {};
    waiting_.emplace(row.index, std::move(row));
    return;
  }
  take(row);
  while (!waiting_.empty() && waiting_.begin()->first == next_ && !enough_)
    take(waiting_.extract(waiting_.begin()).mapped());
  if (enough_) waiting_.clear();
}

void check_until(const Study& study, const std::string& where) {
  if (study.design != Design::latin_hypercube && study.design != Design::grid) return;
  throw InputError({.where = where,
                    .got = "design = \"" + std::string(name(study.design)) + "\"",
                    .expected =
                        "\"random\", \"sobol\" or \"saltelli\": the points of this one depend on "
                        "how many there are, so it cannot stop early"});
}

}  // namespace asdic::detail::study
