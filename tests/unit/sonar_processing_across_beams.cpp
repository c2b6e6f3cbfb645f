// Peaks compared with what the beams around hear at the same time.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.h"
#include "sonar/processing/beam_surroundings.h"
#include "sonar/processing/detector.h"
#include "sonar/processing/listening_band.h"
#include "sonar/pulse.h"
#include "sonar/synthesis.h"

namespace asdic {
namespace {

constexpr double rate = 2500.0, c = 1500.0, length = 4.0;  // [Hz], [m/s], [s] of the record
constexpr std::size_t phones = 24;

/// Half a wavelength of 1000 Hz apart, south to north: 48 beams.
std::vector<Vec3> line() {
  std::vector<Vec3> places;
  for (std::size_t n = 0; n < phones; ++n) places.emplace_back(0.0, 0.75 * double(n) - 8.6, 0.0);
  return places;
}
Pulse sweep() {
  return Pulse({.kind = PulseKind::lfm,
                .start_frequency = 900.0,
                .end_frequency = 1100.0,
                .duration = 0.2,
                .window = PulseWindow::hann});
}
/// A plane wave out of the horizontal, `cosine` to the line.
Return from(double cosine, double delay, std::complex<double> amplitude) {
  const Vec3 look(std::sqrt(1.0 - cosine * cosine), cosine, 0.0);
  return {.delay = delay, .amplitude = amplitude, .slowness = -look / c};
}

DetectorResult heard(const Returns& returns, double noise, bool across, double probability,
                     std::uint32_t seed = 1) {
  const Recording recording{.sample_rate = rate, .samples = std::size_t(length * rate)};
  const std::vector<Vec3> places = line();
  const Pulse pulse = sweep();
  const std::vector<double> p = direct_synthesis(pulse, recording, returns, places);
  std::vector<float> pressure(p.begin(), p.end());
  RandomStream draw(seed, Draw::ambient_noise, 0, 0);
  for (float& x : pressure) x += float(noise * draw.normal());
  const Replica known(std::span<const float>(replica(pulse, rate)), rate);
  const Baseband baseband =
      to_baseband(pressure, phones, rate, 0.0, {.centre = 1000.0, .width = 400.0}, 0.2);
  DetectorSettings settings;
  settings.normaliser.false_alarm_probability = probability;
  settings.normaliser.across_beams = across;
  return detect(baseband, places, c, known, std::vector<double>{1.0}, settings);
}

// False alarms of even noise are those of the beam's own surroundings in time: some hundredths of
// them have beams around that happen to be three times as loud as these. Of about 60 peaks a run,
// 4 runs.
TEST(AcrossBeams, EvenNoiseHasTheSameFalseAlarms) {
  std::size_t alone = 0, across = 0;
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    alone += heard({}, 1.0, false, 3e-3, seed).peaks;
    across += heard({}, 1.0, true, 3e-3, seed).peaks;
  }
  EXPECT_GT(alone, 80U);
  EXPECT_LE(across, alone);
  EXPECT_GE(double(across), 0.9 * double(alone));
}

// 300 scatterers at all bearings answer within 20 ms, two cells, 30 dB over the noise behind the
// filter: the sea right above. Compared in time alone that is a detection in beam after beam.
TEST(AcrossBeams, ASeaThatAnswersFromEverywhereIsNoBeamful) {
  RandomStream draw(3, Draw::scatterer_place, 0, 0);
  Returns burst;
  for (int i = 0; i < 300; ++i) {
    const double cosine = std::cos(pi * draw.uniform()), delay = 2.0 + 0.02 * draw.uniform();
    burst.push_back(from(cosine, delay, draw.complex_normal()));
  }
  const auto alone = heard(burst, 1.0, false, 1e-6), across = heard(burst, 1.0, true, 1e-6);
  EXPECT_GT(alone.detections.size(), 15U);
  EXPECT_LT(5 * across.detections.size(), alone.detections.size());
}

// Two echoes at one time, five cells apart (λ/extent is 0.087 of the cosine): each lies among the
// other's surroundings, whose median it leaves alone.
TEST(AcrossBeams, AnotherEchoHidesNone) {
  const Returns two{from(0.0, 2.0, 3.0), from(0.435, 2.0, 3.0)};
  for (const bool across : {false, true}) {
    const auto found = heard(two, 1.0, across, 1e-6).detections;
    for (const double cosine : {0.0, 0.435}) {
      bool there = false;
      for (const Detection& d : found)
        there = there || (std::abs(d.cosine - cosine) < 0.03 && std::abs(d.time - 2.0) < 0.005);
      EXPECT_TRUE(there) << cosine << ' ' << across;
    }
  }
}

// The beams meant: 2 to 6 cells to both sides, at the ends of a line to one; none of a short line.
TEST(AcrossBeams, TheBeamsMeantLieBesideTheMainLobe) {
  const ArrayShape shape = shape_of(line(), 1.5);
  const BeamGrid grid = beam_grid(shape, 1.5);
  const BeamSurroundings around(shape, grid.looks, 1.5);
  const double cell = 1.5 / shape.length;
  for (std::size_t b = 0; b < grid.looks.size(); ++b) {
    EXPECT_GE(around.of(b).size(), 8U);
    EXPECT_LE(around.of(b).size(), 18U);
    for (const std::uint32_t other : around.of(b)) {
      const double apart = std::abs(grid.cosine[b] - grid.cosine[other]) / cell;
      EXPECT_GE(apart, 2.0 - 1e-9);
      EXPECT_LE(apart, 6.0 + 1e-9);
    }
  }
  const std::vector<Vec3> few{Vec3(0, 0, 0), Vec3(0, 0.75, 0), Vec3(0, 1.5, 0)};
  const ArrayShape little = shape_of(few, 1.5);
  const BeamGrid wide = beam_grid(little, 1.5);
  const BeamSurroundings none(little, wide.looks, 1.5);
  for (std::size_t b = 0; b < wide.looks.size(); ++b) EXPECT_TRUE(none.of(b).empty());
}

}  // namespace
}  // namespace asdic
