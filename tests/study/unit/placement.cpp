#include "study/placement/placement_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "core/error.h"
#include "core/memory_budget.h"
#include "core/random.h"
#include "io/files/output_file.h"
#include "io/scenario/scenario_reader.h"
#include "processing/coverage/coverage.h"
#include "study/placement/placement_file.h"
#include "study/placement/placement_reader.h"
#include "support/temporary_directory.h"

namespace asdic::detail::study {
namespace {

/// A buoy in noise, over a flat bottom or a slope that falls to the east; straight rays.
constexpr const char* buoy = R"(
[environment.sound_speed]
kind = "isovelocity"
speed = 1500.0
[environment.bottom]
kind = "fluid"
speed = 1600.0
density = 1500.0
depth = 400.0
[[platform]]
name = "buoy"
position = [0.0, 0.0, 0.0]
[transmitter]
offset = [0.0, 0.0, 60.0]
source_level_db = 206.0
taper = "omnidirectional"
[pulse]
kind = "cw"
frequency = 1000.0
duration = 0.1
[array]
offset = [0.0, 50.0, 70.0]
kind = "horizontal"
phones = 4
spacing = 0.7
heading_deg = 30.0
[[target]]
range = 2000.0
bearing_deg = 0.0
depth = 50.0
strength_db = 5.0
[noise]
spectral_level_db = 75.0
[reverberation]
enabled = false
[propagation]
max_surface_bounces = 1
max_bottom_bounces = 0
[pings]
recording_duration = 12.0
sample_rate = 4000.0
)";
constexpr const char* slope = R"(
[environment.bottom.shape]
range = [-20000.0, -4000.0, 4000.0, 20000.0]
depth = [30.0, 60.0, 400.0, 400.0]
[environment.transect]
origin = [0.0, 0.0]
bearing_deg = 90.0
)";
/// Five places and 9 × 9 cells.
constexpr const char* grids = R"(
[placement.places]
points = [[-3000.0, 0.0], [0.0, 0.0], [3000.0, 1000.0], [0.0, 3000.0], [1000.0, -3000.0]]
[placement.cells]
east = [-4500.0, 4500.0]
north = [-4500.0, 4500.0]
step = 1000.0
)";

class PlacementOfSensors : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  void write_slope() const {
    std::string text = buoy;
    const std::string flat = "depth = 400.0\n[[platform]]";
    text.replace(text.find(flat), flat.size(), "[[platform]]");
    write("slope.toml", text + slope);
  }
  [[nodiscard]] PlacementPlan read(const std::string& head, const std::string& tail = grids,
                                   const std::vector<std::string>& overrides = {}) const {
    write("buoy.toml", buoy);
    write_slope();
    write("plan.toml", "[placement]\nbearings = 36\nranges = 40\n" + head + tail);
    return read_placement(folder_.path() / "plan.toml", overrides);
  }
  /// The map of a scenario whose first platform is moved by hand. \param more  overrides
  [[nodiscard]] Coverage map_of(const std::string& file, const PlacementPlan& plan, const Vec2& at,
                                const std::string& others = "",
                                std::vector<std::string> more = {}) const {
    const std::string first = "{name=\"buoy\",position=[" + std::to_string(at.x()) + "," +
                              std::to_string(at.y()) + ",0.0]}";
    more.insert(more.begin(), "platform=[" + first + others + "]");
    more.emplace_back("target.0.range=300.0");  // where there is water
    Scenario scenario = read_scenario(folder_.path() / file, more);
    AreaWishes wishes = plan.wishes;
    wishes.depths = {50.0};
    if (!wishes.reach) wishes.reach = 6000.0;
    const CoverageSettings settings = coverage_settings(scenario, wishes);
    return coverage(PingSimulator(std::move(scenario)), settings);
  }
  /// What a map says of the middle of a cell.
  [[nodiscard]] static double at(const Coverage& map, const Vec2& cell) {
    const Vec2 off = cell - map.receiver.head<2>();
    const double turn = std::atan2(off.x(), off.y()) + (off.x() < 0.0 ? 2.0 * pi : 0.0);
    const auto i = static_cast<std::size_t>(off.norm() / map.settings.reach * map.settings.ranges);
    const auto j = static_cast<std::size_t>(turn / (2.0 * pi) * map.settings.bearings);
    if (i >= map.ranges.size()) return 0.0;
    const CoverageLayer& layer = map.layers[0];
    const std::size_t k = j * map.ranges.size() + i;
    if (layer.certainty[k] == std::int8_t(CoverageCertainty::no_water)) return 0.0;
    return double(layer.detection_probability[k]);
  }
  /// The share that the best of all pairs of maps has, by hand. \param maps  [sensors] of each set
  using Sets = std::vector<std::pair<SensorSet, std::vector<const Coverage*>>>;
  static std::pair<SensorSet, double> best_by_hand(const PlacementPlan& plan, const Sets& sets,
                                                   const std::vector<double>& weight) {
    std::pair<SensorSet, double> best{{}, -1.0};
    for (const auto& [set, maps] : sets) {
      double share = 0.0;
      for (std::size_t c = 0; c < plan.cells.size(); ++c) {
        double missed = 1.0;
        for (const Coverage* map : maps) missed *= 1.0 - at(*map, plan.cells[c]);
        share += weight[c] * (1.0 - missed);
      }
      if (share > best.second) best = {set, share};
    }
    return best;
  }
  support::TemporaryDirectory folder_;
};

// Five maps of 81 cells in 20 000 draws need at least 32 MB and are refused before any is made.
TEST_F(PlacementOfSensors, MapsKeepToRunMemory) {
  const std::string head =
      "scenario = \"buoy.toml\"\nsensors = 2\nmap_error = \"cells\"\njudging_draws = 2\n";
  try {
    static_cast<void>(
        place_sensors(read(head + "draws = 20000\n", grids, {"run.memory=\"20 MB\""})));
    ADD_FAILURE() << "32 MB of 20 MB";
  } catch (const MemoryError& error) {
    EXPECT_GT(error.needed(), 32e6);
    EXPECT_NE(std::string(error.what()).find("placement.draws"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("run.memory"), std::string::npos) << error.what();
  }
  const PlacementPlan within = read(head + "draws = 20\n", grids, {"run.memory=\"20 MB\""});
  EXPECT_EQ(place_sensors(within).choice.best.size(), 2U);
}

// Over a slope every place has a map of its own. The shallow west has no room for the buoy at
// [-3000, 0], nor all cells water for the target.
TEST_F(PlacementOfSensors, EqualsAllSetsOfMapsByHandOverASlope) {
  const PlacementPlan plan = read(
      "scenario = \"slope.toml\"\nsensors = 2\nclearance = 40.0\nreach = 5000.0\n"
      "[[placement.zone]]\neast = [0.0, 4500.0]\nnorth = [-4500.0, 4500.0]\nweight = 3.0\n");
  const Placement found = place_sensors(plan);
  // The floor at −3000 m: 60 + 340/8 = 102.5 m; the array at 70 m keeps 32.5 m.
  EXPECT_EQ(found.refused[0], PlaceRefused::too_shallow);
  EXPECT_EQ(std::count(found.refused.begin(), found.refused.end(), PlaceRefused::no), 4);
  std::vector<double> weight(plan.cells.size());
  double sum = 0.0;
  for (std::size_t c = 0; c < weight.size(); ++c)
    sum += weight[c] = plan.cells[c].x() >= 0.0 ? 3.0 : 1.0;  // the floor is deeper than 50 m
  for (double& w : weight) w /= sum;
  std::vector<Coverage> maps;
  for (const Vec2& place : plan.places)
    maps.push_back(place.x() < -2000.0 ? Coverage{} : map_of("slope.toml", plan, place));
  Sets sets;
  for (std::size_t a = 1; a < 5; ++a)
    for (std::size_t b = a + 1; b < 5; ++b) sets.push_back({{a - 1, b - 1}, {&maps[a], &maps[b]}});
  const auto [best, share] = best_by_hand(plan, sets, weight);
  EXPECT_EQ(found.choice.best, best);
  EXPECT_NEAR(found.choice.value, share, 1e-6);
  EXPECT_GT(share, 0.1);
  EXPECT_LT(share, 0.9);
  EXPECT_TRUE(found.choice.proved);
}

// A field of buoys that hear one another: each pair's map is that of a scenario with two platforms,
// written out.
TEST_F(PlacementOfSensors, PairsAreTwoPlatforms) {
  const PlacementPlan plan =
      read("scenario = \"buoy.toml\"\nsensors = 2\nmultistatic = true\nreach = 5000.0\n");
  const Placement found = place_sensors(plan);
  const std::size_t n = plan.places.size();
  std::vector<Coverage> maps;
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b) {
      const Vec2& there = plan.places[b];
      const std::string other = ",{name=\"other\",position=[" + std::to_string(there.x()) + "," +
                                std::to_string(there.y()) + ",0.0]}";
      maps.push_back(
          a == b ? map_of("buoy.toml", plan, plan.places[a])
                 : map_of("buoy.toml", plan, plan.places[a], other, {"array.platform=other"}));
    }
  Sets sets;
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = a + 1; b < n; ++b)
      sets.push_back(
          {{a, b}, {&maps[a * n + a], &maps[a * n + b], &maps[b * n + a], &maps[b * n + b]}});
  const std::vector<double> weight(plan.cells.size(), 1.0 / double(plan.cells.size()));
  const auto [best, share] = best_by_hand(plan, sets, weight);
  EXPECT_EQ(found.choice.best, best);
  EXPECT_NEAR(found.choice.value, share, 1e-6);
}

// Of two pulses the one that is heard is taken, at every place.
TEST_F(PlacementOfSensors, ChoosesThePulse) {
  const Placement found = place_sensors(
      read("scenario = \"buoy.toml\"\nsensors = 2\n[[placement.option]]\nname = \"faint\"\nset = "
           "{ \"transmitter.source_level_db\" = 180.0 }\n[[placement.option]]\nname = \"loud\"\n"));
  for (const std::size_t one : found.choice.best)
    EXPECT_EQ(found.problem.candidates[one].option, 1U);
  EXPECT_EQ(found.sets, 10.0 * 4.0);
}

// Two options that are alike: an array hears pings of its own alone, unless all are to be heard.
TEST_F(PlacementOfSensors, ArraysHearTheirOwnOption) {
  const auto found = [&](const std::string& across) {
    return place_sensors(
        read("scenario = \"buoy.toml\"\nsensors = 2\nmultistatic = true\n" + across +
                 "[[placement.option]]\nname = \"a\"\n[[placement.option]]\nname = \"b\"\n",
             "[placement.places]\npoints = [[-500.0, 0.0], [1000.0, 0.0]]\n[placement.cells]\n"
             "east = [-4000.0, 4000.0]\nnorth = [-4000.0, 4000.0]\nstep = 1000.0\n"));
  };
  const Placement own = found(""), all = found("across_options = true\n");
  const auto option = [](const Placement& of, const SensorSet& set, std::size_t m) {
    return of.problem.candidates[set[m]].option;
  };
  EXPECT_EQ(option(own, own.choice.best, 0), option(own, own.choice.best, 1));
  EXPECT_EQ(own.choice.value, all.choice.value);
  EXPECT_EQ(all.choice.runner_value, all.choice.value);  // whichever options
  double mixed = 0.0;  // of the four sets the two that hear nothing of one another
  for (const double share : own.alone) mixed = std::max(mixed, share);
  EXPECT_GT(own.choice.value, mixed);
}

// The draws that choose are quiet, those that judge are not: what is told is theirs.
TEST_F(PlacementOfSensors, FreshDrawsJudge) {
  const Placement found = place_sensors(
      read("scenario = \"buoy.toml\"\nsensors = 1\ndraws = 2\n",
           std::string(grids) +
               "[vary]\n\"noise.spectral_level_db\" = { law = \"list\", values = [50.0, 55.0, "
               "75.0, 150.0] }\n"));
  EXPECT_GT(found.choice.value, 0.3);
  ASSERT_EQ(found.best.size(), 2U);
  EXPECT_LT(found.best[0], 0.8 * found.choice.value);
  EXPECT_LT(found.best[1], 0.01);
}

// map_error moves the signal excess of cells by their own uncertainty: where there is none, nothing
// changes; drawn maps differ, and the same seed gives the same bits.
TEST_F(PlacementOfSensors, MapsErrAsTheySay) {
  const auto shares = [&](const std::string& kind, const std::string& seed) {
    return place_sensors(read("scenario = \"buoy.toml\"\nsensors = 1\ndraws = 6\nmap_error = \"" +
                              kind + "\"\nseed = " + seed + "\n"))
        .best;
  };
  const auto spread = [](const std::vector<double>& values) {
    Moments moments;
    for (const double value : values) moments.add(value);
    return moments.deviation();
  };
  const auto cells = shares("cells", "1"), maps = shares("maps", "1");
  EXPECT_EQ(cells, shares("cells", "1"));
  EXPECT_NE(cells, shares("cells", "2"));
  EXPECT_GT(spread(cells), 0.0);
  EXPECT_GT(spread(maps), 1.5 * spread(cells));  // what all cells share does not average out
}

TEST_F(PlacementOfSensors, IsReadFromItsFile) {
  const PlacementPlan plan =
      read("scenario = \"buoy.toml\"\nsensors = 2\ntarget_depths = [50.0, 500.0]\n");
  const Placement found = place_sensors(plan);
  const std::filesystem::path path = folder_.path() / "place.h5";
  write_placement(OutputFile(path), plan, found);
  const PlacementAnswer made = answer_of(plan, found), got = read_placement_answer(path);
  EXPECT_EQ(made.share, got.share);
  EXPECT_EQ(made.upper_bound, got.upper_bound);
  EXPECT_EQ(made.places, got.places);
  ASSERT_EQ(got.best.size(), 2U);
  EXPECT_EQ(made.best[1].east, got.best[1].east);
  EXPECT_EQ(made.best[1].option, got.best[1].option);
  EXPECT_EQ(made.best[1].without, got.best[1].without);
  EXPECT_EQ(got.judging, 0U);
  // At 500 m there is no water.
  for (std::size_t x = 0; x < found.detection.size(); ++x)
    EXPECT_EQ(std::isnan(found.detection[x]), x >= plan.cells.size());
}

TEST_F(PlacementOfSensors, TellsWhatIsWrong) {
  const auto message = [&](const std::string& head, const std::string& tail = grids) {
    try {
      static_cast<void>(place_sensors(read(head, tail)));
    } catch (const InputError& error) {
      const std::string text = error.what();
      return text.substr(text.find("plan.toml"));
    }
    return std::string("nothing");
  };
  EXPECT_EQ(
      message("sensors = 2\n"),
      "plan.toml:1: placement.scenario: found none, expected the scenario file of the sensor, "
      "or [[placement.option]]");
  EXPECT_EQ(message("scenario = \"buoy.toml\"\nsensors = 0\n"),
            "plan.toml:5: placement.sensors: found 0, expected a whole number from 1 to 1000");
  EXPECT_EQ(message("scenario = \"buoy.toml\"\nsensors = 2\nat_least = 3\n"),
            "plan.toml:6: placement.at_least: found 3, expected a whole number from 1 to 2");
  EXPECT_EQ(
      message("scenario = \"buoy.toml\"\nsensors = 2\ndraws = 4\n"),
      "plan.toml:6: placement.draws: found 4, expected [vary] or map_error beside it: without "
      "them nothing is drawn");
  EXPECT_EQ(
      message("scenario = \"buoy.toml\"\nsensors = 2\n",
              "[placement.places]\npoints = [[0.0, 0.0], [0.0, 1.0]]\n[placement.cells]\n"
              "east = [0.0, 2500.0]\nnorth = [0.0, 2000.0]\nstep = 1000.0\n"),
      "plan.toml:9: placement.cells.east: found 2500 m, expected whole cells of step = 1000 m");
  EXPECT_EQ(
      message("scenario = \"buoy.toml\"\nsensors = 2\nacross_options = true\n"),
      "plan.toml:6: placement.across_options: found true, expected multistatic = true beside it");
  EXPECT_EQ(message("scenario = \"buoy.toml\"\nsensors = 6\n"),
            "plan.toml: placement.places: found 5 places that 5 candidates leave (the others are "
            "too shallow or off the map), expected at least one for each of the 6 sensors");
}

// Which of many sets that are all alike looks best in some draws is chance. In fresh draws its
// share is what every set has, 1 − ½², its difference from the runner-up is 0, and intervals hold
// these as often as they say; of the draws that chose, the share is too good. Counted over 1000
// choices.
TEST(PlacementDraws, ThoseThatChoseMayNotJudge) {
  constexpr int choices = 1000;
  constexpr std::size_t places = 8, cells = 4, draws = 10;
  int fresh = 0, same = 0, difference = 0;
  for (std::uint32_t n = 0; n < choices; ++n) {
    RandomStream random(31, Draw::study_noise, n, 0);
    const auto draw = [&] {
      PlacementProblem problem{
          .sensors = 2, .draws = draws, .weight = {0.25, 0.25, 0.25, 0.25}, .maps = {}};
      for (std::size_t p = 0; p < places; ++p) {
        problem.candidates.push_back({.place = p});
        std::vector<float> map;
        for (std::size_t x = 0; x < draws * cells; ++x) map.push_back(float(random.uniform()));
        problem.maps.push_back(map);
      }
      return problem;
    };
    const PlacementProblem choosing = draw(), judging = draw();
    const PlacementChoice choice = choose_sensors(choosing, {});
    const auto holds = [&](const PlacementProblem& problem, bool against, double truth) {
      const auto a = shares_of(problem, choice.best), b = shares_of(problem, choice.runner_up);
      Moments values;
      for (std::size_t d = 0; d < draws; ++d) values.add(against ? a[d] - b[d] : a[d]);
      const Interval interval = difference_of_means(values, 0.95).interval;
      return interval.low <= truth && truth <= interval.high ? 1 : 0;
    };
    fresh += holds(judging, false, 0.75);
    same += holds(choosing, false, 0.75);
    difference += holds(judging, true, 0.0);
  }
  EXPECT_NEAR(fresh / double(choices), 0.95, 5.0 * 0.0069);
  EXPECT_NEAR(difference / double(choices), 0.95, 5.0 * 0.0069);
  EXPECT_LT(same / double(choices), 0.75);
}

}  // namespace
}  // namespace asdic::detail::study
