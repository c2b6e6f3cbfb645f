// The summary and the levels of a ping against the samples of its record, over products of pulse,
// band, paths, motion and phones.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "sonar/noise/noise_spectrum.h"
#include "sonar/ping/ping.h"
#include "sonar/warnings/warnings.h"
#include "support/thesis.h"

namespace asdic::detail {
namespace {

/// A wave guide of a depth with a perfectly reflecting surface and floor, a target, and three
/// phones, the second at the array's reference point. Samples are baseband.
Scenario guide(double depth, const PulseSettings& pulse) {
  Scenario s;
  s.environment.water = SoundSpeedProfile::isovelocity(1500.0);
  s.environment.absorption = Thorp{};
  s.environment.bottom = {.depth = depth, .material = ElasticHalfSpace{}};
  s.platforms[0].track.start.position = {0.0, 0.0, 5.0};
  s.transmitters[0] = {.source_level_db = 200.0, .beam = LineBeam{.taper = Taper::omnidirectional}};
  s.arrays[0] = line_array(3, 0.05, 0.4, 0.0);
  s.targets = {support::target({40.0, 20.0, 0.6 * depth}, -10.0)};
  s.pulse = pulse;
  s.reverberation.enabled = false;
  s.pings.recording_duration = 0.4 + pulse.duration;
  s.pings.samples = Samples::baseband;
  // Rate at which little of a peak is lost between two samples. The Hann window of a tone has 17
  // samples, and the peak is at most half a sample away: sin²(π(½ + 1/34)), 0.08 dB. Edges without
  // a window overshoot for about two samples. Doppler shifts need 6 kHz. Two paths of a sweep that
  // beat at its whole width lose cos(π/12), 0.3 dB.
  const double bandwidth = Pulse(pulse).bandwidth_40db();
  s.pings.baseband_rate = (bandwidth * pulse.duration > 100.0 ? 6.0 : 3.0) * bandwidth + 6000.0;
  return s;
}

double peak_of_samples_db(const PingRecord& record, std::size_t phone) {
  const std::size_t samples = record.recording.samples;
  double peak = 0.0;
  for (std::size_t i = 0; i < samples; ++i) {
    const float* p = &record.pressure[(phone * samples + i) * 2];
    peak = std::max(peak, std::hypot(double(p[0]), double(p[1])));
  }
  return db_from_amplitude(peak / std::numbers::sqrt2 / micropascal);
}

struct NamedPulse {
  const char* name;
  PulseSettings settings;
};
const NamedPulse pulses[] = {
    {"0.1 ms", {.waveform = Cw{.frequency = 100e3}, .duration = 1e-4}},
    {"1 ms", {.waveform = Cw{.frequency = 100e3}, .duration = 1e-3}},
    {"1 ms, no window",
     {.waveform = Cw{.frequency = 100e3}, .duration = 1e-3, .window = PulseWindow::none}},
    {"20 ms", {.waveform = Cw{.frequency = 100e3}, .duration = 0.02}},
    {"50 ms sweep",
     {.waveform = Lfm{.start_frequency = 98e3, .end_frequency = 102e3}, .duration = 0.05}}};

// The peak is that of the middle phone's samples. Both use the same paths and the pulse's spectrum,
// but the samples are synthesised by FFT, and the peak is a sum of pulses path by path. Samples may
// miss 0.3 dB of the peak, as derived above; 0.1 dB is left for the synthesis (−80 dB) and the
// search (0.02 dB). The earlier search at 4000 times of the whole echo was 2 to 170 dB too low.
TEST(SummaryAndSamples, EchoPeakIsThatOfTheSamples) {
  for (const NamedPulse& pulse : pulses)
    for (const double depth : {30.0, 200.0})
      for (const bool wide : {false, true})
        for (const double speed : {0.0, 6.0}) {
          Scenario s = guide(depth, pulse.settings);
          s.propagation.band = wide ? BandOfLosses::wide : BandOfLosses::narrow;
          s.propagation.max_surface_bounces = s.propagation.max_bottom_bounces = 2;
          s.platforms[0].track.start.velocity = {speed, 0.0, 0.0};
          s.targets[0].track.start.velocity = {0.0, -0.5 * speed, 0.0};
          const PingSimulator simulator(s);
          const PingRecord record = simulator.simulate(1);
          const TargetSummary& told = record.summary.at(0);
          EXPECT_GT(told.paths, 20);
          EXPECT_NEAR(told.echo_peak_db, peak_of_samples_db(record, 1), 0.4)
              << pulse.name << ", " << depth << " m, " << (wide ? "wide" : "narrow") << ", "
              << speed << " m/s";
          EXPECT_EQ(told.echo_peak_db, simulator.levels(1).summary.at(0).echo_peak_db);
        }
}

// A target straight below, by images: out and back either direct or by the surface, without loss.
// The echoes of 1 ms arrive 2·5 m/1500 m/s = 6.7 ms apart. The peak is therefore that of the
// loudest echo alone, or of the sum of the two that go direct one way and by the surface the other,
// because these arrive together.
TEST(SummaryAndSamples, EchoPeakIsThatOfImages) {
  for (const double depth : {500.0, 5000.0}) {
    Scenario s = guide(depth, pulses[1].settings);
    s.environment.absorption = NoAbsorption{};
    s.targets[0].track.start.position = {0.3, 0.0, 60.0};
    s.propagation.max_bottom_bounces = 0;
    s.propagation.max_surface_bounces = 1;
    const double direct = std::hypot(0.3, 55.0), mirrored = std::hypot(0.3, 65.0);
    const double most = std::max(1.0 / (direct * direct), 2.0 / (direct * mirrored));
    const TargetSummary told = PingSimulator(s).levels(1).summary.at(0);
    EXPECT_NEAR(told.echo_peak_db, 200.0 - 10.0 + db_from_amplitude(most), 0.02) << depth;
  }
}

// With one path the leading edge is at echo_time and the peak of a Hann window half a pulse later,
// within a sample. The level is that of the sonar equation.
TEST(SummaryAndSamples, EchoTimeIsTheLeadingEdge) {
  for (const NamedPulse& pulse : {pulses[0], pulses[1], pulses[3]}) {
    Scenario s = guide(200.0, pulse.settings);
    s.propagation.max_surface_bounces = s.propagation.max_bottom_bounces = 0;
    s.propagation.band = BandOfLosses::narrow;  // level of the path at the centre frequency
    const PingRecord record = PingSimulator(s).simulate(1);
    const TargetSummary& told = record.summary.at(0);
    const std::size_t samples = record.recording.samples;
    std::size_t loudest = 0;
    double peak = 0.0;
    for (std::size_t i = 0; i < samples; ++i) {
      const float* p = &record.pressure[(samples + i) * 2];
      if (const double here = std::hypot(double(p[0]), double(p[1])); here > peak)
        peak = here, loudest = i;
    }
    EXPECT_NEAR(double(loudest) / record.recording.sample_rate,
                told.echo_time + 0.5 * pulse.settings.duration, 1.5 / record.recording.sample_rate)
        << pulse.name;
    EXPECT_NEAR(told.echo_peak_db, told.echo_level_db, 0.01) << pulse.name;
  }
}

// Noise of 50 dB/Hz in the pulse's band, against the mean square of the samples scaled by the
// recorded share of the band. A record of N independent values scatters by 4.9 σ = 4.34·4.9/√N dB.
TEST(SummaryAndSamples, NoiseIsThatOfTheSamples) {
  for (const NamedPulse& pulse : pulses) {
    Scenario s = guide(200.0, pulse.settings);
    s.targets[0].strength_db = -200.0;
    s.noise.law = WhiteNoise{50.0};
    s.pings.recording_duration = 0.5;
    const PingRecord record = PingSimulator(s).simulate(1);
    double power = 0.0;
    for (const float p : record.pressure) power += 0.5 * double(p) * double(p);
    const double n = double(record.pressure.size()) / 2.0, rate = record.recording.sample_rate;
    const double band = Pulse(pulse.settings).bandwidth_40db();
    EXPECT_NEAR(record.summary.at(0).noise_db,
                db_from_power(power / n / (micropascal * micropascal) * band / rate),
                4.9 * 4.34 / std::sqrt(n))
        << pulse.name;
    double levels = 0.0;
    for (const float step : record.levels.noise) levels += double(step);
    EXPECT_NEAR(db_from_power(levels / double(record.levels.noise.size())),
                db_from_power(power / n), 4.9 * 4.34 / std::sqrt(n))
        << pulse.name;
  }
}

/// Mean square of the samples, averaged over pings, in the steps of `/levels` [Pa²].
struct MeanOfPings {
  std::vector<double> samples, levels;
  double expected_db = 0.0;  // expected level at the echo's time
  double received_db = 0.0;  // level during the echo's pulse
  double step = 0.0;
};
MeanOfPings mean_of(const Scenario& s) {
  const PingSimulator simulator(s);
  MeanOfPings mean;
  double received = 0.0;
  for (int ping = 1; ping <= simulator.pings(); ++ping) {
    const PingRecord record = simulator.simulate(ping);
    const std::size_t steps = record.levels.reverberation.size(), n = record.recording.samples;
    mean.samples.resize(steps);
    mean.levels.assign(record.levels.reverberation.begin(), record.levels.reverberation.end());
    mean.step = record.levels.time_step;
    std::vector<double> sums(steps, 0.0), counts(steps, 0.0);
    const TargetSummary& told = record.summary.at(0);
    const double duration = simulator.pulse().duration();
    double at_echo = 0.0, count = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double t = double(i) / record.recording.sample_rate;
      const auto step = std::min(steps - 1, std::size_t(t / mean.step));
      const float* p = &record.pressure[(n + i) * 2];
      const double power = 0.5 * (double(p[0]) * double(p[0]) + double(p[1]) * double(p[1]));
      sums[step] += power;
      counts[step] += 1.0;
      if (std::abs(t - told.echo_time - 0.5 * duration) < 0.5 * duration)
        at_echo += power, count += 1.0;
    }
    for (std::size_t k = 0; k < steps; ++k)
      mean.samples[k] += sums[k] / counts[k] / simulator.pings();
    received += at_echo / count / simulator.pings();
    mean.expected_db = told.reverberation_db;
  }
  mean.received_db = db_from_power(received / (micropascal * micropascal));
  return mean;
}

// Reverberation of a boundary and of a layer of the water, at the echo and in every step of the
// levels, against the mean over 100 pings. Each ping's mean over a pulse is exponential, so 4.9 σ
// over 100 pings are 4.9·4.34/√100 = 2.1 dB. Taking the middle of a cell for the cell, and sheets
// for the layer's depths, adds 0.5 dB.
TEST(SummaryAndSamples, ReverberationIsThatOfTheSamples) {
  for (const bool layer : {false, true}) {
    Scenario s = guide(200.0, pulses[1].settings);
    s.environment.bottom.material = Rigid{};
    s.propagation.max_surface_bounces = s.propagation.max_bottom_bounces = 0;
    s.targets[0].strength_db = -200.0;
    s.reverberation.enabled = true;
    s.reverberation.surface_scatters = false;
    if (layer)
      s.reverberation.volume = {{.top = 60.0, .bottom = 160.0, .strength_db = -60.0}};
    else
      s.reverberation.bottom = Lambert{};
    s.reverberation.bottom_field.statistics.coherence_time = 0.0;
    s.targets[0].track.start.position = {200.0, 80.0, 120.0};
    s.pings.count = 100;
    s.pings.recording_duration = 0.35;
    s.pings.baseband_rate.reset();
    const MeanOfPings mean = mean_of(s);
    EXPECT_NEAR(mean.expected_db, mean.received_db, 2.6) << (layer ? "layer" : "bottom");
    double worst = 0.0, sum = 0.0, count = 0.0;
    const double begins = 2.0 * (layer ? 55.0 : 195.0) / 1500.0;
    for (std::size_t k = 0; k < mean.levels.size(); ++k) {
      const double from = double(k) * mean.step;
      if (from + mean.step < begins) {
        EXPECT_LT(mean.levels[k], 1e-3 * *std::max_element(mean.levels.begin(), mean.levels.end()))
            << from;
        continue;
      }
      if (from < begins + 0.002) continue;  // a pulse's window is longer than a step
      const double off = db_from_power(mean.levels[k] / mean.samples[k]);
      worst = std::max(worst, std::abs(off));
      sum += off, count += 1.0;
    }
    EXPECT_LT(worst, 2.6) << (layer ? "layer" : "bottom");
    // Some 100 lengths of the pulse in 100 pings leave 4.9·4.34/√10000 = 0.2 dB of chance; the rest
    // is as above.
    EXPECT_NEAR(sum / count, 0.0, 0.5) << (layer ? "layer" : "bottom");
  }
}

// Warnings of an echo outside the record, of records that overlap, of a line steered to endfire,
// and of rings further apart than the pulse is long.
TEST(SummaryAndSamples, RecordsThatLackSoundAreWarnedOf) {
  Scenario s = guide(200.0, pulses[1].settings);
  EXPECT_EQ(checks::echo_beside_record(s), "");
  EXPECT_EQ(checks::overlapping_records(s), "");
  EXPECT_EQ(checks::steered_line(s), "");
  s.targets[0].track.start.position = {0.0, 400.0, 5.0};  // 0.533 s there and back
  EXPECT_NE(checks::echo_beside_record(s).find("about 0.533 s"), std::string::npos)
      << checks::echo_beside_record(s);
  s.pings.recording_duration = 0.5335;  // holds 0.9 ms of a pulse of 1 ms
  EXPECT_NE(checks::echo_beside_record(s), "");
  s.pings.recording_duration = 0.54;
  EXPECT_EQ(checks::echo_beside_record(s), "");
  s.pings.recording_start = 0.534;
  EXPECT_NE(checks::echo_beside_record(s), "");
  s.pings.recording_start = 0.0;
  s.pings.count = 2;
  s.pings.interval = 0.54;
  EXPECT_EQ(checks::overlapping_records(s), "");
  s.pings.interval = 0.5;
  EXPECT_NE(checks::overlapping_records(s), "");
  s.pings.continuous = true;
  EXPECT_EQ(checks::overlapping_records(s), "");
  s.reverberation = {.enabled = true, .ground_spacing = 0.5};  // a pulse of 1 ms is 0.75 m
  EXPECT_EQ(checks::coarse_rings(s), "");
  s.reverberation.ground_spacing = 3.0;
  EXPECT_NE(checks::coarse_rings(s).find("at most 0.75 m"), std::string::npos)
      << checks::coarse_rings(s);
  s.reverberation.ground_spacing = 0.5;
  s.platforms[0].track.start.position.z() = 0.05;
  EXPECT_NE(checks::coarse_rings(s).find("at most 0.1 m is wide enough"), std::string::npos)
      << checks::coarse_rings(s);
  s.reverberation.enabled = false;
  EXPECT_EQ(checks::coarse_rings(s), "");
}

}  // namespace
}  // namespace asdic::detail
