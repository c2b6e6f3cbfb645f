// The public face: arrivals, rays, fields, pings, files, receivers, studies.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "asdic/asdic.h"
#include "support/program.h"

namespace {

namespace support = asdic::detail::support;
using testing::HasSubstr;

asdic::Scenario small_sea() { return asdic::Scenario::parse(support::small_scenario); }

asdic::Scenario lloyd() {
  asdic::Scenario sea;
  sea.set("environment.sound_speed", asdic::SoundSpeed{.depth = {0.0}, .speed = {1500.0}})
      .set("environment.bottom", asdic::Bottom{.depth = 5000.0,
                                               .speed = 1500.0,
                                               .density = 1027.0,
                                               .attenuation_db_per_wavelength = 0.0})
      .set("environment.absorption.kind", "none")
      .set("run.frequency", 100.0)
      .set("run.solver", "waves")
      .set("run.source.depth", 50.0)
      .set("run.receivers.depth", asdic::Value(std::vector<double>{40.0, 80.0}))
      .set("run.receivers.range", asdic::EvenlySpaced{200.0, 400.0, 3});
  return sea;
}

/// Lengths of the four paths with at most one bounce a boundary, of images in a sea of rigid
/// bottom: depth 1000 m, source at z, receiver at 500 m, 3000 m away.
std::vector<double> image_delays(double source, double receiver, double range, double depth) {
  std::vector<double> delays;
  for (const double image :
       {source, -source, 2.0 * depth - source, 2.0 * depth + source, -(2.0 * depth - source)})
    delays.push_back(std::hypot(range, receiver - image) / 1500.0);
  std::sort(delays.begin(), delays.end());
  return delays;
}

TEST(PublicArrivals, AreThoseOfImages) {
  const std::vector<asdic::Arrival> found =
      asdic::arrivals(small_sea(), {.range = 3000.0, .depth = 500.0});
  const std::vector<double> expected = image_delays(200.0, 500.0, 3000.0, 1000.0);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i].delay, expected[i], 1e-9);
    EXPECT_NEAR(found[i].level_db(), -20.0 * std::log10(1500.0 * expected[i]), 1e-6);
    EXPECT_EQ(found[i].bounces.size(),
              std::size_t(found[i].surface_bounces + found[i].bottom_bounces));
  }
  EXPECT_THROW(static_cast<void>(asdic::arrivals(small_sea(), {.range = 1e3, .depth = 2e3})),
               asdic::InputError);
  EXPECT_THROW(
      static_cast<void>(asdic::arrivals(small_sea(), {.range = 1e3, .depth = 5e2, .ping = 3})),
      asdic::InputError);
}

TEST(PublicArrivals, OfARunAreItsOcean) {
  const std::vector<asdic::Arrival> found =
      asdic::arrivals(lloyd(), {.range = 300.0, .depth = 40.0});
  ASSERT_GE(found.size(), 2U);
  EXPECT_NEAR(found[0].delay, std::hypot(300.0, 10.0) / 1500.0, 1e-9);
  EXPECT_NEAR(found[1].delay, std::hypot(300.0, 90.0) / 1500.0, 1e-9);
}

TEST(PublicLegs, GoOutAndHome) {
  const std::vector<asdic::Leg> legs = asdic::legs(small_sea());
  ASSERT_EQ(legs.size(), 2U);
  EXPECT_EQ(legs[0].kind, asdic::Leg::Kind::source_to_target);
  EXPECT_EQ(legs[1].kind, asdic::Leg::Kind::target_to_array);
  EXPECT_EQ(legs[1].array, 0);
  EXPECT_NEAR(legs[0].range, 3000.0, 1e-9);
  EXPECT_NEAR(legs[0].arrivals[0].delay, std::hypot(3000.0, 300.0) / 1500.0, 1e-9);
}

// Where the speed is one, rays are straight: 8 degrees down from 200 m.
// What the header says of a receiver below the source: the path that it would have at 0.1 m,
// upright.
TEST(PublicArrivals, StraightBelowAreThoseOfATenthOfAMetre) {
  const auto found = asdic::arrivals(small_sea(), {.range = 0.0, .depth = 500.0});
  const std::vector<double> there = image_delays(200.0, 500.0, 0.1, 1000.0),
                            upright = image_delays(200.0, 500.0, 0.0, 1000.0);
  ASSERT_EQ(found.size(), there.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i].delay, there[i], 1e-12);
    EXPECT_NEAR(found[i].delay - upright[i], 0.01 / (2.0 * upright[i] * 1500.0 * 1500.0), 1e-12);
    EXPECT_DOUBLE_EQ(std::abs(found[i].launch_elevation), asdic::radians(90.0));
    for (const asdic::Bounce& bounce : found[i].bounces) EXPECT_EQ(bounce.range, 0.0);
  }
  const auto itself =
      asdic::arrivals(small_sea(), {.range = 0.0, .depth = 200.0, .source_depth = 200.0});
  ASSERT_FALSE(itself.empty());
  EXPECT_NEAR(itself.front().path_length, 0.1, 1e-6);
}

TEST(PublicRays, AreStraightInStillWater) {
  const double down = asdic::radians(-8.0);
  const std::vector<asdic::Ray> rays =
      asdic::rays(small_sea(), {.elevations = {down, 0.0}, .range = 5000.0});
  ASSERT_EQ(rays.size(), 2U);
  EXPECT_DOUBLE_EQ(rays[0].range.back(), 5000.0);
  EXPECT_NEAR(rays[0].depth.back(), 200.0 - 5000.0 * std::tan(down), 1e-6);
  EXPECT_NEAR(rays[0].time.back(), 5000.0 / std::cos(down) / 1500.0, 1e-9);
  EXPECT_EQ(asdic::rays(small_sea(), {.count = 5}).size(), 5U);
  EXPECT_THROW(static_cast<void>(asdic::rays(small_sea(), {.elevations = {2.0}})),
               asdic::InputError);
  EXPECT_THROW(static_cast<void>(asdic::rays(small_sea(), {.source_depth = 3e3})),
               asdic::InputError);
}

// Two images under a soft surface. The bottom is as the water, and sends nothing back.
TEST(PublicField, IsLloydsMirror) {
  const asdic::Field field = asdic::field(lloyd());
  ASSERT_EQ(field.pressure.size(), 6U);
  const double k = 2.0 * 3.14159265358979323846 * 100.0 / 1500.0;
  for (std::size_t row = 0; row < 2; ++row)
    for (std::size_t column = 0; column < 3; ++column) {
      const double r = field.ranges[column], z = field.depths[row];
      const double near = std::hypot(r, z - 50.0), far = std::hypot(r, z + 50.0);
      const std::complex<double> exact =
          std::polar(1.0 / near, -k * near) - std::polar(1.0 / far, -k * far);
      EXPECT_NEAR(field.loss_db(row, column), -20.0 * std::log10(std::abs(exact)), 0.05);
    }
  EXPECT_THROW(static_cast<void>(field.loss_db(2, 0)), asdic::InputError);
  EXPECT_THROW(static_cast<void>(asdic::field(small_sea())), asdic::InputError);  // no [run]
}

TEST(PublicPing, HasEchoesWhereTheImagesAre) {
  const asdic::Ping ping = asdic::ping(small_sea());
  EXPECT_EQ(ping.number(), 1);
  EXPECT_EQ(ping.channels(), 2U);
  EXPECT_EQ(ping.samples(), 20000U);
  EXPECT_EQ(ping.sample_rate(), 4000.0);
  EXPECT_EQ(ping.pressure().size(), 40000U);
  EXPECT_EQ(ping.channel(1).data(), ping.pressure().data() + 20000);  // no copy
  EXPECT_FALSE(ping.is_complex());
  ASSERT_FALSE(ping.echoes().empty());
  const double first = 2.0 * std::hypot(3000.0, 300.0) / 1500.0;
  const auto earliest =
      std::min_element(ping.echoes().begin(), ping.echoes().end(),
                       [](const auto& a, const auto& b) { return a.delay < b.delay; });
  EXPECT_NEAR(earliest->delay, first, 1e-6);
  EXPECT_THROW(static_cast<void>(ping.channel(2)), asdic::InputError);
  EXPECT_THROW(static_cast<void>(asdic::ping(small_sea(), 3)), asdic::InputError);
}

TEST(PublicPing, OfAPingerIsTheSame) {
  const asdic::Pinger pinger(small_sea());
  EXPECT_EQ(pinger.pings(), 2);
  std::vector<asdic::Ping> all;
  pinger.run([&](const asdic::Ping& ping) { all.push_back(ping); });
  ASSERT_EQ(all.size(), 2U);
  for (int n = 1; n <= 2; ++n) {
    EXPECT_EQ(all[std::size_t(n - 1)].number(), n);
    const asdic::Ping alone = asdic::ping(small_sea(), n);
    EXPECT_TRUE(std::ranges::equal(alone.pressure(), all[std::size_t(n - 1)].pressure()));
  }
  EXPECT_FALSE(std::ranges::equal(all[0].pressure(), all[1].pressure()));
}

// A scenario that was built here: its file holds its text, which the program reads.
TEST(PublicFile, OfABuiltScenarioIsReadByTheProgram) {
  const support::TemporaryDirectory folder;
  asdic::Scenario built = small_sea();
  built.set("pulse.duration", 0.05).set("pings.count", 1);
  const asdic::Ping ping = asdic::ping(built);
  asdic::write_ping(folder / "ping.h5", built, ping);
  const support::Outcome info = support::asdic(folder, "info ping.h5");
  EXPECT_EQ(info.status, 0) << info.err;
  EXPECT_THAT(info.out, HasSubstr("small sea"));
  EXPECT_THAT(info.out, testing::Not(HasSubstr("made on , ,")));
  const support::Outcome processed = support::asdic(folder, "process ping.h5 --quiet");
  EXPECT_EQ(processed.status, 0) << processed.err;

  const asdic::Ping read = asdic::read_ping(folder / "ping.h5");
  EXPECT_EQ(read.scenario().to_toml(), built.to_toml());
  EXPECT_TRUE(std::ranges::equal(read.pressure(), ping.pressure()));
  ASSERT_EQ(read.echoes().size(), ping.echoes().size());
  for (std::size_t i = 0; i < ping.echoes().size(); ++i) {
    EXPECT_EQ(read.echoes()[i].delay, ping.echoes()[i].delay);
    EXPECT_NEAR(read.echoes()[i].arrival_elevation, ping.echoes()[i].arrival_elevation, 1e-12);
  }
  EXPECT_EQ(asdic::pings_in(folder / "ping.h5"), 1);
  EXPECT_THROW(static_cast<void>(asdic::read_ping(folder / "ping.h5", 2)), asdic::InputError);
}

// The same scenario through the program: the same samples, and the same text in the file.
TEST(PublicFile, IsWhatTheProgramWrites) {
  const support::TemporaryDirectory folder;
  const auto path = folder.write("sea.toml", support::small_scenario);
  asdic::write_pings(folder / "library.h5", asdic::Scenario::read(path));
  const support::Outcome program = support::asdic(folder, "ping sea.toml -o program.h5 --quiet");
  ASSERT_EQ(program.status, 0) << program.err;
  ASSERT_EQ(asdic::pings_in(folder / "library.h5"), 2);
  for (int n = 1; n <= 2; ++n) {
    const asdic::Ping ours = asdic::read_ping(folder / "library.h5", n),
                      theirs = asdic::read_ping(folder / "program.h5", n);
    EXPECT_TRUE(std::ranges::equal(ours.pressure(), theirs.pressure()));
    EXPECT_EQ(ours.scenario().to_toml(), support::small_scenario);
    EXPECT_EQ(theirs.scenario().to_toml(), support::small_scenario);
  }
}

// What is written is what was simulated, also of a scenario that was read, used and then changed.
TEST(PublicFile, HoldsTheScenarioThatWasSimulated) {
  const support::TemporaryDirectory folder;
  asdic::Scenario sea = small_sea();
  sea.set("reverberation.enabled", false).erase("noise").set("target.0.strength_db", 10.0);
  const asdic::Ping before = asdic::ping(sea);
  asdic::Scenario louder = sea;
  louder.set("target.0.strength_db", 16.0);
  asdic::write_ping(folder / "ping.h5", louder, asdic::ping(louder));
  const asdic::Ping read = asdic::read_ping(folder / "ping.h5");
  EXPECT_EQ(read.scenario().get("target.0.strength_db").number(), 16.0);
  ASSERT_EQ(read.echoes().size(), before.echoes().size());
  for (std::size_t i = 0; i < read.echoes().size(); ++i)
    EXPECT_NEAR(read.echoes()[i].level_db - before.echoes()[i].level_db, 6.0, 1e-9);
  EXPECT_TRUE(std::ranges::equal(asdic::ping(read.scenario()).pressure(), read.pressure()));
}

// Two transmitters, of which the second sends the second ping, 6 dB louder.
asdic::Scenario two_senders() {
  asdic::Scenario sea = small_sea();
  sea.set("transmitter.name", "first").set("pings.count", 1);
  asdic::Value second = sea.get("transmitter");
  sea.add("transmitter", second.set("name", "second").set("source_level_db", 206.0));
  return sea;
}

TEST(PublicFile, OfALaterPingAloneIsReadAndTold) {
  const support::TemporaryDirectory folder;
  const asdic::Scenario sea = two_senders();
  const asdic::Pinger pinger(sea);
  ASSERT_EQ(pinger.pings(), 2);
  const asdic::Ping second = pinger.ping(2);
  ASSERT_EQ(second.transmitter(), 1);
  asdic::write_ping(folder / "second.h5", sea, second);
  const asdic::Ping read = asdic::read_ping(folder / "second.h5");
  EXPECT_EQ(read.number(), 2);
  EXPECT_TRUE(std::ranges::equal(read.pressure(), second.pressure()));
  try {
    static_cast<void>(asdic::read_ping(folder / "second.h5", 1));
    FAIL() << "there is no ping 1";
  } catch (const asdic::InputError& error) {
    EXPECT_EQ(error.key(), "ping");
    EXPECT_STREQ(error.what(), "ping: found 1, expected 2, the file's only ping");
  }
  const std::string told = support::asdic(folder, "info second.h5").out;
  EXPECT_THAT(told, HasSubstr(", complete\n"));
  EXPECT_THAT(told, HasSubstr("1 ping (number 2)"));
  EXPECT_THAT(told, HasSubstr("206 dB re 1 µPa at 1 m"));
  EXPECT_THAT(told, testing::Not(HasSubstr("200 dB re 1 µPa at 1 m")));
  EXPECT_THAT(told, testing::ContainsRegex("\n +2 +.*rock"));
  EXPECT_EQ(support::asdic(folder, "export second.h5 --wav --ping 1").status, 2);
  ASSERT_EQ(support::asdic(folder, "export second.h5 --wav --ping 2").status, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "second_ping002.wav"));
}

TEST(PublicWatch, TellsStepsAndPings) {
  std::vector<int> steps, pings;
  const asdic::Scenario sea = small_sea();
  sea.validate({.progress = [&](int done, int total) { steps.push_back(10 * done + total); }});
  EXPECT_THAT(steps, testing::ElementsAre(13, 23, 33));
  asdic::Pinger(sea).run([](const asdic::Ping&) {}, {.progress = [&](int done, int total) {
                           pings.push_back(10 * done + total);
                         }});
  EXPECT_THAT(pings, testing::ElementsAre(12, 22));
}

// A slope, whose paths to scatterers take seconds: called off by its first step, validate() is over
// at once; asked again, it finds all.
TEST(PublicWatch, CallsOff) {
  asdic::Scenario sea = small_sea();
  sea.erase("environment.bottom.depth")
      .set("environment.bottom.shape",
           asdic::Bathymetry{.range = {0.0, 5e3, 20e3}, .depth = {1000.0, 900.0, 1100.0}});
  std::stop_source button;
  int steps = 0;
  const asdic::Watch watch{.stop = button.get_token(), .progress = [&](int done, int) {
                             steps = done;
                             button.request_stop();
                           }};
  EXPECT_THROW(sea.validate(watch), asdic::Stopped);
  EXPECT_EQ(steps, 1);
  EXPECT_THROW(asdic::Pinger(sea, watch), asdic::Stopped);
  EXPECT_THROW(static_cast<void>(asdic::ping(sea, 1, watch)), asdic::Stopped);
  EXPECT_EQ(sea.validate(), asdic::Scenario::parse(sea.to_toml()).validate());
}

TEST(PublicWatch, ARunThatIsCalledOffHandsOverWhatIsBefore) {
  const support::TemporaryDirectory folder;
  const asdic::Scenario sea = small_sea().set("pings.count", 40);
  std::stop_source button;
  int taken = 0;
  EXPECT_THROW(asdic::Pinger(sea).run(
                   [&](const asdic::Ping& ping) {
                     EXPECT_EQ(ping.number(), ++taken);
                     button.request_stop();
                   },
                   {.stop = button.get_token()}),
               asdic::Stopped);
  EXPECT_GE(taken, 1);
  EXPECT_LT(taken, 40);
  EXPECT_THROW(asdic::write_pings(folder / "x.h5", sea, {.stop = button.get_token()}),
               asdic::Stopped);
  EXPECT_FALSE(std::filesystem::exists(folder / "x.h5"));
}

TEST(PublicFile, RefusesWhatIsNotItsOwn) {
  const support::TemporaryDirectory folder;
  const asdic::Ping ping = asdic::ping(small_sea());
  asdic::Scenario other = small_sea();
  other.set("seed", 4);
  EXPECT_THROW(asdic::write_ping(folder / "x.h5", other, ping), asdic::InputError);
  EXPECT_FALSE(std::filesystem::exists(folder / "x.h5"));
  const auto text = folder.write("notes.h5", "not ours");
  EXPECT_THROW(asdic::write_ping(text, small_sea(), ping), asdic::InputError);
  EXPECT_THROW(static_cast<void>(asdic::read_ping(text)), asdic::InputError);
}

// One ping at hand is received as it is out of its file, and the loudest detection is the target's.
TEST(PublicProcess, ReceivesAPingAsItsFile) {
  const support::TemporaryDirectory folder;
  asdic::Scenario sea = small_sea();
  sea.set("reverberation.enabled", false).set("target.0.strength_db", 30.0);
  sea.set("pulse", asdic::Lfm{900.0, 1100.0, 0.1}).set("pings.sample_rate", 8000.0);
  sea.set("propagation.max_surface_bounces", 0).set("propagation.max_bottom_bounces", 0);
  asdic::write_pings(folder / "sea.h5", sea);
  std::vector<asdic::Ping> pings;
  asdic::Pinger(sea).run([&](const asdic::Ping& ping) { pings.push_back(ping); });
  const asdic::Receiving asked{.target_depth = 500.0};
  const asdic::Processed of_file = asdic::process(folder / "sea.h5", asked),
                         at_hand = asdic::process(pings, asked);
  ASSERT_FALSE(of_file.detections.empty());
  ASSERT_EQ(of_file.detections.size(), at_hand.detections.size());
  for (std::size_t i = 0; i < of_file.detections.size(); ++i) {
    EXPECT_EQ(of_file.detections[i].time, at_hand.detections[i].time);
    EXPECT_EQ(of_file.detections[i].level_db, at_hand.detections[i].level_db);
    EXPECT_EQ(of_file.detections[i].target, at_hand.detections[i].target);
  }
  EXPECT_EQ(of_file.tracks.size(), at_hand.tracks.size());
  const auto loudest =
      std::max_element(of_file.detections.begin(), of_file.detections.end(),
                       [](const auto& a, const auto& b) { return a.snr_db < b.snr_db; });
  EXPECT_EQ(loudest->target, 0);
  EXPECT_FALSE(asdic::process(pings[0], asked).detections.empty());
  EXPECT_THROW(static_cast<void>(asdic::process(std::vector<asdic::Ping>{})), asdic::InputError);
}

// Next to no noise: rounding stands out of what is there for a background, and the run says so.
TEST(PublicProcess, TellsOfDetectionsBelowWhatARecorderTakes) {
  asdic::Scenario sea = asdic::Scenario::read(ASDIC_SCENARIOS "/deep_ocean.toml");
  const auto faint = [](const asdic::Processed& processed) {
    return std::ranges::count_if(processed.warnings, [](const std::string& warning) {
      return warning.find("more than 120 dB below the loudest sample") != std::string::npos;
    });
  };
  EXPECT_EQ(faint(asdic::process(asdic::ping(sea))), 0);
  sea.set("noise.spectral_level_db", -200.0);
  EXPECT_EQ(faint(asdic::process(asdic::ping(sea))), 1);
}

TEST(PublicProcess, WantsAContinuousRecordOutOfAFile) {
  const support::TemporaryDirectory folder;
  asdic::Scenario sea = small_sea();
  sea.set("pings.continuous", true).set("pings.interval", 3.0).set("reverberation.enabled", false);
  const asdic::Ping made = asdic::ping(sea);
  EXPECT_THROW(static_cast<void>(asdic::process(made)), asdic::InputError);
  asdic::write_pings(folder / "stream.h5", sea);
  const asdic::Ping read = asdic::read_ping(folder / "stream.h5");
  EXPECT_EQ(read.samples(), 20000U);  // 5 s, of which its own row has 3 s
  EXPECT_NO_THROW(static_cast<void>(asdic::process(read)));
}

TEST(PublicStudy, AnswersItsQuestion) {
  const support::TemporaryDirectory folder;
  std::uint64_t told = 0;
  const asdic::StudyResult pd =
      asdic::study(ASDIC_SCENARIOS "/studies/known_answer.toml", folder / "pd.h5",
                   {.changes = {"study.realisations=50"},
                    .progress = [&](std::uint64_t done, std::uint64_t) { told = done; }});
  EXPECT_EQ(pd.rows(), 50U);
  EXPECT_TRUE(pd.complete);
  EXPECT_EQ(told, 50U);
  EXPECT_EQ(pd.columns.size(), pd.values.size());
  EXPECT_FALSE(pd.question.empty());
  EXPECT_LE(pd.low, pd.value);
  EXPECT_LE(pd.value, pd.high);
  EXPECT_EQ(pd.column(pd.columns[0]), pd.values[0]);
  EXPECT_THROW(static_cast<void>(pd.column("legs_searched")), asdic::InputError);  // bookkeeping
  EXPECT_THROW(static_cast<void>(pd.column("nothing")), asdic::InputError);
  EXPECT_EQ(asdic::read_study(folder / "pd.h5").values, pd.values);
}

}  // namespace
