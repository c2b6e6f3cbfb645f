#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "core/geometry.h"
#include "support/processing.h"
#include "support/thesis.h"

namespace asdic::detail {
namespace {

/// A tone of 1 s at 4 kHz from a vehicle at 4500 m in Munk's profile, 16 phones north to south, a
/// target to the east-north-east, noise, no reverberation.
Scenario munk(double range = 17000.0, const Vec3& velocity = {-4.0, 1.0, 0.0}) {
  Scenario s = support::thesis(SoundSpeedProfile::munk());
  s.environment.bottom = {.depth = 5000.0, .material = FluidHalfSpace{}};
  s.platforms[0].track.start.position = {100.0, -50.0, 4500.0};
  s.arrays[0] = line_array(16, 0.1875, 0.0, 0.0);
  const double bearing = radians(70.0);
  s.targets = {
      support::target({100.0 + range * std::sin(bearing), -50.0 + range * std::cos(bearing), 125.0},
                      20.0, velocity)};
  std::get<LineBeam>(s.transmitters[0].beam).taper = Taper::omnidirectional;
  s.noise.law = WhiteNoise{50.0};
  s.propagation.max_surface_bounces = 0;
  s.propagation.max_bottom_bounces = 0;
  s.pings.recording_duration = 32.0;
  s.pings.sample_rate = 10000.0;
  return s;
}

struct Outcome {
  ProcessedArray processed;
  PingScore score;
  std::vector<TrueEcho> echoes;
  std::vector<TrueTarget> targets;
};

Outcome run(const PingSimulator& simulator, const PingRecord& record, ProcessingSettings settings) {
  const Scenario& scenario = simulator.scenario();
  settings.detector.first_time = simulator.pulse().duration();
  const PingProcessor processor(scenario, support::replicas_of(simulator), settings);
  Outcome out;
  out.processed = processor.process(support::recording_of(scenario, record));
  out.echoes = true_echoes(record, 0);
  out.targets = true_targets(scenario, record.ping, record.start_time, out.echoes);
  out.score = score_detections(out.processed.result.detections, out.echoes, out.targets,
                               out.processed.shape, out.processed.places.array,
                               processor.resolution(out.processed), *settings.detector.first_time,
                               scenario.pings.recording_duration);
  return out;
}
Outcome run(const Scenario& scenario, const ProcessingSettings& settings) {
  const PingSimulator simulator(scenario);
  return run(simulator, simulator.simulate(1), settings);
}

const Detection& hit(const Outcome& out) {
  return out.processed.result.detections[std::size_t(out.score.targets[0].detection)];
}

// A resolution cell is time_cell·(dr/dτ) long and λ/(L·sin) wide: the place found, of the two that
// a line cannot resolve, lies within it, and the Doppler factor within half a bin, 1/(2fT). The
// loudest of unresolved paths is what is found, and their delays spread far less than a cell.
TEST(ProcessedPing, LocatesTheTargetWithinTheResolutionCell) {
  for (const double range : {9000.0, 16000.0, 22000.0}) {
    const Outcome out = run(munk(range), {.target_depth = 125.0});
    ASSERT_EQ(out.score.hits, 1) << range;
    const TargetScore& score = out.score.targets[0];
    const Detection& d = hit(out);
    ASSERT_EQ(d.locations.size(), 2U);
    const double long_cell = out.processed.result.time_cell * d.locations[0].range_slope;
    const double wide_cell =
        (out.processed.sound_speed / 4000.0) / out.processed.shape.length / std::sin(radians(70.0));
    EXPECT_LT(std::abs(score.range_error), 0.5 * long_cell) << range;
    EXPECT_LT(std::abs(score.bearing_error), 0.5 * wide_cell) << range;
    const double bin = 0.5 / (4000.0 * 1.0);
    double nearest = infinity;
    for (const TrueEcho& e : out.echoes)
      nearest = std::min(nearest, std::abs(e.doppler - d.doppler));
    EXPECT_LT(nearest, bin) << range;
    // The target's radial speed: −4 sin 70° + cos 70°; a bin is c/(4fT) = 0.09 m/s.
    EXPECT_NEAR(d.locations[0].range_rate, -4.0 * std::sin(radians(70.0)) + std::cos(radians(70.0)),
                0.1);
    // The mirror image lies on the other side of the axis, at about as much range.
    EXPECT_NEAR(std::remainder(d.locations[0].bearing + d.locations[1].bearing, 2.0 * pi), 0.0,
                1e-6);
  }
}

// A sweep of 200 Hz has cells of 4 m; noise alone limits it. Straight rays of 1500 m/s at the same
// depth are wrong by the refraction and the difference of the speeds: many cells.
TEST(ProcessedPing, RangesByTheSoundPathsNotBy1500) {
  Scenario s = munk(17000.0, Vec3::Zero());
  s.pulse.waveform = Lfm{3900.0, 4100.0};
  const Outcome right = run(s, {.max_speed = 0.0, .target_depth = 125.0});
  ASSERT_EQ(right.score.hits, 1);
  const double cell = right.processed.result.time_cell * 750.0;
  EXPECT_LT(std::abs(right.score.targets[0].range_error), cell);
  const Outcome wrong = run(s, {.max_speed = 0.0, .target_depth = 125.0, .range_speed = 1500.0});
  ASSERT_EQ(wrong.score.hits, 1);
  EXPECT_GT(std::abs(wrong.score.targets[0].range_error), 10.0 * cell);
}

// An upright array tells the elevation, and the ray that came in at it leads to the depth: near the
// surface here, whatever the settings' own guess; range as above.
TEST(ProcessedPing, TracesTheRayBackFromAnUprightArray) {
  Scenario s = munk(8000.0, Vec3::Zero());
  s.platforms[0].track.start.position.z() = 3500.0;
  s.arrays[0] = line_array(32, 0.1875, 0.0, radians(90.0));
  const Outcome out = run(s, {});
  ASSERT_EQ(out.score.hits, 1);
  const Detection& d = hit(out);
  ASSERT_EQ(d.locations.size(), 1U);
  EXPECT_TRUE(std::isnan(d.bearing));
  // The elevation is known to a tenth of λ/L = 3.7°, times 8.8 km of path: 60 m of depth.
  EXPECT_NEAR(d.locations[0].position.z(), 125.0, 100.0);
  EXPECT_LT(std::abs(out.score.targets[0].range_error), 100.0);
}

// Two rings above one another are a volume: one place, both angles. 5 % of λ/aperture each.
TEST(ProcessedPing, AVolumeTellsTheSideAndTheElevation) {
  Scenario s = munk(9000.0, Vec3::Zero());
  s.platforms[0].track.start.position.z() = 2000.0;
  s.arrays[0].phones.clear();
  for (int i = 0; i < 16; ++i)
    for (const double z : {-0.4, -0.13, 0.13, 0.4})
      s.arrays[0].phones.emplace_back(0.45 * std::sin(i * pi / 8), 0.45 * std::cos(i * pi / 8), z);
  ProcessingSettings settings{.max_speed = 2.0, .target_depth = 125.0};
  settings.detector.lowest_elevation = radians(-30.0);
  settings.detector.highest_elevation = radians(30.0);
  const Outcome out = run(s, settings);
  ASSERT_EQ(out.score.hits, 1);
  const Detection& d = hit(out);
  ASSERT_EQ(d.locations.size(), 1U);
  EXPECT_NEAR(d.bearing, radians(70.0), radians(1.2));
  // The loudest path pair's own elevation.
  double level = -infinity, elevation = 0.0;
  for (const TrueEcho& e : out.echoes)
    if (e.level_db > level) level = e.level_db, elevation = std::asin(e.travel.z());
  EXPECT_NEAR(d.elevation, elevation, radians(1.2));
  EXPECT_LT(out.score.targets[0].position_error, 300.0);
}

// Two platforms: the way out and the way back are different legs. The cell is that of the sum.
TEST(ProcessedPing, LocatesByABistaticPair) {
  Scenario s = munk(12000.0, Vec3::Zero());
  s.platforms.push_back({.name = "ear", .track = {}});
  s.platforms[1].track.start.position = {2000.0, 5000.0, 4000.0};
  s.arrays[0].platform = 1;
  const Outcome out = run(s, {.target_depth = 125.0});
  ASSERT_EQ(out.score.hits, 1);
  const Detection& d = hit(out);
  EXPECT_LT(std::abs(out.score.targets[0].range_error),
            0.5 * out.processed.result.time_cell * d.locations[0].range_slope);
}

// The same bits for any number of threads.
TEST(ProcessedPing, IsTheSameForAnyNumberOfThreads) {
  Scenario s = munk(7000.0);
  s.pings.recording_duration = 12.0;
  s.arrays[0] = line_array(8, 0.1875, 0.0, 0.0);
  const PingSimulator simulator(s);
  const PingRecord record = simulator.simulate(1);
  for (const Beamformer beamformer : {Beamformer::conventional, Beamformer::mvdr}) {
    ProcessingSettings settings{.target_depth = 125.0};
    settings.detector.beamformer = beamformer;
    settings.detector.normaliser.false_alarm_probability = 1e-4;  // noise gives some more
    std::vector<std::vector<Detection>> all;
    std::vector<std::vector<float>> maps;
    for (const std::size_t threads : {1U, 7U}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      const Outcome out = run(simulator, record, settings);
      all.push_back(out.processed.result.detections);
      maps.push_back(out.processed.result.maps.beam_time);
    }
    ASSERT_GT(all[0].size(), 1U);
    for (std::size_t k = 1; k < all.size(); ++k) {
      ASSERT_EQ(all[k].size(), all[0].size());
      EXPECT_TRUE(maps[k] == maps[0]);
      for (std::size_t i = 0; i < all[0].size(); ++i) {
        EXPECT_EQ(all[k][i].time, all[0][i].time);
        EXPECT_EQ(all[k][i].doppler, all[0][i].doppler);
        EXPECT_EQ(all[k][i].snr_db, all[0][i].snr_db);
        ASSERT_EQ(all[k][i].locations.size(), all[0][i].locations.size());
        for (std::size_t j = 0; j < all[0][i].locations.size(); ++j)
          EXPECT_EQ(all[k][i].locations[j].range, all[0][i].locations[j].range);
      }
    }
  }
}

// Noise alone: 32 s × 160 Hz of Doppler span × 16 independent beams are 8·10⁴ cells; at 10⁻⁶, and
// with the filters and beams between them that raise the largest value (by a factor of a few),
// about 0.3 detections. Four or more have a probability below 10⁻³.
TEST(ProcessedPing, NoiseAloneGivesFewDetections) {
  Scenario s = munk();
  s.targets.clear();
  const Outcome quiet = run(s, {});
  EXPECT_LE(quiet.processed.result.detections.size(), 3U);
}

/// Eight pings of one minute at a target that goes by, from a vehicle that moves.
TEST(ProcessedTracks, FollowTheTruth) {
  Scenario s = munk(14000.0, {-5.0, 3.0, 0.0});
  s.platforms[0].track.start.velocity = {0.0, 2.0, 0.0};
  s.propagation.max_surface_bounces = 1;
  s.pings.count = 10;
  s.pings.interval = 60.0;
  s.pings.recording_duration = 24.0;
  const PingSimulator simulator(s);
  ProcessingSettings settings{.target_depth = 125.0};
  settings.detector.first_time = 1.0;
  const auto tracks = support::tracks_of(simulator, settings);
  ASSERT_GE(tracks.size(), 1U);
  const auto longest = std::max_element(
      tracks.begin(), tracks.end(),
      [](const auto& a, const auto& b) { return a.points.size() < b.points.size(); });
  ASSERT_GE(longest->points.size(), 9U);
  for (std::size_t i = 3; i < longest->points.size(); ++i) {  // once it has settled
    const TrackPoint& p = longest->points[i];
    const Kinematics truth = s.targets[0].track.at(p.time);
    // Five standard deviations of its own estimate, and never more than a cell: λ/L·r is 1.2 km.
    const double off = (p.position - truth.position.head<2>()).norm();
    EXPECT_LT(off, 5.0 * p.position_sigma) << i;
    EXPECT_LT(off, 200.0) << i;
  }
  const TrackPoint& last = longest->points.back();
  EXPECT_NEAR(last.velocity.x(), -5.0, 1.0);
  EXPECT_NEAR(last.velocity.y(), 3.0, 1.0);
}

}  // namespace
}  // namespace asdic::detail
