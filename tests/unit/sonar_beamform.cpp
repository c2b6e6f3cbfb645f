#include "sonar/beamform.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "sonar/array.h"

namespace asdic {
namespace {

constexpr double c = 1500.0;
const Recording two_seconds = {.sample_rate = 16000.0, .start = 0.0, .samples = 32000};

/// A plane wave from a bearing and elevation, heard by the phones.
Baseband plane_wave(const ReceiverArray& array, double bearing, double elevation,
                    double amplitude) {
  const Synthesizer synthesizer(Pulse({.duration = 0.5}), two_seconds, 0.0);
  const Returns one = {
      {.delay = 0.7, .amplitude = amplitude, .slowness = -look_direction(bearing, elevation) / c}};
  return synthesizer.baseband(one, array.phones);
}

std::vector<Vec3> circle_of_looks() {
  std::vector<Vec3> looks;
  for (int degree = 0; degree < 360; ++degree)
    looks.push_back(look_direction(radians(degree), 0.0));
  return looks;
}

// A square of nine phones half a wavelength apart has no ambiguity: the loudest of 360 beams is the
// bearing of the wave, and at its peak (mid-pulse) it reads the wave's own power.
TEST(Beamform, LoudestBeamLooksAtThePlaneWave) {
  ReceiverArray square;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j) square.phones.push_back(Vec3(0.1875 * i, 0.1875 * j, 0.0));
  for (int bearing : {0, 37, 90, 181, 300}) {
    const Baseband b = plane_wave(square, radians(bearing), 0.0, 3.0);
    const BeamPower beams = beamform(b, square.phones, circle_of_looks(), c);
    EXPECT_EQ(beams.loudest(0.7, 1.2), static_cast<std::size_t>(bearing));
    const auto middle = static_cast<std::size_t>(0.95 * beams.sample_rate);
    EXPECT_NEAR(beams.beam(static_cast<std::size_t>(bearing))[middle], 9.0, 0.02);
  }
}

// A horizontal line measures one angle: sin(apparent) = sin(azimuth from broadside)·cos(elevation).
TEST(Beamform, LineSeesTheConeAngle) {
  const ReceiverArray line = line_array(16, 0.1875, radians(90.0), 0.0);  // broadside is north
  std::vector<Vec3> looks;
  for (int tenth = -900; tenth <= 900; ++tenth)
    looks.push_back(look_direction(radians(0.1 * tenth), 0.0));
  const double azimuth = radians(40.0), elevation = radians(-32.0);
  const BeamPower beams =
      beamform(plane_wave(line, azimuth, elevation, 1.0), line.phones, looks, c);
  const double apparent = -90.0 + 0.1 * double(beams.loudest(0.7, 1.2));
  EXPECT_NEAR(apparent, degrees(std::asin(std::sin(azimuth) * std::cos(elevation))), 0.06);
}

// 16 phones without shading, off the axis: |sin(16ψ/2)/(16 sin(ψ/2))|², ψ = 2π d sin θ/λ.
TEST(Beamform, PatternIsThatOfADiscreteLine) {
  const ReceiverArray line = line_array(16, 0.1875, radians(90.0), 0.0);
  const Baseband b = plane_wave(line, 0.0, 0.0, 1.0);
  const std::vector<Vec3> looks = {look_direction(radians(5.0), 0.0),
                                   look_direction(radians(11.0), 0.0)};
  const BeamPower beams = beamform(b, line.phones, looks, c);
  const auto middle = static_cast<std::size_t>(0.95 * beams.sample_rate);
  for (std::size_t i = 0; i < 2; ++i) {
    const double half = pi * 0.1875 * 4000.0 / c * std::sin(radians(i == 0 ? 5.0 : 11.0));
    EXPECT_NEAR(beams.beam(i)[middle], std::pow(std::sin(16 * half) / (16 * std::sin(half)), 2),
                2e-3);
  }
}

TEST(Beamform, WantsOnePhonePerChannel) {
  const ReceiverArray line = line_array(4, 0.2, 0.0, 0.0);
  const Baseband b = plane_wave(line, 0.0, 0.0, 1.0);
  EXPECT_THROW((void)beamform(b, std::span(line.phones).first(3), circle_of_looks(), c),
               InputError);
}

}  // namespace
}  // namespace asdic
