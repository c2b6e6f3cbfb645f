// The scenarios that show reverberation in two dimensions, run.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "io/scenario/scenario_reader.h"
#include "sonar/ping/ping.h"

namespace asdic::detail {
namespace {

PingRecord run(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return PingSimulator(
             read_scenario(std::string(ASDIC_SCENARIOS) + "/" + name + ".toml", overrides))
      .simulate(1);
}

double mean_db(const PingRecord& record, double from, double to) {
  const auto& power = record.levels.reverberation;
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < power.size(); ++i) {
    const double t = (double(i) + 0.5) * record.levels.time_step;
    if (t >= from && t < to) sum += double(power[i]), count += 1.0;
  }
  return db_from_power(sum / count);
}

// Nothing is received of the layer before sound has been at its top and back, 0.32 s; then it is
// loud. Fish that swim widen the synthesis' band, and a mean over other samples of the same sound
// differs by less than 0.1 dB.
TEST(ReverberationScenarios, TheLayerIsReceivedWhenSoundHasBeenThere) {
  const PingRecord layer = run("deep_scattering_layer");
  const PingRecord without = run("deep_scattering_layer", {"reverberation.volume=[]"});
  EXPECT_NEAR(mean_db(layer, 0.0, 0.3), mean_db(without, 0.0, 0.3), 0.1);
  EXPECT_GT(mean_db(layer, 0.7, 2.0), mean_db(without, 0.7, 2.0) + 10.0);
}

/// Power of the beam towards the target at a Doppler shift, in the half second of its echo: the
/// pulse's own Hann window picks the time. Phases at 1500 Hz are right over 20 Hz to a hundredth.
double beam_power(const PingRecord& record, double time, double shift) {
  const double rate = record.recording.sample_rate, received = 1500.0 + shift;
  const Vec3 look = Vec3(3000.0, 2000.0, 70.0).normalized();
  std::complex<double> sum = 0.0;
  for (std::size_t n = 0; n < record.phones.size(); ++n) {
    const double ahead = look.dot(record.phones[n] - record.phones[0]) / 1500.0;  // [s]
    for (int i = 0; i < int(0.5 * rate); ++i) {
      const double t = double(i) / rate, window = std::pow(std::sin(pi * t / 0.5), 2);
      const auto sample = std::size_t(std::llround((time + t - record.recording.start) * rate));
      sum += window * double(record.pressure[n * record.recording.samples + sample]) *
             std::polar(1.0, -2.0 * pi * (received * t + 1500.0 * ahead));
    }
  }
  return std::norm(sum);
}

/// The loudest shift between two [Hz].
double loudest_shift(const PingRecord& record, double time, double low, double high) {
  double best = low, most = 0.0;
  for (double shift = low; shift <= high; shift += 0.1)
    if (const double power = beam_power(record, time, shift); power > most)
      best = shift, most = power;
  return best;
}

// Received in the beam towards the target, from the pressure: without it the sound of the sea lies
// on the ridge of that bearing, 2·v·cos(angle)/λ = 10 Hz at 1500 Hz and 1500 m/s (the Bragg lines
// at ±1.8 Hz and a beam 0.75 Hz wide: 3 Hz). With it a line stands off the ridge by its closing
// speed of 5 m/s, another 10 Hz. The pairs of paths that go by the bottom, 15 degrees steep and
// within the same half second, shift by cos(15 degrees), 0.7 Hz, less: 1 Hz, half of the pulse's
// resolution. A target taken to rest would be on the ridge.
TEST(ReverberationScenarios, TheTargetLeavesTheRidge) {
  const PingRecord record = run("moving_platform_reverb"),
                   sea = run("moving_platform_reverb", {"target=[]"});
  const double range = std::hypot(3000.0, 2000.0), cosine = 3000.0 / range,
               ridge = 2.0 * 6.0 * cosine, closing = (4.0 * 3000.0 + 3.0 * 2000.0) / range;
  const double shift = ridge + 2.0 * closing;
  const double time = 2.0 * (range - 0.5 * (closing + 6.0 * cosine) * 4.8) / 1500.0;
  EXPECT_NEAR(loudest_shift(sea, time, -30.0, 30.0), ridge, 3.0);
  EXPECT_NEAR(loudest_shift(record, time, ridge + 5.0, 30.0), shift, 1.0);
  EXPECT_GT(beam_power(record, time, shift), 10.0 * beam_power(sea, time, shift));
  EXPECT_GT(record.summary[0].reverberation_db, record.summary[0].noise_db + 20.0);
}

}  // namespace
}  // namespace asdic::detail
