#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <functional>
#include <string>

#include "support/thesis.h"

namespace asdic::detail {
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
  s.noise.law = WhiteNoise{40.0};
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
      {"noise", [](Scenario& s) { s.noise.law = WhiteNoise{55.0}; }},
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
    // Over slopes paths are also searched to the outermost phones, which have turned.
    const bool over_slopes = s.environment.bottom.shape.has_value();
    if (!over_slopes || change.name != "heading of the array") {
      EXPECT_EQ(record.reuse.legs_searched, 0);
    }
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
      {"frequency", [](Scenario& s) { std::get<Cw>(s.pulse.waveform).frequency = 3900.0; }},
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

// A second array receives the same way out: it is searched for once.
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
      {"sweep", [](Scenario& s) { s.pulse.waveform = Lfm{}; }},
      {"rate", [](Scenario& s) { s.pings.baseband_rate = 500.0; }},
      {"carrier", [](Scenario& s) { s.pings.carrier = 3990.0; }},
      {"record", [](Scenario& s) { s.pings.recording_duration = 3.5; }},
      {"pressure", [](Scenario& s) { s.pings.samples = Samples::pressure; }},
      {"speed", [](Scenario& s) { s.targets[0].track.start.velocity.x() = -9.0; }},
      {"wide band", [](Scenario& s) { s.propagation.band = BandOfLosses::wide; }}};
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

/// Two platforms, three boundaries and layers, laws of every kind by name.
Scenario with_every_field() {
  Scenario s = layered();
  s.platforms.push_back(s.platforms[0]);
  s.platforms[1].track.start.position = {500.0, 0.0, 300.0};
  s.arrays[0].platform = 1;
  std::get<LineBeam>(s.transmitters[0].beam).taper = Taper::hann;
  s.reverberation.volume = {{.top = 200.0, .bottom = 240.0}};
  s.reverberation.azimuths = 6;
  s.reverberation.resolve_azimuth = false;
  s.pings.recording_duration = 2.5;
  s.targets[0].track.start = {.position = {900.0, 100.0, 125.0}, .velocity = Vec3::Zero()};
  for (Platform& platform : s.platforms) platform.track.start.velocity.setZero();
  return s;
}

std::vector<Change> changes_of_what_is_expected() {
  const auto nrl = [](Scenario& s) -> NrlSurface& {
    return std::get<NrlSurface>(s.reverberation.surface);
  };
  const auto ellis_crowe = [](double mu, double nu, double slope) {
    return [=](Scenario& s) {
      s.reverberation.bottom = EllisCrowe{.mu_db = mu, .nu_db = nu, .slope_deg = slope};
    };
  };
  const auto table = [](std::vector<double> grazing, std::vector<double> strength) {
    return [=](Scenario& s) {
      s.reverberation.bottom = ScatteringTable{.grazing = grazing, .strength_db = strength};
    };
  };
  const auto projectors = [](double amplitude, double phase, double delay, double apart) {
    return [=](Scenario& s) {
      s.transmitters[0].beam = ProjectorBeam{.projectors = {{.offset = {0.0, 0.0, apart}},
                                                            {.offset = {apart, 0.0, 0.0},
                                                             .amplitude = amplitude,
                                                             .phase = phase,
                                                             .delay = delay}}};
    };
  };
  const auto beam = [](double level, double elevation, double bearing) {
    return [=](Scenario& s) {
      s.transmitters[0].beam = TableBeam{.table = {.bearings = {0.0, bearing},
                                                   .elevations = {elevation},
                                                   .level_db = {0.0, level}}};
    };
  };
  return {
      {"wind", [](Scenario& s) { s.wind_speed = 14.0; }},
      {"spectral strength", [=](Scenario& s) { nrl(s).A_s *= 2.0; }},
      {"exponent", [=](Scenario& s) { nrl(s).gamma2 = 3.5; }},
      {"reference length", [=](Scenario& s) { nrl(s).h0 = 2.0; }},
      {"law of the surface", [](Scenario& s) { s.reverberation.surface = ChapmanHarris{}; }},
      {"another", [](Scenario& s) { s.reverberation.surface = OgdenErskine{}; }},
      {"wind over another",
       [](Scenario& s) { s.reverberation.surface = OgdenErskine{}, s.wind_speed = 14.0; }},
      {"surface scatters", [](Scenario& s) { s.reverberation.surface_scatters = false; }},
      {"Lambert's constant", [](Scenario& s) { s.reverberation.bottom = Lambert{-30.0}; }},
      {"law of the bottom", ellis_crowe(-27.0, -15.0, 10.0)},
      {"its diffuse part", ellis_crowe(-28.0, -15.0, 10.0)},
      {"its facets", ellis_crowe(-27.0, -16.0, 10.0)},
      {"their slope", ellis_crowe(-27.0, -15.0, 12.0)},
      {"table", table({0.1, 1.0}, {-30.0, -20.0})},
      {"angles of a table", table({0.1, 1.1}, {-30.0, -20.0})},
      {"strengths of a table", table({0.1, 1.0}, {-30.0, -21.0})},
      {"bottom scatters", [](Scenario& s) { s.reverberation.bottom.reset(); }},
      {"strength of a layer", [](Scenario& s) { s.reverberation.volume[0].strength_db = -75.0; }},
      {"sheets of a layer", [](Scenario& s) { s.reverberation.volume[0].sheets = 3; }},
      {"thickness of a layer",
       [](Scenario& s) {
         s.reverberation.volume[0].top -= 4.0, s.reverberation.volume[0].bottom += 4.0;
       }},
      {"elevation", [](Scenario& s) { s.transmitters[0].elevation = 0.3; }},
      {"beamwidth",
       [](Scenario& s) { std::get<LineBeam>(s.transmitters[0].beam).beamwidth *= 1.5; }},
      {"taper",
       [](Scenario& s) { std::get<LineBeam>(s.transmitters[0].beam).taper = Taper::rectangular; }},
      {"no beam",
       [](Scenario& s) {
         std::get<LineBeam>(s.transmitters[0].beam).taper = Taper::omnidirectional;
       }},
      {"projectors", projectors(1.0, 0.0, 0.0, 0.2)},
      {"where they are", projectors(1.0, 0.0, 0.0, 0.21)},
      {"their amplitudes", projectors(0.9, 0.0, 0.0, 0.2)},
      {"their phases", projectors(1.0, 0.1, 0.0, 0.2)},
      {"their delays", projectors(1.0, 0.0, 1e-5, 0.2)},
      {"steering of projectors",
       [=](Scenario& s) {
         projectors(1.0, 0.0, 0.0, 0.2)(s);
         std::get<ProjectorBeam>(s.transmitters[0].beam).turned.bearing = 0.3;
       }},
      {"table of a beam", beam(-10.0, 0.0, 3.0)},
      {"its levels", beam(-11.0, 0.0, 3.0)},
      {"its bearings", beam(-10.0, 0.0, 2.9)},
      {"its rows", beam(-10.0, 0.1, 3.0)},
      {"how it is turned",
       [=](Scenario& s) {
         beam(-10.0, 0.0, 3.0)(s);
         std::get<TableBeam>(s.transmitters[0].beam).turned.bearing = 0.3;
       }},
      {"frequency", [](Scenario& s) { std::get<Cw>(s.pulse.waveform).frequency = 3900.0; }},
      {"pulse", [](Scenario& s) { s.pulse.duration = 0.12; }},
      {"end of the record", [](Scenario& s) { s.pings.recording_duration = 2.6; }},
      {"sectors", [](Scenario& s) { s.reverberation.azimuths = 7; }},
      {"sectors by the array", [](Scenario& s) { s.reverberation.resolve_azimuth = true; }},
      {"rings", [](Scenario& s) { s.reverberation.ground_spacing = 30.0; }},
      {"scatterers a cell", [](Scenario& s) { s.reverberation.scatterers_per_cell = 2; }},
      {"source", [](Scenario& s) { s.platforms[0].track.start.position.x() += 1.0; }},
      {"receiver", [](Scenario& s) { s.platforms[1].track.start.position.y() += 1.0; }},
      {"depth of the receiver",
       [](Scenario& s) { s.platforms[1].track.start.position.z() += 1.0; }},
      {"motion of the source", [](Scenario& s) { s.platforms[0].track.start.velocity.x() = 2.0; }},
      {"motion of the receiver",
       [](Scenario& s) { s.platforms[1].track.start.velocity.x() = 2.0; }},
      {"the array's place",
       [](Scenario& s) {
         s.arrays[0].offset = {3.0, 0.0, 0.0};
       }},
      // Which paths are received as one hangs on what the array resolves.
      {"phones", [](Scenario& s) { s.arrays[0].phones = line_array(2, 0.1, 0.0, 0.0).phones; }},
      {"bounces", [](Scenario& s) { s.propagation.max_surface_bounces = 2; }},
      {"water", [](Scenario& s) { s.environment.water = SoundSpeedProfile::isovelocity(1490.0); }},
      {"bottom", [](Scenario& s) { s.environment.bottom.material = Rigid{}; }},
  };
}

double expected_db(const PingRecord& record) { return record.summary.front().reverberation_db; }

// What is expected of the reverberation (limits of what is audible, the mean level) is kept, and
// nothing of it is used for anything else: each change alone is worked out anew, and comes out as
// if nothing were kept; what does not enter is found again, and so is what was there first.
TEST(SharedReverberation, EverythingThatEntersTheExpectedLevelIsPartOfItsKey) {
  const auto shared = std::make_shared<SharedPropagation>();
  const double first = expected_db(PingSimulator(with_every_field(), shared).levels(1));
  for (const Change& change : changes_of_what_is_expected()) {
    SCOPED_TRACE(change.name);
    Scenario s = with_every_field();
    change.make(s);
    const PingRecord anew = PingSimulator(s, shared).levels(1);
    EXPECT_FALSE(anew.reuse.expected_level);
    EXPECT_EQ(expected_db(anew), expected_db(PingSimulator(s).levels(1)));
    const PingRecord again = PingSimulator(s, shared).levels(1);
    EXPECT_TRUE(again.reuse.expected_level);
    EXPECT_EQ(expected_db(again), expected_db(anew));
  }
  const std::vector<Change> others = {
      {"nothing", [](Scenario&) {}},
      {"seed", [](Scenario& s) { s.seed = 77; }},
      {"noise", [](Scenario& s) { s.noise.law = WhiteNoise{55.0}; }},
      {"statistics", [](Scenario& s) { s.reverberation.surface_field.statistics.k_shape = 0.7; }},
      {"motion", [](Scenario& s) { s.reverberation.bottom_field.motion.speed_rms = 0.5; }}};
  for (const Change& change : others) {
    SCOPED_TRACE(change.name);
    Scenario s = with_every_field();
    change.make(s);
    const PingRecord record = PingSimulator(s, shared).levels(1);
    EXPECT_TRUE(record.reuse.expected_level);
    EXPECT_EQ(expected_db(record), first);
  }
}

// With echoes and reverberation across the band limits are others than at one frequency, and they
// are kept apart from those.
TEST(SharedReverberation, PointsOfTheBandArePartOfTheKey) {
  const auto shared = std::make_shared<SharedPropagation>();
  Scenario s = with_every_field();
  EXPECT_FALSE(PingSimulator(s, shared).simulate(1).reuse.expected_level);
  s.propagation.band = BandOfLosses::wide;
  for (const bool known : {false, true}) {
    const PingRecord record = PingSimulator(s, shared).simulate(1);
    EXPECT_EQ(record.reuse.expected_level, known);
    EXPECT_TRUE(same(record, PingSimulator(s).simulate(1)));
  }
  s.environment.absorption = Thorp{};
  const PingRecord other = PingSimulator(s, shared).simulate(1);
  EXPECT_FALSE(other.reuse.expected_level);
  EXPECT_TRUE(same(other, PingSimulator(s).simulate(1)));
}

}  // namespace
}  // namespace asdic::detail
