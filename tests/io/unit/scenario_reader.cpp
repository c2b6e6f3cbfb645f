#include "io/scenario/scenario_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/error.h"
#include "io/scenario/propagation.h"
#include "support/temporary_directory.h"

namespace asdic::detail {
namespace {

constexpr const char* small_scenario = R"([environment]
wind_speed = 5
[environment.sound_speed]
kind = "table"
depth = [0.0, 100.0, 5000.0]
speed = [1510.0, 1500.0, 1540.0]
[environment.bottom]
depth = 5000.0
kind = "rigid"
[platform]
position = [0.0, 0.0, 4500.0]
[transmitter]
source_level_db = 220.0
elevation_deg = 8.0
beamwidth_deg = 6.0
[pulse]
kind = "cw"
frequency = 4000.0
duration = 1.0
window = "hann"
[array]
kind = "horizontal"
phones = 16
spacing = 0.1875
[[target]]
range = 25000.0
bearing_deg = 90.0
depth = 125.0
strength_db = 15.0
[pings]
count = 2
recording_duration = 60
)";

TEST(ScenarioReader, ReadsWhatStandsThere) {
  const Scenario s = parse_scenario(small_scenario, "small.toml");
  EXPECT_EQ(s.wind_speed, 5.0);
  EXPECT_EQ(s.environment.water.depths().size(), 3U);
  EXPECT_EQ(s.environment.bottom.depth, 5000.0);
  EXPECT_TRUE(std::holds_alternative<Rigid>(s.environment.bottom.material));
  EXPECT_TRUE(std::holds_alternative<Thorp>(s.environment.absorption));
  EXPECT_EQ(s.platforms[0].track.start.position.z(), 4500.0);
  EXPECT_DOUBLE_EQ(s.transmitters[0].elevation, radians(8.0));
  EXPECT_EQ(std::get<LineBeam>(s.transmitters[0].beam).taper, Taper::hann);
  EXPECT_EQ(s.pulse.window, PulseWindow::hann);
  EXPECT_EQ(s.arrays[0].phones.size(), 16U);
  ASSERT_EQ(s.targets.size(), 1U);
  EXPECT_NEAR((s.targets[0].track.start.position - Vec3(25000.0, 0.0, 125.0)).norm(), 0.0, 1e-9);
  EXPECT_EQ(s.pings.count, 2);
  EXPECT_FALSE(s.noise.any());
  EXPECT_EQ(s.text, small_scenario);
  const auto& surface = std::get<NrlSurface>(s.reverberation.surface);
  EXPECT_EQ(surface.wind_speed, 5.0);
  EXPECT_EQ(surface.sound_speed, 1510.0);
}

TEST(ScenarioReader, BouncesAreANumberOrAuto) {
  const auto read = [](const std::string& value) {
    return parse_scenario(
               std::string(small_scenario) + "[propagation]\nmax_bottom_bounces = " + value + "\n",
               "small.toml")
        .propagation;
  };
  EXPECT_EQ(read("7").max_bottom_bounces, 7);
  EXPECT_EQ(read("\"auto\"").max_bottom_bounces, std::nullopt);
  EXPECT_EQ(read("7").max_surface_bounces, std::nullopt);
  EXPECT_THROW(static_cast<void>(read("\"many\"")), InputError);
  EXPECT_THROW(static_cast<void>(read("-1")), InputError);
}

TEST(ScenarioReader, OverridesReplaceAddAndIndex) {
  const std::vector<std::string> overrides{"transmitter.elevation_deg=12",
                                           "target.0.strength_db=20.5",
                                           "pulse.window=none",
                                           "noise.spectral_level_db=40",
                                           "environment.sound_speed.speed.1=1490",
                                           "target.0.name=a bare phrase",
                                           R"(environment.bottom={kind="vacuum", depth=5200})"};
  const Scenario s = parse_scenario(small_scenario, "small.toml", overrides);
  EXPECT_DOUBLE_EQ(s.transmitters[0].elevation, radians(12.0));
  EXPECT_EQ(s.targets[0].strength_db, 20.5);
  EXPECT_EQ(s.targets[0].name, "a bare phrase");
  EXPECT_EQ(s.pulse.window, PulseWindow::none);
  EXPECT_EQ(s.noise.flat_level_db(), 40.0);
  EXPECT_EQ(s.environment.water.speeds()[1], 1490.0);
  EXPECT_EQ(s.environment.bottom.depth, 5200.0);
  EXPECT_EQ(s.overrides, overrides);
  EXPECT_EQ(s.text, small_scenario);  // verbatim: the overrides are recorded beside it
}

TEST(ScenarioReader, EveryScatteringLawCanBeChosen) {
  for (const std::string kind : {"nrl", "chapman-harris", "ogden-erskine"}) {
    const std::vector<std::string> overrides{"reverberation.surface.kind=" + kind};
    const Scenario s = parse_scenario(small_scenario, "small.toml", overrides);
    std::visit(
        [&](const auto& law) {
          EXPECT_EQ(law.name, kind);
          if constexpr (requires { law.wind_speed; }) {
            EXPECT_EQ(law.wind_speed, 5.0);
          }
        },
        s.reverberation.surface);
  }
  const std::vector<std::string> parameter{"reverberation.surface.gamma2=3.8"};
  const Scenario s = parse_scenario(small_scenario, "small.toml", parameter);
  EXPECT_EQ(std::get<NrlSurface>(s.reverberation.surface).gamma2, 3.8);
}

TEST(ScenarioReader, ReverberationIsReadKeyByKey) {
  const auto read = [](std::vector<std::string> overrides) {
    return parse_scenario(small_scenario, "small.toml", overrides).reverberation;
  };
  const ReverberationSettings plain = read({});
  EXPECT_FALSE(plain.bottom);
  EXPECT_TRUE(plain.volume.empty());
  EXPECT_TRUE(plain.surface_scatters);
  EXPECT_EQ(plain.azimuths, 36);
  EXPECT_TRUE(plain.resolve_azimuth);
  EXPECT_EQ(plain.surface_field.statistics.coherence_time, 0.0);
  EXPECT_EQ(plain.surface_field.motion.kind, ScattererMotion::Kind::still);

  const ReverberationSettings all = read(
      {"reverberation.resolve_azimuth=false", "reverberation.scatterers_per_cell=3",
       "reverberation.most_returns=50000", "reverberation.synthesis=covariance",
       R"(reverberation.surface={kind="table", grazing_deg=[5, 40], strength_db=[-50, -30], )"
       R"(motion="bragg", receding_share=0.25, current=[1, -2], coherence_time=4})",
       R"(reverberation.bottom={kind="ellis-crowe", nu_db=-18, k_shape=0.8, correlation_length=80})",
       R"(reverberation.volume=[{depth=[100, 300], strength_db=-72, sheets=2, )"
       R"(motion="spread", speed_rms=0.5}])"});
  EXPECT_FALSE(all.resolve_azimuth);
  EXPECT_EQ(all.scatterers_per_cell, 3);
  EXPECT_EQ(all.most_returns, 50'000U);
  EXPECT_EQ(plain.synthesis, ScattererSynthesis::automatic);
  EXPECT_EQ(all.synthesis, ScattererSynthesis::covariance);
  const auto& table = std::get<ScatteringTable>(all.surface);
  EXPECT_NEAR(table.strength(radians(22.5)), -40.0, 1e-9);
  EXPECT_EQ(table.strength(0.0), -50.0);
  EXPECT_EQ(all.surface_field.motion.kind, ScattererMotion::Kind::bragg);
  EXPECT_EQ(all.surface_field.motion.receding_share, 0.25);
  EXPECT_EQ(all.surface_field.motion.current, Vec2(1.0, -2.0));
  EXPECT_EQ(all.surface_field.statistics.coherence_time, 4.0);
  ASSERT_TRUE(all.bottom);
  EXPECT_EQ(std::get<EllisCrowe>(*all.bottom).nu_db, -18.0);
  EXPECT_EQ(all.bottom_field.statistics.k_shape, 0.8);
  EXPECT_EQ(all.bottom_field.statistics.correlation_length, 80.0);
  EXPECT_TRUE(std::isinf(all.bottom_field.statistics.coherence_time));  // a bottom stays
  ASSERT_EQ(all.volume.size(), 1U);
  EXPECT_EQ(all.volume[0].bottom, 300.0);
  EXPECT_EQ(all.volume[0].sheets, 2);
  EXPECT_EQ(all.volume[0].field.motion.speed_rms, 0.5);
  EXPECT_TRUE(std::isinf(
      read({"reverberation.surface.frozen=true"}).surface_field.statistics.coherence_time));
}

TEST(ScenarioReader, FaultsOfReverberationNameTheKey) {
  const auto fault = [](std::string override) -> std::string {
    const std::vector<std::string> overrides{std::move(override)};
    try {
      static_cast<void>(parse_scenario(small_scenario, "small.toml", overrides));
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  };
  const std::vector<std::pair<std::string, std::string>> faults = {
      {"reverberation.azimuths=0", "reverberation.azimuths"},
      {"reverberation.scatterers_per_cell=0", "reverberation.scatterers_per_cell"},
      {"reverberation.most_returns=5", "reverberation.most_returns"},
      {"reverberation.synthesis=magic", "reverberation.synthesis"},
      {"reverberation.surface.kind=marsh", "reverberation.surface.kind"},
      {"reverberation.surface.motion=waltz", "reverberation.surface.motion"},
      {R"(reverberation.surface={motion="bragg", receding_share=2})", "receding_share"},
      {R"(reverberation.surface={motion="spread"})", "speed_rms"},
      {R"(reverberation.surface={current=[1]})", "two numbers"},
      {R"(reverberation.surface={frozen=true, coherence_time=3})", "coherence_time"},
      {R"(reverberation.surface={kind="table", grazing_deg=[5, 4], strength_db=[-3, -4]})",
       "grazing_deg[1]"},
      {R"(reverberation.surface={kind="table", grazing_deg=[5], strength_db=[-3, -4]})",
       "strength_db"},
      {R"(reverberation.bottom={kind="lambert", mu_db=5})", "reverberation.bottom.mu_db"},
      {R"(reverberation.bottom={motion="bragg"})", "reverberation.bottom.motion"},
      {R"(reverberation.bottom={k_shape=0})", "reverberation.bottom.k_shape"},
      {R"(reverberation.volume=[{depth=[300, 100], strength_db=-70}])", "the deeper one last"},
      {R"(reverberation.volume=[{depth=[100, 300]}])", "strength_db"},
      {R"(reverberation.volume=[{depth=[100, 30000], strength_db=-70}])", "depth"},
      {R"(reverberation.volume=[{depth=[100, 11000], strength_db=-70}])", "and the bottom"},
  };
  for (const auto& [override, told] : faults)
    EXPECT_NE(fault(override).find(told), std::string::npos) << override << ": " << fault(override);
}

TEST(ScenarioReader, IncludedOceanGivesWhatTheScenarioDoesNot) {
  const support::TemporaryDirectory folder;
  std::filesystem::create_directory(folder / "oceans");
  static_cast<void>(folder.write("oceans/profile.csv", "depth,speed\n0,1520\n4000,1530\n"));
  static_cast<void>(folder.write("oceans/ocean.toml", R"([environment]
wind_speed = 9.0
[environment.sound_speed]
kind = "table"
file = "profile.csv"
[environment.bottom]
depth = 4000.0
kind = "fluid"
)"));
  std::string text(small_scenario);
  text = "include = \"oceans/ocean.toml\"\n" + text.substr(text.find("[platform]"));
  const std::vector<std::string> overrides{"platform.position=[0,0,3000]"};
  const Scenario s =
      parse_scenario("environment.wind_speed = 7.0\n" + text, folder / "scenario.toml", overrides);
  EXPECT_EQ(s.wind_speed, 7.0);
  EXPECT_EQ(s.environment.water.at(0.0).c, 1520.0);  // found beside the fragment
  EXPECT_EQ(s.environment.bottom.depth, 4000.0);
  // A table with a kind of its own is not mixed with the fragment's.
  const Scenario own =
      parse_scenario("environment.sound_speed = {kind = \"isovelocity\", speed = 1490}\n" + text,
                     folder / "scenario.toml", overrides);
  EXPECT_EQ(own.environment.water.at(2000.0).c, 1490.0);
}

// Below its last level the water keeps its temperature and salinity, so the speed grows with
// pressure alone, by 0.016–0.018 (m/s)/m (Mackenzie's ∂c/∂z at these depths).
TEST(ScenarioReader, TemperatureSalinityGoesOnToTheBottom) {
  const std::vector<std::string> overrides{
      R"(environment.sound_speed={kind="temperature-salinity", depth=[10,2000], temperature=[20.0,3.5], salinity=[36.0,34.9], equation="mackenzie", latitude_deg=30})"};
  const Scenario s = parse_scenario(small_scenario, "small.toml", overrides);
  const auto depths = s.environment.water.depths();
  EXPECT_EQ(depths.front(), 0.0);
  EXPECT_EQ(depths.back(), 5000.0);
  for (std::size_t i = 3; i < depths.size(); ++i) {
    EXPECT_LE(depths[i] - depths[i - 1], 250.0 + 1e-9);
    const double gradient =
        (s.environment.water.speeds()[i] - s.environment.water.speeds()[i - 1]) /
        (depths[i] - depths[i - 1]);
    EXPECT_GT(gradient, 0.016);
    EXPECT_LT(gradient, 0.0185);
  }
}

struct Fault {
  const char* name;
  const char* replace;  // this text of the small scenario …
  const char* with;     // … by this
  const char* message;  // the whole of it
};

class ScenarioFault : public testing::TestWithParam<Fault> {};

TEST_P(ScenarioFault, IsReportedWithPlaceFindingAndExpectation) {
  const Fault& fault = GetParam();
  std::string text(small_scenario);
  const auto at = text.find(fault.replace);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, std::string(fault.replace).size(), fault.with);
  try {
    static_cast<void>(parse_scenario(text, "s.toml"));
    FAIL() << "read without complaint";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), fault.message);
  }
}

const Fault faults[] = {
    {"UnknownKey", "window = ", "windw = ",
     "s.toml:20: pulse.windw: found an unknown key, expected a known key (did you mean "
     "\"window\"?)"},
    {"UnknownTable", "[pings]", "[pngs]",
     "s.toml:30: pngs: found an unknown key, expected a known key (did you mean \"pings\"?)"},
    {"KeyOfAnotherKind", "window = \"hann\"", "start_frequency = 3950.0",
     "s.toml:20: pulse.start_frequency: found an unknown key, expected one of \"duration\", "
     "\"frequency\", \"kind\" or \"window\""},
    {"WrongType", "source_level_db = 220.0", "source_level_db = \"loud\"",
     "s.toml:13: transmitter.source_level_db: found \"loud\", expected a level from -300 to 400 "
     "dB"},
    {"FractionOfAPhone", "phones = 16", "phones = 16.5",
     "s.toml:23: array.phones: found 16.5, expected a whole number from 1 to 4096"},
    {"NoPhones", "phones = 16", "phones = 0",
     "s.toml:23: array.phones: found 0, expected a whole number from 1 to 4096"},
    {"Missing", "frequency = 4000.0\n", "",
     "s.toml:16: pulse.frequency: found nothing, expected a frequency from 0.1 to 1000000 "
     "Hz"},
    {"MissingTable", "[platform]\nposition = [0.0, 0.0, 4500.0]\n", "",
     "s.toml:1: platform.position: found nothing, expected [east, north, depth] in m"},
    {"MissingKind", "kind = \"rigid\"\n", "",
     "s.toml:7: environment.bottom.kind: found nothing, expected \"vacuum\", \"rigid\", \"fluid\", "
     "\"elastic\", \"grain-size\", \"table\" or \"layered\""},
    {"UnknownKind", "\"cw\"", "\"cv\"",
     "s.toml:17: pulse.kind: found \"cv\", expected \"cw\", \"lfm\", \"hfm\", \"sfm\", \"costas\", "
     "\"ptfm\", \"geometric_comb\", \"pulse_train\" or \"file\" (did you mean \"cw\"?)"},
    {"OutOfRange", "beamwidth_deg = 6.0", "beamwidth_deg = 0",
     "s.toml:15: transmitter.beamwidth_deg: found 0 degrees, expected a beamwidth from 0.01 "
     "to 179 degrees"},
    {"NegativeSpeed", "1500.0, 1540.0", "-1500.0, 1540.0",
     "s.toml:6: environment.sound_speed.speed[1]: found -1500 m/s, expected a speed from 200 to "
     "10000 m/s"},
    {"NotANumber", "wind_speed = 5", "wind_speed = nan",
     "s.toml:2: environment.wind_speed: found nan, expected a wind speed from 0 to 60 m/s"},
    {"Infinite", "[0.0, 0.0, 4500.0]", "[0.0, inf, 4500.0]",
     "s.toml:11: platform.position[1]: found inf, expected a coordinate from -10000000 to "
     "10000000 m"},
    {"UnsortedDepths", "[0.0, 100.0, 5000.0]", "[0.0, 6000.0, 5000.0]",
     "s.toml:5: environment.sound_speed.depth[2]: found 5000 m, expected a depth below the one "
     "before it, 6000 m"},
    {"UnequalColumns", "[1510.0, 1500.0, 1540.0]", "[1510.0, 1500.0]",
     "s.toml:6: environment.sound_speed.speed: found an array of 2, expected as many values as "
     "depths, 3"},
    {"EmptyArray", "[1510.0, 1500.0, 1540.0]", "[]",
     "s.toml:6: environment.sound_speed.speed: found an array of 0, expected an array of numbers, "
     "each a speed from 200 to 10000 m/s, one at least"},
    {"ShortSteepProfile", "[0.0, 100.0, 5000.0]", "[0.0, 10.0, 20.0]",
     "s.toml:5: environment.sound_speed.depth: found levels from 0 to 20 m, by which the speed at "
     "5000 m would be 3080 m/s, expected levels that reach from the surface to the bottom at "
     "5000 m"},
    {"MissingFile", "depth = [0.0, 100.0, 5000.0]\nspeed = [1510.0, 1500.0, 1540.0]",
     "file = \"nowhere.csv\"",
     "s.toml:5: environment.sound_speed.file: found no such file \"nowhere.csv\", expected a "
     "readable CSV file"},
    {"NegativeDepthOfWater", "depth = 5000.0\nkind", "depth = -5000.0\nkind",
     "s.toml:8: environment.bottom.depth: found -5000 m, expected a depth from 0.01 to "
     "12000 m"},
    {"PlatformBelowTheBottom", "[0.0, 0.0, 4500.0]", "[0.0, 0.0, 5500.0]",
     "s.toml:11: platform.position: found depth 5500 m at 0 s, expected a depth between the "
     "surface (0 m) and the bottom (5000 m)"},
    {"PlatformDivesIntoTheBottom", "[0.0, 0.0, 4500.0]",
     "[0.0, 0.0, 4500.0]\nvelocity = [0.0, 0.0, 5.0]",
     "s.toml:12: platform.velocity: found depth 5100 m at 120 s, expected a depth between the "
     "surface (0 m) and the bottom (5000 m)"},
    {"WaypointAboveTheSurface", "position = [0.0, 0.0, 4500.0]",
     "waypoints = [{ time = 0, position = [0, 0, 100] }, { time = 30, position = [0, 0, -1] }]",
     "s.toml:11: platform.waypoints[1]: found depth -1 m at 30 s, expected a depth between the "
     "surface (0 m) and the bottom (5000 m)"},
    {"WaypointsOutOfOrder", "position = [0.0, 0.0, 4500.0]",
     "waypoints = [{ time = 9, position = [0, 0, 100] }, { time = 3, position = [0, 0, 90] }]",
     "s.toml:11: platform.waypoints[1].time: found 3, expected a time after the waypoint before "
     "it, 9 s"},
    {"PhonesInTheBottom", "kind = \"horizontal\"\nphones = 16\nspacing = 0.1875",
     "kind = \"vertical\"\nphones = 3\nspacing = 600",
     "s.toml:23: array.phones: found phone 0 at depth 5100 m at 0 s, expected a depth between the "
     "surface (0 m) and the bottom (5000 m)"},
    {"PhoneAboveTheSurface", "kind = \"horizontal\"\nphones = 16\nspacing = 0.1875",
     "kind = \"positions\"\npositions = [[0, 0, 0], [0, 0, -4501]]",
     "s.toml:23: array.positions: found phone 1 at depth -1 m at 0 s, expected a depth between "
     "the surface (0 m) and the bottom (5000 m)"},
    {"PositionOfTwoNumbers", "[0.0, 0.0, 4500.0]", "[0.0, 4500.0]",
     "s.toml:11: platform.position: found an array of 2, expected [east, north, depth] in m"},
    {"TargetAboveTheSurface", "depth = 125.0", "depth = -125.0",
     "s.toml:28: target[0].depth: found -125 m, expected a depth from 0 to 12000 m"},
    {"TargetBelowTheBottom", "depth = 125.0", "depth = 5125.0",
     "s.toml:28: target[0].depth: found depth 5125 m at 0 s, expected a depth between the surface "
     "(0 m) and the bottom (5000 m)"},
    {"TargetSurfaces", "strength_db = 15.0", "strength_db = 15.0\nvelocity = [0, 0, -2]",
     "s.toml:30: target[0].velocity: found depth -115 m at 120 s, expected a depth between the "
     "surface (0 m) and the bottom (5000 m)"},
    {"TargetOnThePlatform", "range = 25000.0\nbearing_deg = 90.0\ndepth = 125.0",
     "position = [0, 0, 4500.5]",
     "s.toml:26: target[0].position: found 0.5 m at 0 s, expected a target at least 1 m from the "
     "platform"},
    {"TwoPlacesOfATarget", "range = 25000.0", "position = [1, 2, 3]",
     "s.toml:27: target[0].bearing_deg: found 90, expected no \"bearing_deg\" beside "
     "position"},
    {"TargetIsNoTable", "[[target]]", "[target]",
     "s.toml:25: target: found a table, expected an array of tables, [[target]]"},
    {"LastPingFirst", "strength_db = 15.0", "strength_db = 15.0\nfirst_ping = 3\nlast_ping = 2",
     "s.toml:31: target[0].last_ping: found 2, expected at least first_ping, 3"},
    {"ZeroDuration", "duration = 1.0", "duration = 0.0",
     "s.toml:19: pulse.duration: found 0 s, expected a duration from 1e-06 to 1000 s"},
    {"NegativeRecording", "recording_duration = 60", "recording_duration = -60",
     "s.toml:32: pings.recording_duration: found -60 s, expected a duration from 1e-06 to "
     "100000 s"},
    {"TooBigForMemory", "recording_duration = 60",
     "recording_duration = 4000\n[run]\nmemory = \"1 GB\"",
     "s.toml:32: pings.recording_duration: found 64000000 samples on 16 phones, which take 4.1 GB "
     "of memory, expected at most 1.0 GB, as run.memory says: a shorter record, fewer phones, a "
     "lower sample rate or pings.samples = \"baseband\", or a larger run.memory"},
    {"MemoryWithoutAUnit", "recording_duration = 60",
     "recording_duration = 60\n[run]\nmemory = \"4 apples\"",
     "s.toml:34: run.memory: found \"4 apples\", expected a memory from 1000000 to "
     "1e+18 bytes, or a text such as \"4 GB\" or \"512 MiB\""},
    {"PulseLongerThanTheRecord", "duration = 1.0", "duration = 61.0",
     "s.toml:19: pulse.duration: found 61 s, expected a pulse no longer than the record, 60 s"},
    {"SampledTooSlowly", "recording_duration = 60", "sample_rate = 8000",
     "s.toml:32: pings.sample_rate: found 8000 Hz, expected a sample rate above 8000 Hz: twice "
     "the highest frequency of the pulse with its Doppler shift"},
    {"SampledTooSlowlyForItsSideLobes", "recording_duration = 60", "sample_rate = 8004",
     "s.toml:32: pings.sample_rate: found 8004 Hz, expected a sample rate above 8006 Hz: twice "
     "the highest frequency of the pulse with its Doppler shift"},
    {"TwoElevations", "recording_duration = 60", "elevations_deg = [1, 2]",
     "s.toml:32: pings.elevations_deg: found an array of 2, expected no elevations_deg beside "
     "transmitter.elevation_deg"},
    {"NegativeSeed", "[environment]", "seed = -1\n[environment]",
     "s.toml:1: seed: found -1, expected a whole number of at least 0"},
    {"Date", "wind_speed = 5", "wind_speed = 2013-05-01",
     "s.toml:2: found a date or time, expected a number, a string, true or false, an array or a "
     "table"},
    {"Syntax", "kind = \"cw\"", "kind = cw",
     "s.toml:17:8: found a fault (Error while parsing value: could not determine value type), "
     "expected TOML 1.0"},
    {"DuplicateKey", "count = 2", "count = 2\ncount = 3",
     "s.toml:32:9: found a fault (Error while parsing key-value pair: cannot redefine existing "
     "integer 'count'), expected TOML 1.0"},
    {"NoInclude", "[environment]", "include = \"sea.toml\"\n[environment]",
     "s.toml:1: include: found no such file \"sea.toml\", expected a TOML file with an "
     "[environment]"},
};
INSTANTIATE_TEST_SUITE_P(EveryFault, ScenarioFault, testing::ValuesIn(faults),
                         [](const auto& test) { return std::string(test.param.name); });

struct OverrideFault {
  const char* assignment;
  const char* message;
};

TEST(ScenarioReader, WrongOverridesAreReportedAsSuch) {
  const OverrideFault wrong[] = {
      {"pulse.duration=-1",
       "--set pulse.duration: found -1 s, expected a duration from 1e-06 to 1000 s"},
      {"pulse.duratoin=1",
       "--set pulse.duratoin: found an unknown key, expected a known key (did you mean "
       "\"duration\"?)"},
      {"target.3.strength_db=1",
       "--set target.3.strength_db: found index \"3\" of target, expected an index from 0 to 0"},
      {"target.x.strength_db=1",
       "--set target.x.strength_db: found index \"x\" of target, expected an index from 0 to 0"},
      {"pulse.duration.long=1",
       "--set pulse.duration.long: found \"long\" below pulse.duration, which is 1, expected a "
       "path through tables and arrays"},
      {"pulse", "--set: found \"pulse\", expected key=value"},
      {"=3", "--set: found \"=3\", expected key=value"},
      {"target.0.depth=6000",
       "--set target.0.depth: found depth 6000 m at 0 s, expected a depth "
       "between the surface (0 m) and the bottom (5000 m)"},
      {"pulse={kind=",
       "--set pulse: found a fault (Error while parsing key-value pair: encountered end-of-file), "
       "expected a TOML value"},
      {"pulse.kind=beep",
       "--set pulse.kind: found \"beep\", expected \"cw\", \"lfm\", \"hfm\", \"sfm\", \"costas\", "
       "\"ptfm\", \"geometric_comb\", \"pulse_train\" or \"file\""},
  };
  for (const OverrideFault& fault : wrong) {
    const std::vector<std::string> overrides{fault.assignment};
    try {
      static_cast<void>(parse_scenario(small_scenario, "s.toml", overrides));
      ADD_FAILURE() << fault.assignment << " was read without complaint";
    } catch (const InputError& error) {
      EXPECT_STREQ(error.what(), fault.message);
    }
  }
}

TEST(ScenarioReader, FaultsInCsvProfilesNameTheirLine) {
  const support::TemporaryDirectory folder;
  std::string text(small_scenario);
  const std::string arrays = "depth = [0.0, 100.0, 5000.0]\nspeed = [1510.0, 1500.0, 1540.0]";
  text.replace(text.find(arrays), arrays.size(), "file = \"p.csv\"");
  const std::pair<const char*, const char*> wrong[] = {
      {"depth,speed\n0,1500\n100,fast\n", ":3: speed: found \"fast\", expected a finite number"},
      {"depth,speed\n# spring\n\n0,1500\n100\n", ":5: found 1 fields, expected 2 as in the header"},
      {"depth,speed\n0,1500\n100,nan\n", ":3: speed: found \"nan\", expected a finite number"},
      {"depth,speed\n0,1500\n100,1510\n50,1511\n",
       ":4: depth: found 50 m, expected a depth below the one before it, 100 m"},
      {"depth,speed\n0,-1500\n",
       ":2: speed: found -1500 m/s, expected a speed from 200 to 10000 m/s"},
      {"depth,temperature\n0,15\n",
       ": found the columns \"depth,temperature\", expected a column \"speed\""},
      {"", ": found an empty file, expected a header and at least one row of numbers"},
      {"depth,speed\n",
       ": found a header without rows, expected a header and at least one row of numbers"},
  };
  for (const auto& [content, message] : wrong) {
    const auto csv = folder.write("p.csv", content);
    try {
      static_cast<void>(parse_scenario(text, folder / "s.toml"));
      ADD_FAILURE() << "read without complaint: " << content;
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(), csv.string() + message);
    }
  }
  // A byte-order mark, CRLF, spaces and comments do no harm.
  static_cast<void>(
      folder.write("p.csv", "\xEF\xBB\xBF# x\r\nDepth , Speed\r\n0, 1500\r\n\r\n+100 ,1501\r\n"));
  EXPECT_EQ(parse_scenario(text, folder / "s.toml").environment.water.depths()[1], 100.0);
}

TEST(ScenarioReader, FilesThatCannotBeReadAreNamed) {
  const support::TemporaryDirectory folder;
  try {
    static_cast<void>(read_scenario(folder / "none.toml"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(),
              (folder / "none.toml").string() + ": found no such file, expected a scenario file");
  }
  EXPECT_THROW(static_cast<void>(read_scenario(folder.path())), InputError);
}

TEST(ScenarioReader, ARunIsNoSonar) {
  try {
    static_cast<void>(read_scenario(ASDIC_SCENARIOS "/wedge.toml"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.fault().got, "[run] and no sonar");
  }
}

TEST(Scenarios, AllOfThemRead) {
  int read = 0;
  for (const auto& entry : std::filesystem::directory_iterator(ASDIC_SCENARIOS)) {
    if (entry.path().extension() != ".toml") continue;
    if (entry.path().filename().string().starts_with("ocean_")) {  // fragments
      const std::vector<std::string> include{"include=" + entry.path().string()};
      const std::string text(small_scenario);
      EXPECT_NO_THROW(static_cast<void>(
          parse_scenario(text.substr(text.find("[platform]")), "s.toml", include)))
          << entry.path();
    } else if (!has_sonar(entry.path(), {})) {  // runs of the propagation model
      std::vector<std::string> notes;
      EXPECT_NO_THROW(static_cast<void>(read_propagation_case(entry.path(), {}, notes)))
          << entry.path();
      EXPECT_TRUE(notes.empty()) << entry.path();
    } else {
      EXPECT_NO_THROW(static_cast<void>(read_scenario(entry.path()))) << entry.path();
    }
    ++read;
  }
  EXPECT_GE(read, 5);
}

}  // namespace
}  // namespace asdic::detail
