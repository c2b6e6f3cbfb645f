// A line towed far behind the point that delays refer to.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.h"
#include "sonar/processing/detector.h"
#include "sonar/processing/listening_band.h"
#include "sonar/pulse.h"
#include "sonar/synthesis.h"

namespace asdic {
namespace {

constexpr double rate = 2500.0, c = 1500.0, length = 6.0;  // [Hz], [m/s], [s] of the record
constexpr std::size_t phones = 16;

// 200 m behind sound from ahead is heard 0.13 s late: the beams that look there have nothing at the
// record's end, those that look astern nothing at its beginning. Silence there is no background.
// Noise alone, at 10⁻⁶ a cell and some 5·10⁵ cells: 0.3 false alarms a run are expected after
// clustering at most, 6 of them allowed; with silence as background there were hundreds, of
// infinite SNR. The echo from ahead, heard 1 s before the end, is found.
TEST(FarLine, HasNoDetectionsInTheSilenceAroundItsRecord) {
  std::vector<Vec3> places;
  for (std::size_t n = 0; n < phones; ++n) places.emplace_back(0.0, -200.0 - 0.75 * double(n), 0.0);
  const Pulse pulse({.kind = PulseKind::lfm,
                     .start_frequency = 900.0,
                     .end_frequency = 1100.0,
                     .duration = 0.2,
                     .window = PulseWindow::hann});
  const Recording recording{.sample_rate = rate, .samples = std::size_t(length * rate)};
  const Returns echo{{.delay = 4.8, .amplitude = 1.0, .slowness = Vec3(0.0, -1.0, 0.0) / c}};
  const std::vector<double> p = direct_synthesis(pulse, recording, echo, places);
  std::vector<float> pressure(p.begin(), p.end());
  RandomStream draw(7, Draw::ambient_noise, 0, 0);
  for (float& x : pressure) x += float(0.5 * draw.normal());
  const Replica known(std::span<const float>(replica(pulse, rate)), rate);
  const Baseband baseband =
      to_baseband(pressure, phones, rate, 0.0, {.centre = 1000.0, .width = 400.0}, 0.2);
  DetectorSettings settings;
  settings.normaliser.false_alarm_probability = 1e-6;
  const DetectorResult result =
      detect(baseband, places, c, known, std::vector<double>{1.0}, settings);
  int echoes = 0;
  for (const Detection& d : result.detections) {
    EXPECT_TRUE(std::isfinite(d.snr_db)) << d.time;
    echoes += std::abs(d.time - 4.8) < 0.01 && std::abs(d.cosine) > 0.95;
  }
  EXPECT_EQ(echoes, 1);
  EXPECT_LE(result.detections.size(), 7U);
}

}  // namespace
}  // namespace asdic
