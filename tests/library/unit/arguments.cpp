// The public face: arguments that are no numbers or no text, places out of the water, objects that
// were moved from. Each is refused by one message that names the argument.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "asdic/asdic.h"
#include "support/program.h"

namespace {

namespace support = asdic::detail::support;
using testing::HasSubstr;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

asdic::Scenario small_sea() { return asdic::Scenario::parse(support::small_scenario); }

/// The same water with a run of the propagation model and no sonar.
asdic::Scenario small_run() {
  asdic::Scenario sea;
  sea.set("environment", small_sea().get("environment"))
      .set("run.frequency", 1000.0)
      .set("run.source.depth", 200.0)
      .set("run.receivers.depth", 500.0)
      .set("run.receivers.range", asdic::EvenlySpaced{1e3, 3e3, 3});
  return sea;
}

/// What a refusal says; none: nothing was refused.
template <class Work>
std::optional<asdic::InputError> fault_of(const Work& work) {
  try {
    work();
  } catch (const asdic::InputError& error) {
    return error;
  }
  return std::nullopt;
}

/// The key that a refusal names, and whether it tells what was found and expected.
template <class Work>
std::string refused(const Work& work) {
  const std::optional<asdic::InputError> error = fault_of(work);
  if (!error) return "nothing was refused";
  return error->found().empty() || error->expected().empty() ? "no words" : error->key();
}

std::string refused_receiver(const asdic::Receiver& receiver) {
  const auto of = [&](const asdic::Scenario& sea) {
    return refused([&] { static_cast<void>(asdic::arrivals(sea, receiver)); });
  };
  const std::string sonar = of(small_sea()), run = of(small_run());
  return sonar == run ? sonar : sonar + " of a sonar, " + run + " of a run";
}

TEST(PublicArguments, OfArrivalsAreNumbersInTheWater) {
  for (const double wrong : {nan, infinity, -infinity}) {
    EXPECT_EQ(refused_receiver({.range = wrong, .depth = 100.0}), "receiver.range");
    EXPECT_EQ(refused_receiver({.range = 1e3, .depth = wrong}), "receiver.depth");
    EXPECT_EQ(refused_receiver({.range = 1e3, .depth = 100.0, .source_depth = wrong}),
              "receiver.source_depth");
    EXPECT_EQ(refused_receiver({.range = 1e3, .depth = 100.0, .frequency = wrong}),
              "receiver.frequency");
    EXPECT_EQ(refused_receiver({.range = 1e3, .depth = 100.0, .bearing = wrong}),
              "receiver.bearing");
  }
  EXPECT_EQ(refused_receiver({.range = -1.0, .depth = 100.0}), "receiver.range");
  EXPECT_EQ(refused_receiver({.range = 1e3, .depth = -1.0}), "receiver.depth");
  EXPECT_EQ(refused_receiver({.range = 1e3, .depth = 1001.0}), "receiver.depth");
  EXPECT_EQ(refused_receiver({.range = 1e3, .depth = 100.0, .source_depth = 1001.0}),
            "receiver.source_depth");
  EXPECT_EQ(refused_receiver({.range = 1e3, .depth = 100.0, .frequency = 0.0}),
            "receiver.frequency");
  EXPECT_EQ(refused_receiver({.range = 1e3, .depth = 100.0, .ping = 0}), "receiver.ping");
  EXPECT_EQ(refused_receiver({.range = 1e3, .depth = 100.0, .ping = 3}), "receiver.ping");
  EXPECT_EQ(refused_receiver({.range = 1e3, .depth = 100.0}), "nothing was refused");
  EXPECT_EQ(refused([] { static_cast<void>(asdic::legs(small_sea(), -1)); }), "ping");
  const auto error = fault_of(
      [] { static_cast<void>(asdic::arrivals(small_sea(), {.range = nan, .depth = 100.0})); });
  ASSERT_TRUE(error);
  EXPECT_STREQ(error->what(), "receiver.range: found nan m, expected a range from 0 to 20000000 m");
}

std::string refused_fan(const asdic::Fan& fan) {
  return refused([&] { static_cast<void>(asdic::rays(small_sea(), fan)); });
}

TEST(PublicArguments, OfAFanAreNumbersAndSomeRays) {
  for (const double wrong : {nan, infinity, 1.5708}) {
    EXPECT_EQ(refused_fan({.lowest = wrong}), "fan.lowest");
    EXPECT_EQ(refused_fan({.highest = wrong}), "fan.highest");
    EXPECT_EQ(refused_fan({.elevations = {0.1, wrong}}), "fan.elevations[1]");
  }
  for (const int count : {0, -3, std::numeric_limits<int>::max()})
    EXPECT_EQ(refused_fan({.count = count}), "fan.count");
  for (const double range : {nan, infinity, 0.0, -1.0})
    EXPECT_EQ(refused_fan({.count = 2, .range = range}), "fan.range");
  EXPECT_EQ(refused_fan({.count = 2, .source_depth = nan}), "fan.source_depth");
  EXPECT_EQ(refused_fan({.count = 2, .source_depth = 1001.0}), "fan.source_depth");
  EXPECT_EQ(refused_fan({.count = 2, .bounces = -1}), "fan.bounces");
  EXPECT_EQ(refused_fan({.count = 2, .range = 1e3, .bounces = 0}), "nothing was refused");
}

TEST(PublicArguments, OfAFieldAreNumbersAndSomeReceivers) {
  const auto of = [](const asdic::Value& ranges) {
    return refused(
        [&] { static_cast<void>(asdic::field(small_run().set("run.receivers.range", ranges))); });
  };
  EXPECT_EQ(of(asdic::EvenlySpaced{1e3, 3e3, 0}), "run.receivers.range.count");
  EXPECT_EQ(of(asdic::EvenlySpaced{1e3, 3e3, -1}), "run.receivers.range.count");
  EXPECT_EQ(of(asdic::EvenlySpaced{nan, 3e3, 2}), "run.receivers.range.first");
  EXPECT_EQ(of(std::vector<double>{}), "run.receivers.range");
  EXPECT_EQ(of(std::vector<double>{1e3, infinity}), "run.receivers.range[1]");
  // A field that somebody filled, with fewer numbers than receivers.
  const asdic::Field half{
      .source_depths = {5.0}, .depths = {1.0, 2.0}, .ranges = {1.0}, .pressure = {1.0F}};
  EXPECT_EQ(half.loss_db(0, 0), 0.0);
  EXPECT_EQ(refused([&] { static_cast<void>(half.loss_db(1, 0)); }), "pressure");
  EXPECT_EQ(refused([&] { static_cast<void>(half.loss_db(2, 0)); }), "receiver");
}

TEST(PublicArguments, OfAReceiverAreHeldAgainstItsSettings) {
  const asdic::Ping ping = asdic::ping(small_sea());
  const auto of = [&](const asdic::Receiving& receiving) {
    return refused([&] { static_cast<void>(asdic::process(ping, receiving)); });
  };
  for (const double speed : {nan, -1.0, 601.0}) EXPECT_EQ(of({.max_speed = speed}), "max_speed");
  EXPECT_EQ(of({.guard_cells = nan}), "guard_cells");
  EXPECT_EQ(of({.reference_cells = 0.0}), "reference_cells");
  EXPECT_EQ(of({.false_alarm_probability = 0.0}), "false_alarm_probability");
  EXPECT_EQ(of({.from = nan}), "from");
  EXPECT_EQ(of({.from = 100.0}), "from");  // after the record
  EXPECT_EQ(of({.until = -1.0}), "until");
  EXPECT_EQ(of({.target_depth = nan}), "target_depth");
  EXPECT_EQ(of({.range_speed = 0.0}), "range_speed");
  EXPECT_EQ(of({}), "nothing was refused");
}

TEST(PublicArguments, APingerTakesAFunction) {
  EXPECT_EQ(refused([] { asdic::Pinger(small_sea()).run({}); }), "take");
  EXPECT_EQ(refused([] { static_cast<void>(asdic::Pinger(small_sea()).ping(3)); }), "number");
}

TEST(PublicValue, RefusesWhatNoFileCanHold) {
  constexpr auto most = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(asdic::Value(most).whole(), std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(asdic::Value(std::numeric_limits<std::int64_t>::min()).whole(),
            std::numeric_limits<std::int64_t>::min());
  const auto error = fault_of([] { static_cast<void>(asdic::Value(most + 1)); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->found(), "9223372036854775808");
  EXPECT_EQ(refused([] { static_cast<void>(asdic::Value(static_cast<const char*>(nullptr))); }),
            "value");
}

// A lone byte of Latin-1, a form that is not the shortest, half of a surrogate pair.
TEST(PublicValue, RefusesWhatIsNoText) {
  asdic::Scenario sea = small_sea();
  for (const char* wrong : {"caf\xe9", "\xc0\xaf", "\xed\xa0\x80", "\xff", "cut \xe2\x82"}) {
    EXPECT_EQ(refused([&] { sea.set("title", wrong); }), "value") << wrong;
    EXPECT_EQ(refused([&] { sea.set("title", {wrong}); }), "value");
    EXPECT_EQ(refused([&] { sea.set("target.0", asdic::Target{.name = wrong}); }), "value");
    EXPECT_EQ(refused([&] { sea.set(wrong, 1.0); }), "path");
    EXPECT_EQ(refused([&] { static_cast<void>(asdic::Value::table({{wrong, 1.0}})); }), "value");
  }
  EXPECT_EQ(sea.to_toml(), support::small_scenario);
  EXPECT_EQ(sea.set("title", "café 10 €").get("title").text(), "café 10 €");
}

TEST(PublicFaults, APathThatLeadsNowhereIsTheKey) {
  asdic::Scenario sea = small_sea();
  EXPECT_EQ(refused([&] { sea.set("target.5.range", 1.0); }), "target.5.range");
  EXPECT_EQ(refused([&] { sea.set("title.x", 1.0); }), "title.x");
  EXPECT_EQ(refused([&] { sea.set("", 1.0); }), "path");
  const auto error = fault_of([&] { sea.set("target.5.range", 1.0); });
  EXPECT_EQ(error->file(), "");
  EXPECT_STREQ(error->what(),
               "target.5.range: found index \"5\" of target, expected an index from 0 to 0");
}

TEST(PublicFaults, AFileThatIsNotThereIsTheFile) {
  const support::TemporaryDirectory folder;
  const std::string none = (folder / "no such.h5").string();
  const auto file_of = [&](const auto& work) {
    const std::optional<asdic::InputError> error = fault_of(work);
    return error ? error->file() + '|' + error->key() : "nothing was refused";
  };
  EXPECT_EQ(file_of([&] { static_cast<void>(asdic::Scenario::read(none)); }), none + '|');
  EXPECT_EQ(file_of([&] { static_cast<void>(asdic::read_ping(none)); }), none + '|');
  EXPECT_EQ(file_of([&] { static_cast<void>(asdic::pings_in(none)); }), none + '|');
  EXPECT_EQ(file_of([&] { static_cast<void>(asdic::process(none)); }), none + '|');
  EXPECT_EQ(file_of([&] { static_cast<void>(asdic::read_study(none)); }), none + '|');
  EXPECT_EQ(file_of([&] { static_cast<void>(asdic::study(none, "x.h5")); }), none + '|');
  // One that a scenario names is the fault of its key.
  EXPECT_EQ(
      file_of([&] { small_sea().set("pulse", asdic::PulseFile{.file = "none.wav"}).validate(); }),
      "|pulse.file");
}

TEST(PublicMoves, LeaveScenariosAndPingsAsTheyWere) {
  asdic::Scenario sea = small_sea();
  const asdic::Scenario taken = std::move(sea);
  EXPECT_EQ(sea.to_toml(), taken.to_toml());  // NOLINT(bugprone-use-after-move): that is the test
  EXPECT_EQ(sea.validate(), taken.validate());

  asdic::Ping ping = asdic::ping(sea);
  const asdic::Ping kept = std::move(ping);
  EXPECT_EQ(ping.pressure().data(), kept.pressure().data());  // NOLINT(bugprone-use-after-move)
  EXPECT_EQ(ping.scenario().to_toml(), sea.to_toml());

  asdic::Pinger pinger(sea);
  const asdic::Pinger other = std::move(pinger);
  EXPECT_EQ(pinger.pings(), other.pings());  // NOLINT(bugprone-use-after-move)
  asdic::Value value = "text";
  const asdic::Value text = std::move(value);
  EXPECT_EQ(value.kind(), asdic::Value::Kind::nothing);  // NOLINT(bugprone-use-after-move)
}

TEST(PublicMoves, AWriterThatWasMovedFromOrFinishedRefuses) {
  const support::TemporaryDirectory folder;
  const asdic::Ping ping = asdic::ping(small_sea());
  asdic::PingWriter writer(folder / "ping.h5", small_sea());
  asdic::PingWriter taken = std::move(writer);
  const auto use = [&](asdic::PingWriter& used) {
    return refused([&] { used.append(ping); }) + ' ' + refused([&] { used.finish(); });
  };
  EXPECT_EQ(use(writer), "writer writer");  // NOLINT(bugprone-use-after-move)
  taken.append(ping);
  EXPECT_EQ(refused([&] { taken.append(ping); }), "ping");  // it is in the file
  taken.finish();
  EXPECT_EQ(use(taken), "writer writer");
  EXPECT_EQ(asdic::pings_in(folder / "ping.h5"), 1);
}

}  // namespace
