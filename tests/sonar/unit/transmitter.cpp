#include "sonar/scenario/transmitter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry.h"

namespace asdic::detail {
namespace {

constexpr double wavelength = 0.5, c = 1500.0;

/// A square of n × n projectors half a wavelength apart, its plane east and down.
ProjectorBeam square(int n) {
  ProjectorBeam beam;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      beam.projectors.push_back({.offset = Vec3(i - 0.5 * (n - 1), 0.0, j - 0.5 * (n - 1)) * 0.25});
  return beam;
}

// sin(nψ)/(n·sin ψ) in each of its two directions, ψ = ½k·spacing·(difference of the direction
// cosines): exact for a lattice, 1e-12.
TEST(Projectors, OfASquareMakeTheProductOfTwoLines) {
  ProjectorBeam beam = square(8);
  beam.turned.bearing = radians(10.0);
  const Transmitter t{.elevation = radians(-5.0), .beam = beam};
  const BeamPattern pattern(t, wavelength, c);
  const Vec3 axis = direction(radians(10.0), t.elevation);
  EXPECT_NEAR(std::abs(pattern.towards(radians(10.0), t.elevation) - 1.0), 0.0, 1e-12);
  EXPECT_FALSE(pattern.azimuthally_symmetric());
  const auto line = [](double psi) {
    return std::abs(psi) < 1e-9 ? 1.0 : std::sin(8.0 * psi) / (8.0 * std::sin(psi));
  };
  for (double bearing = -80.0; bearing < 80.0; bearing += 7.3)
    for (double elevation = -60.0; elevation < 60.0; elevation += 6.1) {
      const Vec3 d = direction(radians(bearing), radians(elevation)) - axis;
      const double expected = line(0.5 * pi * d.x()) * line(0.5 * pi * d.z());
      EXPECT_NEAR(std::abs(pattern.towards(radians(bearing), radians(elevation)) - expected), 0.0,
                  1e-12);
    }
}

// Two projectors half a wavelength apart along the bearing, in antiphase: nothing abeam, and the
// sum of both along the line. With a quarter of a wavelength and a quarter period: a cardioid.
TEST(Projectors, HavePhasesAndDelays) {
  // Steered to the north, abeam of the line, where phases cancel.
  const BeamPattern dipole(
      {.beam = ProjectorBeam{.projectors = {{.offset = {0.25, 0, 0}, .phase = pi}, {}}}},
      wavelength, c);
  EXPECT_NEAR(std::abs(dipole.towards(0.0, 0.0)), 0.0, 1e-12);
  EXPECT_NEAR(std::abs(dipole.towards(radians(90.0), 0.0)), 1.0, 1e-12);
  // The eastern one, λ/8·2 = a quarter of a wavelength on, sends a quarter period late: in phase to
  // the east, against the other to the west.
  const BeamPattern cardioid(
      {.beam = ProjectorBeam{.projectors = {{.offset = {0.125, 0, 0}, .delay = 0.125 / c}, {}}}},
      wavelength, c);
  EXPECT_NEAR(std::abs(cardioid.towards(radians(90.0), 0.0)), 1.0, 1e-12);
  EXPECT_NEAR(std::abs(cardioid.towards(radians(-90.0), 0.0)), 0.0, 1e-12);
}

TEST(Projectors, TurnWithTheHeadingWhereTheyAreAskedTo) {
  ProjectorBeam beam = square(4);
  beam.turned.bearing = radians(20.0);
  const BeamPattern north({.beam = beam}, wavelength, c, radians(70.0));
  beam.turned.frame = BearingFrame::heading;
  const BeamPattern turned({.beam = beam}, wavelength, c, radians(70.0));
  EXPECT_NEAR(std::abs(north.towards(radians(20.0), 0.0)), 1.0, 1e-12);
  EXPECT_NEAR(std::abs(turned.towards(radians(90.0), 0.0)), 1.0, 1e-12);
  for (const double b : {-50.0, 5.0, 60.0})
    EXPECT_NEAR(std::abs(north.towards(radians(b), 0.1) - turned.towards(radians(b + 70.0), 0.1)),
                0.0, 1e-12);
}

TEST(BeamTable, IsStraightInDecibelsRoundTheCircle) {
  const TableBeam beam{.table = {.bearings = {0.0, radians(90.0), radians(270.0)},
                                 .elevations = {radians(-10.0), radians(10.0)},
                                 .level_db = {0.0, -2.0, -10.0, -12.0, -20.0, -22.0}},
                       .turned = {.bearing = radians(30.0)}};
  const BeamPattern pattern({.beam = beam}, wavelength, c);
  const auto level = [&](double bearing, double elevation) {
    return db_from_amplitude(std::abs(pattern.towards(radians(bearing), radians(elevation))));
  };
  EXPECT_NEAR(level(30.0, 0.0), -1.0, 1e-9);
  EXPECT_NEAR(level(75.0, -10.0), -5.0, 1e-9);
  EXPECT_NEAR(level(345.0, -10.0), -10.0, 1e-9) << "half way from 270° to 360°";
  EXPECT_NEAR(level(30.0, 80.0), -2.0, 1e-9) << "beyond its elevations";
  EXPECT_NEAR(level(30.0 + 720.0, 0.0), -1.0, 1e-9);
}

// A line's length is metal: at another frequency its beam is narrower in proportion.
TEST(Line, KeepsItsLengthAtOtherFrequencies) {
  const Transmitter t{.beam = LineBeam{.taper = Taper::rectangular, .beamwidth = radians(10.0)}};
  const BeamPattern at_centre(t, wavelength, c), higher(t, 0.8 * wavelength, c, 0.0, wavelength);
  EXPECT_NEAR(higher.line_length(), at_centre.line_length(), 1e-12);
  EXPECT_TRUE(higher.azimuthally_symmetric());
  const double sine = std::sin(radians(4.0));
  EXPECT_NEAR(higher(std::asin(0.8 * sine)), at_centre(std::asin(sine)), 1e-12);
}

// The reported width of a steered line is that of its pattern, searched from the axis to −3 dB on
// either side in steps of 1e-4 degrees. Beyond the vertical the pattern is that of the opposite
// bearing, sin(π − θ) = sin θ. The constants u₃ have ten digits. A width of 7 degrees becomes 40 at
// the vertical.
TEST(Line, IsAsWideAsItsPatternWhenItIsSteered) {
  for (const Taper taper : {Taper::hann, Taper::rectangular})
    for (const double elevation : {0.0, 30.0, -50.0, 80.0, 88.0, 90.0, -90.0}) {
      const LineBeam line{.taper = taper, .beamwidth = radians(7.0)};
      const BeamPattern pattern({.elevation = radians(elevation), .beam = line}, wavelength, c);
      const auto edge = [&](double step) {
        double at = elevation;
        while (pattern(std::asin(std::sin(radians(at)))) > std::sqrt(0.5)) at += step;
        return at;
      };
      EXPECT_NEAR(degrees(line.steered_width(radians(elevation))), edge(1e-4) - edge(-1e-4), 3e-4)
          << elevation;
    }
  EXPECT_NEAR(degrees(LineBeam{.beamwidth = radians(7.0)}.steered_width(0.5 * pi)), 40.2, 0.1);
}

}  // namespace
}  // namespace asdic::detail
