// Targets, transmitting arrays and receivers in a scenario file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "io/scenario/scenario_reader.h"
#include "sonar/ping/ping.h"

namespace asdic::detail {
namespace {

std::string scenario(const std::string& transmitter, const std::string& array,
                     const std::string& target) {
  return "[environment.sound_speed]\nkind = \"isovelocity\"\nspeed = 1500.0\n"
         "[environment.bottom]\ndepth = 500.0\nkind = \"rigid\"\n"
         "[platform]\nposition = [0.0, 0.0, 100.0]\n"
         "[pulse]\nkind = \"cw\"\nfrequency = 1000.0\nduration = 0.1\n"
         "[pings]\ncount = 2\nrecording_duration = 2.0\nsample_rate = 4000.0\n"
         "[transmitter]\nsource_level_db = 200.0\n" +
         transmitter + "\n[array]\n" + array + "\n[[target]]\nposition = [1000, 0, 100]\n" +
         target + "\n";
}

const std::string plain_transmitter = "taper = \"omnidirectional\"",
                  plain_array = "kind = \"horizontal\"\nphones = 2\nspacing = 0.5",
                  plain_target = "strength_db = 10.0";

TEST(SoundScenario, ReadsTargetsWithHighlights) {
  const Scenario s = parse_scenario(
      scenario(plain_transmitter, plain_array,
               "heading_deg = 30.0\nfluctuation = \"swerling-3\"\nscan_pings = 4\n"
               "hull = { length = 70.0, beam = 8.0 }\n"
               "highlight = [{ offset = [30, 0, 1], strength_db = 4 }, { offset = [-30, 0, 0], "
               "aspect = { angle_deg = [0, 90, 270], level_db = [1, 2, 3] } }]"),
      "s.toml");
  const Target& t = s.targets[0];
  EXPECT_DOUBLE_EQ(*t.heading, radians(30.0));
  EXPECT_EQ(t.fluctuation, Fluctuation::swerling_3);
  EXPECT_EQ(t.scan_pings, 4);
  EXPECT_EQ(t.hull->length, 70.0);
  ASSERT_EQ(t.highlights.size(), 2U);
  EXPECT_EQ(t.highlights[0].offset, Vec3(30, 0, 1));
  EXPECT_DOUBLE_EQ(t.highlights[1].aspect->aspect[2], radians(270.0));
}

TEST(SoundScenario, ReadsTransmittersAndReceivers) {
  const Scenario s = parse_scenario(
      scenario("kind = \"projectors\"\nbearing_deg = 40\nbearing_from = \"heading\"\n"
               "projector = [{ offset = [0, 1, 0], amplitude = 2, phase_deg = 90, delay = 1e-3 }]",
               "kind = \"towed\"\nbehind = [10, 20, 30]\nheading_deg = 90\n"
               "electronics = { gain_db = [0, 1, 2], dead = [2], converter = { bits = 12, "
               "full_scale = 2.0 }, band_pass = { low = 500, high = 1500, order = 2 } }",
               plain_target),
      "s.toml");
  const auto& beam = std::get<ProjectorBeam>(s.transmitters[0].beam);
  EXPECT_DOUBLE_EQ(beam.projectors[0].phase, radians(90.0));
  EXPECT_EQ(beam.turned.frame, BearingFrame::heading);
  // From their middle, 20 m behind the tow point.
  EXPECT_LT((array_at(s, 0, 0.0).position - s.platforms[0].track.at(0.0).position - Vec3(-20, 0, 0))
                .norm(),
            1e-12);
  EXPECT_LT((s.arrays[0].phones[2] - Vec3(-10, 0, 0)).norm(), 1e-12);
  EXPECT_EQ(s.arrays[0].electronics.converter->bits, 12);
  EXPECT_EQ(s.arrays[0].electronics.band_pass->order, 2);
  EXPECT_EQ(s.arrays[0].electronics.dead, std::vector{2});
  const Scenario table = parse_scenario(
      scenario("kind = \"table\"\ntable = { bearing_deg = [0, 180], elevation_deg = [-90, 0, 90], "
               "level_db = [[-10, 0, -10], [-30, -20, -30]] }",
               "kind = \"positions\"\nshapes = [{ positions = [[0, 0, 0]] }, { positions = "
               "[[1, 0, 0]] }]",
               plain_target),
      "s.toml");
  EXPECT_EQ(std::get<TableBeam>(table.transmitters[0].beam).table.level_db.size(), 6U);
  const Vec3 in_ping_two = array_at(table, 0, 0.0).position + phones_at(table, 0, 2, 0.0)[0];
  EXPECT_EQ(in_ping_two, Vec3(table.platforms[0].track.at(0.0).position + Vec3(1, 0, 0)));
}

struct Fault {
  const char *transmitter, *array, *target, *message;
};

TEST(SoundScenario, SaysWhatIsWrong) {
  const char *t = plain_transmitter.c_str(), *a = plain_array.c_str(), *b = plain_target.c_str();
  const Fault faults[] = {
      {t, a, "strength_db = 1\n[propagation]\nband = \"medium\"",
       "propagation.band: found \"medium\", expected \"auto\", \"narrow\" or \"wide\""},
      {t, a, "strength_db = 1\nhighlight = [{ offset = [1, 0, 0], strength_db = 1 }]",
       "strength_db: found 1, expected no \"strength_db\" beside highlight"},
      {t, a, "highlight = [{ offset = [1, 0, 0] }]", "highlight[0].strength_db: found nothing"},
      {t, a, "highlight = [{ offset = [1, 0, 0], strength_db = 1 }]", "heading_deg: found nothing"},
      {t, a, "heading_deg = 0\nhighlight = [{ offset = [1, 2], strength_db = 1 }]",
       "highlight[0].offset: found an array of 2, expected [forward, starboard, down] in m"},
      {t, a, "strength_db = 1\n[[reverberation.volume]]\ndepth = [300, 200.5]\nstrength_db = -70",
       "volume[0].depth: found 300 m and 200.5 m, expected two depths, the deeper one last"},
      {"taper = \"omnidirectional\"\ninterval = 0.05", a, b,
       "transmitter.interval: found 0.05 s, expected an interval of at least the pulse's duration, "
       "0.1 s: a projector sends one pulse at a time"},
      {t, a, "strength_db = 1\nhull = { length = 10, beam = 2 }",
       "expected no \"hull\" without highlights that it could hide"},
      {t, a, "strength_db = 1\nfluctuation = \"swerling-1\"", "scan_pings: found nothing"},
      {t, a, "strength_db = 1\nfluctuation = \"swerling\"", "fluctuation: found \"swerling\""},
      {t, a, "heading_deg = 0\naspect = { angle_deg = [0, 90, 80], level_db = [1, 2, 3] }",
       "angle_deg[2]: found 80 degrees, expected an aspect above the one before it, 90 degrees"},
      {t, a, "heading_deg = 0\naspect = { bow_db = 1, beam_db = 2 }", "stern_db: found nothing"},
      {"kind = \"projectors\"", a, b, "projector: found none"},
      {"kind = \"projectors\"\nprojector = [{ offset = [0, 0, 0], amplitude = 0 }]", a, b,
       "expected an amplitude above 0"},
      {"kind = \"projectors\"\nbeamwidth_deg = 5\nprojector = [{ offset = [0, 0, 0] }]", a, b,
       "beamwidth_deg: found 5, expected no \"beamwidth_deg\" beside kind = \"projectors\""},
      {"taper = \"omnidirectional\"\nbearing_deg = 5", a, b,
       "bearing_deg: found 5, expected no \"bearing_deg\" beside a vertical line"},
      {"kind = \"table\"\ntable = { bearing_deg = [0, 90], elevation_deg = [0], level_db = [[0]] }",
       a, b, "level_db: found 1 rows of 1, expected a row for each of 2 bearings, of 1 elevations"},
      {t, "kind = \"towed\"", b, "behind: found nothing"},
      {t,
       "kind = \"positions\"\nshapes = [{ positions = [[0, 0, 0]] }, { positions = [[0, 0, 0], "
       "[1, 0, 0]] }]",
       b, "positions: found 2, expected as many phones as in the first shape, 1"},
      {t, "kind = \"horizontal\"\nphones = 2\nspacing = 0.5\nelectronics = { gain_db = [1] }", b,
       "gain_db: found 1 numbers, expected one number for each of 2 phones"},
      {t, "kind = \"horizontal\"\nphones = 2\nspacing = 0.5\nelectronics = { dead = [2] }", b,
       "dead[0]: found 2, expected the number of a phone, 0 to 1"},
      {t,
       "kind = \"horizontal\"\nphones = 2\nspacing = 0.5\nelectronics = { band_pass = { low = "
       "10, high = 5 } }",
       b, "high: found 5, expected a frequency above low, 10 Hz"},
      {t,
       "kind = \"horizontal\"\nphones = 2\nspacing = 0.5\nelectronics = { converter = { bits = "
       "40, full_scale = 1 } }",
       b, "bits: found 40"},
  };
  for (const Fault& fault : faults) {
    try {
      static_cast<void>(
          parse_scenario(scenario(fault.transmitter, fault.array, fault.target), "s.toml"));
      ADD_FAILURE() << "read without complaint; wanted " << fault.message;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(fault.message));
    }
  }
}

// The commented examples run, and what they are about is there.
TEST(SoundScenario, HighlightTargetShowsItsHighlights) {
  const PingSimulator simulator(read_scenario(ASDIC_SCENARIOS "/highlight_target.toml"));
  const PingRecord record = simulator.simulate(1);
  std::vector<int> seen(4);
  for (const EchoPath& echo : record.echoes) ++seen.at(std::size_t(echo.highlight));
  EXPECT_GT(*std::max_element(seen.begin(), seen.end()), 3) << "several pairs of paths";
  EXPECT_GT(std::count_if(seen.begin(), seen.end(), [](int n) { return n > 0; }), 2);
}

}  // namespace
}  // namespace asdic::detail
