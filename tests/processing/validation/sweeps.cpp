#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry.h"
#include "support/processing.h"
#include "support/thesis.h"

namespace asdic::detail {
namespace {

/// A sweep of 400 Hz and 0.25 s, and a target that closes at 4 m/s a little east of north-east, in
/// water without refraction; noise, no reverberation.
Scenario sweeping(const AnyWaveform& sweep) {
  Scenario s = support::thesis(SoundSpeedProfile::isovelocity(1500.0));
  s.platforms[0].track.start.position = {0.0, 0.0, 1000.0};
  s.arrays[0] = line_array(16, 0.3, 0.0, 0.0);
  std::get<LineBeam>(s.transmitters[0].beam).taper = Taper::omnidirectional;
  s.transmitters[0].source_level_db = 210.0;
  s.pulse = {.waveform = sweep, .duration = 0.25, .window = PulseWindow::hann};
  const Vec3 towards = direction(radians(50.0), 0.0);
  const Vec3 place = 3000.0 * towards + Vec3(0.0, 0.0, 1000.0);
  s.targets = {support::target(place, 10.0, -4.0 * towards)};
  s.noise.law = WhiteNoise{60.0};
  s.pings.recording_duration = 6.0;
  s.pings.sample_rate = 8000.0;
  return s;
}

// One echo, one detection, whatever the number of Doppler filters: all its other peaks lie on the
// pulse's ridge, κ = −dτ/dη away, and are explained by it. Its Doppler factor is told to half a
// filter's −3 dB half-width, and its delay, corrected along the ridge, to a cell. With the ridge
// mirrored (echo and filter exchanged) every filter makes a detection of its own.
TEST(ProcessedSweepPulse, OneEchoIsOneDetection) {
  for (const AnyWaveform& sweep :
       {AnyWaveform(Lfm{2300.0, 2700.0}), AnyWaveform(Lfm{2700.0, 2300.0}),
        AnyWaveform(Hfm{2300.0, 2700.0}), AnyWaveform(Hfm{2700.0, 2300.0})}) {
    SCOPED_TRACE(name_of(sweep));
    const Scenario s = sweeping(sweep);
    const PingSimulator simulator(s);
    const PingRecord record = simulator.simulate(1);
    ProcessingSettings settings{.max_speed = 20.0, .target_depth = 1000.0};
    settings.detector.first_time = 0.5;
    const PingProcessor processor(s, support::replicas_of(simulator), settings);
    ASSERT_GE(processor.dopplers(0).size(), 3U);
    const ProcessedArray done = processor.process(support::recording_of(s, record));
    const std::vector<TrueEcho> echoes = true_echoes(record, 0);
    ASSERT_EQ(echoes.size(), 1U);
    ASSERT_EQ(done.result.detections.size(), 1U);
    const Detection& d = done.result.detections[0];
    const double off = d.doppler - echoes[0].doppler;
    EXPECT_GT(d.snr_db, 20.0);
    EXPECT_LT(std::abs(off), 0.5 * done.result.doppler_cell);
    EXPECT_NEAR(d.time - done.result.delay_per_doppler * off, echoes[0].time,
                done.result.time_cell);
    ASSERT_EQ(d.locations.size(), 2U);
    // A cell of 1/B is 2 m; the ridge turns half a half-width of Doppler into range.
    const double ridge = std::abs(done.result.delay_per_doppler) * 0.5 * done.result.doppler_cell;
    EXPECT_NEAR(d.locations[0].range, 3000.0, (done.result.time_cell + ridge) * 750.0 + 8.0);
    EXPECT_NEAR(d.locations[0].bearing, radians(50.0), 0.5 * 0.6 / 4.5 / std::sin(radians(50.0)));
  }
}

// Ten pings of one target are one track a side, which ends where the target is.
TEST(ProcessedSweepPulse, OneTargetIsOneTrack) {
  Scenario s = sweeping(Lfm{2300.0, 2700.0});
  s.pings.count = 10;
  s.pings.interval = 10.0;
  const PingSimulator simulator(s);
  ProcessingSettings settings{.target_depth = 1000.0};
  settings.detector.first_time = 0.5;
  const auto tracks = support::tracks_of(simulator, settings);
  ASSERT_EQ(tracks.size(), 1U);
  const TrackPoint& last = tracks[0].points.back();
  const Vec3 truth = s.targets[0].track.at(last.time).position;
  // λ/L is 7.6°, 400 m at 3 km; an echo over 20 dB tells a tenth of that.
  EXPECT_LT((last.position - truth.head<2>()).norm(), 40.0);
}

}  // namespace
}  // namespace asdic::detail
