// Part of summary_parts.h: a run of pings.
#include <algorithm>
#include <cmath>

#include "study/measures/ping_run.h"
#include "study/plan/no_value.h"
#include "study/summary/axis.h"
#include "study/summary/intervals.h"
#include "study/summary/summary_parts.h"

namespace asdic::detail::study {
namespace {

/// A share of the rows, and its interval.
struct Share {
  double value = 0.0, count = 0.0;
  Interval interval{};
  RowMean mean;
};

/// The columns of one target's run.
class Run {
 public:
  /// \param suffix  of the target's columns
  Run(const Study& study, const Table& table, const std::string& suffix)
      : plan_(study.summary), run_(*study.measure.run), means_(study, table), table_(table) {
    for (int k = 0; k < run_.count; ++k) {
      const std::string head = "ping_" + std::to_string(run_.first + k);
      detected_.push_back(column_of(table, head + "_detected" + suffix));
      range_.push_back(column_of(table, head + "_range" + suffix));
      time_.push_back(column_of(table, head + "_time"));
    }
    if (run_.tracker) track_ping_ = column_of(table, "track_ping" + suffix);
  }

  /// Of the rows of which all is known up to a ping. \param yes  of what happened so far
  template <class Yes>
  [[nodiscard]] Share share_until(std::size_t ping, Yes yes) const {
    std::vector<double> so_far(ping + 1);
    return share_of(means_.of_all([&](std::size_t row) {
      if (table_.valid[row] == 0) return no_value;
      for (std::size_t k = 0; k <= ping; ++k) so_far[k] = table_.values[detected_[k]][row];
      const RunAnswer answer = run_answer(so_far, run_);
      return !answer.known ? no_value : yes(answer) ? 1.0 : 0.0;
    }));
  }
  /// Of the rows in which this ping is known.
  [[nodiscard]] Share share_in(std::size_t ping) const {
    return share_of(means_.of_column(detected_[ping]));
  }
  /// Of the valid rows: the tracker has the target with this ping or before.
  [[nodiscard]] Share tracked_until(std::size_t ping) const {
    const double last = static_cast<double>(run_.first) + static_cast<double>(ping);
    return share_of(means_.of_all([&](std::size_t row) {
      if (table_.valid[row] == 0) return no_value;
      return table_.values[track_ping_][row] <= last ? 1.0 : 0.0;
    }));
  }
  [[nodiscard]] double mean_range(std::size_t ping) const { return mean_of(range_[ping]); }
  [[nodiscard]] double mean_time(std::size_t ping) const { return mean_of(time_[ping]); }
  [[nodiscard]] std::size_t pings() const { return detected_.size(); }
  [[nodiscard]] const PingRunPlan& rule() const { return run_; }
  [[nodiscard]] bool weighted() const { return means_.weighted(); }

 private:
  [[nodiscard]] double mean_of(std::size_t column) const {
    return means_.of_column(column).value(false);
  }
  [[nodiscard]] Share share_of(const RowMean& mean) const {
    return {.value = mean.count() > 0.0 ? mean.value(true) : no_value,
            .count = mean.count(),
            .interval = mean.interval(true, plan_.interval, plan_.confidence),
            .mean = mean};
  }

  const SummaryPlan& plan_;
  const PingRunPlan& run_;
  RowMeans means_;
  const Table& table_;
  std::vector<std::size_t> detected_, range_, time_;  // [pings] columns
  std::size_t track_ping_ = 0;                        // column, with a tracker
};

const Column share{.unit = "1"};

void add_share(SummaryTable& to, const std::string& name, const std::string& meaning) {
  add_column(to, share, name, meaning);
  add_column(to, share, name + "_low", "confidence interval");
  add_column(to, share, name + "_high", "confidence interval");
}

/// Probabilities against the number of the ping. \param ever  [pings], for who needs them again
SummaryTable by_ping(const Study& study, const Run& run, const std::string& suffix,
                     std::vector<Share>& ever) {
  const PingRunPlan& rule = run.rule();
  const bool by_filter = study.measure.detection->by == DetectionPlan::By::matched_filter;
  SummaryTable made{
      .name = "pings" + suffix, .title = "Detection ping by ping, and so far", .axes = {"ping"}};
  add_column(made, share, "ping", "number of the ping");
  add_column(made, share, "count", "valid realisations in which all pings so far are known");
  add_column(made, {.unit = "s"}, "time", "when it is sent, after the run's first: mean");
  add_column(made, {.unit = "m"}, "range",
             "horizontal, from the transmitter to the target, when it is sent: mean");
  add_column(made, share, "known", "valid realisations in which this ping is known");
  add_share(made, "pd", "detected in this ping: share of the realisations");
  add_share(made, "pd_ever", "detected in this ping or before: share of the realisations");
  add_column(made, share, "first", "detected in this ping for the first time: share");
  add_column(made, share, "pd_ever_independent",
             "what pd_ever would be if pings did not depend on one another");
  if (by_filter)
    add_column(made, share, "pfa_ever_set",
               "a false alarm in one cell so far, of pings that do not depend on one another");
  if (rule.initiates())
    add_share(made, "ptrack",
              std::to_string(rule.hits) + " detections within " + std::to_string(rule.within) +
                  " pings in a row, so far: share of the realisations");
  if (rule.tracker)
    add_share(made, "ptracked",
              "the tracker believes a track of the target, so far: share of the realisations");
  std::vector<std::string> weighed{"pd_", "pd_ever_"};
  if (rule.initiates()) weighed.emplace_back("ptrack_");
  if (rule.tracker) weighed.emplace_back("ptracked_");
  if (run.weighted())
    for (const std::string& head : weighed) add_worth(made, head);
  double missed = 1.0;
  for (std::size_t k = 0; k < run.pings(); ++k) {
    const Share here = run.share_in(k);
    const Share so_far = run.share_until(k, [](const RunAnswer& a) { return a.first >= 0; });
    const Share first =
        run.share_until(k, [&](const RunAnswer& a) { return a.first == static_cast<int>(k); });
    ever.push_back(so_far);
    missed *= 1.0 - here.value;
    put(made,
        {static_cast<double>(rule.first) + static_cast<double>(k), so_far.count, run.mean_time(k),
         run.mean_range(k), here.count, here.value, here.interval.low, here.interval.high,
         so_far.value, so_far.interval.low, so_far.interval.high, first.value, 1.0 - missed});
    if (by_filter)
      put(made, {-std::expm1(static_cast<double>(k + 1) *
                             std::log1p(-study.measure.false_alarm_probability()))});
    std::vector<Share> tracks;
    if (rule.initiates())
      tracks.push_back(run.share_until(k, [](const RunAnswer& a) { return a.initiated >= 0; }));
    if (rule.tracker) tracks.push_back(run.tracked_until(k));
    for (const Share& one : tracks) put(made, {one.value, one.interval.low, one.interval.high});
    if (!run.weighted()) continue;
    put_worth(made, here.mean);
    put_worth(made, so_far.mean);
    for (const Share& one : tracks) put_worth(made, one.mean);
  }
  return made;
}

/// After how many pings, and when, so large a share is detected: the first at which it is, and at
/// which the interval's ends are. \param ever  [pings]
SummaryTable first_detection(const Study& study, const Run& run, const std::string& suffix,
                             const std::vector<Share>& ever) {
  SummaryTable made{.name = "first_detection" + suffix,
                    .title = "When it is detected for the first time: quantiles",
                    .axes = {"probability"}};
  add_column(made, share, "probability", "share of the realisations that are detected by then");
  add_column(made, share, "count", "valid realisations in which all pings are known");
  const std::string later = "; NaN: not within the run";
  for (const std::string name : {"ping", "time"}) {
    const Column like{.unit = name == "ping" ? "1" : "s"};
    const std::string what =
        name == "ping" ? "number of the ping" : "when it is sent, after the first";
    add_column(made, like, name, what + later);
    add_column(made, like, name + "_low", "confidence interval" + later);
    add_column(made, like, name + "_high", "confidence interval" + later);
  }
  add_share(made, "never", "not detected within the run: share of the realisations");
  const Share& all = ever.back();
  std::vector<double> quantiles = study.summary.quantiles;
  std::sort(quantiles.begin(), quantiles.end());
  for (const double p : quantiles) {
    const auto reached = [&](auto value) {
      const auto at =
          std::find_if(ever.begin(), ever.end(), [&](const Share& one) { return value(one) >= p; });
      return static_cast<std::size_t>(at - ever.begin());
    };
    const std::size_t middle = reached([](const Share&one) { return one.value; }),
                      low = reached([](const Share&one) { return one.interval.high; }),
                      high = reached([](const Share&one) { return one.interval.low; });
    const auto number = [&](std::size_t k) {
      return k < ever.size() ? static_cast<double>(run.rule().first) + static_cast<double>(k)
                             : no_value;
    };
    const auto time = [&](std::size_t k) { return k < ever.size() ? run.mean_time(k) : no_value; };
    put(made, {p, all.count, number(middle), number(low), number(high), time(middle), time(low),
               time(high), 1.0 - all.value, 1.0 - all.interval.high, 1.0 - all.interval.low});
  }
  return made;
}

}  // namespace

std::vector<SummaryTable> ping_tables(const Study& study, const Table& table) {
  if (!study.measure.run) return {};
  const std::string head = "ping_" + std::to_string(study.measure.run->first) + "_detected";
  std::vector<SummaryTable> made;
  for (const Column& column : table.columns) {
    if (column.role != Column::Role::ping || !column.name.starts_with(head)) continue;
    const std::string suffix = column.name.substr(head.size());
    const Run run(study, table, suffix);
    std::vector<Share> ever;
    made.push_back(by_ping(study, run, suffix, ever));
    made.push_back(first_detection(study, run, suffix, ever));
  }
  return made;
}

}  // namespace asdic::detail::study
