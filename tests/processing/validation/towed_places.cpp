// The receiver on what every phone of a towed line receives by paths of its own: lines far astern,
// straight and in a turn.
#include <gtest/gtest.h>

#include <cmath>

#include "support/processing.h"
#include "support/two_platforms.h"

namespace asdic::detail {
namespace {

constexpr double c = 1500.0, highest = 1000.0;  // [m/s], [Hz]

/// A ship with a line of 64 phones 0.75 m apart, an echo from straight ways alone, faint noise. The
/// sweep is short: what a range rate between two Doppler filters does to its delay, T·f/B = 0.95 m
/// for one m/s, stays within a cell of 15 m.
Scenario tow(double first, const Vec3& target) {
  Scenario s = support::two_platforms();
  s.platforms.resize(1);
  s.platforms[0].track.start = {.position = {0.0, 0.0, 100.0}, .velocity = {3.0, 0.0, 0.0}};
  TowedLine line;
  for (int n = 0; n < 64; ++n) line.behind.push_back(first + 0.75 * n);
  s.arrays[0] = {};
  s.arrays[0].towed = line;
  s.arrays[0].phones.resize(64);
  s.targets.resize(1);
  s.targets[0].name = "target";
  s.targets[0].strength_db = 15.0;
  s.targets[0].track.start.position = target;
  s.transmitters[0].source_level_db = 215.0;
  s.pulse = {.waveform = Lfm{.start_frequency = 900.0, .end_frequency = highest},
             .duration = 0.1,
             .window = PulseWindow::hann};
  s.noise.law = WhiteNoise{30.0};
  s.propagation.direct_blast = false;
  s.pings.recording_duration = 8.0;
  s.pings.sample_rate = 4000.0;
  return s;
}

struct Place {
  double range_error, bearing_error, position_error, cell, beam;  ///< [m], [rad]
};

/// Where the receiver puts the target, and how much it resolves there.
Place place_of(const Scenario& scenario) {
  const PingSimulator simulator(scenario);
  const PingRecord record = simulator.simulate(1);
  ProcessingSettings settings{.max_speed = 5.0,
                              .target_depth = scenario.targets[0].track.start.position.z()};
  settings.detector.first_time = simulator.pulse().duration();
  const PingProcessor processor(scenario, support::replicas_of(simulator), settings);
  const ProcessedArray processed = processor.process(support::recording_of(scenario, record));
  const std::vector<TrueEcho> echoes = true_echoes(record, 0);
  const PingScore score =
      score_detections(processed.result.detections, echoes,
                       true_targets(scenario, record.ping, record.start_time, echoes),
                       processed.shape, processed.places.array, processor.resolution(processed),
                       *settings.detector.first_time, scenario.pings.recording_duration);
  EXPECT_EQ(score.hits, 1);
  if (score.hits != 1) return {};
  const Detection& d = processed.result.detections[std::size_t(score.targets[0].detection)];
  return {.range_error = score.targets[0].range_error,
          .bearing_error = score.targets[0].bearing_error,
          .position_error = score.targets[0].position_error,
          .cell = processed.result.time_cell * d.locations[0].range_slope,
          .beam = c / highest / processed.shape.length};
}

// 300 and 1000 m astern, abeam, on the bow and near: within half a cell of
// range and half a beam's width, whether plane waves serve the phones or each has its own paths.
TEST(TowedPlaces, AStraightLineFarAsternPlacesTheTargetWithinACell) {
  for (const double first : {300.0, 1000.0})
    for (const Vec3& target : {Vec3(0, 5000, 100), Vec3(2500, -2500, 100), Vec3(-300, 1500, 100)})
      for (const bool exact : {false, true}) {
        Scenario s = tow(first, target);
        s.propagation.exact_per_phone = exact;
        const Place found = place_of(s);
        EXPECT_LT(std::abs(found.range_error), 0.5 * found.cell) << first << " " << exact;
        EXPECT_LT(std::abs(found.bearing_error), 0.5 * found.beam) << first << " " << exact;
      }
}

// The ship turns by a right angle on a circle of 400 m while her line receives the echo: beams have
// the line's shape in the middle of the record and turn with it, which leaves less than a beam.
TEST(TowedPlaces, ALineThatTurnsPlacesTheTargetWithinACell) {
  for (const Vec3& target : {Vec3(2500, 2500, 120), Vec3(300, -3500, 100)})
    for (const bool exact : {false, true}) {
      Scenario s = tow(50.0, target);
      std::vector<Waypoint>& way = s.platforms[0].track.waypoints;
      way.push_back({-60.0, {-240.0, 0.0, 100.0}});
      way.push_back({-10.0, {-40.0, 0.0, 100.0}});
      for (int k = 0; k <= 18; ++k) {
        const double angle = radians(5.0 * k);
        way.push_back({400.0 * angle / 4.0,
                       {400.0 * std::sin(angle), 400.0 * (1.0 - std::cos(angle)), 100.0}});
      }
      s.propagation.exact_per_phone = exact;
      const Place found = place_of(s);
      EXPECT_LT(std::abs(found.range_error), 0.5 * found.cell) << exact;
      EXPECT_LT(std::abs(found.bearing_error), found.beam) << exact;
    }
}

}  // namespace
}  // namespace asdic::detail
