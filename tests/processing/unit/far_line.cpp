// A line towed far behind the point that delays refer to.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.h"
#include "processing/detector.h"
#include "processing/listening_band.h"
#include "sonar/signal/pulse.h"
#include "sonar/synthesis/direct_synthesis.h"
#include "sonar/synthesis/synthesis.h"

namespace asdic::detail {
namespace {

constexpr double rate = 2500.0, c = 1500.0, length = 6.0;  // [Hz], [m/s], [s] of the record
constexpr std::size_t phones = 16;

// 200 m behind, sound from 60° off the bow is received 0.067 s late. Beams steered about the
// platform had nothing at one end of the record, a background of silence there and infinite SNRs,
// and received the echo at other times than the beam that looks at it: eight detections. Noise
// alone makes 0.3 of them at most (10⁻⁶ a cell, some 3·10⁵ cells). The one echo is told at its time
// at the platform: what the line tells of the cosine, to a tenth of λ/L = 0.17, moves that by
// 0.13·0.017 s = 2 ms.
TEST(FarLine, TellsAnEchoOnceAtThePlatformsTime) {
  std::vector<Vec3> places;
  for (std::size_t n = 0; n < phones; ++n) places.emplace_back(0.0, -200.0 - 0.6 * double(n), 0.0);
  const Pulse pulse({.waveform = Lfm{.start_frequency = 900.0, .end_frequency = 1100.0},
                     .duration = 0.2,
                     .window = PulseWindow::hann});
  const Recording recording{.sample_rate = rate, .samples = std::size_t(length * rate)};
  const Returns echo{
      {.delay = 4.8, .amplitude = 1.0, .slowness = -Vec3(std::sqrt(0.75), 0.5, 0.0) / c}};
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
  ASSERT_EQ(result.detections.size(), 1U);
  const Detection& found = result.detections[0];
  EXPECT_TRUE(std::isfinite(found.snr_db));
  EXPECT_NEAR(found.time, 4.8, 0.003);
  EXPECT_NEAR(found.cosine, -0.5, 0.017) << "the axis goes from the first phone to the last";
}

}  // namespace
}  // namespace asdic::detail
