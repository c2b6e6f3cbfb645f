#include "study/summary/until.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

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

/// All that --until can name: measures, measures along the axes of [summary], indices.
std::vector<UntilTarget> possible(const Study& study) {
  std::vector<UntilTarget> all;
  const std::vector<Column> every = columns(study);
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
      all.push_back({.name = along(shown_name(column), axes), .column = column.name, .axes = axes});
    }
  const std::optional<std::size_t> question = first_question(every);
  if (study.design != Design::saltelli || !question) return all;
  for (const char* index : {"first_order", "total_order", "second_order"})
    if (std::string_view(index) != "second_order" || study.design_options.second_order)
      all.push_back({.name = index, .column = every[*question].name, .index = index});
  return all;
}

UntilTarget target_of(const Study& study, const std::string& text) {
  const auto fault = [&](const std::string& expected) {
    return InputError({.where = "--until", .got = in_quotes(text), .expected = expected});
  };
  const auto mark = text.rfind('=');
  const std::string number = text.substr(mark == std::string::npos ? 0 : mark + 1);
  double half_width = 0.0;
  const auto [end, error] =
      std::from_chars(number.data(), number.data() + number.size(), half_width);
  if (number.empty() || error != std::errc() || end != number.data() + number.size() ||
      !(half_width > 0.0) || !std::isfinite(half_width))
    throw fault("a number above 0, or NAME=NUMBER as in pd_by_range=0.05");
  UntilTarget target{.half_width = half_width};
  if (mark == std::string::npos) return target;
  const std::string name = text.substr(0, mark);
  std::vector<std::string> names;
  std::string list;
  for (UntilTarget& one : possible(study)) {
    if (one.name == name) {
      one.half_width = half_width;
      return std::move(one);
    }
    names.push_back(one.name);
    list += (list.empty() ? "" : ", ") + one.name;
  }
  const std::string nearest = nearest_name(name, names);
  throw fault("a number, or with the name of what is to be known: " + list +
              (nearest.empty() ? "" : " (did you mean " + in_quotes(nearest) + "?)"));
}

const std::vector<double>* values_of(const SummaryTable& table, const std::string& name) {
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (table.columns[c].name == name) return &table.values[c];
  return nullptr;
}

/// "range 12500, wind_speed 3.5"
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

/// The widest interval of a column of a table.
void find_widest(const SummaryTable& table, const std::string& column, Known& known) {
  const auto* low = values_of(table, column + "_low");
  const auto* high = values_of(table, column + "_high");
  if (low == nullptr || high == nullptr || low->empty()) return;
  std::size_t widest = 0;
  double half = -1.0;
  for (std::size_t row = 0; row < low->size(); ++row) {
    const double width = 0.5 * ((*high)[row] - (*low)[row]);
    const double here = std::isfinite(width) ? width : infinity;
    if (here > half) widest = row;
    half = std::max(half, here);
  }
  known.half_width = half;
  known.where = place_in(table, widest);
}

}  // namespace

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

Until::Until(const Study& study, const std::vector<std::string>& texts) {
  for (const std::string& text : texts) {
    targets_.push_back(target_of(study, text));
    for (std::size_t i = 0; i + 1 < targets_.size(); ++i)
      if (targets_[i].name == targets_.back().name)
        throw InputError({.where = "--until",
                          .got = in_quotes(text) + " beside " + in_quotes(texts[i]),
                          .expected = "each answer once"});
  }
  if (!texts.empty()) study_ = std::make_shared<const Study>(study);
}

std::string Until::text() const {
  std::string text;
  for (const UntilTarget& target : targets_)
    text += (text.empty() ? "--until " : " --until ") +
            (target.name.empty() ? "" : target.name + "=") + to_text(target.half_width);
  return text;
}

OrderedEstimate::OrderedEstimate(RunningEstimate estimate, std::uint64_t first, const Until& until)
    : estimate_(std::move(estimate)), first_(first), next_(first), until_(until) {
  if (until_.study() == nullptr) return;
  const Study& study = *until_.study();
  const std::vector<Column> every = columns(study);
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
    if (target.axes.empty() && target.index.empty()) continue;
    takes(target.column);
    for (const SummaryAxis& axis : target.axes) takes(axis.column);
    if (is_weighted(study)) takes(log_weight_column);
  }
  weight_ = place(log_weight_column);
  for (const std::size_t column : taken_) rows_.columns.push_back(every[column]);
  rows_.values.resize(taken_.size());
}

Known OrderedEstimate::known(const UntilTarget& target, std::size_t mean) const {
  Known known{.name = target.name, .asked = target.half_width, .where = ""};
  if (target.name.empty()) {
    known.name = estimate_.name();
    if (const std::optional<Estimate> now = estimate_.estimate())
      known.half_width = 0.5 * (now->high - now->low);
  } else if (!target.index.empty()) {
    for (const SummaryTable& table : saltelli_tables(*until_.study(), rows_))
      find_widest(table, target.index, known);
  } else if (!target.axes.empty()) {
    for (const SummaryTable& table : tables_by(*until_.study(), target.axes, rows_))
      for (const Column& column : rows_.columns)
        if (column.name == target.column) find_widest(table, shown_name(column), known);
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

void OrderedEstimate::take(const Row& row) {
  if (enough_) return;
  estimate_.add(row);
  const double weight = weight_ < row.values.size() ? std::exp(row.values[weight_]) : 1.0;
  for (Mean& mean : means_)
    if (row.valid && mean.column < row.values.size() && std::isfinite(row.values[mean.column]))
      mean.of.add(row.index, row.values[mean.column], weight);
    else
      mean.of.leave_out(row.index, weight);
  if (!taken_.empty()) {
    rows_.index.push_back(row.index);
    rows_.valid.push_back(row.valid ? 1 : 0);
    for (std::size_t i = 0; i < taken_.size(); ++i)
      rows_.values[i].push_back(row.values.at(taken_[i]));
  }
  if (!row.valid) ++skipped_;
  ++next_;
  if (!until_ || !is_look(next_ - first_, estimate_.clusters())) return;
  for (std::size_t i = 0; i < until_.targets().size(); ++i)
    if (!known(until_.targets()[i], i).enough()) return;
  enough_ = next_ - first_;
}

void OrderedEstimate::add(Row row) {
  if (row.index < next_ || enough_) return;
  if (row.index > next_) {
    row.pressure = {};
    row.cells = {};
    waiting_.emplace(row.index, std::move(row));
    return;
  }
  take(row);
  while (!waiting_.empty() && waiting_.begin()->first == next_ && !enough_)
    take(waiting_.extract(waiting_.begin()).mapped());
  if (enough_) waiting_.clear();
}

void check_until(const Study& study) {
  if (study.design != Design::latin_hypercube && study.design != Design::grid) return;
  throw InputError({.where = "--until",
                    .got = "design = \"" + std::string(name(study.design)) + "\"",
                    .expected =
                        "\"random\", \"sobol\" or \"saltelli\": the points of this one depend on "
                        "how many there are, so it cannot stop early"});
}

}  // namespace asdic::detail::study
