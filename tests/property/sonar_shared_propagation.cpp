#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <functional>
#include <string>

#include "support/thesis.h"

namespace asdic {
namespace {

/// Echoes by several paths from a moving target, reverberation of two boundaries, noise.
Scenario layered() {
  Scenario s = support::thesis(SoundSpeedProfile::munk());
  s.environment.bottom = {.depth = 5000.0, .material = FluidHalfSpace{}};
  s.platforms[0].track.start.position = {0.0, 0.0, 400.0};
  s.platforms[0].track.start.velocity = {1.5, 2.0, 0.0};
  s.arrays[0] = line_array(3, 0.1875, 0.3, 0.1);
  s.targets = {support::target({2500.0, 800.0, 125.0}, 20.0, {-7.0, 2.0, 0.0})};
  s.pulse.duration = 0.1;
  s.noise.spectral_level_db = 40.0;
  s.reverberation.enabled = true;
  s.reverberation.azimuths = 12;
  s.reverberation.bottom = Lambert{};
  s.propagation.max_surface_bounces = 1;
  s.propagation.max_bottom_bounces = 1;
  s.pings.recording_duration = 4.0;
  s.pings.count = 2;
  return s;
}

/// The same over a slope: planes instead of one column.
Scenario sloping() {
  Scenario s = layered();
  const std::array<double, 2> range = {0.0, 8000.0}, depth = {900.0, 600.0};
  s.environment.water = SoundSpeedProfile::isovelocity(1500.0);
  s.environment.bottom.shape.emplace(range, depth, ShapeInterpolation::piecewise_linear);
  s.environment.bottom.depth = 900.0;
  s.transect.bearing = 0.4;
  s.reverberation.azimuths = 4;
  s.pings.recording_duration = 2.5;
  s.targets[0].track.start.position = {1200.0, 300.0, 125.0};
  return s;
}

bool same(const PingRecord& a, const PingRecord& b) {
  return a.pressure == b.pressure && a.echoes.size() == b.echoes.size() &&
         a.summary.front().reverberation_db == b.summary.front().reverberation_db &&
         a.summary.front().echo_peak_db == b.summary.front().echo_peak_db;
}

struct Change {
  std::string name;
  std::function<void(Scenario&)> make;
};

/// What a study varies without touching the ocean or a place.
std::vector<Change> changes_that_trace_nothing() {
  return {
      {"nothing", [](Scenario&) {}},
      {"seed", [](Scenario& s) { s.seed = 77; }},
      {"noise", [](Scenario& s) { s.noise.spectral_level_db = 55.0; }},
      {"strength", [](Scenario& s) { s.targets[0].strength_db = 3.0; }},
      {"wind", [](Scenario& s) { s.wind_speed = 14.0; }},
      {"source level", [](Scenario& s) { s.transmitters[0].source_level_db = 200.0; }},
      {"elevation", [](Scenario& s) { s.transmitters[0].elevation = 0.3; }},
      {"heading of the array", [](Scenario& s) { s.arrays[0] = line_array(3, 0.1875, 1.1, 0.0); }}};
}

class SharedPropagationLaws : public testing::TestWithParam<Scenario (*)()> {};

// Exactness is the contract: whatever is known, the bits are those of a simulator by itself. And
// nothing is traced again when no place and no number of the ocean has changed.
TEST_P(SharedPropagationLaws, NothingIsTracedTwiceAndNoBitChanges) {
  const auto shared = std::make_shared<SharedPropagation>();
  const PingRecord first = PingSimulator(GetParam()(), shared).simulate(1);
  EXPECT_FALSE(first.reuse.ocean);
  EXPECT_FALSE(first.reuse.reverberation);
  EXPECT_GT(first.reuse.legs_searched, 1);
  for (const Change& change : changes_that_trace_nothing()) {
    SCOPED_TRACE(change.name);
    Scenario s = GetParam()();
    change.make(s);
    const PingRecord record = PingSimulator(s, shared).simulate(1);
    EXPECT_TRUE(record.reuse.ocean);
    EXPECT_TRUE(record.reuse.reverberation);
    EXPECT_EQ(record.reuse.legs_searched, 0);
    EXPECT_GT(record.reuse.legs_reused, 1);
    EXPECT_TRUE(same(record, PingSimulator(s).simulate(1)));
  }
}

// Each of these changes what sound does: it has to be searched for, and comes out as if nobody had
// searched before.
TEST_P(SharedPropagationLaws, WhatChangesPropagationIsTracedAnew) {
  const auto shared = std::make_shared<SharedPropagation>();
  EXPECT_FALSE(PingSimulator(GetParam()(), shared).simulate(1).reuse.ocean);
  const std::vector<Change> changes = {
      {"target", [](Scenario& s) { s.targets[0].track.start.position.x() += 1.0; }},
      {"bounces", [](Scenario& s) { s.propagation.max_surface_bounces = 2; }},
      {"frequency", [](Scenario& s) { s.pulse.frequency = 3900.0; }},
      {"bottom", [](Scenario& s) { s.environment.bottom.material = Rigid{}; }},
      {"water",
       [](Scenario& s) {
         s.environment.water = SoundSpeedProfile::isovelocity(std::nextafter(1500.0, 1e9));
       }},
      {"absorption", [](Scenario& s) { s.environment.absorption = Thorp{}; }}};
  for (const Change& change : changes) {
    SCOPED_TRACE(change.name);
    Scenario s = GetParam()();
    change.make(s);
    const PingRecord record = PingSimulator(s, shared).simulate(1);
    EXPECT_GT(record.reuse.legs_searched, 0);
    EXPECT_TRUE(same(record, PingSimulator(s).simulate(1)));
  }
}

// Many simulators at once, one memory so small that it forgets all the time: the same bits.
TEST_P(SharedPropagationLaws, SameBitsFromManyThreadsAndOutOfASmallMemory) {
  const PingRecord alone = PingSimulator(GetParam()()).simulate(2);
  for (const std::size_t bytes : {std::size_t{1}, std::size_t{100'000}, std::size_t{1} << 30}) {
    const auto shared = std::make_shared<SharedPropagation>(bytes);
    std::array<bool, 6> equal{};
    tbb::parallel_for(std::size_t{0}, equal.size(), [&](std::size_t i) {
      equal[i] = same(PingSimulator(GetParam()(), shared).simulate(2), alone);
    });
    for (const bool one : equal) EXPECT_TRUE(one) << bytes;
    EXPECT_LE(shared->bytes(), bytes);
  }
}

INSTANTIATE_TEST_SUITE_P(, SharedPropagationLaws, testing::Values(&layered, &sloping),
                         [](const auto& test) { return test.index == 0 ? "Layered" : "Sloping"; });

// A second array hears the same way out: it is searched for once.
TEST(SharedPropagation, ArraysShareTheWayOut) {
  Scenario s = layered();
  s.targets[0].track.start.velocity.setZero();
  s.platforms[0].track.start.velocity.setZero();
  const int one = PingSimulator(s).simulate(1).reuse.legs_searched;
  s.arrays.push_back(s.arrays[0]);
  s.arrays[1].offset = {0.0, 10.0, 0.0};
  const Reuse two = PingSimulator(s).simulate(1).reuse;
  EXPECT_EQ(one, 2);                // out and back
  EXPECT_EQ(two.legs_searched, 3);  // and back to the other
  EXPECT_EQ(two.legs_reused, 1);
}

/// What a vehicle's processor asks for, of a target so near and fast that delays are curves.
Scenario in_baseband() {
  Scenario s = layered();
  s.reverberation.enabled = false;
  s.pulse.duration = 1.0;
  s.pings.samples = Samples::baseband;
  s.pings.carrier = 4000.0;
  s.pings.baseband_rate = 400.0;
  return s;
}

// Plans of the synthesis and shapes of echoes are kept, too: of whatever they were made for before,
// and by however many threads, a ping is the same bit for bit.
TEST(SharedSynthesis, NoBitChangesWhateverIsKept) {
  const auto shared = std::make_shared<SharedPropagation>();
  const std::vector<Change> changes = {
      {"nothing", [](Scenario&) {}},
      {"seed", [](Scenario& s) { s.seed = 77; }},
      {"strength", [](Scenario& s) { s.targets[0].strength_db = 3.0; }},
      {"heading", [](Scenario& s) { s.arrays[0] = line_array(3, 0.1875, 1.1, 0.0); }},
      {"phones", [](Scenario& s) { s.arrays[0] = line_array(5, 0.1875, 1.1, 0.0); }},
      {"window", [](Scenario& s) { s.pulse.window = PulseWindow::tukey; }},
      {"taper",
       [](Scenario& s) {
         s.pulse.window = PulseWindow::tukey;
         s.pulse.tukey_fraction = 0.3;
       }},
      {"duration", [](Scenario& s) { s.pulse.duration = 0.8; }},
      {"sweep", [](Scenario& s) { s.pulse.kind = PulseKind::lfm; }},
      {"rate", [](Scenario& s) { s.pings.baseband_rate = 500.0; }},
      {"carrier", [](Scenario& s) { s.pings.carrier = 3990.0; }},
      {"record", [](Scenario& s) { s.pings.recording_duration = 3.5; }},
      {"pressure", [](Scenario& s) { s.pings.samples = Samples::pressure; }},
      {"speed", [](Scenario& s) { s.targets[0].track.start.velocity.x() = -9.0; }},
      {"wide band", [](Scenario& s) { s.propagation.wide_band = true; }}};
  bool curved = false;
  for (const int threads : {1, 2, 7}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    for (const Change& change : changes) {
      SCOPED_TRACE(change.name);
      Scenario s = in_baseband();
      change.make(s);
      const PingRecord record = PingSimulator(s, shared).simulate(1);
      EXPECT_TRUE(same(record, PingSimulator(s).simulate(1)));
      for (const EchoPath& echo : record.echoes) curved = curved || echo.curve.has_value();
    }
  }
  EXPECT_TRUE(curved);  // else nothing of this was asked
}

}  // namespace
}  // namespace asdic
