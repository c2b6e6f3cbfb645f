#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/geometry.h"
#include "core/units.h"
#include "processing/matched_filter.h"
#include "processing/pulse_ambiguity.h"
#include "support/processing.h"
#include "support/thesis.h"

namespace asdic::detail {
namespace {

/// A pulse of half a second, and a target that closes at 4 m/s a little east of north-east, in
/// water without refraction; noise, no reverberation.
Scenario sending(const AnyWaveform& waveform) {
  Scenario s = support::thesis(SoundSpeedProfile::isovelocity(1500.0));
  s.platforms[0].track.start.position = {0.0, 0.0, 1000.0};
  s.arrays[0] = line_array(8, 0.3, 0.0, 0.0);
  std::get<LineBeam>(s.transmitters[0].beam).taper = Taper::omnidirectional;
  s.transmitters[0].source_level_db = 215.0;
  s.pulse = {.waveform = waveform, .duration = 0.5, .window = PulseWindow::hann};
  const Vec3 towards = direction(radians(50.0), 0.0);
  const Vec3 place = 3000.0 * towards + Vec3(0.0, 0.0, 1000.0);
  s.targets = {support::target(place, 10.0, -4.0 * towards)};
  s.noise.law = WhiteNoise{60.0};
  s.pings.recording_duration = 6.0;
  s.pings.sample_rate = 8000.0;
  return s;
}

std::vector<AnyWaveform> generated() {
  return {
      Costas{.frequency = 2500.0},
      Sfm{.frequency = 2500.0, .swing = 100.0, .modulation_frequency = 8.0},
      Ptfm{.start_frequency = 2450.0, .end_frequency = 2550.0, .sweeps = 8},
      GeometricComb{.start_frequency = 2450.0, .end_frequency = 2550.0, .lines = 6},
      PulseTrain{
          .start_frequency = 2450.0, .end_frequency = 2550.0, .pulses = 10, .pulse_duration = 0.04},
      PulseTrain{.start_frequency = 2500.0,
                 .end_frequency = 2500.0,
                 .pulses = 10,
                 .pulse_duration = 0.03}};
}

// The loudest detection is the echo: at its delay to a cell of its band, at its Doppler factor to
// half a filter's −3 dB half-width, and at its place. The nails beside are 0.9 dB lower or more,
// those 19 Hz aside 1.9 dB: five times what noise of 24 dB less does.
TEST(ProcessedWaveforms, AnEchoOfEachIsFoundWhereItIs) {
  for (const AnyWaveform& waveform : generated()) {
    SCOPED_TRACE(name_of(waveform));
    const Scenario s = sending(waveform);
    const PingSimulator simulator(s);
    const PingRecord record = simulator.simulate(1);
    ProcessingSettings settings{.max_speed = 8.0, .target_depth = 1000.0};
    settings.detector.first_time = 0.6;
    const PingProcessor processor(s, support::replicas_of(simulator), settings);
    const ProcessedArray done = processor.process(support::recording_of(s, record));
    const std::vector<TrueEcho> echoes = true_echoes(record, 0);
    ASSERT_EQ(echoes.size(), 1U);
    ASSERT_FALSE(done.result.detections.empty());
    const Detection& d = *std::max_element(
        done.result.detections.begin(), done.result.detections.end(),
        [](const Detection& a, const Detection& b) { return a.snr_db < b.snr_db; });
    EXPECT_GT(d.snr_db, 20.0);
    const double cell = 1.0 / Pulse(s.pulse).bandwidth_99();
    EXPECT_NEAR(d.time, echoes[0].time, cell);
    EXPECT_LT(std::abs(d.doppler - echoes[0].doppler), 0.5 * done.result.doppler_cell);
    ASSERT_EQ(d.locations.size(), 2U);
    EXPECT_NEAR(d.locations[0].range, 3000.0, 750.0 * cell + 8.0);
  }
}

// Ten tones of t = 30 ms under a Hann window, I = 52.2 ms apart: one pulse later nine of ten meet,
// (9/10)², and 1/I further all ten meet as much as one does itself there, ∫w² e^{i2πt/I}dt over
// ∫w²: five sincs about x = t/I = 0.574, 0.877 together. A sweep has neither.
TEST(Nails, AreWhereAndAsLoudAsATrainsClosedForm) {
  const PulseTrain train{
      .start_frequency = 2500.0, .end_frequency = 2500.0, .pulses = 10, .pulse_duration = 0.03};
  const Pulse pulse({.waveform = train, .duration = 0.5, .window = PulseWindow::hann});
  const Replica sent(replica(pulse, 16000.0), 16000.0);
  const double interval = 0.47 / 9.0, x = 0.03 / interval;
  const auto sinc = [](double u) { return u == 0.0 ? 1.0 : std::sin(pi * u) / (pi * u); };
  const double one = (3.0 / 8.0 * sinc(x) + 0.25 * (sinc(x - 1.0) + sinc(x + 1.0)) +
                      1.0 / 16.0 * (sinc(x - 2.0) + sinc(x + 2.0))) /
                     (3.0 / 8.0);
  const Nail late = nail_in_delay(sent), fast = nail_in_doppler(sent, 0.012);
  EXPECT_NEAR(late.offset, interval, 1e-3);  // delays are that far apart
  EXPECT_NEAR(late.power, 0.81, 0.005);
  EXPECT_NEAR(fast.offset, 1.0 / interval / 2500.0, 0.03 / interval / 2500.0);
  EXPECT_NEAR(fast.power, one * one, 0.02);  // steps are a quarter of a cell apart
  EXPECT_GT(reach_of_answer(sent, 0.1, 0.3), 0.3);
  const Pulse sweep(
      {.waveform = Lfm{2450.0, 2550.0}, .duration = 0.5, .window = PulseWindow::hann});
  const Replica swept(replica(sweep, 16000.0), 16000.0);
  EXPECT_LT(nail_in_delay(swept).power, 0.02);
  EXPECT_EQ(reach_of_answer(swept, 0.02, 0.14), 0.0);
}

// What `asdic plot` draws beside what the filter itself does: cells of the picture are its greatest
// values, so none is below the filter's at the cell's middle, and the echo's own is 1.
TEST(PulseAmbiguity, IsTheFiltersGreatestInEachCell) {
  std::vector<AnyWaveform> all = generated();
  all.insert(all.end(), {Cw{2500.0}, Lfm{2450.0, 2550.0}, Hfm{2550.0, 2450.0}});
  for (const AnyWaveform& waveform : all) {
    SCOPED_TRACE(name_of(waveform));
    const Pulse pulse({.waveform = waveform, .duration = 0.5, .window = PulseWindow::hann});
    const PulseAmbiguity found = pulse_ambiguity(pulse);
    ASSERT_EQ(found.power.size(), found.delays.size() * found.dopplers.size());
    const std::size_t n = found.delays.size(), middle = found.power.size() / 2;
    EXPECT_EQ(found.delays[n / 2], 0.0);
    EXPECT_NEAR(found.power[middle], 1.0, 1e-6);
    EXPECT_LE(*std::max_element(found.power.begin(), found.power.end()), 1.0 + 1e-6);
    const Replica replica(asdic::detail::replica(pulse, 16000.0), 16000.0);
    for (std::size_t r = 3; r < found.dopplers.size(); r += 19) {
      const std::vector<double> one{found.dopplers[r]};
      const std::vector<double> row = ambiguity(replica, found.delays, one);
      for (std::size_t c = 0; c < n; c += 7)
        EXPECT_GT(found.power[r * n + c], 0.9 * row[c] - 1e-4) << r << ' ' << c;
    }
  }
}

}  // namespace
}  // namespace asdic::detail
