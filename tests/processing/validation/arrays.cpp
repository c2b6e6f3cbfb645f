#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry.h"
#include "support/processing.h"
#include "support/thesis.h"

namespace asdic::detail {
namespace {

/// A 0.5 s tone of 1.5 kHz (λ = 1 m) and one loud echo, 2.5 km away in water without refraction, in
/// white noise; 24 phones half a wavelength apart to the east, bent northwards by an arc.
Scenario one_echo(double sag, double bearing, double depth = 100.0) {
  Scenario s = support::thesis(SoundSpeedProfile::isovelocity(1500.0));
  s.platforms[0].track.start.position = {0.0, 0.0, 100.0};
  s.arrays[0].phones.clear();
  for (int i = 0; i < 24; ++i) {
    const double x = 0.5 * i - 5.75;
    s.arrays[0].phones.emplace_back(x, sag * (1.0 - std::pow(x / 5.75, 2)), 0.0);
  }
  s.transmitters[0].source_level_db = 205.0;
  s.pulse = {.waveform = Cw{.frequency = 1500.0}, .duration = 0.5};
  Vec3 place = 2500.0 * direction(bearing, 0.0);
  place.z() = depth;
  s.targets = {support::target(place, 12.0)};
  s.noise.law = WhiteNoise{60.0};
  s.pings.recording_duration = 6.0;
  s.pings.sample_rate = 4000.0;
  return s;
}

struct Received {
  ProcessedArray processed;
  PingScore score;
};

Received receive(const Scenario& s, Beamformer beamformer, double depth = 100.0) {
  const PingSimulator simulator(s);
  const PingRecord record = simulator.simulate(1);
  ProcessingSettings settings{.target_depth = depth};
  settings.detector.first_time = 0.5;
  settings.detector.beamformer = beamformer;
  const PingProcessor processor(s, support::replicas_of(simulator), settings);
  std::vector<TrueEcho> echoes = true_echoes(record, 0);
  Received out;
  out.processed = processor.process(support::recording_of(s, record), {}, echoes);
  for (std::size_t i = 0; i < echoes.size(); ++i)
    echoes[i].threshold_db = out.processed.result.thresholds_db[i];
  out.score =
      score_detections(out.processed.result.detections, echoes,
                       true_targets(s, record.ping, record.start_time, echoes), out.processed.shape,
                       out.processed.places.array, processor.resolution(out.processed), 0.5, 6.0);
  return out;
}

// A lone echo is in the covariance that shapes the beams: without a bound to their white noise the
// beams beside its direction null it. Bounded to 1 dB over 1/N, a beam a quarter of a cell off
// loses at most 3.4 dB (amplitude 0.9 − 0.44·0.51, docs/theory/processing.md) against 0.9 dB of the
// conventional one's; interpolation between beams gives it back: it is received no more than 1 dB
// weaker. (It is received up to 2 dB louder: weights that are trained on a few blocks fit these
// blocks' noise.)
TEST(ProcessedMvdr, ReceivesALoneLoudEchoAsLoudAsPlainBeams) {
  for (const double bearing : {-50.0, 20.0, 60.0, 90.0}) {
    SCOPED_TRACE(bearing);
    const Scenario s = one_echo(0.0, radians(bearing));
    const Received plain = receive(s, Beamformer::conventional),
                   adapted = receive(s, Beamformer::mvdr);
    ASSERT_EQ(plain.processed.result.detections.size(), 1U);
    ASSERT_EQ(adapted.processed.result.detections.size(), 1U);
    EXPECT_EQ(adapted.score.hits, 1);
    EXPECT_GT(adapted.processed.result.detections[0].snr_db,
              plain.processed.result.detections[0].snr_db - 1.0);
  }
}

// A bend of a tenth to one and a half wavelengths hardly tells elevations, but from λ/4 on the
// side. The echo is found at its bearing within half a beam, λ/(2L·sin of the angle with the axis),
// the place on the right side of the line.
TEST(ProcessedBentLine, FindsTheEchoAtItsBearing) {
  for (const double sag : {0.1, 0.3, 0.6, 1.0, 1.4})
    for (const double bearing : {60.0, 20.0, -50.0, 160.0})
      for (const double depth : {100.0, 250.0}) {
        SCOPED_TRACE("sag " + std::to_string(sag) + ", bearing " + std::to_string(bearing));
        const Received received =
            receive(one_echo(sag, radians(bearing), depth), Beamformer::conventional, depth);
        EXPECT_EQ(received.processed.shape.bent, sag > 0.25);
        ASSERT_EQ(received.score.hits, 1);
        EXPECT_EQ(received.score.false_alarms, 0);
        const double across = std::abs(std::cos(radians(bearing)));
        EXPECT_LT(std::abs(received.score.targets[0].bearing_error), 0.5 / 11.5 / across);
        const Detection& d = received.processed.result.detections[0];
        EXPECT_EQ(d.locations.size(), sag > 0.25 ? 1U : 2U);
      }
}

// An echo far below the noise cannot be what was detected, however near: here it is 40 dB weaker
// than it was when the recording was made. Nor is its target missed: nobody could receive it.
TEST(ProcessedTruth, DoesNotExplainABurstByAWhisper) {
  const Scenario s = one_echo(0.0, radians(20.0));
  const PingSimulator simulator(s);
  const PingRecord record = simulator.simulate(1);
  const PingProcessor processor(s, support::replicas_of(simulator), {.target_depth = 100.0});
  std::vector<TrueEcho> echoes = true_echoes(record, 0);
  const ProcessedArray done = processor.process(support::recording_of(s, record), {}, echoes);
  ASSERT_EQ(done.result.thresholds_db.size(), 1U);
  ASSERT_GE(done.result.detections.size(), 1U);
  // The threshold is what the detection stood over, by its excess, within what a beam and a filter
  // beside the peak lose (2 dB) and the echo's own level differs from its beam's.
  EXPECT_NEAR(done.result.thresholds_db[0],
              done.result.detections[0].level_db - done.result.detections[0].excess_db, 2.0);
  EXPECT_NEAR(done.result.detections[0].level_db, echoes[0].level_db, 2.0);
  const auto score = [&](double weaker_db) {
    std::vector<TrueEcho> changed = echoes;
    changed[0].level_db -= weaker_db;
    changed[0].threshold_db = done.result.thresholds_db[0];
    return score_detections(done.result.detections, changed,
                            true_targets(s, record.ping, record.start_time, changed), done.shape,
                            done.places.array, processor.resolution(done), 0.5, 6.0);
  };
  EXPECT_EQ(score(0.0).hits, 1);
  const PingScore whisper = score(40.0);
  EXPECT_EQ(whisper.hits, 0);
  EXPECT_EQ(whisper.misses, 0);
  EXPECT_FALSE(whisper.targets[0].detectable);
  EXPECT_EQ(whisper.owner[0], -1);
}

}  // namespace
}  // namespace asdic::detail
