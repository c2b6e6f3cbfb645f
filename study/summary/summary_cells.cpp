// Part of summary_parts.h: cells without an echo, and false-alarm rates.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/text.h"
#include "core/units.h"
#include "study/summary/intervals.h"
#include "study/summary/k_shape.h"
#include "study/summary/summary_parts.h"
#include "study/summary/tail.h"

namespace asdic::detail::study {
namespace {

constexpr double most_factor = 1.3;  // of the rate that is set
constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// Three digits, for messages.
std::string short_text(double x) {
  std::array<char, 40> text{};
  static_cast<void>(
      std::snprintf(text.data(), text.size(), x >= 1e3 && x < 1e7 ? "%.0f" : "%.3g", x));
  return text.data();
}

/// A rate with its interval, and how it was had.
struct FoundRate {
  double value = not_known, low = not_known, high = not_known;
  bool by_tail = false;
};

/// One bin of time of one target's cells.
class CellBin {
 public:
  CellBin(const SummaryPlan& plan, const CellSums& sums, std::size_t place)
      : plan_(plan),
        levels_(sums.shape.levels),
        counts_(levels_.size(), 0.0),
        above_(levels_.size(), 0.0),
        dispersion_(levels_.size(), 1.0) {
    const std::size_t n = levels_.size();
    const auto part = [&](const std::vector<std::int64_t>& of, std::size_t level) {
      return static_cast<double>(of[place * n + level]);
    };
    rows_ = static_cast<double>(sums.realisations[place]);
    double above = 0.0;
    for (std::size_t i = n; i-- > 0;) {
      counts_[i] = part(sums.count, i);
      above_[i] = above += counts_[i];
    }
    // Of a ratio K/N of sums over rows: Var = Σ(k − pn)²/N², over p(1 − p)/N of independent cells.
    for (std::size_t i = 1; i < n && cells() > 0.0; ++i) {
      const double p = above_[i] / cells();
      if (!(p > 0.0) || rows_ < 2.0) continue;
      const double scatter =
          part(sums.squares, i) - 2.0 * p * part(sums.with_all, i) + p * p * part(sums.squares, 0);
      dispersion_[i] = std::max(1.0, scatter * rows_ / (rows_ - 1.0) / (cells() * p * (1.0 - p)));
    }
  }

  [[nodiscard]] double cells() const { return above_.front(); }
  [[nodiscard]] double rows() const { return rows_; }
  [[nodiscard]] const std::vector<double>& above() const { return above_; }
  [[nodiscard]] std::size_t level_at(double u) const {
    const auto it = std::lower_bound(levels_.begin(), levels_.end(), u - 1e-9);
    return std::min(levels_.size() - 1, static_cast<std::size_t>(it - levels_.begin()));
  }
  /// As many independent cells.
  [[nodiscard]] double worth(std::size_t level) const { return cells() / dispersion_[level]; }
  [[nodiscard]] FoundRate counted(std::size_t level) const {
    if (!(cells() > 0.0)) return {};
    const double d = dispersion_[level];
    const Interval interval = clopper_pearson(above_[level] / d, cells() / d, plan_.confidence);
    return {above_[level] / cells(), interval.low, interval.high};
  }
  /// By counting where ten independent cells or more are there, else by the tail.
  [[nodiscard]] FoundRate rate(std::size_t level, const Tail& tail, const ShapeFit& shape,
                               double cells_around) const {
    constexpr double enough = 10.0;
    const bool count =
        above_[level] / dispersion_[level] >= enough || !tail.fitted || levels_[level] < tail.from;
    if (count) return counted(level);
    const Interval interval = far_interval(tail, shape, levels_[level], cells_around);
    return {tail.rate(levels_[level]), interval.low, interval.high, true};
  }
  [[nodiscard]] Tail tail() const {
    return fit_tail(levels_, counts_, dispersion_, plan_.confidence);
  }
  [[nodiscard]] ShapeFit k_shape(double cells) const {
    double sum = 0.0, number = 0.0;
    for (std::size_t i = 1; i < levels_.size() && above_[i] >= 30.0; ++i) {
      sum += dispersion_[i];
      ++number;
    }
    return fit_k_shape(levels_, counts_, cells, number > 0.0 ? sum / number : 1.0,
                       plan_.confidence);
  }

 private:
  const SummaryPlan& plan_;
  const std::vector<double>& levels_;
  std::vector<double> counts_, above_, dispersion_;
  double rows_ = 0.0;
};

/// A table whose columns are told one after the other.
class TableMaker {
 public:
  TableMaker(std::string name, std::string title, std::vector<std::string> axes)
      : made_{.name = std::move(name), .title = std::move(title), .axes = std::move(axes)} {}
  void column(const std::string& name, const std::string& unit, const std::string& meaning) {
    made_.columns.push_back({.name = name, .unit = unit, .meaning = meaning, .labels = {}});
    made_.values.emplace_back();
  }
  void interval(const std::string& name, const std::string& meaning) {
    column(name, "1", meaning);
    column(name + "_low", "1", "confidence interval");
    column(name + "_high", "1", "confidence interval");
  }
  void row(const std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) made_.values[i].push_back(values[i]);
  }
  [[nodiscard]] SummaryTable& table() { return made_; }

 private:
  SummaryTable made_;
};

/// "_rock" of each target; "" of one alone.
std::vector<std::string> suffixes(const Table& table) {
  const std::string head = "snr_matched_db";
  std::vector<std::string> all;
  for (const Column& column : table.columns)
    if (column.role == Column::Role::measure && column.name.starts_with(head))
      all.push_back(column.name.substr(head.size()));
  return all;
}

/// The ratio to the background at a level, of as many cells as there usually are [dB].
double ratio_db(double level, double cells) {
  return db_from_power(std::isinf(cells) ? level : cells * std::expm1(level / cells));
}

void add_by_time(const Study& study, const CellSums& sums, const std::string& suffix,
                 const std::vector<CellBin>& bins, const std::vector<ShapeFit>& shapes,
                 std::vector<SummaryTable>& all) {
  const double set = study.measure.false_alarm_probability();
  TableMaker made("cells_by_time" + suffix, "Cells without an echo against time after the ping",
                  {"time"});
  made.column("time", "s", "middle of the bin");
  made.column("time_low", "s", "least of the bin");
  made.column("time_high", "s", "greatest of the bin");
  made.column("count", "1", "realisations with a cell there");
  made.column("cells", "1", "cells of all of them");
  made.column("worth", "1", "independent cells whose rate scatters as much");
  made.interval("pfa", "cells over the threshold");
  made.column("pfa_set", "1", "false-alarm probability that is set");
  made.interval("k_shape", "of the K distribution; infinite: Rayleigh");
  for (std::size_t time = 0; time < sums.shape.times(); ++time) {
    const CellBin& bin = bins[time + 1];
    const std::size_t level = bin.level_at(-std::log(set));
    const FoundRate rate = bin.counted(level);
    const ShapeFit& shape = shapes[time + 1];
    const double low = sums.shape.edges[time], high = sums.shape.edges[time + 1];
    made.row({0.5 * (low + high), low, high, bin.rows(), bin.cells(), bin.worth(level), rate.value,
              rate.low, rate.high, set, shape.shape, shape.low, shape.high});
  }
  made.table().edges = {"time_low", "time_high"};
  all.push_back(std::move(made.table()));
}

void add_tails(const CellSums& sums, const std::string& suffix, const std::vector<ShapeFit>& shapes,
               const std::vector<Tail>& tails, double cells, std::vector<SummaryTable>& all) {
  TableMaker made("cells_tail" + suffix,
                  "Tail of the cells without an echo, by peaks over a threshold", {"bin"});
  made.column("bin", "1", "0: all times together, then the bins of cells_by_time");
  made.column("from_db", "dB", "threshold of the tail over the background");
  made.column("cells", "1", "cells at or above it");
  made.column("worth", "1", "as many independent ones");
  made.interval("shape", "of the generalised Pareto law; 0: exponential, as of Rayleigh noise");
  made.column("scale", "1", "of the same, in -ln P of even Rayleigh noise");
  made.column("goodness", "1", "probability of as large an Anderson-Darling statistic by chance");
  made.interval("k_shape", "of the K distribution; infinite: Rayleigh");
  for (std::size_t place = 0; place <= sums.shape.times(); ++place) {
    const Tail& tail = tails[place];
    const ShapeFit& shape = shapes[place];
    std::vector<double> row{static_cast<double>(place),
                            not_known,
                            not_known,
                            not_known,
                            not_known,
                            not_known,
                            not_known,
                            not_known,
                            not_known};
    if (tail.fitted)
      row = {static_cast<double>(place),
             ratio_db(tail.from, cells),
             tail.count,
             tail.worth,
             tail.shape,
             tail.shape_interval.low,
             tail.shape_interval.high,
             tail.scale,
             tail.goodness};
    row.insert(row.end(), {shape.shape, shape.low, shape.high});
    made.row(row);
  }
  all.push_back(std::move(made.table()));
}

void add_rates(const Study& study, const CellSums& sums, const std::string& suffix,
               const CellBin& bin, const Tail& tail, const ShapeFit& shape,
               std::vector<SummaryTable>& all) {
  TableMaker made("false_alarm_rates" + suffix,
                  "What is found where a false-alarm probability is set", {"pfa_set"});
  made.column("pfa_set", "1", "false-alarm probability, of even Rayleigh noise");
  made.column("threshold_db", "dB", "over the background");
  made.column("cells", "1", "cells over it");
  made.column("worth", "1", "independent cells whose rate scatters as much, of all");
  made.interval("pfa", "found rate");
  made.column("by_tail", "1", "1: by the fitted tail; 0: by counting");
  const double set = study.measure.false_alarm_probability();
  std::vector<double> levels;
  for (int decade = 1; decade <= 8; ++decade) levels.push_back(decade * std::log(10.0));
  const double own = -std::log(set);
  if (std::none_of(levels.begin(), levels.end(),
                   [&](double u) { return std::abs(u - own) < 1e-9 * own; }))
    levels.insert(std::upper_bound(levels.begin(), levels.end(), own), own);
  const double cells = study.measure.matched_filter.estimated_from();
  for (const double u : levels) {
    const std::size_t level = bin.level_at(u);
    const FoundRate rate = bin.rate(level, tail, shape, cells);
    made.row({std::exp(-sums.shape.levels[level]), ratio_db(sums.shape.levels[level], cells),
              bin.above()[level], bin.worth(level), rate.value, rate.low, rate.high,
              rate.by_tail ? 1.0 : 0.0});
  }
  all.push_back(std::move(made.table()));
}

void add_roc(const Study& study, const CellSums& sums, const Table& table,
             const std::string& suffix, const CellBin& bin, const Tail& tail, const ShapeFit& shape,
             std::vector<SummaryTable>& all) {
  const auto column =
      std::find_if(table.columns.begin(), table.columns.end(),
                   [&](const Column& c) { return c.name == "snr_matched_db" + suffix; });
  if (column == table.columns.end()) return;
  const auto& values = table.values[static_cast<std::size_t>(column - table.columns.begin())];
  std::vector<double> present;
  for (std::size_t row = 0; row < table.index.size(); ++row)
    if (table.valid[row] != 0 && !std::isnan(values[row])) present.push_back(values[row]);
  if (present.empty()) return;
  std::sort(present.begin(), present.end());
  TableMaker made("roc_cells" + suffix,
                  "Receiver operating characteristic, false alarms of all cells", {"threshold_db"});
  made.column("threshold_db", "dB", "over the background");
  made.interval("pfa", "cells over it without an echo");
  made.column("by_tail", "1", "1: by the fitted tail; 0: by counting");
  made.interval("pd", "over it with the echo");
  const double cells = study.measure.matched_filter.estimated_from();
  constexpr double least = 1e-8;
  for (std::size_t level = sums.shape.levels.size(); level-- > 1;) {
    const double u = sums.shape.levels[level];
    const FoundRate rate = bin.rate(level, tail, shape, cells);
    if (u > -std::log(least) + 1e-9 || !(rate.value >= least)) continue;
    const double threshold = ratio_db(u, cells);
    const auto n = static_cast<double>(present.size());
    const auto hits = static_cast<double>(
        present.end() - std::upper_bound(present.begin(), present.end(), threshold));
    const Interval pd =
        proportion_interval(study.summary.interval, hits, n, study.summary.confidence);
    made.row({threshold, rate.value, rate.low, rate.high, rate.by_tail ? 1.0 : 0.0, hits / n,
              pd.low, pd.high});
  }
  all.push_back(std::move(made.table()));
}

}  // namespace

std::vector<SummaryTable> cell_tables(const Study& study, const Table& table) {
  const CellSums& sums = table.cells;
  std::vector<SummaryTable> all;
  if (sums.empty()) return all;
  const std::vector<std::string> of = suffixes(table);
  const std::size_t places = sums.shape.times() + 1;
  const double cells = study.measure.matched_filter.estimated_from();
  for (std::size_t target = 0; target < std::min(of.size(), sums.shape.targets); ++target) {
    std::vector<CellBin> bins;
    std::vector<Tail> tails;
    std::vector<ShapeFit> shapes;
    for (std::size_t place = 0; place < places; ++place) {
      bins.emplace_back(study.summary, sums, target * places + place);
      tails.push_back(bins.back().cells() > 0.0 ? bins.back().tail() : Tail{});
      shapes.push_back(bins.back().k_shape(cells));
    }
    add_by_time(study, sums, of[target], bins, shapes, all);
    add_rates(study, sums, of[target], bins.front(), tails.front(), shapes.front(), all);
    add_tails(sums, of[target], shapes, tails, cells, all);
    if (study.summary.roc)
      add_roc(study, sums, table, of[target], bins.front(), tails.front(), shapes.front(), all);
  }
  return all;
}

std::vector<std::string> rate_warnings(const Study& study,
                                       const std::vector<SummaryTable>& tables) {
  std::vector<std::string> all;
  for (const SummaryTable& table : tables) {
    const std::size_t nowhere = table.columns.size();
    const auto column = [&](const std::string& name) {
      std::size_t c = 0;
      while (c < nowhere && table.columns[c].name != name) ++c;
      return c;
    };
    const auto value = [&](std::size_t c, std::size_t row) { return table.values.at(c).at(row); };
    const bool of_detection = table.name.starts_with("pd");
    const std::size_t rate = column("pfa"), low = column("pfa_low"), high = column("pfa_high"),
                      set = column("pfa_set");
    if (std::max({rate, low, high, set}) == nowhere) continue;
    if (!of_detection && !table.name.starts_with("cells_by_time") && table.name != "statistics")
      continue;
    const std::size_t count = column(of_detection ? "pfa_count" : "count"), cells = column("cells");
    for (std::size_t row = 0; row < table.values.at(rate).size(); ++row) {
      const double wanted = value(set, row);
      if (!(value(low, row) > most_factor * wanted || value(high, row) < wanted / most_factor))
        continue;
      std::string where = table.name;
      for (const std::string& axis : table.axes) {
        const std::size_t from = column(axis + "_low"), to = column(axis + "_high");
        const Column& along = table.columns.at(column(axis));
        const double x = value(column(axis), row);
        const std::string unit = along.unit.empty() || along.unit == "1" ? "" : ' ' + along.unit;
        where += &axis == table.axes.data() ? ", " : " and ";
        where += axis + ' ';
        if (!along.labels.empty() && x >= 0.0 && x < static_cast<double>(along.labels.size()))
          where += along.labels[static_cast<std::size_t>(x)];
        else if (from < nowhere && to < nowhere)
          where += short_text(value(from, row)) + " to " + short_text(value(to, row)) + unit;
        else
          where += short_text(x) + unit;
      }
      std::string of = cells < nowhere ? short_text(value(cells, row)) + " cells of " : "";
      of += count < nowhere ? short_text(value(count, row)) + " realisations" : "the realisations";
      all.push_back("false-alarm rate: " + where + ": found " + short_text(value(rate, row)) +
                    " (" + short_text(value(low, row)) + " to " + short_text(value(high, row)) +
                    " in " + of + "), expected " + short_text(wanted) + " within a factor of 1.3");
    }
  }
  constexpr std::size_t most = 20;
  if (all.size() > most) {
    const std::size_t more = all.size() - most;
    all.resize(most);
    all.push_back("false-alarm rate: " + std::to_string(more) +
                  " more bins of the summary's tables are off by more than a factor of 1.3");
  }
  using Background = MatchedFilterPlan::Background;
  const Background background = study.measure.matched_filter.background;
  if (!all.empty() && background != Background::expected && background != Background::summed)
    all.push_back(
        "false-alarm rate: where the level bends or the noise is not the background, "
        "measure.matched_filter.background = \"expected\" compares with what the simulation "
        "itself expects");
  return all;
}

std::vector<std::string> alarm_warnings(const Study& study, const Table& table) {
  const auto mean_of = [&](const std::string& name) {
    Moments moments;
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      for (std::size_t row = 0; table.columns[c].name == name && row < table.index.size(); ++row)
        if (counts(table, row, c)) moments.add(table.values[c][row]);
    return moments;
  };
  const Moments found = mean_of("false_alarms"), even = mean_of("false_alarms_of_noise");
  const Interval interval = found.mean_interval(study.summary.confidence);
  if (!(interval.low > even.mean())) return {};
  return {"false alarms: the receiver makes " + short_text(found.mean()) + " a ping (" +
          short_text(interval.low) + " to " + short_text(interval.high) + "), even noise at most " +
          short_text(even.mean()) +
          ": its threshold is not at the false-alarm probability that is set, because the "
          "background bends or is not Rayleigh"};
}

}  // namespace asdic::detail::study
