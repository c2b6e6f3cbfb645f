#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/scenario/scenario_reader.h"
#include "sonar/ping/recorded_replica.h"
#include "support/serve.h"

// A session without sockets: every command, every refusal, and what of a scenario no client sees.

namespace asdic::detail {
namespace {

using support::Served;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Session, GreetsWithWhatItServes) {
  Served served;
  const auto hello = nlohmann::json::parse(served.session().greeting().line);
  EXPECT_EQ(hello["asdic"], 1);
  EXPECT_EQ(hello["ok"], true);
  EXPECT_EQ(hello["pace"], "fast");
  EXPECT_EQ(hello["channels"], 2);
  EXPECT_EQ(hello["sample_rate"], 200.0);
}

// The truth: PingSimulator of the same scenario, ping for ping. The schedule goes on beyond it.
TEST(Session, SamplesAreThoseOfARun) {
  Served served;
  const PingSimulator run(parse_scenario(support::served_scenario, "same.toml"));
  for (int ping = 1; ping <= 3; ++ping) {
    const auto said = served(R"({"command": "ping", "deliver": "samples"})");
    ASSERT_EQ(said["ok"], true) << said;
    EXPECT_EQ(said["ping"], ping);
    EXPECT_EQ(said["time"], 10.0 * (ping - 1));
    EXPECT_EQ(said["samples"]["shape"], (std::vector<int>{2, 1000, 2}));
    EXPECT_EQ(said["samples"]["bytes"], 2 * 1000 * 2 * 4);
    EXPECT_EQ(served.last.samples, run.simulate(ping).pressure);
  }
  EXPECT_EQ(served(R"({"command": "ping"})")["time"], 30.0);
}

// The pulse follows the samples, where it is asked for.
TEST(Session, APingMayBringItsPulse) {
  Served served;
  const auto plain = served(R"({"command": "ping", "time": 0, "deliver": "samples"})");
  const std::vector<float> pressure = served.last.samples;
  EXPECT_FALSE(plain.contains("replica"));
  const auto both = served(R"({"command": "ping", "deliver": "samples", "replica": true})");
  ASSERT_EQ(both["ok"], true) << both;
  const std::size_t values = served.last.samples.size() - pressure.size();
  EXPECT_EQ(both["samples"]["bytes"], plain["samples"]["bytes"]);
  EXPECT_EQ(both["replica"]["bytes"], values * sizeof(float));
  EXPECT_EQ(both["replica"]["shape"], (std::vector<std::size_t>{values / 2, 2}));
  const Scenario scenario = parse_scenario(support::served_scenario, "same.toml");
  const std::vector<float> pulse = recorded_replica(scenario, 0);
  EXPECT_TRUE(std::equal(pulse.begin(), pulse.end(),
                         served.last.samples.end() - static_cast<std::ptrdiff_t>(values)));
  const auto alone = served(R"({"command": "ping", "replica": true})");
  EXPECT_EQ(alone["replica"], both["replica"]);
  EXPECT_EQ(served.last.samples, pulse);
}

// Before the latest change there was another scenario, which is not kept: that is said.
TEST(Session, APingBeforeTheLatestChangeIsTold) {
  Served served;
  const auto told = [&](const char* line) {
    const auto said = served(line);
    EXPECT_EQ(said["ok"], true) << said;
    return said.value("warnings", nlohmann::json::array()).dump();
  };
  EXPECT_THAT(told(R"({"command": "ping", "time": 50})"), Not(HasSubstr("latest change")));
  told(R"({"command": "update", "time": 100, "targets": {"velocity": [1, 0, 0]}})");
  EXPECT_THAT(told(R"({"command": "ping", "time": 99})"),
              HasSubstr("time: 99 s lies before the latest change, at 100 s"));
  EXPECT_THAT(told(R"({"command": "ping", "time": 100})"), Not(HasSubstr("latest change")));
  told(R"({"command": "update", "time": 20, "wind_speed": 3})");
  EXPECT_THAT(told(R"({"command": "ping", "time": 30})"), HasSubstr("latest change"));
}

TEST(Session, AnUpdateInThePastIsTold) {
  Served served;
  const auto told = [&](const char* line) {
    const auto said = served(line);
    EXPECT_EQ(said["ok"], true) << said;
    EXPECT_FALSE(said.contains("behind"));  // there is no clock
    return said.value("warnings", nlohmann::json::array()).dump();
  };
  EXPECT_THAT(told(R"({"command": "update", "time": 100, "wind_speed": 3})"),
              Not(HasSubstr("lies")));
  EXPECT_THAT(told(R"({"command": "update", "time": 99, "wind_speed": 4})"),
              HasSubstr("time: 99 s lies before the latest change, at 100 s"));
  EXPECT_EQ(served(R"({"command": "ping", "time": 200})")["ok"], true);
  EXPECT_THAT(told(R"({"command": "update", "time": 150, "wind_speed": 3})"),
              HasSubstr("time: 150 s lies before the latest ping, at 200 s"));
  EXPECT_THAT(told(R"({"command": "update", "time": 200, "wind_speed": 4})"),
              Not(HasSubstr("lies")));
  EXPECT_THAT(told(R"({"command": "update", "wind_speed": 5})"), Not(HasSubstr("lies")));
  serve::SessionSettings settings;
  settings.pace = {.factor = 2.0};
  Served live(support::served_scenario, settings);
  live.clock += 10.0;
  EXPECT_EQ(live(R"({"command": "update", "time": 19.5, "wind_speed": 5})")["behind"], 0.5);
  EXPECT_EQ(live(R"({"command": "update", "wind_speed": 5})")["behind"], 0.0);
}

// 3 km away and back at 1500 m/s: 4 s. TL = 20 log 3000, RL = SL − 2 TL + TS.
TEST(Session, TellsTheEchoOfEachTarget) {
  Served served;
  const auto said = served(R"({"id": 1, "command": "ping"})");
  ASSERT_EQ(said["targets"].size(), 1U);
  const auto& rock = said["targets"][0];
  EXPECT_EQ(rock["name"], "rock");
  EXPECT_NEAR(rock["echo_time"].get<double>(), 4.0, 1e-6);
  EXPECT_NEAR(rock["echo_level_db"].get<double>(), 200.0 - 40.0 * std::log10(3000.0) + 10.0, 1e-3);
  EXPECT_NEAR(said["first_echo"].get<double>(), 4.0, 1e-6);
  for (const char* stage :
       {"prepare", "rays", "eigenrays", "patches", "synthesis", "noise", "write"})
    EXPECT_GE(said["timings"][stage].get<double>(), 0.0) << stage;
  EXPECT_EQ(said["latency"], 0.0);  // by a clock that stands
  EXPECT_FALSE(said.contains("file"));
}

TEST(Session, APingHasALevelABeamAndAWaveformOfItsOwn) {
  Served served;
  const auto level = [&](const std::string& line) {
    const auto said = served(line);
    EXPECT_EQ(said["ok"], true) << said;
    return said["targets"][0]["echo_level_db"].get<double>();
  };
  const double usual = level(R"({"command": "ping"})");
  EXPECT_NEAR(level(R"({"command": "ping", "source_level_db": 210})"), usual + 10.0, 1e-9);
  EXPECT_NEAR(level(R"({"command": "ping", "elevation_deg": 10})"), usual - 3.0,
              0.1);  // half the beam
  EXPECT_NEAR(level(R"({"command": "ping", "elevation_deg": 5, "beamwidth_deg": 10})"), usual - 3.0,
              0.1);
  EXPECT_EQ(served(R"({"command": "ping", "elevation_deg": 7})")["elevation_deg"], 7.0);
  EXPECT_EQ(level(R"({"command": "ping"})"), usual);  // for that ping alone
  const auto sweep = served(
      R"({"command": "ping", "waveform": {"kind": "lfm", "start_frequency": 980.0,
          "end_frequency": 1020.0, "duration": 0.5, "window": "hann"}})");
  EXPECT_EQ(sweep["ok"], true) << sweep;
  for (
      const char* pulse :
      {R"("kind": "costas", "frequency": 1000.0, "prime": 5)",
       R"("kind": "sfm", "frequency": 1000.0, "swing": 40.0, "modulation_frequency": 6.0)",
       R"("kind": "ptfm", "start_frequency": 980.0, "end_frequency": 1020.0, "sweeps": 4)",
       R"("kind": "geometric_comb", "start_frequency": 980.0, "end_frequency": 1020.0, "lines": 4)",
       R"("kind": "pulse_train", "frequency": 1000.0, "pulses": 3, "pulse_duration": 0.1)"}) {
    const auto said =
        served(R"({"command": "ping", "waveform": {"duration": 0.5, "window": "hann", )" +
               std::string(pulse) + "}}");
    EXPECT_EQ(said["ok"], true) << said;
  }
}

TEST(Session, APingHasATimeOfItsOwn) {
  Served served;
  ASSERT_EQ(served(R"({"command": "update", "targets": {"velocity": [-10, 0, 0]}})")["ok"], true);
  const auto said = served(R"({"command": "ping", "time": 100})");
  EXPECT_EQ(said["time"], 100.0);
  EXPECT_EQ(said["ping"], 1);
  // 2000 m away then, still closing: τ/2 = (2000 − 10·τ/2)/1500.
  EXPECT_NEAR(said["targets"][0]["echo_time"].get<double>(), 2.0 * 2000.0 / 1510.0, 1e-3);
  EXPECT_EQ(served(R"({"command": "ping"})")["time"], 110.0);  // the interval goes on from there
}

TEST(Session, PlatformsMoveFromWhereTheyAreSaidToBe) {
  Served served;
  const auto at = [&] { return served(R"({"command": "state"})")["platforms"][0]; };
  ASSERT_EQ(served
                .refusal(R"({"command": "update", "time": 10, "platform":
                             {"position": [100, 0, 300], "heading_deg": 90, "speed": 2}})")
                .substr(0, 1),
            "{");
  served(R"({"command": "ping"})");  // the next is at 10 s
  EXPECT_EQ(at()["position"], (std::vector<double>{100.0, 0.0, 300.0}));
  EXPECT_NEAR(at()["velocity"][0].get<double>(), 2.0, 1e-9);
  served(R"({"command": "ping"})");  // 20 s
  EXPECT_NEAR(at()["position"][0].get<double>(), 120.0, 1e-9);
  served(R"({"command": "update", "platform": {"speed": 4}})");
  served(R"({"command": "ping"})");  // 30 s
  EXPECT_NEAR(at()["position"][0].get<double>(), 160.0, 1e-6);
  served(R"({"command": "update", "platform": {"velocity": [0, 0, 0]}})");
  EXPECT_NEAR(at()["position"][0].get<double>(), 160.0, 1e-6);
  served(R"({"command": "update", "platform": {"waypoints": [{"time": 0, "position": [0, 0, 50]},
                                                           {"time": 60, "position": [0, 60, 50]}]}})");
  EXPECT_EQ(at()["position"], (std::vector<double>{0.0, 30.0, 50.0}));
}

TEST(Session, TargetsComeAndGo) {
  Served served;
  const auto names = [&] {
    std::string all;
    const nlohmann::json said = served(R"({"command": "state"})");
    for (const auto& one : said["targets"]) all += one["name"].get<std::string>() + " ";
    return all;
  };
  EXPECT_EQ(served(R"({"command": "update", "targets": [{"name": "whale", "strength_db": 0,
                      "position": [0, 2000, 100], "heading_deg": 0, "speed": 1}]})")["ok"],
            true);
  EXPECT_EQ(names(), "rock whale ");
  EXPECT_EQ(served(R"({"command": "ping"})")["targets"].size(), 2U);
  EXPECT_EQ(served(R"({"command": "update", "targets": [{"name": "rock", "remove": true}]})")["ok"],
            true);
  EXPECT_EQ(names(), "whale ");
  EXPECT_EQ(served(R"({"command": "update", "targets": {"remove": true}})")["ok"], true);
  EXPECT_EQ(served(R"({"command": "ping"})")["targets"].size(), 0U);
}

// A target whose place was given from the platform's start stays there when that moves.
TEST(Session, TargetsDoNotFollowThePlatform) {
  std::string text = support::served_scenario;
  const std::string position = "position = [3000.0, 0.0, 200.0]";
  text.replace(text.find(position), position.size(),
               "range = 3000.0\nbearing_deg = 90.0\ndepth = 200.0");
  Served served(text);
  served(R"({"command": "update", "platform": {"position": [1000, 0, 200]}})");
  const auto said = served(R"({"command": "ping"})");
  EXPECT_NEAR(said["targets"][0]["echo_time"].get<double>(), 2.0 * 2000.0 / 1500.0, 1e-6) << said;
}

// What does not depend on what changed is not traced again.
TEST(Session, TellsWhatItReused) {
  Served served;
  const auto reused = [&](const std::string& update) {
    if (!update.empty()) served(R"({"command": "update", )" + update + "}");
    return served(R"({"command": "ping", "time": 0})")["reused"];
  };
  EXPECT_EQ(reused("")["ocean"], false);
  const auto noise = reused(R"("noise": {"spectral_level_db": 50})");
  EXPECT_EQ(noise["ocean"], true);
  EXPECT_EQ(noise["legs"], 2);  // there and back
  EXPECT_EQ(noise["legs_searched"], 0);
  EXPECT_EQ(noise["reverberation"], true);
  const auto target = reused(R"("targets": {"position": [2000, 0, 300]})");
  EXPECT_EQ(target["legs_searched"], 2);
  EXPECT_EQ(target["reverberation"], true);
  EXPECT_EQ(reused(R"("sound_speed": {"kind": "isovelocity", "speed": 1490})")["ocean"], false);
}

TEST(Session, UpdatesChangeWhatIsReceived) {
  Served served;
  const auto samples = [&] {
    served(R"({"command": "ping", "time": 0, "deliver": "samples"})");
    return served.last.samples;
  };
  const struct {
    std::string fields;
    std::size_t channels;
  } cases[] = {
      {R"("wind_speed": 15)", 2},
      {R"("sound_speed": {"depth": [0, 1000], "speed": [1480, 1520]})", 2},
      {R"("sound_speed": {"kind": "isovelocity", "speed": 1490})", 2},
      {R"("noise": {"spectral_level_db": 60})", 2},
      {R"("noise": {"kind": "knudsen", "sea_state": 3})", 2},
      {R"("seed": 9)", 2},
      {R"("array": {"positions": [[0, 0, 0], [1, 1, 0], [2, 2, 1]]})", 3},
  };
  for (const auto& one : cases) {
    const auto said = served(R"({"command": "update", )" + one.fields + "}");
    ASSERT_EQ(said["ok"], true) << said;
    EXPECT_EQ(samples().size(), one.channels * 1000 * 2) << one.fields;
  }
  ASSERT_EQ(served(R"({"command": "update", "recording": {"duration": 2, "start": 1}})")["ok"],
            true);
  EXPECT_EQ(samples().size(), 3U * 400 * 2);
}

// What was received after changes is what `asdic ping` receives with the overrides that the state
// has.
TEST(Session, OverridesSayWhatWasReceived) {
  const support::TemporaryDirectory output;
  serve::SessionSettings settings;
  settings.output = output.path();
  Served served(support::served_scenario, settings);
  ASSERT_EQ(served(R"({"command": "update", "wind_speed": 3, "targets": {"strength_db": 25},
                     "platform": {"position": [10, 0, 150], "velocity": [1, 2, 0.1]}})")["ok"],
            true);
  const auto said = served(
      R"({"command": "ping", "elevation_deg": 4, "waveform": {"kind": "cw", "frequency": 1005.0, "duration": 0.2, "window": "hann"}})");
  ASSERT_EQ(said["ok"], true) << said;
  EXPECT_EQ(said["dataset"], "/pressure");
  EXPECT_EQ(std::filesystem::path(said["file"].get<std::string>()),
            output / "session-0001/ping-000001.h5");
  const PingFile file(said["file"].get<std::string>());
  EXPECT_TRUE(file.complete());
  EXPECT_EQ(file.scenario_text(), support::served_scenario);
  const auto overrides = file.file().attribute_texts("", "overrides");
  const PingSimulator again(parse_scenario(file.scenario_text(), "again.toml", overrides));
  const PingRecord record = again.simulate(1);
  const std::size_t row = record.pressure.size() / 2;
  EXPECT_EQ(file.pressure(0, 0), std::vector<float>(record.pressure.begin(),
                                                    record.pressure.begin() + std::ptrdiff_t(row)));
}

TEST(Session, FilesAreNotWrittenOver) {
  const support::TemporaryDirectory output;
  serve::SessionSettings settings;
  settings.output = output.path();
  for (int session = 1; session <= 2; ++session) {
    Served served(support::served_scenario, settings);
    for (int ping = 1; ping <= 2; ++ping)
      EXPECT_THAT(served(R"({"command": "ping"})")["file"].get<std::string>(),
                  ::testing::EndsWith("session-000" + std::to_string(session) + "/ping-00000" +
                                      std::to_string(ping) + ".h5"));
  }
}

TEST(Session, ADiskThatIsFullIsOurSecret) {
  serve::SessionSettings settings;
  settings.output = "/proc/SECRET";  // where nothing can be made
  Served served(support::served_scenario, settings);
  EXPECT_EQ(served.refusal(R"({"command": "ping"})"),
            "run: it could not be done; the server's log says why");
  EXPECT_THAT(served.log, HasSubstr("/proc/SECRET"));
}

struct RefusedCase {
  std::string line, message;
};

TEST(Session, RefusesInOneMessage) {
  const std::string update = R"({"command": "update", )", ping = R"({"command": "ping", )";
  const RefusedCase cases[] = {
      {ping + R"("time": -1})", "value: time: found -1 s, expected a time from 0 to 1e+09 s"},
      {ping + R"("time": "now"})", "value: time: found \"now\", expected a time from 0 to 1e+09 s"},
      {ping + R"("elevation_deg": 91})",
       "value: elevation_deg: found 91 degrees, expected an elevation from -90 to 90 degrees"},
      {ping + R"("level": 200})",
       R"(value: level: found an unknown key, expected one of "beamwidth_deg", "deliver", "elevation_deg", "replica", "source_level_db", "time", "transmitter" or "waveform")"},
      {ping + R"("wave_form": 2})",
       "value: wave_form: found an unknown key, expected a known key (did you mean "
       "\"waveform\"?)"},
      {ping + R"("deliver": "file"})",
       "value: deliver: found \"file\", expected \"samples\" or \"none\": the server has no "
       "--output-dir"},
      {ping + R"("transmitter": "x"})",
       "value: transmitter: found \"x\", expected the name of a transmitter"},
      {ping + R"("waveform": 5})", "value: waveform: found 5, expected a table"},
      {ping + R"("waveform": {"kind": "cw"}})",
       "scenario: waveform.frequency: found nothing, expected a frequency from 0.1 to "
       "1000000 Hz"},
      {ping + R"("waveform": {"kind": "file", "file": "/etc/passwd"}})",
       "file: waveform.file: found a file, expected none: the server was started without "
       "--data-dir"},
      {ping + R"("output": "/tmp/x.h5"})",
       R"(value: output: found an unknown key, expected one of "beamwidth_deg", "deliver", "elevation_deg", "replica", "source_level_db", "time", "transmitter" or "waveform")"},
      {R"({"command": "update"})",
       "value: update: found nothing, expected platform, array, targets, wind_speed, sound_speed, "
       "noise, seed or recording"},
      {update + R"("platform": {"name": "ship", "speed": 1}})",
       "value: platform.name: found \"ship\", expected the name of one of the platforms"},
      {update + R"("platform": {"position": [1, 2]}})",
       "value: platform.position: found an array of 2, expected [east, north, depth] in m"},
      {update + R"("platform": {"speed": 1, "velocity": [1, 0, 0]}})",
       "value: platform.speed: found 1, expected none of it beside velocity"},
      {update + R"("platform": {"position": [0, 0, 2000]}})",
       "scenario: platform.position: found depth 2000 m at 0 s, expected a depth between the "
       "surface (0 m) and the bottom "
       "(1000 m)"},
      {update + R"("time": 30, "platform": {"position": [0, 0, 2000], "speed": 2,
                    "heading_deg": 10}})",
       "scenario: platform.position: found depth 2000 m at 0 s, expected a depth between the "
       "surface (0 m) and the bottom (1000 m)"},
      {update + R"("platform": {"heading": 3}})",
       "value: platform.heading: found an unknown key, expected a known key (did you mean "
       "\"heading_deg\"?)"},
      {update + R"("targets": {"name": "new", "postion": [0, 900, 100]}})",
       "value: targets.postion: found an unknown key, expected a known key (did you mean "
       "\"position\"?)"},
      {update + R"("targets": {"name": "new", "position": [0, 900, 100]}})",
       "scenario: targets.strength_db: found nothing, expected a target strength from -200 to 200 "
       "dB"},
      {update + R"("targets": {"name": "new"}})",
       "value: targets.position: found nothing, expected the position of a new target"},
      {update + R"("seed": 1e30})",
       "value: seed: found 1e+30, expected a whole number from 0 to 9223372036854775806"},
      {update + R"("wind_speed": 61})",
       "value: wind_speed: found 61 m/s, expected a wind speed from 0 to 60 m/s"},
      {update + R"("sound_speed": {"depth": [0, 1000], "speed": [1500]}})",
       "scenario: sound_speed.speed: found an array of 1, expected as many values as depths, 2"},
      {update + R"("targets": [{"name": "rock", "strength_db": 5}, {"name": "b",
                                "position": [0, 9, 9], "strength_db": 999}]})",
       "scenario: targets[1].strength_db: found 999 dB, expected a target strength from -200 to "
       "200 dB"},
      {ping + R"("source_level_db": 200, "waveform": {"kind": "cw", "frequency": 1000.0,
                 "duration": 0.1, "colour": "red"}})",
       R"(scenario: waveform.colour: found an unknown key, expected one of "duration", "frequency", "kind" or "window")"},
      {ping + R"("waveform": {"kind": "cw", "frequency": 1000.0, "duration": 9.0}})",
       "scenario: waveform.duration: found 9 s, expected a pulse no longer than the record, 5 s"},
      {ping + R"("waveform": {"kind": "lfm", "start_frequency": 500.0, "end_frequency": 1500.0,
                 "duration": 0.1}})",
       "scenario: pings.baseband_rate: found what the scenario has, expected a baseband rate of at "
       "least 2000 Hz: the pulse's band with its Doppler shift about a carrier of 1000 Hz"},
      {update + R"("seed": 1.5})",
       "value: seed: found 1.5, expected a whole number from 0 to 9223372036854775806"},
      {update + R"("pings": {"count": 9}})",
       R"(value: pings: found an unknown key, expected one of "array", "noise", "platform", "recording", "seed", "sound_speed", "targets", "time" or "wind_speed")"},
      {R"({"command": "state", "of": "SECRET"})",
       "value: state: found further keys, expected \"command\" and \"id\" alone"},
  };
  Served served;
  for (const RefusedCase& one : cases) {
    EXPECT_EQ(served.refusal(one.line), one.message) << one.line;
    EXPECT_THAT(served.last.line, Not(HasSubstr("SECRET_scenario"))) << one.line;
  }
  EXPECT_EQ(served(R"({"command": "ping"})")["ping"], 1);  // none of them counted, or changed it
}

TEST(Session, CapsWhatAPingMayNeed) {
  const struct {
    std::string limit, line, message;
  } cases[] = {
      {"samples=1000", R"({"command": "update", "recording": {"duration": 5.5}})",
       "limit: samples of a phone: found 1100, expected at most 1000"},
      {"channels=2", R"({"command": "update", "array": {"positions": [[0,0,0],[1,0,0],[2,0,0]]}})",
       "limit: phones: found 3, expected at most 2"},
      {"targets=1",
       R"({"command": "update", "targets": {"name": "b", "position": [9, 9, 9], "strength_db": 1}})",
       "limit: targets: found 2, expected at most 1"},
      {"answer_bytes=15000", R"({"command": "ping", "deliver": "samples"})",
       "limit: deliver: found more samples, expected at most 15000 bytes in an answer"},
  };
  for (const auto& one : cases) {
    serve::SessionSettings settings;
    serve::set_limit(settings.limits, one.limit);
    Served served(support::served_scenario, settings);
    EXPECT_EQ(served.refusal(one.line), one.message);
    EXPECT_EQ(served(R"({"command": "ping"})")["ok"], true) << one.limit;  // it goes on
  }
  for (const std::string limit :
       {"samples=999", "channels=1", "patches=1000", "memory_bytes=1000"}) {
    serve::SessionSettings settings;
    serve::set_limit(settings.limits, limit);
    EXPECT_THROW(Served(support::served_scenario, settings), InputError) << limit;
  }
}

// A straight line has no end in time, and is refused where coordinates have theirs.
TEST(Session, AStraightLineGoesOn) {
  Served served;
  ASSERT_EQ(served(R"({"command": "update", "time": 0, "targets":
                     {"position": [3000, 0, 200], "velocity": [0.01, 0, 0]}})")["ok"],
            true);
  for (const double time : {86400.0, 200000.0, 900000.0}) {
    const auto said = served(R"({"command": "ping", "time": )" + std::to_string(time) + "}");
    ASSERT_EQ(said["ok"], true) << said;
    // The echo comes from where the target is when it is hit: there and back at 1500 m/s.
    EXPECT_NEAR(said["first_echo"].get<double>(), 2.0 * (3000.0 + 0.01 * time) / 1500.0, 1e-3);
  }
  ASSERT_EQ(served(R"({"command": "update", "time": 900000, "targets":
                     {"position": [9989000, 0, 100], "velocity": [10, 0, 0]}})")["ok"],
            true);
  EXPECT_THAT(served.refusal(R"({"command": "ping", "time": 900200})"),
              HasSubstr("targets: found a place 9990000 m away at 900200 s, expected coordinates "
                        "below 9990000 m"));
}

// Phones and targets stay in the water from the ping to the end of its record.
TEST(Session, LooksWhereThingsAreWhenAPingIsSent) {
  Served served;
  ASSERT_EQ(served(R"({"command": "update", "targets": {"velocity": [0, 0, 10]}})")["ok"], true);
  EXPECT_EQ(served(R"({"command": "ping", "time": 70})")["ok"], true);  // 900 m; 950 m at the end
  EXPECT_EQ(served.refusal(R"({"command": "ping", "time": 78})"),
            "scenario: targets: found depth 1030 m at 83 s, expected a depth between the surface "
            "(0 m) and the bottom (1000 m)");
  ASSERT_EQ(served(R"({"command": "update", "time": 0, "targets":
                     {"position": [3000, 0, 200], "velocity": [-10, 0, 0]}})")["ok"],
            true);
  EXPECT_EQ(served.refusal(R"({"command": "ping", "time": 300})"),
            "scenario: targets: found 0 m, expected at least 1 m from the platform");
}

// Phones are where the offset puts them, also where the platform is not in their middle.
TEST(Session, LooksWhereThePhonesOfALineBelowThePlatformAre) {
  std::string line = support::served_scenario;
  const std::string level = "kind = \"horizontal\"\nphones = 2\nspacing = 0.75\n";
  const auto at = line.find(level);
  ASSERT_NE(at, std::string::npos);
  line.replace(at, level.size(), "kind = \"positions\"\npositions = [[0, 0, 0], [0, 0, 100]]\n");
  Served served(line);
  ASSERT_EQ(served(R"({"command": "update", "platform": {"velocity": [0, 0, 10]}})")["ok"], true);
  EXPECT_EQ(served(R"({"command": "ping", "time": 64})")["ok"], true);  // 940 m; 990 m at the end
  EXPECT_EQ(served.refusal(R"({"command": "ping", "time": 68})"),
            "scenario: array: found depth 1030 m at 73 s, expected a depth between the surface "
            "(0 m) and the bottom (1000 m)");
}

TEST(Session, AContinuousRecordIsListenedTo) {
  Served served(std::string(support::served_scenario) + "continuous = true\n");
  EXPECT_THAT(served.refusal(R"({"command": "ping"})"), HasSubstr("\"listen\" before it"));
}

// By the clock: a ping without a time is sent now; one in the future waits for it.
TEST(Session, KeepsTimeByTheClock) {
  serve::SessionSettings settings;
  settings.pace = {.factor = 2.0};
  Served served(support::served_scenario, settings);
  served.clock += 5.0;
  EXPECT_EQ(served(R"({"command": "ping"})")["time"], 10.0);
  const auto wait = [&](const std::string& line) {
    return served.session().wait(serve::read_command(line, {}));
  };
  EXPECT_EQ(wait(R"({"command": "ping"})"), 0.0);
  EXPECT_EQ(wait(R"({"command": "ping", "time": 30})"), 10.0);
  EXPECT_EQ(wait(R"({"command": "ping", "time": 4})"), 0.0);
  EXPECT_EQ(wait(R"({"command": "state"})"), 0.0);
  EXPECT_EQ(served(R"({"command": "ping", "time": 4})")["behind"], 3.0);
  EXPECT_EQ(served.refusal(R"({"command": "ping", "time": 2000})"),
            "limit: time: found 2000 s, expected a ping at most idle_seconds ahead of the clock");
}

TEST(Session, QuitEndsItWithItsLatencies) {
  Served served;
  served(R"({"command": "ping"})");
  const auto said = served(R"({"id": "bye", "command": "quit"})");
  EXPECT_EQ(said["id"], "bye");
  EXPECT_EQ(said["pings"], 1);
  EXPECT_EQ(said["latency"]["pings"], 1);
  EXPECT_TRUE(served.last.last);
}

TEST(Session, TellsItsLimits) {
  Served served;
  const auto limits = served(R"({"command": "limits"})")["limits"];
  EXPECT_EQ(limits["queued_pings"], 8);
  EXPECT_EQ(limits.size(), serve::limits_by_name({}).size());
}

// A cast in the data folder: found, wrong, and not told what it says.
TEST(Session, ReadsFilesOfTheDataFolder) {
  const support::TemporaryDirectory data;
  static_cast<void>(data.write("good.csv", "depth,speed\n0,1500\n1000,1520\n"));
  static_cast<void>(data.write("bad.csv", "depth,speed\n0,1500\nSECRET,1520\n"));
  static_cast<void>(data.write("worse.csv", "SECRET\n"));
  static_cast<void>(data.write("order.csv", "depth,speed\n0,1500\n777.25,1520\n5,1500\n"));
  static_cast<void>(data.write("short.csv", "depth,speed\n777.25,1500\n778.25,1450\n"));
  serve::SessionSettings settings;
  settings.data = serve::DataFolder(data.path());
  Served served(support::served_scenario, settings);
  const auto cast = [&](const std::string& name) {
    return served.refusal(R"({"command": "update", "sound_speed": {"file": ")" + name + "\"}}");
  };
  EXPECT_EQ(cast("good.csv").substr(0, 1), "{");
  for (const std::string name :
       {"bad.csv", "worse.csv", "order.csv", "short.csv", "missing.csv", "../x.csv"}) {
    EXPECT_THAT(cast(name), Not(HasSubstr("777.25"))) << name;
    const std::string message = cast(name);
    EXPECT_THAT(message, HasSubstr("expected")) << name;
    EXPECT_THAT(message, Not(HasSubstr("SECRET"))) << name;
    EXPECT_THAT(message, Not(HasSubstr(data.path().string()))) << name;
  }
}

}  // namespace
}  // namespace asdic::detail
