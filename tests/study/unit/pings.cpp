#include "study/measures/ping_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iostream>
#include <numbers>

#include "core/error.h"
#include "study/reader/study_reader.h"
#include "study/sampling/design.h"
#include "study/summary/intervals.h"
#include "study/summary/summary_parts.h"
#include "support/function_study.h"
#include "support/mixture.h"
#include "support/plain_sea.h"
#include "support/summary_tables.h"
#include "support/temporary_directory.h"

// Detection over a run of pings: what a row says, and what the tables say.

namespace asdic::detail::study {
namespace {

/// Whether any window of n pings up to ping k holds m hits: looked at one by one.
bool window_full(unsigned hits, int k, int m, int n) {
  for (int last = 0; last <= k; ++last) {
    int in_it = 0;
    for (int ping = std::max(0, last - n + 1); ping <= last; ++ping)
      in_it += (hits >> ping & 1U) != 0 ? 1 : 0;
    if (in_it >= m) return true;
  }
  return false;
}

TEST(PingRun, EveryPatternOfNinePings) {
  constexpr int pings = 9;
  for (const auto& [m, n] : {std::pair{1, 1}, {2, 3}, {3, 5}, {4, 4}, {3, 9}})
    for (unsigned hits = 0; hits < 1U << pings; ++hits) {
      std::vector<double> detected;
      for (int k = 0; k < pings; ++k) detected.push_back((hits >> k & 1U) != 0 ? 1.0 : 0.0);
      const RunAnswer answer =
          run_answer(detected, {.first = 1, .count = pings, .hits = m, .within = n});
      ASSERT_TRUE(answer.known);
      EXPECT_EQ(answer.detections, std::popcount(hits));
      EXPECT_EQ(answer.first, hits == 0 ? -1 : std::countr_zero(hits));
      int begins = -1;
      for (int k = 0; k < pings && begins < 0; ++k)
        if (window_full(hits, k, m, n)) begins = k;
      ASSERT_EQ(answer.initiated, begins) << hits << ": " << m << " of " << n;
    }
}

TEST(PingRun, OneThatIsNotKnownMakesAllOfItUnknown) {
  const RunAnswer answer = run_answer(std::vector<double>{1.0, std::nan(""), 1.0},
                                      {.first = 1, .count = 3, .hits = 2, .within = 3});
  EXPECT_FALSE(answer.known);
  EXPECT_EQ(answer.first, -1);
}

/// P(a window of n pings with m hits, up to ping k) of independent pings: the chain of the last
/// n − 1 outcomes, those that have begun a track taken out.
std::vector<double> chance_of_track(double p, int pings, int m, int n) {
  const std::size_t states = std::size_t{1} << (n - 1);
  std::vector<double> now(states, 0.0), made;
  now[0] = 1.0;
  double begun = 0.0;
  for (int k = 0; k < pings; ++k) {
    std::vector<double> next(states, 0.0);
    for (std::size_t s = 0; s < states; ++s)
      for (const std::size_t hit : {std::size_t{0}, std::size_t{1}}) {
        const double weight = now[s] * (hit != 0 ? p : 1.0 - p);
        const std::size_t all = s << 1 | hit;
        if (std::popcount(all) >= m)
          begun += weight;
        else
          next[all & (states - 1)] += weight;
      }
    now = next;
    made.push_back(begun);
  }
  return made;
}

constexpr int pings = 6;

Study study_of_pings() {
  Study study;
  study.measure.detection = DetectionPlan{};
  study.measure.run = PingRunPlan{.first = 2, .count = pings, .hits = 2, .within = 3};
  study.summary.quantiles = {0.9, 0.25, 0.5};
  return study;
}

/// Rows of pings that detect with probability `p` each and are not known with probability `lost`.
Table rows_of(std::uint64_t seed, std::size_t rows, double p, double lost) {
  Table table;
  for (int k = 2; k < 2 + pings; ++k) {
    const std::string head = "ping_" + std::to_string(k);
    for (const char* what : {"_detected", "_range", "_time"})
      table.columns.push_back({.name = head + what, .unit = "1", .role = Column::Role::ping});
  }
  table.values.resize(table.columns.size());
  for (std::size_t row = 0; row < rows; ++row) {
    table.index.push_back(row);
    table.valid.push_back(1);
    for (std::uint32_t k = 0; k < pings; ++k) {
      const bool known = uniform_draw(seed, row, 2 * k) >= lost;
      const double hit = uniform_draw(seed, row, 2 * k + 1) < p ? 1.0 : 0.0;
      table.values[std::size_t{3} * k].push_back(known ? hit : std::nan(""));
      table.values[std::size_t{3} * k + 1].push_back(1000.0 * (k + 1));
      table.values[std::size_t{3} * k + 2].push_back(60.0 * k);
    }
  }
  return table;
}

TEST(PingTables, IntervalsHoldTheClosedFormsAsOftenAsTheySay) {
  // Truths: 1 − (1 − p)^k, and the chain of windows. 400 studies of 150 rows, of which a tenth of
  // the pings is not known. 95 % of 400: a standard deviation of 4.4, six of them 26. An estimate
  // that takes what is not known for missed, or counts such rows only where they were detected,
  // lies beyond.
  const Study study = study_of_pings();
  constexpr double p = 0.3, lost = 0.1;
  const std::vector<double> track = chance_of_track(p, pings, 2, 3);
  std::vector<int> ever_held(pings, 0), track_held(pings, 0), missed_held(pings, 0),
      found_held(pings, 0);
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const Table rows = rows_of(seed, 150, p, lost);
    const auto tables = summarise(study, rows);
    const SummaryTable& t = named(tables, "pings");
    for (std::size_t k = 0; k < pings; ++k) {
      const double truth = 1.0 - std::pow(1.0 - p, k + 1);
      ever_held[k] +=
          column(t, "pd_ever_low")[k] <= truth && truth <= column(t, "pd_ever_high")[k] ? 1 : 0;
      track_held[k] +=
          column(t, "ptrack_low")[k] <= track[k] && track[k] <= column(t, "ptrack_high")[k] ? 1 : 0;
      // The wrong ones.
      double found = 0.0, all_known = 0.0;
      for (std::size_t row = 0; row < rows.index.size(); ++row) {
        bool hit = false, known = true;
        for (std::size_t i = 0; i <= k; ++i) {
          hit = hit || rows.values[3 * i][row] == 1.0;
          known = known && std::isfinite(rows.values[3 * i][row]);
        }
        found += hit ? 1.0 : 0.0;
        all_known += hit || known ? 1.0 : 0.0;
      }
      const Interval as_missed = wilson(found, 150.0, 0.95),
                     as_left = wilson(found, all_known, 0.95);
      missed_held[k] += as_missed.low <= truth && truth <= as_missed.high ? 1 : 0;
      found_held[k] += as_left.low <= truth && truth <= as_left.high ? 1 : 0;
    }
  }
  for (std::size_t k = 0; k < pings; ++k) {
    EXPECT_NEAR(ever_held[k], 380, 26) << k;
    if (k > 0) {
      EXPECT_NEAR(track_held[k], 380, 26) << k;
    }
  }
  EXPECT_LT(*std::min_element(missed_held.begin(), missed_held.end()), 354);
  EXPECT_LT(*std::min_element(found_held.begin(), found_held.end()), 354);
}

TEST(PingTables, WhenItIsDetectedFirst) {
  const auto tables = summarise(study_of_pings(), rows_of(9, 40'000, 0.3, 0.0));
  const SummaryTable& t = named(tables, "pings");
  EXPECT_EQ(column(t, "ping").front(), 2.0);
  EXPECT_EQ(column(t, "count").back(), 40'000.0);
  EXPECT_EQ(column(t, "time").back(), 300.0);
  EXPECT_EQ(column(t, "range").back(), 6000.0);
  for (std::size_t k = 0; k < pings; ++k) {
    // Geometric; five standard deviations.
    const double truth = 0.3 * std::pow(0.7, k);
    EXPECT_NEAR(column(t, "first")[k], truth, 5.0 * std::sqrt(truth / 40'000.0)) << k;
    EXPECT_NEAR(column(t, "pd_ever_independent")[k], column(t, "pd_ever")[k], 0.015) << k;
    // Ten pings of 10⁻⁴ each, say: 1 − (1 − 10⁻⁴)^k
    EXPECT_NEAR(column(t, "pfa_ever_set")[k], 1.0 - std::pow(1.0 - 1e-4, k + 1), 1e-12);
  }
  // 1 − 0.7^k passes 0.25 with the first ping, 0.5 with the second; 0.9 is not within six pings.
  const SummaryTable& first = named(tables, "first_detection");
  EXPECT_EQ(column(first, "probability"), (std::vector<double>{0.25, 0.5, 0.9}));
  EXPECT_EQ(column(first, "ping")[0], 2.0);
  EXPECT_EQ(column(first, "ping")[1], 3.0);
  EXPECT_EQ(column(first, "time")[1], 60.0);
  EXPECT_TRUE(std::isnan(column(first, "ping")[2]));
  EXPECT_TRUE(std::isnan(column(first, "time_high")[2]));
  EXPECT_NEAR(column(first, "never")[0], std::pow(0.7, 6), 0.01);
  EXPECT_LT(column(first, "never_low")[0], column(first, "never")[0]);
  EXPECT_GT(column(first, "never_high")[0], column(first, "never")[0]);
}

/// Rows whose z is drawn far out: ping k detects with probability 0.6 where z is beyond a threshold
/// that falls from ping to ping. Ranges follow another input, drawn off its law too. One ping in
/// twenty is not known.
constexpr std::array<double, pings> thresholds{3.4, 3.2, 3.0, 2.8, 2.6, 2.4};
constexpr double each = 0.6;
support::FunctionStudy drawn_far_out() {
  support::FunctionStudy made;
  made.measure = "detected_ever";
  made.of = [](std::span<const double>, double) { return 0.0; };
  made.study.realisations = 1500;
  made.study.variables = {support::normal_input("z"), support::normal_input("y")};
  made.study.proposal = support::mixture({{ScoreLaw{2.8, 1.0}, ScoreLaw{1.5, 1.0}}});
  made.study.measure = study_of_pings().measure;
  made.study.summary.quantiles = {0.001, 0.003};
  made.study.summary.roc = made.study.summary.sensitivity = made.study.summary.convergence = false;
  return made;
}
Table rows_of(const support::FunctionStudy& made) {
  Table table = made.table();
  const std::size_t ever = table.columns.size() - 1;
  const Table runs = rows_of(made.study.seed + 500, table.index.size(), each, 0.05);
  for (std::size_t c = 0; c < runs.columns.size(); ++c) {
    table.columns.push_back(runs.columns[c]);
    table.values.push_back(runs.values[c]);
  }
  for (std::size_t row = 0; row < table.index.size(); ++row) {
    const double z = table.values[0][row], y = table.values[1][row];
    std::vector<double> detected;
    for (std::size_t k = 0; k < pings; ++k) {
      double& hit = table.values[ever + 1 + 3 * k][row];
      if (hit == 1.0 && !(z > thresholds.at(k))) hit = 0.0;
      table.values[ever + 2 + 3 * k][row] += 100.0 * y;
      detected.push_back(hit);
    }
    const RunAnswer answer = run_answer(detected, *made.study.measure.run);
    table.values[ever][row] = !answer.known ? std::nan("") : answer.first >= 0 ? 1.0 : 0.0;
  }
  return table;
}

// Truths in closed form: z lies between the thresholds of pings j and j − 1 with a probability that
// is known, and then pings from j on detect by themselves.
TEST(WeightedPings, IntervalsHoldTheClosedFormsAsOftenAsTheySay) {
  const auto tail = [](double z) { return 0.5 * std::erfc(z / std::numbers::sqrt2); };
  const std::vector<double> chain = chance_of_track(each, pings, 2, 3);
  std::vector<double> ever(pings, 0.0), track(pings, 0.0);
  for (std::size_t k = 0; k < pings; ++k)
    for (std::size_t j = 0; j <= k; ++j) {
      const double band = tail(thresholds.at(j)) - (j > 0 ? tail(thresholds.at(j - 1)) : 0.0);
      ever[k] += band * (1.0 - std::pow(1.0 - each, k - j + 1));
      track[k] += band * chain[k - j];
    }
  support::FunctionStudy made = drawn_far_out();
  std::vector<support::Coverage> in_ping(pings), so_far(pings), begun(pings), range(pings),
      first_time(pings), without(pings);
  support::Coverage when;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    made.study.seed = seed;
    Table rows = rows_of(made);
    const auto tables = ping_tables(made.study, rows);
    const SummaryTable &t = named(tables, "pings"), &first = named(tables, "first_detection");
    const auto statistics = statistics_table(made.study, rows);
    const auto take = [&](support::Coverage& to, const std::string& name, std::size_t k,
                          double truth) {
      to.add(column(t, name)[k], column(t, name + "_low")[k], column(t, name + "_high")[k], truth);
    };
    for (std::size_t k = 0; k < pings; ++k) {
      take(in_ping[k], "pd", k, each * tail(thresholds.at(k)));
      take(so_far[k], "pd_ever", k, ever[k]);
      if (k > 0) take(begun[k], "ptrack", k, track[k]);
      range[k].add(column(t, "range")[k], 0.0, 0.0, 0.0);
      first_time[k].add(column(t, "first")[k], 0.0, 0.0, 0.0);
    }
    // What the whole run comes to is a measure of the rows as well.
    const std::size_t of_run = 4;
    ASSERT_EQ(statistics.columns[0].labels[2], "detected_ever");
    EXPECT_EQ(column(t, "pd_ever").back(), column(statistics, "mean")[2]);
    EXPECT_EQ(column(t, "pd_ever_low").back(), column(statistics, "mean_low")[2]);
    EXPECT_EQ(column(t, "pd_ever_high").back(), column(statistics, "mean_high")[2]);
    EXPECT_EQ(column(t, "pd_ever_effective").back(), column(statistics, "effective_of_event")[2]);
    EXPECT_EQ(column(t, "pd_ever_largest_share").back(), column(statistics, "largest_share")[2]);
    EXPECT_EQ(column(t, "count").back(), column(statistics, "count")[2]);
    EXPECT_EQ(column(first, "never")[0], 1.0 - column(t, "pd_ever").back());
    ASSERT_EQ(rows.columns[of_run].name, "detected_ever");
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
      const double p = column(first, "probability")[i];
      const auto reached = std::find_if(ever.begin(), ever.end(), [&](double x) { return x >= p; });
      const double truth = 2.0 + static_cast<double>(reached - ever.begin());
      const auto end = [&](const char* name) {
        const double ping = column(first, name)[i];
        return std::isnan(ping) ? infinity : ping;
      };
      when.add(0.0, end("ping_low"), end("ping_high"), truth);
    }
    // Wrong: no weights.
    for (Column& one : rows.columns)
      if (one.name == log_weight_column) one.name = "something";
    const auto unweighted = ping_tables(made.study, rows);
    const SummaryTable& u = named(unweighted, "pings");
    for (std::size_t k = 0; k < pings; ++k)
      without[k].add(column(u, "pd_ever")[k], column(u, "pd_ever_low")[k],
                     column(u, "pd_ever_high")[k], ever[k]);
  }
  const auto covers = [](const support::Coverage& c, double truth) {
    EXPECT_GE(c.held, c.least());
    EXPECT_NEAR(c.mean(), truth, 5.0 * c.deviation() / std::sqrt(double(c.count)));
  };
  for (std::size_t k = 0; k < pings; ++k) {
    covers(in_ping[k], each * tail(thresholds.at(k)));
    covers(so_far[k], ever[k]);
    if (k > 0) covers(begun[k], track[k]);
    EXPECT_NEAR(range[k].mean(), 1000.0 * double(k + 1),
                5.0 * range[k].deviation() / std::sqrt(60.0));
    EXPECT_NEAR(first_time[k].mean(), ever[k] - (k > 0 ? ever[k - 1] : 0.0),
                5.0 * first_time[k].deviation() / std::sqrt(60.0));
    EXPECT_EQ(without[k].held, 0);
    std::cout << "ping " << k + 2 << ": held " << in_ping[k].held << ", so far " << so_far[k].held
              << ", track " << begun[k].held << ", so far without weights " << without[k].held
              << " of 60\n";
  }
  EXPECT_GE(when.held, when.least());
}

TEST(WeightedPings, WithAllWeightsAlikeTheTablesAreThoseWithoutThem) {
  const Study study = study_of_pings();
  Table rows = rows_of(4, 500, 0.3, 0.1);
  const auto plain = ping_tables(study, rows);
  rows.columns.push_back({.name = log_weight_column, .unit = "1", .role = Column::Role::weight});
  rows.values.emplace_back(std::vector<double>(500, 0.0));
  const auto with = ping_tables(study, rows);
  const SummaryTable &a = named(plain, "pings"), &b = named(with, "pings");
  for (const char* name : {"ping", "count", "known"}) EXPECT_EQ(column(a, name), column(b, name));
  for (std::size_t k = 0; k < pings; ++k) {
    for (const char* name :
         {"time", "range", "pd", "pd_ever", "first", "pd_ever_independent", "ptrack"})
      EXPECT_NEAR(column(a, name)[k], column(b, name)[k], 1e-9) << name;
    const double n = column(b, "count")[k], hits = n * column(a, "pd_ever")[k];
    EXPECT_NEAR(column(b, "pd_ever_effective")[k], std::min(hits, n - hits), 1e-6);
    EXPECT_NEAR(column(b, "pd_ever_largest_share")[k], 1.0 / std::min(hits, n - hits), 1e-9);
  }
  EXPECT_EQ(column(named(plain, "first_detection"), "ping").front(),
            column(named(with, "first_detection"), "ping").front());
}

/// The message of a study that is refused, "" of one that is read.
std::string refusal(const std::string& measure, const std::string& more = "") {
  const support::TemporaryDirectory folder;
  try {
    static_cast<void>(
        read_study(folder.write("study.toml", "[study]\nrealisations = 2\n[measure]\n" + measure +
                                                  support::plain_sea + more)));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(PingReader, SaysWhatItWants) {
  const auto holds = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  const std::string five = "count = 5\ninterval = 10.0\n";
  EXPECT_TRUE(holds(refusal("echo_level = true\npings = true\n", five), "a detection with them"));
  EXPECT_TRUE(holds(refusal("detection = true\npings = true\n"), "two pings or more"));
  EXPECT_TRUE(
      holds(refusal("detection = true\npings = { initiation = [3, 2] }\n", five), "m at most n"));
  EXPECT_TRUE(holds(refusal("detection = true\npings = { initiation = [3, 6] }\n", five),
                    "at most the 5 pings"));
  EXPECT_TRUE(holds(refusal("detection = true\npings = { count = 6 }\n", five), "pings.count"));
  EXPECT_EQ(
      refusal("detection = true\npings = { first = 2, count = 4, initiation = [3, 4] }\n", five),
      "");
}

TEST(PingReader, TakesRowsThatHaveWeights) {
  EXPECT_EQ(refusal("detection = true\ntarget_place = true\npings = true\n[summary]\nmap = true\n"
                    "[vary]\n\"target.0.strength_db\" = { law = \"normal\", mean = 10.0, "
                    "deviation = 3.0 }\n[[rare.component]]\ncentre = { strength_db = 2.0 }\n",
                    "count = 5\ninterval = 10.0\n"),
            "");
}

TEST(PingRow, ItsOwnPingIsOneOfTheRun) {
  // The row's `detected` is that of `ping`, which is asked for once; other pings are other noise.
  const support::TemporaryDirectory folder;
  const Study study =
      read_study(folder.write("study.toml",
                              "[study]\nrealisations = 40\n[measure]\nping = 2\ndetection = { "
                              "false_alarm_probability = 1e-2 }\npings = true\n" +
                                  std::string(support::plain_sea) + "count = 3\ninterval = 10.0\n"),
                 std::vector<std::string>{"noise.spectral_level_db=93.0"});
  const std::vector<Column> all = columns(study);
  const auto at = [&](const std::string& name) {
    const auto it = std::find_if(all.begin(), all.end(),
                                 [&](const Column& column) { return column.name == name; });
    EXPECT_NE(it, all.end()) << name;
    return static_cast<std::size_t>(it - all.begin());
  };
  EXPECT_EQ(all[at("ping_2_detected")].role, Column::Role::ping);
  EXPECT_EQ(all[at("detected_ever")].role, Column::Role::measure);
  EXPECT_LT(at("detected_ever"), at("detected"));  // what the study is about
  const Realiser realiser(study);
  int differ = 0, hits = 0;
  for (std::uint64_t index = 0; index < 40; ++index) {
    const Row row = realiser.realise(index);
    ASSERT_EQ(row.values.size(), all.size());
    EXPECT_EQ(row.values[at("detected")], row.values[at("ping_2_detected")]);
    EXPECT_EQ(row.values[at("ping_3_time")], 20.0);
    EXPECT_EQ(row.values[at("ping_3_range")], 3000.0);
    differ += row.values[at("ping_1_detected")] != row.values[at("ping_3_detected")] ? 1 : 0;
    hits += static_cast<int>(row.values[at("detections")]);
    EXPECT_EQ(row.values[at("detected_ever")], row.values[at("detections")] > 0.0 ? 1.0 : 0.0);
  }
  EXPECT_GT(differ, 0);
  EXPECT_GT(hits, 0);
  EXPECT_LT(hits, 120);
}

}  // namespace
}  // namespace asdic::detail::study
