#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"
#include "study/reader/study_reader.h"
#include "study/summary/summary.h"
#include "support/realised.h"
#include "support/summary_tables.h"

// A run of pings of the known answer: a Swerling target in white noise, whose probabilities over
// several pings are closed forms.

namespace asdic::detail::study {
namespace {

constexpr int pings = 5;

/// A target that closes in from 40 km at 15 m/s: 4.5 km from ping to ping.
/// \param scan_pings  that have one draw of the target's power
Study crossing(int scan_pings, int rows) {
  const std::filesystem::path file =
      std::filesystem::path(ASDIC_SCENARIOS) / "studies/known_answer.toml";
  const std::vector<std::string> set{
      "study.realisations=" + std::to_string(rows),
      "pings.count=5",
      "pings.interval=300.0",
      "target.0.fluctuation=swerling-1",
      "target.0.scan_pings=" + std::to_string(scan_pings),
      "target.0.velocity=[-15.0, 0.0, 0.0]",
      "vary.\"target.0.range\".low=39.999e3",
      "vary.\"target.0.range\".high=40.0e3",
      "vary.\"target.0.bearing_deg\"={law=\"uniform\", low=89.999, high=90.001}",
      "measure.pings={initiation=[2, 3]}",
      "summary.by=[]",
      "summary.confidence=0.999"};
  return read_study(file, set);
}

SummaryTable pings_of(const Study& study) {
  for (SummaryTable& one : summarise(study, support::realised(study)))
    if (one.name == "pings") return std::move(one);
  throw std::runtime_error("no table pings");
}

/// Of ping k: SNR = RL + 10 lg E − NL, the target where the sound strikes it.
double snr(int k) {
  const double sent = 40e3 - 15.0 * 300.0 * k;
  const double range = sent * 1500.0 / 1515.0;
  return power_from_db(200.0 - 40.0 * std::log10(range) + 30.0 - 32.0) * 0.375 * 0.25;
}

/// P(|√S a + n|² > x) of an amplitude with power g·S: Marcum's Q₁(√(2gS), √(2x)), as a sum.
double marcum(double s, double x) {
  double sum = 0.0, weight = std::exp(-s), tail = 0.0, term = std::exp(-x);
  for (int j = 0; j < 400; ++j) {
    tail += term;
    sum += weight * tail;
    weight *= s / (j + 1.0);
    term *= x / (j + 1.0);
  }
  return sum;
}

TEST(OverPings, DrawsOfEachPingMultiplyWhatIsMissed) {
  // A draw for each ping, as of Swerling 2: pings are independent, P_k = P_fa^(1/(1 + SNR_k)),
  // P_ever = 1 − Π(1 − P_k).
  const SummaryTable t = pings_of(crossing(1, 1200));
  double missed = 1.0;
  // P(no two hits within three in a row), by the last two outcomes.
  double none = 1.0, last = 0.0, before = 0.0;
  for (int k = 0; k < pings; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const double p = std::pow(1e-4, 1.0 / (1.0 + snr(k)));
    EXPECT_LT(column(t, "pd_low")[at], p) << k;
    EXPECT_GT(column(t, "pd_high")[at], p) << k;
    missed *= 1.0 - p;
    EXPECT_LT(column(t, "pd_ever_low")[at], 1.0 - missed) << k;
    EXPECT_GT(column(t, "pd_ever_high")[at], 1.0 - missed) << k;
    const double new_last = none * p, new_before = last * (1.0 - p);
    none = (none + before) * (1.0 - p);
    last = new_last;
    before = new_before;
    const double track = 1.0 - none - last - before;
    EXPECT_LE(column(t, "ptrack_low")[at], track + 1e-12) << k;
    EXPECT_GE(column(t, "ptrack_high")[at], track) << k;
    EXPECT_EQ(column(t, "time")[at], 300.0 * k);
    EXPECT_NEAR(column(t, "range")[at], 40e3 - 4500.0 * k, 2.0);
  }
}

TEST(OverPings, OneDrawOfAScanIsNoFiveDraws) {
  // Swerling 1, a scan of all five pings: their draw g ~ Exp(1) is one. Given it pings are
  // independent, so P_ever = ∫ (1 − Π(1 − Q₁(√(2g SNR_k), √(2 ln 1/P_fa)))) e^{−g} dg.
  const SummaryTable t = pings_of(crossing(5, 1200));
  const double threshold = -std::log(1e-4);
  constexpr int steps = 4000;
  std::vector<double> ever(pings, 0.0);
  for (int i = 0; i < steps; ++i) {
    const double g = -std::log1p(-(i + 0.5) / steps);
    double missed = 1.0;
    for (int k = 0; k < pings; ++k) {
      missed *= 1.0 - (g * snr(k) > 200.0 ? 1.0 : marcum(g * snr(k), threshold));
      ever[static_cast<std::size_t>(k)] += (1.0 - missed) / steps;
    }
  }
  for (std::size_t k = 0; k < pings; ++k) {
    EXPECT_LT(column(t, "pd_ever_low")[k], ever[k]) << k;
    EXPECT_GT(column(t, "pd_ever_high")[k], ever[k]) << k;
  }
  // The wrong model: independent pings.
  EXPECT_GT(column(t, "pd_ever_independent").back(), column(t, "pd_ever_high").back() + 0.02);
}

}  // namespace
}  // namespace asdic::detail::study
