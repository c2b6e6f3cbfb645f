#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "sonar/ping/run_pings.h"
#include "support/listen.h"
#include "support/thesis.h"

namespace asdic::detail {
namespace {

/// Everything at once, small: echoes by several paths, moving target and vehicle, reverberation,
/// noise.
Scenario busy() {
  Scenario s = support::thesis(SoundSpeedProfile::munk());
  s.environment.bottom = {.depth = 5000.0, .material = FluidHalfSpace{}};
  s.platforms[0].track.start.position = {0.0, 0.0, 400.0};
  s.platforms[0].track.start.velocity = {1.5, 2.0, 0.0};
  s.arrays[0] = line_array(4, 0.1875, 0.3, 0.1);
  s.targets = {support::target({3000.0, 800.0, 125.0}, 20.0, {-7.0, 2.0, 0.0})};
  s.pulse.duration = 0.2;
  s.noise.law = WhiteNoise{40.0};
  s.reverberation.enabled = true;
  s.reverberation.azimuths = 12;
  s.propagation.max_surface_bounces = 1;
  s.propagation.max_bottom_bounces = 1;
  s.pings.count = 5;
  s.pings.recording_duration = 6.0;
  return s;
}

std::vector<PingRecord> run(const Scenario& scenario, std::size_t threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  const PingSimulator simulator(scenario);
  std::vector<PingRecord> records;
  run_pings(simulator, [&](PingRecord&& record) { records.push_back(std::move(record)); });
  return records;
}

// The same bits for 1, 2 and 7 threads, in the order of the pings; and a ping is the same alone.
TEST(PingLaws, SameBitsForAnyThreadsAndAloneOrInASequence) {
  const std::vector<PingRecord> one = run(busy(), 1);
  ASSERT_EQ(one.size(), 5U);
  for (const std::size_t threads : {2U, 7U}) {
    const std::vector<PingRecord> many = run(busy(), threads);
    ASSERT_EQ(many.size(), 5U);
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_EQ(many[i].ping, int(i) + 1);
      EXPECT_TRUE(many[i].pressure == one[i].pressure) << threads << " threads, ping " << i + 1;
    }
  }
  EXPECT_FALSE(one[0].pressure == one[1].pressure);
  EXPECT_TRUE(PingSimulator(busy()).simulate(4).pressure == one[3].pressure);
}

// Source and target exchanged: the way there and the way back of a sonar at rest are the same, so
// every pair of paths (i, j) has a counterpart (j, i) of the same delay and pressure. And the
// vehicle at the target's place receives it as the target at the vehicle's would.
TEST(PingLaws, Reciprocity) {
  Scenario s = busy();
  s.platforms[0].track.start.velocity.setZero();
  s.targets[0].track.start.velocity.setZero();
  const PingRecord there = PingSimulator(s).simulate(1);
  std::swap(s.platforms[0].track.start.position, s.targets[0].track.start.position);
  const PingRecord back = PingSimulator(s).simulate(1);
  ASSERT_EQ(there.echoes.size(), back.echoes.size());
  ASSERT_GE(there.echoes.size(), 9U);
  const auto sum =
      [](const PingRecord& r) {  // of delays and complex amplitudes, whatever the order
        std::complex<double> total = 0.0;
        for (const EchoPath& e : r.echoes)
          total += e.received.amplitude * std::polar(1.0, 7.0 * e.received.delay);
        return total;
      };
  // Delays to 1e-9 s; amplitudes are derivatives of the range, 1e-6 of the strongest.
  EXPECT_LT(std::abs(sum(there) - sum(back)), 1e-6 * std::abs(sum(there)));
  for (const EchoPath& e : there.echoes)
    for (const EchoPath& f : there.echoes)
      if (e.outgoing == f.returning && e.returning == f.outgoing) {
        EXPECT_NEAR(e.received.delay, f.received.delay, 1e-9);
        EXPECT_LT(std::abs(e.received.amplitude - f.received.amplitude),
                  1e-6 * std::abs(e.received.amplitude));
      }
}

// One path, nothing lost: ∫p² dt = p_rms²·∫|s₊|²dt, exact for a band-limited pulse but for the
// synthesis' error, −80 dB of the peak; 0.01 dB is 2e-3.
TEST(PingLaws, TheRecordHoldsThePulsesEnergy) {
  for (const AnyWaveform& waveform : {AnyWaveform(Cw{}), AnyWaveform(Lfm{}), AnyWaveform(Hfm{})}) {
    Scenario s = support::thesis(SoundSpeedProfile::isovelocity(1500.0));
    s.arrays[0] = line_array(1, 0.1875, 0.0, 0.0);
    s.pulse.waveform = waveform;
    s.targets = {support::target({3000.0, 0.0, 4500.0}, 30.0)};
    s.pings.recording_start = 3.0;
    s.pings.recording_duration = 3.0;
    const PingSimulator simulator(s);
    const PingRecord record = simulator.simulate(1);
    double energy = 0.0;
    for (const float p : record.pressure) energy += static_cast<double>(p) * static_cast<double>(p);
    const double level = 230.0 + 30.0 - 40.0 * std::log10(3000.0);
    EXPECT_NEAR(db_from_power(energy / 16000.0 / (micropascal * micropascal)),
                level + db_from_power(simulator.pulse().energy()), 0.01);
  }
}

/// The delay of the path like `like` between two depths at a range [s].
double delay_of(const EigenraySolver& ocean, double from, double to, double range,
                const Arrival& like) {
  double best = infinity, delay = 0.0;
  for (const Arrival& a : ocean.find(from, to, range, 4000.0, {1, 1})) {
    if (a.surface_bounces != like.surface_bounces || a.bottom_bounces != like.bottom_bounces)
      continue;
    const double miss = std::abs(a.launch_elevation - like.launch_elevation);
    if (miss < best) best = miss, delay = a.delay;
  }
  return delay;
}

// The echo of a target that moves comes from where the target is struck, and is received where the
// array is by then: every path pair against a fixed-point iteration with nothing linearised, 1 µs.
TEST(PingLaws, DelaysOfMovingTargetsAreThoseOfAFixedPoint) {
  Scenario s = busy();
  s.reverberation.enabled = false;
  const PingSimulator simulator(s);
  int compared = 0;
  for (const int ping : {1, 3}) {
    const PingRecord record = simulator.simulate(ping);
    ASSERT_GE(record.echoes.size(), 9U);
    ASSERT_EQ(record.legs.size(), 2U);
    const double start = record.start_time;
    const Vec3 source = s.platforms[0].track.at(start).position;
    for (const EchoPath& echo : record.echoes) {
      const Arrival& out = record.legs[0].arrivals[static_cast<std::size_t>(echo.outgoing)];
      const Arrival& home = record.legs[1].arrivals[static_cast<std::size_t>(echo.returning)];
      const auto range = [](const Vec3& a, const Vec3& b) { return (b - a).head<2>().norm(); };
      double struck = 0.0, received = 0.0;
      Vec3 at = source;
      for (int i = 0; i < 8; ++i) {
        at = s.targets[0].track.at(start + struck).position;
        struck = delay_of(simulator.ocean(), source.z(), at.z(), range(source, at), out);
      }
      at = s.targets[0].track.at(start + struck).position;
      for (int i = 0; i < 8; ++i) {
        const Vec3 phone = s.platforms[0].track.at(start + received).position;
        received = struck + delay_of(simulator.ocean(), at.z(), phone.z(), range(at, phone), home);
      }
      EXPECT_NEAR(echo.received.delay, received, 1e-6);
      ++compared;
    }
  }
  EXPECT_GE(compared, 18);
}

/// Two arrays on two platforms, and a waypoint that the pulse meets.
Scenario two_arrays() {
  Scenario s = busy();
  s.platforms.push_back({.name = "buoy", .track = {}});
  s.platforms[1].track.start.position = {1500.0, -400.0, 80.0};
  s.arrays.push_back(line_array(2, 0.1875, 0.0, 0.0));
  s.arrays[1].platform = 1;
  s.pings.count = 2;
  return s;
}

// A study that asks for levels gets those of the whole ping, without its samples. Equal to the last
// bit, since the summary is made of the same paths and expectations.
TEST(PingLaws, LevelsAreThoseOfTheWholePing) {
  for (const Scenario& scenario : {busy(), two_arrays()}) {
    const PingSimulator simulator(scenario);
    for (const int ping : {1, 2}) {
      const PingRecord whole = simulator.simulate(ping), levels = simulator.levels(ping);
      EXPECT_TRUE(levels.pressure.empty());
      EXPECT_EQ(levels.start_time, whole.start_time);
      EXPECT_EQ(levels.phones.size(), whole.phones.size());
      ASSERT_EQ(levels.legs.size(), whole.legs.size());
      ASSERT_EQ(levels.echoes.size(), whole.echoes.size());
      for (std::size_t i = 0; i < whole.echoes.size(); ++i) {
        EXPECT_EQ(levels.echoes[i].received.delay, whole.echoes[i].received.delay);
        EXPECT_EQ(levels.echoes[i].received.amplitude, whole.echoes[i].received.amplitude);
      }
      ASSERT_EQ(levels.summary.size(), 1U);
      const TargetSummary &a = levels.summary[0], &b = whole.summary[0];
      if (scenario.arrays.size() == 1) {  // the buoy is in the shadow of what the vehicle lights up
        EXPECT_TRUE(std::isfinite(b.reverberation_db));
      }
      EXPECT_EQ(a.array, b.array);
      EXPECT_EQ(a.paths, b.paths);
      EXPECT_EQ(a.echo_time, b.echo_time);
      EXPECT_EQ(a.echo_level_db, b.echo_level_db);
      EXPECT_EQ(a.echo_peak_db, b.echo_peak_db);
      EXPECT_EQ(a.reverberation_db, b.reverberation_db);
      EXPECT_EQ(a.noise_db, b.noise_db);
      EXPECT_EQ(a.signal_excess_db, b.signal_excess_db);
    }
  }
}

// The summary tells of the array that receives the loudest pair: what it says there is what it says
// in a scenario with that array alone, wherever in the list it stands. Of the reverberation but for
// where the grid hangs whose cell centres are summed (from the first pair's middle on): 0.1 dB.
TEST(PingLaws, SummaryIsThatOfTheArrayThatReceivesTheTargetBest) {
  Scenario s = two_arrays();
  s.platforms[1].track.start.position = {2800.0, 700.0, 80.0};  // beside the target
  const TargetSummary both = PingSimulator(s).levels(1).summary[0];
  EXPECT_EQ(both.array, 1);
  s.arrays.erase(s.arrays.begin());
  const TargetSummary alone = PingSimulator(s).levels(1).summary[0];
  EXPECT_EQ(alone.array, 0);
  EXPECT_EQ(both.paths, alone.paths);
  EXPECT_EQ(both.echo_peak_db, alone.echo_peak_db);
  EXPECT_NEAR(both.reverberation_db, alone.reverberation_db, 0.1);
}

}  // namespace
}  // namespace asdic::detail
