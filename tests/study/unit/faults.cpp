#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>

#include "core/error.h"
#include "study/measures/realisation.h"
#include "study/reader/study_reader.h"
#include "support/plain_sea.h"
#include "support/temporary_directory.h"

namespace asdic::detail::study {
namespace {

using support::plain_sea;

/// Reads a study whose own tables come first, so that their lines are known. \return the message
std::string fault_of(const std::string& tables) {
  const support::TemporaryDirectory folder;
  const std::filesystem::path path = folder.path() / "study.toml";
  std::ofstream(path) << tables << plain_sea;
  try {
    static_cast<void>(read_study(path));
  } catch (const InputError& error) {
    const std::string text = error.what();
    const auto at = text.find("study.toml");
    return at == std::string::npos ? text : text.substr(at);
  }
  return "no fault";
}

struct Fault {
  std::string tables, message;
};

TEST(StudyFile, EveryFaultNamesLineKeyFoundAndExpected) {
  const std::string study = "[study]\nrealisations = 10\n", vary = study + "[vary]\n",
                    measure = "[measure]\necho_level = true\n";
  const std::vector<Fault> faults{
      {"[vary]\n",
       "study.toml:1: study: found no [study], expected a [study] with its "
       "realisations: a study file"},
      {"[study]\n",
       "study.toml:1: study.realisations: found nothing, expected a whole number "
       "from 1 to 1000000000000000"},
      {"[study]\nrealisations = 0\n",
       "study.toml:2: study.realisations: found 0, expected a whole "
       "number from 1 to 1000000000000000"},
      {study + "design = \"latin\"\n",
       "study.toml:3: study.design: found \"latin\", expected \"random\", \"latin_hypercube\", "
       "\"sobol\", \"grid\" or \"saltelli\""},
      {study + "blocks = 5\n",
       "study.toml:3: study.blocks: found 5, expected no \"blocks\" but beside design = "
       "\"saltelli\""},
      {study + "design = \"sobol\"\nchance = true\n",
       "study.toml:4: study.chance: found true, expected no \"chance\" but beside design = "
       "\"saltelli\""},
      {study + "replicates = 4\n",
       "study.toml:3: study.replicates: found 4, expected no \"replicates\" but beside design = "
       "\"sobol\""},
      {study + "design = \"sobol\"\nreplicates = 4\n" + measure,
       "study.toml:2: study.realisations: found 10, expected a multiple of 4, the replicates, such "
       "as 12"},
      {study + "design = \"saltelli\"\nblocks = 5\n",
       "study.toml:2: study.realisations: found 10, expected no \"realisations\" beside blocks"},
      {study + "design = \"saltelli\"\n" + measure,
       "study.toml:3: study.design: found \"saltelli\", expected inputs in [vary], whose indices "
       "it is for"},
      {study +
           "design = \"saltelli\"\nsecond_order = true\nchance = true\n[vary]\n"
           "\"environment.wind_speed\" = { law = \"uniform\", low = 3, high = 4 }\n" +
           measure,
       "study.toml:2: study.realisations: found 10, expected a multiple of 6, the rows of a block "
       "(A, B and two for each of the 2 groups), such as 12"},
      {"[study]\nblocks = 3\ndesign = \"saltelli\"\ngroups = [[\"wind\"]]\n[vary]\n"
       "\"environment.wind_speed\" = { law = \"uniform\", low = 3, high = 4 }\n" +
           measure,
       "study.toml:4: study.groups[0][0]: found \"wind\", expected an input, one of "
       "\"wind_speed\""},
      {"[study]\nblocks = 3\ndesign = \"saltelli\"\ngroups = [[\"wind_speed\"], [\"wind_speed\"]]\n"
       "[vary]\n\"environment.wind_speed\" = { law = \"uniform\", low = 3, high = 4 }\n" +
           measure,
       "study.toml:4: study.groups[1][0]: found \"wind_speed\" twice, expected every input once"},
      {study + "groups = []\n",
       "study.toml:3: study.groups: found an array of 0, expected no \"groups\" but beside design "
       "= "
       "\"saltelli\""},
      {study + "design = \"saltelli\"\n[vary]\n"
               "\"environment.wind_speed\" = { law = \"list\", values = [3, 4] }\n",
       "study.toml:5: vary.\"environment.wind_speed\".law: found \"list\", expected "
       "\"categorical\" or \"grid\" in Saltelli's design, whose values are all drawn"},
      {study + "sede = 1\n",
       "study.toml:3: study.sede: found an unknown key, expected a known key "
       "(did you mean \"seed\"?)"},
      {study + "on_error = \"ignore\"\n",
       "study.toml:3: study.on_error: found \"ignore\", expected "
       "\"stop\" or \"skip\""},
      {study + "scenario = \"no.toml\"\n", "study.toml:3: study.scenario: found no such file"},
      {vary + "x = 3\n", "study.toml:4: vary.x: found 3, expected a table"},
      {vary + "\"environment.wind_speed\" = { law = \"gauss\" }\n" + measure,
       "study.toml:4: vary.\"environment.wind_speed\".law: found \"gauss\", expected \"uniform\""},
      {vary + "\"environment.wind_speed\" = { law = \"uniform\", low = 5, high = 4 }\n" + measure,
       "study.toml:4: vary.\"environment.wind_speed\".high: found 4, expected a number above 5"},
      {vary + "\"environment.wind_speed\" = { law = \"uniform\", low = 5 }\n" + measure,
       "study.toml:4: vary.\"environment.wind_speed\".high: found nothing"},
      {vary + "\"environment.wind_speed\" = { law = \"normal\", mean = 5, deviation = 0 }\n",
       "study.toml:4: vary.\"environment.wind_speed\".deviation: found 0, expected a number above "
       "0"},
      {vary + "\"environment.wind_speed\" = { law = \"normal\", mean = 5, deviation = 1, min = 9, "
              "max = 8 }\n",
       "study.toml:4: vary.\"environment.wind_speed\".max: found 8, expected a number above min, "
       "9"},
      {vary + "\"environment.wind_speed\" = { law = \"uniform\", low = 5, high = 6, min = 7 }\n",
       "study.toml:4: vary.\"environment.wind_speed\".min: found 7, expected limits within which "
       "the law has values"},
      {study +
           "design = \"sobol\"\n[vary]\n\"environment.wind_speed\" = { law = \"list\", values = "
           "[1, 2] }\n" +
           measure,
       "study.toml:5: vary.\"environment.wind_speed\".law: found \"list\", expected "
       "\"categorical\" "
       "or \"grid\" for an even number of values in a Sobol' design"},
      {vary + "\"environment.wind_speed\" = { law = \"rayleigh\" }\n",
       "study.toml:4: vary.\"environment.wind_speed\".mean: found nothing, expected a number above "
       "0, or \"scale\""},
      {vary + "\"environment.wind_speed\" = { law = \"categorical\" }\n",
       "study.toml:4: vary.\"environment.wind_speed\".values: found nothing, expected an array of "
       "values"},
      {vary + "\"environment.wind_speed\" = { law = \"categorical\", values = [1, 2], weights = "
              "[1] }\n",
       "study.toml:4: vary.\"environment.wind_speed\".weights: found an array of 1, expected as "
       "many weights as there are values, 2"},
      {vary + "\"environment.wind_speed\" = { law = \"grid\", from = 1, to = 2, count = 1 }\n",
       "study.toml:4: vary.\"environment.wind_speed\".count: found 1, expected a whole number from "
       "2 to 1000000"},
      {vary + "wind = { keys = [\"\"], law = \"uniform\", low = 1, high = 2 }\n",
       "study.toml:4: vary.wind.keys: found an array of 1, expected an array of keys, each in "
       "quotes"},
      {vary + "wind = { keys = [], law = \"track\", range = 1000.0, depth = 50.0 }\n",
       "study.toml:4: vary.wind.keys: found an array of 0, expected a key to write: this law draws "
       "no single number"},
      {vary + "pair = { keys = [\"environment.wind_speed\", \"target.0.strength_db\"], law = "
              "\"list\", rows = [[1, 2], [3]] }\n",
       "study.toml:4: vary.pair.rows[1]: found an array of 1, expected an array of a value for "
       "each "
       "of the 2 keys"},
      {vary + "\"target.0.strenght_db\" = { law = \"uniform\", low = 1, high = 2 }\n" + measure,
       "study.toml:4: target[0].strenght_db: found an unknown key (realisation 0: strenght_db = "},
      {vary + "\"target.3.strength_db\" = { law = \"uniform\", low = 1, high = 2 }\n" + measure,
       "study.toml:4: found index \"3\" of target (realisation 0: strength_db = "},
      {vary + "\"target.0\" = { law = \"track\", speed = 3 }\n",
       "study.toml:4: vary.\"target.0\".range: found nothing, expected a number above 0, or "
       "\"radius\""},
      {vary + "\"target.0\" = { law = \"track\", radius = 10, depth = [3, 2] }\n",
       "study.toml:4: vary.\"target.0\".depth: found an array of 2, expected a number, or [least, "
       "greatest]"},
      {vary +
           "p = { law = \"profile_eof\", depth = [0, 100], modes = [[1, 2, 3]], deviations = [1] "
           "}\n",
       "study.toml:4: vary.p.modes[0]: found an array of 3, expected a number for each of the 2 "
       "depths"},
      {vary + "p = { law = \"profile_casts\", casts = [\"no.csv\"] }\n",
       "study.toml:4: vary.p.casts[0]: found no such file"},
      {vary, "study.toml:1: measure.echo_level: found nothing, expected at least one measure"},
      {study + "[measure]\necho_levels = true\n",
       "study.toml:4: measure.echo_levels: found an unknown key, expected a known key (did you "
       "mean "
       "\"echo_level\"?)"},
      {study + "[measure]\ndetection = { false_alarm_probability = 0.9 }\n",
       "study.toml:4: measure.detection.false_alarm_probability: found 0.9, expected a probability "
       "from 1e-30 to 0.5"},
      {study + "[measure]\ndetection = { by = \"ear\" }\n",
       "study.toml:4: measure.detection.by: found \"ear\", expected \"matched_filter\" or "
       "\"receiver\""},
      {study + "[measure]\nping = 2\necho_level = true\n",
       "study.toml:4: measure.ping: found 2, expected a whole number from 1 to 1"},
      {study + "[measure]\ntime_series = 0\n",
       "study.toml:4: measure.time_series: found 0, expected a whole number from 1"},
      {study + "[measure]\nspectra = \"some\"\n",
       "study.toml:4: measure.spectra: found \"some\", expected \"none\" or \"all\""},
      {study + "[measure]\nspectra = { every = 0 }\n",
       "study.toml:4: measure.spectra.every: found 0, expected a whole number from 1"},
      {study + "[measure]\nspectra = { resolution = 0 }\n",
       "study.toml:4: measure.spectra.resolution: found 0"},
      {study + "[measure]\nspectra = { phones = \"first\" }\n",
       "study.toml:4: measure.spectra.phones: found \"first\", expected \"mean\" or \"each\""},
      {study + "[measure]\nspectra = { step = 1.0 }\n",
       "study.toml:4: measure.spectra.step: found an unknown key"},
      {study + "[measure]\ndetections = -1\n",
       "study.toml:4: measure.detections: found -1, expected a whole number from 1"},
      {study + "[measure]\nsnr_matched = true\nmatched_filter = { phone = 2 }\n",
       "study.toml:5: measure.matched_filter.phone: found 2, expected a whole number from 0 to 1"},
      {study + "[measure]\necho_level = true\n[measure.receiver]\nmax_speed = 3\n",
       "study.toml:5: measure.receiver: found a table, expected localisation_error, "
       "localisation_ellipse, detections or a detection by the receiver with it"},
      {study + "[measure]\nlocalisation_error = true\n[measure.receiver]\nmax_speed = 601\n",
       "study.toml:6: measure.receiver.max_speed: found 601 m/s, expected a speed from 0 to 600 "
       "m/s"},
      {study + "[measure]\nlocalisation_error = true\n[measure.receiver]\nelevations = \"up\"\n",
       "study.toml:6: measure.receiver.elevations: found \"up\", expected two angles such as "
       "-20:20, "
       "the lower first"},
      {study + "[measure]\ndetection = { by = \"receiver\" }\n[measure.receiver]\n"
               "false_alarm_probability = 1e-3\n",
       "study.toml:6: measure.receiver.false_alarm_probability: found 0.001, expected no "
       "\"false_alarm_probability\" beside a detection by the receiver, which has it"},
      {study + measure + "[summary]\nconfidence = 2\n",
       "study.toml:6: summary.confidence: found 2, expected a probability from 0.5 to 0.999999"},
      {study + measure + "[summary]\nby = [\"echo_level\"]\n",
       "study.toml:6: summary.by[0]: found \"echo_level\", expected a column, \"echo_level_db\" "
       "(did you mean \"echo_level_db\"?)"},
      {study + measure + "[summary]\nby = [{ axis = \"echo_level_db\", edges = [1, 1] }]\n",
       "study.toml:6: summary.by[0].edges[1]: found 1, expected an edge above the one before it, "
       "1"},
      {study + measure + "[summary]\nquantiles = [0.5, 0.9, 0.5]\n",
       "study.toml:6: summary.quantiles[2]: found 0.5, expected every probability once"},
      {study + measure + "[summary]\ninterval = \"normal\"\n",
       "study.toml:6: summary.interval: found \"normal\", expected \"wilson\" or "
       "\"clopper_pearson\""},
  };
  for (const Fault& fault : faults) {
    const std::string message = fault_of(fault.tables);
    EXPECT_EQ(message.substr(0, fault.message.size()), fault.message) << "whole: " << message;
  }
}

// The cost of a design of blocks: what it makes of them, and what it says.
TEST(StudyFile, BlocksAreCountedInRealisations) {
  const support::TemporaryDirectory folder;
  const auto read = [&](const std::string& design) {
    std::ofstream(folder.path() / "study.toml")
        << "[study]\n"
        << design
        << "[vary]\n\"environment.wind_speed\" = { law = \"uniform\", low = 3, high = 4 }\n"
           "\"target.0\" = { law = \"track\", range = [1000, 2000], depth = 80 }\n"
           "[measure]\necho_level = true\n"
        << plain_sea;
    return read_study(folder.path() / "study.toml");
  };
  const Study first = read("design = \"saltelli\"\nblocks = 5\n");
  EXPECT_EQ(first.realisations, 20U);  // a track's columns are one group
  EXPECT_EQ(design_text(first),
            "5 blocks of 4 realisations (A, B and one for each of wind_speed, target_0): 20 "
            "realisations");
  const Study second = read(
      "design = \"saltelli\"\nrealisations = 40\nsecond_order = true\n"
      "chance = true\n");
  EXPECT_EQ(design_text(second),
            "5 blocks of 8 realisations (A, B and two for each of wind_speed, target_0, chance): "
            "40 realisations");
  const Study together =
      read("design = \"saltelli\"\nblocks = 5\ngroups = [[\"target_0\", \"wind_speed\"]]\n");
  EXPECT_EQ(design_text(together),
            "5 blocks of 3 realisations (A, B and one for each of wind_speed + target_0): 15 "
            "realisations");
  EXPECT_NE(identity(first), identity(together));
  const Study scrambles = read("design = \"sobol\"\nrealisations = 64\nreplicates = 16\n");
  EXPECT_EQ(design_text(scrambles), "16 independent scrambles of 4 points: 64 realisations");
  // What decides the rows is in the identity, and one replicate is the design as it was.
  const Study plain = read("design = \"sobol\"\nrealisations = 64\n"),
              one = read("design = \"sobol\"\nrealisations = 64\nreplicates = 1\n");
  EXPECT_EQ(identity(plain), identity(one));
  EXPECT_NE(identity(plain), identity(scrambles));
  EXPECT_NE(identity(first), identity(second));
  EXPECT_EQ(design_text(plain), "");
}

// What would end a study when its file is written, after all realisations, is said when it is read.
TEST(StudyFile, SummariesThatCollideAreFoundAtReading) {
  const std::string before =
                        "[study]\nrealisations = 10\n[vary]\n"
                        "\"target.0.depth\" = { law = \"uniform\", low = 50.0, high = 90.0 }\n"
                        "\"environment.wind_speed\" = { law = \"grid\", values = [3.0, 5.0] }\n",
                    measure = "[measure]\necho_level = true\ndetection = true\n[summary]\n";
  const std::vector<Fault> faults{
      {"by = [\"depth\",\n{ axis = \"depth\", bins = 3 }]\n",
       "study.toml:11: summary.by[1]: found a second table \"pd_by_depth\", as of by[0], expected "
       "every axis, or pair of axes, once"},
      {"by = [[\"depth\", \"wind_speed\"], \"depth\",\n[\"depth\", \"wind_speed\"]]\n",
       "study.toml:11: summary.by[2]: found a second table \"pd_by_depth_and_wind_speed\""},
      {"by = [[\"depth\", \"depth\"]]\n",
       "study.toml:10: summary.by[0]: found an axis that gives pd_by_depth_and_depth two columns "
       "\"depth\""},
  };
  for (const Fault& fault : faults) {
    const std::string message = fault_of(before + measure + fault.tables);
    EXPECT_EQ(message.substr(0, fault.message.size()), fault.message) << "whole: " << message;
  }
  EXPECT_EQ(
      fault_of(before +
               "x = { keys = [\"environment.bottom.depth\"], name = \"count\", law = "
               "\"list\", values = [900.0, 950.0] }\n" +
               measure)
          .find("summary.by (every input by itself): found an axis that gives pd_by_count two "
                "columns \"count\""),
      std::string("study.toml: ").size());
  // A measure may be an axis; it has no mean along itself.
  EXPECT_EQ(fault_of(before + measure + "by = [\"echo_level_db\", \"detected\"]\n"), "no fault");
}

TEST(StudyFile, KeysOfAScenarioBesideItsFileAreRefused) {
  const support::TemporaryDirectory folder;
  std::ofstream(folder.path() / "sea.toml") << plain_sea;
  std::ofstream(folder.path() / "study.toml")
      << "[study]\nrealisations = 1\nscenario = \"sea.toml\"\n[measure]\necho_level = true\n"
         "[noise]\nspectral_level_db = 3.0\n";
  try {
    static_cast<void>(read_study(folder.path() / "study.toml"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("study.toml:6: noise: found a key of the scenario "
                        "beside study.scenario"),
              std::string::npos)
        << error.what();
  }
}

class Drawn : public testing::Test {
 protected:
  Study read(const std::string& tables) {
    std::ofstream(folder_.path() / "study.toml") << tables << plain_sea;
    return read_study(folder_.path() / "study.toml");
  }
  support::TemporaryDirectory folder_;
};

TEST_F(Drawn, AValueThatMakesNoScenarioStopsOrIsSkipped) {
  const std::string vary =
      "[vary]\n\"target.0.depth\" = { law = \"list\", values = [100.0, 2000.0] }\n"
      "[measure]\necho_level = true\n";
  {
    const Realiser realiser(read("[study]\nrealisations = 4\n" + vary));
    EXPECT_TRUE(realiser.realise(0).valid);
    try {
      static_cast<void>(realiser.realise(1));
      FAIL();
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("study.toml:4: target[0].depth: found depth 2000 m"),
                std::string::npos)
          << error.what();
      EXPECT_NE(std::string(error.what()).find("(realisation 1: depth = 2000)"), std::string::npos)
          << error.what();
    }
  }
  const Realiser realiser(read("[study]\nrealisations = 4\non_error = \"skip\"\n" + vary));
  const Row row = realiser.realise(1);
  EXPECT_FALSE(row.valid);
  EXPECT_NE(row.fault.find("realisation 1"), std::string::npos);
  ASSERT_EQ(row.values.size(), 2U);
  EXPECT_EQ(row.values[0], 2000.0);
  EXPECT_TRUE(std::isnan(row.values[1]));
}

TEST_F(Drawn, RangeVariesOfATargetPlacedByItsPosition) {
  const Study study = read(
      "[study]\nrealisations = 4\n[vary]\n\"target.0.range\" = { law = \"list\", values = [1000, "
      "2000] }\n[measure]\necho_level = true\nstrongest_path = true\n");
  const Row row = Realiser(study).realise(1);
  // 2000 m at the depth of the platform, 1500 m/s.
  EXPECT_NEAR(row.values[2], 2.0 * 2000.0 / 1500.0, 1e-9);
}

TEST_F(Drawn, TheStudySetsKeysOfItsScenarioForGood) {
  const std::string tables =
      "[study]\nrealisations = 4\n[set]\n\"target.0.position\" = [2000, 0, 100]\n[measure]\n"
      "strongest_path = true\n";
  EXPECT_NEAR(Realiser(read(tables)).realise(0).values[0], 2.0 * 2000.0 / 1500.0, 1e-9);
  const std::string path = (folder_.path() / "study.toml").string();
  const std::vector<std::string> overrides{"target.0.position=[1000, 0, 100]"};
  EXPECT_NEAR(Realiser(read_study(path, overrides)).realise(0).values[0], 2.0 * 1000.0 / 1500.0,
              1e-9);
  EXPECT_THROW(
      static_cast<void>(read("[study]\nrealisations = 4\n[set]\n\"target.3.name\" = \"x\"\n")),
      InputError);
}

// A law is reached by its key in quotes.
TEST_F(Drawn, AnOverrideReachesALaw) {
  const std::string text =
      "[study]\nrealisations = 4\n[vary]\n\"target.0.range\" = { law = \"uniform\", low = 1000, "
      "high = 2000 }\n[measure]\necho_level = true\n";
  static_cast<void>(read(text));
  const std::string path = (folder_.path() / "study.toml").string();
  const std::vector<std::string> higher{R"(vary."target.0.range".low=1999)"};
  for (std::uint64_t i = 0; i < 4; ++i)
    EXPECT_GE(Realiser(read_study(path, higher)).realise(i).values[0], 1999.0);
  const std::vector<std::string> wrong{R"(vary."target.0.range".low=2001)"};
  try {
    static_cast<void>(read_study(path, wrong));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("vary.\"target.0.range\".high: found 2000, expected a "
                        "number above 2001"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(Drawn, GridWalksThroughAllCombinationsTheLastFastest) {
  const Study study = read(
      "[study]\ndesign = \"grid\"\n[vary]\n"
      "\"target.0.range\" = { law = \"grid\", values = [1000, 2000, 3000] }\n"
      "\"environment.wind_speed\" = { law = \"grid\", from = 2, to = 8, count = 2 }\n"
      "[measure]\npaths = true\n");
  EXPECT_EQ(study.realisations, 6U);
  const Realiser realiser(study);
  const std::vector<std::pair<double, double>> expected{{1000, 2}, {1000, 8}, {2000, 2},
                                                        {2000, 8}, {3000, 2}, {3000, 8}};
  for (std::uint64_t i = 0; i < 6; ++i) {
    const Row row = realiser.realise(i);
    EXPECT_EQ(row.values[0], expected[i].first);
    EXPECT_EQ(row.values[1], expected[i].second);
  }
}

TEST_F(Drawn, TracksAndProfilesReachTheScenario) {
  const Study study = read(
      "[study]\nrealisations = 8\n[vary]\n"
      "\"target.0\" = { law = \"track\", range = [1000, 4000], bearing_deg = [30, 60], depth = "
      "[50, "
      "150], speed = 2, course_deg = 90 }\n"
      "profile = { law = \"profile_eof\", depth = [0, 100, 1000], modes = [[1, 1, 1], [1, 0, 0]], "
      "deviations = [2, 1] }\n"
      "[measure]\nstrongest_path = true\n");
  const std::vector<Column> all = columns(study);
  const std::vector<std::string> names{"target_0_range", "target_0_bearing_deg", "target_0_depth",
                                       "target_0_speed", "target_0_course_deg",  "profile_1",
                                       "profile_2"};
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(all[i].name, names[i]);
  const Realiser realiser(study);
  for (std::uint64_t i = 0; i < 4; ++i) {
    const Row row = realiser.realise(i);
    const double range = row.values[0];
    EXPECT_GE(row.values[1], 30.0);
    EXPECT_LE(row.values[1], 60.0);
    EXPECT_EQ(row.values[3], 2.0);
    // Straight rays at nearly 1500 m/s + the amplitude of the constant mode; mode 2 (1 m/s at the
    // surface, gone at 100 m) and the 4 m that the target moves change less than 0.3 %.
    const double slant = std::hypot(range, row.values[2] - 100.0);
    EXPECT_NEAR(row.values[7], 2.0 * slant / (1500.0 + row.values[5]), 0.003 * row.values[7]);
  }
}

TEST_F(Drawn, ColumnsHaveTheUnitsOfTheirKeys) {
  const std::string law = " = { law = \"uniform\", low = 40, high = 50 }\n";
  const Study study = read("[study]\nrealisations = 4\n[vary]\n\"noise.spectral_level_db\"" + law +
                           "\"transmitter.source_level_db\"" + law + "\"target.0.strength_db\"" +
                           law + "[measure]\necho_level = true\n");
  std::vector<std::string> units;
  for (const Column& column : columns(study)) units.push_back(column.unit);
  EXPECT_EQ(units, (std::vector<std::string>{"dB re 1 µPa²/Hz", "dB re 1 µPa at 1 m", "dB",
                                             "dB re 1 µPa"}));
}

// Of every kind of key: what the setting's description has, also of choices among numbers.
TEST_F(Drawn, ColumnsHaveTheUnitsAndNamesOfTheDescriptions) {
  const std::string law = " = { law = \"uniform\", low = 1, high = 2 }\n";
  const Study study =
      read("[study]\nrealisations = 4\n[vary]\n\"pings.recording_start\"" + law +
           "\"environment.wind_speed\"" + law + "\"transmitter.first_ping_time\"" + law +
           "\"propagation.max_launch_angle_deg\" = { law = \"uniform\", low = 80, high = 90 }\n"
           "\"target.0.position.2\" = { law = \"uniform\", low = 90, high = 110 }\n"
           "\"seed\" = { law = \"list\", values = [1, 2] }\n"
           "sea = { law = \"list\", keys = [\"pulse.duration\", \"pings.interval\"], rows = [[0.1, "
           "60], [0.2, 90]] }\n[measure]\necho_level = true\n");
  std::map<std::string, Column> found;
  for (const Column& column : columns(study)) found[column.name] = column;
  const auto is = [&](const std::string& name, const std::string& unit,
                      const std::string& meaning) {
    ASSERT_TRUE(found.contains(name)) << name;
    EXPECT_EQ(found[name].unit, unit) << name;
    EXPECT_EQ(found[name].meaning, meaning);
  };
  is("recording_start", "s", "pings.recording_start: time of a record, after the ping");
  is("wind_speed", "m/s", "environment.wind_speed: wind speed at 10 m height");
  is("first_ping_time", "s", "transmitter.first_ping_time: time of its first ping");
  is("max_launch_angle_deg", "degrees",
     "propagation.max_launch_angle_deg: angle of a path, from the horizontal");
  is("position_2", "m", "target.0.position.2: at the start");
  is("seed", "1", "seed: of all that is drawn");
  is("sea_duration", "s", "pulse.duration: duration from the leading to the trailing edge");
  is("sea_interval", "s", "pings.interval: interval from ping to ping of one transmitter");
}

TEST_F(Drawn, CastsAndWaypointsAreDrawnWhole) {
  std::ofstream(folder_.path() / "slow.csv") << "depth,speed\n0,1450\n1000,1450\n";
  const Study study = read(
      "[study]\nrealisations = 8\n[vary]\n"
      "cast = { law = \"profile_casts\", casts = [\"slow.csv\", { depth = [0, 1000], speed = "
      "[1550, 1550] }] }\n"
      "\"target.0.waypoints\" = { law = \"list\", values = [[{ time = 0, position = [1000, 0, 100] "
      "}], [{ time = 0, position = [2000, 0, 100] }]], labels = [\"near\", \"far\"] }\n"
      "[measure]\nstrongest_path = true\n");
  const std::vector<Column> all = columns(study);
  EXPECT_EQ(all[0].labels, (std::vector<std::string>{"slow", "2"}));
  EXPECT_EQ(all[0].unit, "1");  // which cast: no speed
  EXPECT_EQ(all[1].labels, (std::vector<std::string>{"near", "far"}));
  const Realiser realiser(study);
  for (std::uint64_t i = 0; i < 8; ++i) {
    const Row row = realiser.realise(i);
    EXPECT_EQ(row.values[1], double(i % 2));
    const double speed = row.values[0] == 0.0 ? 1450.0 : 1550.0;
    EXPECT_NEAR(row.values[2], 2.0 * (i % 2 == 0 ? 1000.0 : 2000.0) / speed, 1e-6);
  }
}

TEST_F(Drawn, IdentityIsOfWhatDecidesTheRows) {
  const std::string head = "[study]\nrealisations = 4\n";
  const std::string vary =
      "[vary]\n\"target.0.range\" = { law = \"uniform\", low = 1e3, high = 2e3 }\n";
  const std::string measure = "[measure]\necho_level = true\n";
  const std::string one = identity(read(head + vary + measure));
  EXPECT_EQ(one, identity(read(head + "title = \"other\"\n" + vary + measure)));
  EXPECT_EQ(one, identity(read("[study]\nrealisations = 9\n" + vary + measure)));
  EXPECT_EQ(one, identity(read(head + vary + measure + "[summary]\nroc = false\n")));
  EXPECT_NE(one, identity(read(head + "seed = 2\n" + vary + measure)));
  EXPECT_NE(one, identity(read(head + vary + measure + "paths = true\n")));
  EXPECT_NE(one, identity(read(head +
                               "[vary]\n\"target.0.range\" = { law = \"uniform\", low = "
                               "1e3, high = 3e3 }\n" +
                               measure)));
  EXPECT_EQ(one, identity(read(head + "on_error = \"skip\"\n" + vary + measure)));
  const std::string latin = "[study]\ndesign = \"latin_hypercube\"\nrealisations = ";
  EXPECT_NE(identity(read(latin + "4\n" + vary + measure)),
            identity(read(latin + "5\n" + vary + measure)));
}

}  // namespace
}  // namespace asdic::detail::study
