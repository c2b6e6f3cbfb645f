#include <cmath>

#include "study/summary/intervals.h"
#include "study/summary/summary.h"
#include "study/summary/summary_parts.h"

namespace asdic::detail::study {

RunningEstimate::RunningEstimate(const Study& study) : level_(study.summary.confidence) {
  const std::vector<Column> all = columns(study);
  const std::optional<std::size_t> question = first_question(all);
  column_ = question.value_or(all.size());
  interval_ = study.summary.interval;
  if (!question) return;
  proportion_ = is_proportion(all[column_]);
  name_ = proportion_ ? proportion_name(all[column_]) : all[column_].name;
  unit_ = all[column_].unit;
}

void RunningEstimate::add(const Row& row) {
  if (!row.valid || column_ >= row.values.size()) return;
  if (!std::isfinite(row.values[column_])) {
    ++left_out_;
    return;
  }
  ++count_;
  const double step = row.values[column_] - mean_;
  mean_ += step / static_cast<double>(count_);
  squares_ += step * (row.values[column_] - mean_);
}

std::optional<Estimate> RunningEstimate::estimate() const {
  if (count_ < 2) return std::nullopt;
  const auto n = static_cast<double>(count_);
  Interval interval;
  if (proportion_) {
    interval = proportion_interval(interval_, std::round(mean_ * n), n, level_);
  } else {
    const double half = two_sided(level_) * std::sqrt(squares_ / (n - 1.0) / n);
    interval = {mean_ - half, mean_ + half};
  }
  return Estimate{.name = name_,
                  .unit = unit_,
                  .value = mean_,
                  .low = interval.low,
                  .high = interval.high,
                  .level = level_,
                  .count = count_};
}

}  // namespace asdic::detail::study
