// Part of summary_parts.h: receiver operating characteristics.
#include <algorithm>
#include <array>
#include <cmath>

#include "study/summary/intervals.h"
#include "study/summary/summary_parts.h"

namespace asdic::detail::study {
namespace {

constexpr std::size_t most_points = 200;

/// The values of a column that are numbers (−∞ among them), sorted.
std::vector<double> sorted_values(const Table& table, std::size_t column) {
  std::vector<double> values;
  values.reserve(table.index.size());
  for (std::size_t row = 0; row < table.index.size(); ++row)
    if (table.valid[row] != 0 && !std::isnan(table.values[column][row]))
      values.push_back(table.values[column][row]);
  table.values[column].rest();
  std::sort(values.begin(), values.end());
  return values;
}

double above(const std::vector<double>& sorted, double threshold) {
  return static_cast<double>(sorted.end() -
                             std::upper_bound(sorted.begin(), sorted.end(), threshold));
}

/// P(present > absent) + ½P(equal): the area under the curve (Mann & Whitney), with the variance of
/// Hanley & McNeil, Radiology 143, 29 (1982).
struct Area {
  double value = 0.0, error = 0.0;
};
Area area_of(const std::vector<double>& present, const std::vector<double>& absent) {
  double sum = 0.0;
  for (const double x : present) {
    const auto [low, high] = std::equal_range(absent.begin(), absent.end(), x);
    sum += static_cast<double>(low - absent.begin()) + 0.5 * static_cast<double>(high - low);
  }
  const auto p = static_cast<double>(present.size()), a = static_cast<double>(absent.size());
  const double value = sum / (p * a), square = value * value;
  const double q1 = value / (2.0 - value), q2 = 2.0 * square / (1.0 + value);
  const double variance =
      (value * (1.0 - value) + (p - 1.0) * (q1 - square) + (a - 1.0) * (q2 - square)) / (p * a);
  return {value, std::sqrt(std::max(0.0, variance))};
}

}  // namespace

std::vector<SummaryTable> roc_tables(const SummaryPlan& plan, const Table& table) {
  const std::string head = "snr_matched_db", other = "snr_absent_db";
  std::vector<SummaryTable> all;
  SummaryTable areas{
      .name = "roc_area", .title = "Area under the receiver operating curve", .axes = {"target"}};
  areas.columns = {{.name = "target", .unit = "1", .meaning = "whose matched filter"},
                   {.name = "area", .unit = "1", .meaning = "P(with echo > without)"},
                   {.name = "area_low", .unit = "1", .meaning = "confidence interval"},
                   {.name = "area_high", .unit = "1", .meaning = "confidence interval"}};
  areas.values.resize(areas.columns.size());
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const std::string& name = table.columns[c].name;
    if (!name.starts_with(head) || table.columns[c].role != Column::Role::measure) continue;
    const std::string suffix = name.substr(head.size());
    const auto it = std::find_if(table.columns.begin(), table.columns.end(),
                                 [&](const Column& o) { return o.name == other + suffix; });
    if (it == table.columns.end()) continue;
    const std::vector<double> present = sorted_values(table, c);
    const std::vector<double> absent =
        sorted_values(table, static_cast<std::size_t>(it - table.columns.begin()));
    if (present.empty() || absent.empty()) continue;
    SummaryTable roc{.name = "roc" + suffix,
                     .title = "Receiver operating characteristic",
                     .axes = {"threshold_db"}};
    roc.columns = {{.name = "threshold_db", .unit = "dB", .meaning = "over the background"},
                   {.name = "pfa", .unit = "1", .meaning = "over it without an echo"},
                   {.name = "pfa_low", .unit = "1", .meaning = "confidence interval"},
                   {.name = "pfa_high", .unit = "1", .meaning = "confidence interval"},
                   {.name = "pd", .unit = "1", .meaning = "over it with the echo"},
                   {.name = "pd_low", .unit = "1", .meaning = "confidence interval"},
                   {.name = "pd_high", .unit = "1", .meaning = "confidence interval"}};
    roc.values.resize(roc.columns.size());
    // Thresholds from the greatest value down, at shares of both samples.
    std::vector<double> thresholds;
    for (const auto* sample : {&present, &absent})
      for (std::size_t i = 0; i <= most_points / 2; ++i)
        thresholds.push_back(sample_quantile(
            *sample, static_cast<double>(i) / static_cast<double>(most_points / 2)));
    std::erase_if(thresholds, [](double x) { return !std::isfinite(x); });
    std::sort(thresholds.begin(), thresholds.end(), std::greater<>());
    thresholds.erase(std::unique(thresholds.begin(), thresholds.end()), thresholds.end());
    for (const double threshold : thresholds) {
      std::vector<double> row{threshold};
      for (const auto* sample : {&absent, &present}) {
        const auto n = static_cast<double>(sample->size());
        const double hits = above(*sample, threshold);
        const Interval interval = proportion_interval(plan.interval, hits, n, plan.confidence);
        row.insert(row.end(), {hits / n, interval.low, interval.high});
      }
      for (std::size_t i = 0; i < row.size(); ++i) roc.values[i].push_back(row[i]);
    }
    const Area area = area_of(present, absent);
    const double half = two_sided(plan.confidence) * area.error;
    areas.columns[0].labels.push_back(suffix.empty() ? "target" : suffix.substr(1));
    const std::array<double, 4> row{static_cast<double>(all.size()), area.value,
                                    std::max(0.0, area.value - half),
                                    std::min(1.0, area.value + half)};
    for (std::size_t i = 0; i < row.size(); ++i) areas.values[i].push_back(row[i]);
    all.push_back(std::move(roc));
  }
  if (!all.empty()) all.push_back(std::move(areas));
  return all;
}

}  // namespace asdic::detail::study
