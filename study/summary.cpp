#include "study/summary.h"

#include <cmath>

#include "study/law.h"

namespace asdic::study {
namespace {

/// z of a two-sided interval of a normal.
double two_sided(double confidence) { return normal_upper_quantile(0.5 * (1.0 - confidence)); }

SummaryTable statistics(const Study& study, const Table& table) {
  SummaryTable made{.name = "statistics", .title = "Every column over all valid realisations"};
  Column quantity{.name = "quantity", .unit = "1", .meaning = "column"};
  std::vector<double> which, count, mean, deviation, low, high;
  const double z = two_sided(study.summary.confidence);
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    double n = 0.0, m = 0.0, squares = 0.0;  // Welford
    for (std::size_t row = 0; row < table.index.size(); ++row) {
      const double x = table.values[c][row];
      if (table.valid[row] == 0 || !std::isfinite(x)) continue;
      n += 1.0;
      const double step = x - m;
      m += step / n;
      squares += step * (x - m);
    }
    const double none = std::nan("");
    const double s = n > 1.0 ? std::sqrt(squares / (n - 1.0)) : none;
    which.push_back(static_cast<double>(c));
    quantity.labels.push_back(table.columns[c].name);
    count.push_back(n);
    mean.push_back(n > 0.0 ? m : none);
    deviation.push_back(s);
    low.push_back(m - z * s / std::sqrt(n));
    high.push_back(m + z * s / std::sqrt(n));
  }
  made.columns = {quantity,
                  {.name = "count", .unit = "1", .meaning = "finite values"},
                  {.name = "mean", .unit = "of the quantity", .meaning = "mean"},
                  {.name = "deviation", .unit = "of the quantity", .meaning = "standard deviation"},
                  {.name = "low", .unit = "of the quantity", .meaning = "of the mean's interval"},
                  {.name = "high", .unit = "of the quantity", .meaning = "of the mean's interval"}};
  made.values = {which, count, mean, deviation, low, high};
  return made;
}

}  // namespace

std::vector<SummaryTable> summarise(const Study& study, const Table& table) {
  return {statistics(study, table)};
}

RunningEstimate::RunningEstimate(const Study& study) {
  const std::vector<Column> all = columns(study);
  while (column_ < all.size() && all[column_].role != Column::Role::measure) ++column_;
  if (column_ < all.size()) {
    name_ = all[column_].name;
    unit_ = all[column_].unit;
  }
  level_ = study.summary.confidence;
}

void RunningEstimate::add(const Row& row) {
  if (!row.valid || column_ >= row.values.size() || !std::isfinite(row.values[column_])) return;
  ++count_;
  const double x = row.values[column_], step = x - mean_;
  mean_ += step / static_cast<double>(count_);
  squares_ += step * (x - mean_);
}

std::optional<Estimate> RunningEstimate::estimate() const {
  if (count_ < 2) return std::nullopt;
  const auto n = static_cast<double>(count_);
  const double half = two_sided(level_) * std::sqrt(squares_ / (n - 1.0) / n);
  return Estimate{.name = name_,
                  .unit = unit_,
                  .value = mean_,
                  .low = mean_ - half,
                  .high = mean_ + half,
                  .level = level_,
                  .count = count_};
}

}  // namespace asdic::study
