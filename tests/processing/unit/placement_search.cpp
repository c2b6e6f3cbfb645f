#include "processing/placement/placement_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/random.h"
#include "support/deep.h"

namespace asdic::detail {
namespace {

/// A field of sensors that each see a disc with a soft edge; cells of a square, two draws.
PlacementProblem random_field(std::uint64_t seed, std::size_t places, std::size_t options,
                              std::size_t sensors, std::size_t at_least, bool pairs) {
  constexpr std::size_t side = 6, draws = 2;
  RandomStream random(seed, Draw::study_input, 0, 0);
  PlacementProblem problem{
      .pairs = pairs, .sensors = sensors, .at_least = at_least, .draws = draws, .maps = {}};
  double sum = 0.0;
  for (std::size_t c = 0; c < side * side; ++c) {
    problem.weight.push_back(random.uniform());
    sum += problem.weight.back();
  }
  for (double& w : problem.weight) w /= sum;
  std::vector<double> x, y, reach;
  for (std::size_t p = 0; p < places; ++p)
    for (std::size_t o = 0; o < options; ++o) {
      x.push_back(o == 0 ? random.uniform() : x.back());
      y.push_back(o == 0 ? random.uniform() : y.back());
      reach.push_back(0.15 + 0.25 * random.uniform());
      problem.candidates.push_back({.place = p, .option = o});
    }
  const auto map = [&](std::size_t a, std::size_t b) {
    std::vector<float> p;
    for (std::size_t d = 0; d < draws; ++d)
      for (std::size_t c = 0; c < side * side; ++c) {
        const double cx = (double(c % side) + 0.5) / side, cy = (double(c / side) + 0.5) / side;
        const double way =
            0.5 * (std::hypot(cx - x[a], cy - y[a]) + std::hypot(cx - x[b], cy - y[b]));
        p.push_back(float(random.uniform() / (1.0 + std::exp(20.0 * (way - reach[a])))));
      }
    return p;
  };
  for (std::size_t a = 0; a < x.size(); ++a)
    if (pairs)
      for (std::size_t b = 0; b < x.size(); ++b) problem.maps.push_back(map(a, b));
    else
      problem.maps.push_back(map(a, a));
  return problem;
}

/// P(at least k detect) by all outcomes of the maps, one by one.
double share_by_outcomes(const PlacementProblem& problem, const SensorSet& set) {
  std::vector<const std::vector<float>*> maps;
  for (const std::size_t a : set) {
    if (!problem.pairs) maps.push_back(&problem.maps[a]);
    for (const std::size_t b : set)
      if (problem.pairs) maps.push_back(&problem.maps[a * problem.candidates.size() + b]);
  }
  const std::size_t cells = problem.weight.size();
  double share = 0.0;
  for (std::size_t x = 0; x < problem.draws * cells; ++x)
    for (std::size_t outcome = 0; outcome < std::size_t{1} << maps.size(); ++outcome) {
      double p = 1.0;
      std::size_t hits = 0;
      for (std::size_t m = 0; m < maps.size(); ++m) {
        const bool hit = (outcome >> m & 1U) != 0;
        p *= hit ? double((*maps[m])[x]) : 1.0 - double((*maps[m])[x]);
        hits += hit ? 1 : 0;
      }
      if (hits >= problem.at_least) share += problem.weight[x % cells] * p / double(problem.draws);
    }
  return share;
}

/// All sets, by counting up; nothing of the search's own code but the value of a set.
struct BruteForce {
  double best = -1.0, second = -1.0;
  SensorSet set;
  double count = 0.0;
};
BruteForce brute_force(const PlacementProblem& problem) {
  BruteForce found;
  const std::size_t n = problem.candidates.size();
  std::vector<char> in(n, 0);
  std::fill_n(in.begin(), problem.sensors, char{1});
  do {
    SensorSet set;
    std::vector<std::size_t> places;
    for (std::size_t c = 0; c < n; ++c)
      if (in[c] != 0) {
        set.push_back(c);
        places.push_back(problem.candidates[c].place);
      }
    if (std::adjacent_find(places.begin(), places.end()) != places.end()) continue;
    found.count += 1.0;
    double value = 0.0;
    for (const double one : shares_of(problem, set)) value += one / double(problem.draws);
    if (value > found.best) {
      found.second = found.best;
      found.best = value;
      found.set = set;
    } else {
      found.second = std::max(found.second, value);
    }
  } while (std::prev_permutation(in.begin(), in.end()));
  return found;
}

TEST(PlacementSearch, ASetIsWorthWhatItsOutcomesAre) {
  for (const bool pairs : {false, true})
    for (const std::size_t at_least : {1U, 2U, 3U}) {
      const PlacementProblem problem = random_field(5, 5, 1, 3, at_least, pairs);
      const SensorSet set{0, 2, 4};
      double mean = 0.0;
      for (const double one : shares_of(problem, set)) mean += 0.5 * one;
      EXPECT_NEAR(mean, share_by_outcomes(problem, set), 1e-12) << pairs << at_least;
    }
}

TEST(PlacementSearch, CountsItsSets) {
  // 7 places with 2 options: C(7, 3)·2³.
  EXPECT_EQ(number_of_sets(random_field(1, 7, 2, 3, 1, false)), 35.0 * 8.0);
}

struct Kind {
  const char* name;
  std::size_t options, at_least;
  bool pairs;
};
const Kind kinds[] = {{"one detection", 1, 1, false},
                      {"two pulses", 2, 1, false},
                      {"two detections", 1, 2, false},
                      {"multistatic", 1, 1, true},
                      {"multistatic, two detections", 1, 2, true}};

// Looking at all sets must find what counting up finds, and the second best; the bound of the
// search by swaps must hold, and swaps from eleven starts find the best set nearly always. How
// often greedy choice and its swaps alone do not is counted: they are no proof.
TEST(PlacementSearch, IsTheBestOfAllSetsOnSmallMaps) {
  const std::uint64_t fields = support::deep() ? 400 : 24;
  for (const Kind& kind : kinds) {
    int greedy = 0, swapped = 0, started = 0;
    double worst = 0.0, loosest = 0.0;
    for (std::uint64_t seed = 1; seed <= fields; ++seed) {
      const PlacementProblem problem =
          random_field(seed, 9, kind.options, 3, kind.at_least, kind.pairs);
      const BruteForce truth = brute_force(problem);
      const PlacementChoice all = choose_sensors(problem, {.method = PlacementMethod::exhaustive});
      ASSERT_NEAR(all.value, truth.best, 1e-12) << kind.name << seed;
      ASSERT_EQ(all.best, truth.set) << kind.name << seed;
      ASSERT_NEAR(all.runner_value, truth.second, 1e-12) << kind.name << seed;
      ASSERT_TRUE(all.proved);
      ASSERT_EQ(truth.count, number_of_sets(problem));
      const PlacementChoice found = choose_sensors(problem, {.method = PlacementMethod::swap});
      ASSERT_LE(truth.best, found.upper_bound + 1e-12) << kind.name << seed;
      ASSERT_LE(found.value, truth.best + 1e-12);
      ASSERT_LE(found.greedy_value.back(), found.swapped_value + 1e-12);
      greedy += found.greedy_value.back() < truth.best - 1e-9 ? 1 : 0;
      swapped += found.swapped_value < truth.best - 1e-9 ? 1 : 0;
      started += found.value < truth.best - 1e-9 ? 1 : 0;
      worst = std::max(worst, 1.0 - found.swapped_value / truth.best);
      loosest = std::max(loosest, found.upper_bound - truth.best);
      // Nemhauser, Wolsey & Fisher, Math. Program. 14, 265, 1978: 1 − 1/e of a cardinality, and
      // half of a matroid.
      if (!kind.pairs && kind.at_least == 1) {
        ASSERT_GE(found.greedy_value.back(),
                  (kind.options == 1 ? 1.0 - std::exp(-1.0) : 0.5) * truth.best);
      }
    }
    RecordProperty(std::string(kind.name) + ": fields", int(fields));
    std::printf(
        "%-28s of %d fields: greedy misses the best in %d, after swaps %d (by at most %.2f %%), "
        "from 11 starts %d; bound above the best by at most %.3f\n",
        kind.name, int(fields), greedy, swapped, 100.0 * worst, started, loosest);
    EXPECT_LE(started, int(fields) / 24) << kind.name;
  }
}

// Maps that share no cell: gains add up, and the bound is the best itself, of pulses too.
TEST(PlacementSearch, TheBoundIsTightWhereMapsDoNotMeet) {
  for (const bool pairs : {false, true})
    for (const std::size_t at_least : {std::size_t{1}, std::size_t{2}}) {
      if (pairs && at_least > 1) continue;
      PlacementProblem problem{.pairs = pairs, .sensors = 3, .at_least = at_least, .maps = {}};
      constexpr std::size_t count = 10;
      for (std::size_t c = 0; c < count; ++c) {
        problem.candidates.push_back({.place = c / 2, .option = c % 2});
        problem.weight.push_back(1.0 / double(count));
      }
      for (std::size_t a = 0; a < count; ++a)
        for (std::size_t b = 0; b < (pairs ? count : 1); ++b) {
          std::vector<float> map(count, 0.0F);
          if (!pairs || a == b) map[a] = 0.05F * float(a + 1);
          problem.maps.push_back(map);
        }
      const PlacementChoice found = choose_sensors(problem, {.method = PlacementMethod::swap});
      // The better option of the three best places: 0.5, 0.4 and 0.3 of a tenth each.
      const double best = at_least == 1 ? 0.12 : 0.0;
      EXPECT_NEAR(found.value, best, 1e-8);
      EXPECT_NEAR(found.upper_bound, at_least == 1 ? best : 0.06, 1e-8);  // Markov's: half of it
      EXPECT_EQ(found.proved, at_least == 1);
    }
}

// A case made so that greedy choice fails: the middle disc is the largest, the two others together
// see everything. One swap cannot leave the middle alone either way; here it can.
TEST(PlacementSearch, SwapsMendWhatGreedBegan) {
  PlacementProblem problem{
      .candidates = {{0, 0}, {1, 0}, {2, 0}},
      .sensors = 2,
      .weight = {0.25, 0.25, 0.25, 0.25},
      .maps = {{0.9F, 0.9F, 0.0F, 0.0F}, {0.0F, 0.95F, 0.95F, 0.0F}, {0.0F, 0.0F, 0.9F, 0.9F}}};
  const PlacementChoice found = choose_sensors(problem, {.method = PlacementMethod::swap});
  EXPECT_EQ(found.greedy.front(), SensorSet{1});
  EXPECT_EQ(found.best, (SensorSet{0, 2}));
  EXPECT_NEAR(found.value, 0.9, 1e-6);
  EXPECT_EQ(found.swaps, 1);
  EXPECT_LT(found.greedy_value.back(), 0.9 - 0.1);
}

// Multistatic values are not submodular: a second sensor may bring more than the first one did.
TEST(PlacementSearch, PairsAreNotSubmodular) {
  const std::vector<float> nothing{0.0F}, much{0.9F};
  PlacementProblem problem{.candidates = {{0, 0}, {1, 0}, {2, 0}},
                           .pairs = true,
                           .sensors = 2,
                           .weight = {1.0},
                           .maps = {nothing, much, nothing, much, nothing, nothing, nothing,
                                    nothing, std::vector<float>{0.5F}}};
  const PlacementChoice found = choose_sensors(problem, {.method = PlacementMethod::swap});
  // Greed takes the third sensor, which is the best alone, and is left with it: less than any
  // submodular value would allow.
  EXPECT_EQ(found.greedy.front(), SensorSet{2});
  EXPECT_EQ(found.best, (SensorSet{0, 1}));
  EXPECT_NEAR(found.value, 1.0 - 0.1 * 0.1, 1e-6);
  EXPECT_NEAR(found.greedy_value.back(), 0.5, 1e-6);
  EXPECT_LT(found.greedy_value.back(), (1.0 - std::exp(-1.0)) * found.value);
}

TEST(PlacementSearch, CanBeStopped) {
  const PlacementProblem problem = random_field(3, 12, 1, 4, 1, false);
  int calls = 0;
  EXPECT_THROW(static_cast<void>(choose_sensors(problem, {}, [&](double) { return ++calls < 3; })),
               Interrupted);
}

}  // namespace
}  // namespace asdic::detail
