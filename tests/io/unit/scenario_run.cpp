#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/error.h"
#include "io/scenario/propagation.h"
#include "io/scenario/writer.h"
#include "io/text/csv_table.h"
#include "io/text/toml_writer.h"

namespace asdic::detail {
namespace {

const std::string ocean = R"([environment.sound_speed]
kind = "isovelocity"
speed = 1500
[environment.bottom]
kind = "rigid"
depth = 100
)";

PropagationCase read(const std::string& run, const std::string& before = ocean) {
  std::vector<std::string> notes;
  return parse_propagation_case(before + run, "r.toml", {}, notes);
}

TEST(ScenarioRun, SaysEverythingThatARunIs) {
  const PropagationCase run = read(R"([run]
task = "field"
field = "semi-coherent"
frequency = 250
box_range = 12000
box_depth = 150
[run.source]
depth = [20, 40]
kind = "line"
[run.source.pattern]
elevation_deg = [-90, 0, 90]
level_db = [-20, 0, -20]
[run.receivers]
depth = { first = 0, last = 100, count = 11 }
range = [1000, 2000, 9000]
[run.fan]
lowest_deg = -30
highest_deg = 20
count = 500
[run.beams]
kind = "cerveny-cartesian"
displacement = true
[run.beams.cerveny]
width = "minimum"
curvature = "doubled"
component = "vertical"
width_multiplier = 0.5
loop_range = 5000
images = 3
window = 6
[run.literal]
step = 20
beams = 400
single_beam = 7
)");
  EXPECT_EQ(run.task, Task::field);
  EXPECT_EQ(run.field, FieldKind::semi_coherent);
  EXPECT_EQ(run.frequency, 250.0);
  EXPECT_EQ(run.box_range, 12000.0);
  EXPECT_EQ(run.source_depths, (std::vector<double>{20.0, 40.0}));
  EXPECT_EQ(run.beams.source, SourceKind::line);
  ASSERT_TRUE(run.beams.pattern.has_value());
  EXPECT_DOUBLE_EQ(run.beams.pattern->at(0.0), 1.0);
  EXPECT_DOUBLE_EQ(run.beams.pattern->at(radians(90.0)), 0.1);
  ASSERT_EQ(run.receivers.depths.size(), 11U);
  EXPECT_EQ(run.receivers.depths[3], 30.0);
  EXPECT_EQ(run.receivers.depths.back(), 100.0);
  EXPECT_EQ(run.beams.lowest, radians(-30.0));
  EXPECT_EQ(run.beams.count, 500);
  EXPECT_EQ(run.beams.kind, BeamKind::cerveny_cartesian);
  ASSERT_TRUE(run.beams.cerveny.has_value());
  EXPECT_EQ(run.beams.cerveny->width, CervenyBeams::Width::minimum);
  EXPECT_EQ(run.beams.cerveny->curvature, CervenyBeams::Curvature::doubled);
  EXPECT_EQ(run.beams.cerveny->component, CervenyBeams::Component::vertical);
  EXPECT_EQ(run.beams.cerveny->images, 3);
  EXPECT_EQ(run.literal.step, 20.0);
  EXPECT_EQ(run.literal.single_beam, 7);
}

TEST(ScenarioRun, WhatIsLeftOutIsTakenFromTheRest) {
  const PropagationCase run = read(
      "[run]\nfrequency = 100\n[run.source]\ndepth = 50\n"
      "[run.receivers]\ndepth = 20\nrange = [1000, 8000]\n");
  EXPECT_EQ(run.box_range, 1.01 * 8000.0);
  EXPECT_EQ(run.box_depth, 1.01 * 100.0 + 1.0);
  EXPECT_EQ(run.beams.kind, BeamKind::hat);
  EXPECT_EQ(run.beams.highest, 0.5 * pi);
  EXPECT_FALSE(run.beams.cerveny.has_value());
  const PropagationCase rays = read(
      "[run]\ntask = \"rays\"\nfrequency = 100\nbox_range = 5000\n[run.source]\ndepth = 50\n"
      "[run.fan]\nelevations_deg = [-10, 0, 10]\n");
  EXPECT_EQ(rays.receivers.size(), 0U);
  EXPECT_EQ(rays.beams.elevations.size(), 3U);
  EXPECT_EQ(rays.beams.highest, radians(10.0));
}

// Where the bottom rises on behind the last receiver, sound may turn round there.
TEST(ScenarioRun, TheBoxReachesUpARisingBottom) {
  const auto box = [](const std::string& range, const std::string& depth) {
    return read(
               "[run]\nfrequency = 100\n[run.source]\ndepth = 5\n"
               "[run.receivers]\ndepth = 5\nrange = 2000\n",
               "[environment.sound_speed]\nkind = \"isovelocity\"\nspeed = 1500.0\n"
               "[environment.bottom]\nkind = \"rigid\"\n[environment.bottom.shape]\nrange = " +
                   range + "\ndepth = " + depth + "\n")
        .box_range;
  };
  EXPECT_DOUBLE_EQ(box("[0, 3000]", "[200, 10]"), 1.01 * 3000.0);
  EXPECT_DOUBLE_EQ(box("[0, 9000]", "[200, 10]"), 1.01 * 4000.0);
  EXPECT_DOUBLE_EQ(box("[0, 2500, 3000]", "[200, 100, 150]"), 1.01 * 2500.0);
  EXPECT_DOUBLE_EQ(box("[0, 3000]", "[100, 200]"), 1.01 * 2000.0);
}

// A sonar's scenario gives the frequency, the source's depth and the ocean along the transect.
TEST(ScenarioRun, ASonarScenarioWillDo) {
  std::vector<std::string> notes;
  const std::string text = read_text_file(ASDIC_SCENARIOS "/isovelocity.toml") +
                           "\n[run.receivers]\ndepth = 30\nrange = 2000\n";
  const PropagationCase run =
      parse_propagation_case(text, ASDIC_SCENARIOS "/isovelocity.toml", {}, notes);
  EXPECT_EQ(run.source_depths.size(), 1U);
  EXPECT_GT(run.source_depths[0], 0.0);
  EXPECT_GT(run.frequency, 100.0);
}

TEST(ScenarioRun, FaultsNameTheirKeys) {
  const auto message = [](const std::string& run) -> std::string {
    try {
      static_cast<void>(read(run));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  const std::string head = "[run]\nfrequency = 100\n[run.source]\ndepth = 50\n";
  const std::string receivers = "[run.receivers]\ndepth = 20\nrange = 1000\n";
  EXPECT_EQ(message("[run]\ntask = \"field\"\n"),
            "r.toml:7: run.frequency: found nothing, expected a frequency from 0.001 to "
            "100000000 Hz");
  EXPECT_EQ(message(head),
            "r.toml:7: run.receivers.depth: found nothing, expected a depth from -1000000 to "
            "1000000 m");
  EXPECT_EQ(message(head + receivers + "[run.beams]\nkind = \"gausian\"\n"),
            "r.toml:15: run.beams.kind: found \"gausian\", expected \"hat\", \"gaussian\", "
            "\"ray-centred-hat\", \"ray-centred-gaussian\", \"simple-gaussian\", "
            "\"cerveny-cartesian\" or \"cerveny-ray-centred\" (did you mean \"gaussian\"?)");
  EXPECT_EQ(message(head + receivers + "[run.fan]\nlowest_deg = 10\nhighest_deg = -10\n"),
            "r.toml:16: run.fan.highest_deg: found -10, expected not below the lowest elevation");
  EXPECT_EQ(
      message(head + receivers + "[run.fan]\nlowest_deg = 10\nlowest_rad = 0.1\n"),
      "r.toml:16: run.fan.lowest_rad: found 0.1, expected no \"lowest_rad\" beside lowest_deg");
  EXPECT_EQ(message(head + "[run.receivers]\nirregular = true\ndepth = [1, 2]\nrange = [5]\n"),
            "r.toml:13: run.receivers.depth: found an array of 2, expected one for each of the 1 "
            "ranges of an irregular set");
  EXPECT_EQ(message(head + "[run.receivers]\ndepth = 5\nrange = [5, 4]\n"),
            "r.toml:13: run.receivers.range[1]: found 4, expected a value not below the one before "
            "it, 5 m");
}

TEST(TomlWriter, DegreesThatReadBackAsTheSameBits) {
  EXPECT_EQ(exact_degrees(radians(-17.3)), "-17.3");
  EXPECT_EQ(exact_degrees(0.0), "0");
  EXPECT_EQ(exact_degrees(-0.0), "-0.0");
  EXPECT_EQ(exact_degrees(0.5 * pi), "90");
  int exact = 0;
  for (int i = 1; i < 1000; ++i) {
    const std::string text = exact_degrees(1e-3 * i);
    if (text.empty()) continue;
    ++exact;
    EXPECT_EQ(radians(std::stod(text)), 1e-3 * i);
  }
  EXPECT_GT(exact, 500);  // 180/π of a number rounds to the right one more often than not
}

TEST(TomlWriter, TextThatAnyReaderTakes) {
  TomlWriter out;
  out.text("a", "quote \" backslash \\ tab \t bell \a");
  out.text("b", "G\xc3\xbcnther, and in Latin-1: G\xfcnther");
  EXPECT_EQ(out.str(),
            "a = \"quote \\\" backslash \\\\ tab \\u0009 bell \\u0007\"\n"
            "b = \"G\xc3\xbcnther, and in Latin-1: G\xc3\xbcnther\"\n");
}

}  // namespace
}  // namespace asdic::detail
