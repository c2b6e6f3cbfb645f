#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core/doppler.h"
#include "core/error.h"
#include "sonar/scenario/array.h"
#include "sonar/scenario/track.h"
#include "sonar/scenario/transmitter.h"

namespace asdic::detail {
namespace {

std::vector<std::vector<double>> reference_rows(const std::string& name) {
  std::ifstream file(std::string(ASDIC_TEST_DATA) + "/../sonar/data/signal/" + name);
  EXPECT_TRUE(file) << name;
  std::vector<std::vector<double>> rows;
  std::string line, cell;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::vector<double> row;
    for (std::istringstream cells(line); std::getline(cells, cell, ',');)
      row.push_back(std::strtod(cell.c_str(), nullptr));
    rows.push_back(row);
  }
  return rows;
}

constexpr double wavelength = 0.375;
const double width = radians(6.0);

/// Elevation at which a line steered to the horizontal has this u = (L/λ) sin θ.
double elevation_of(double u, const BeamPattern& pattern) {
  return std::asin(u * wavelength / pattern.line_length());
}

TEST(BeamPattern, HannMatchesTheReference) {  // 10 digits in the file
  const BeamPattern pattern({.elevation = 0.0, .beam = LineBeam{.beamwidth = width}}, wavelength);
  for (const auto& row : reference_rows("hann_pattern.csv"))
    EXPECT_NEAR(pattern(elevation_of(row[0], pattern)), row[1], 1e-10) << "u = " << row[0];
}

TEST(BeamPattern, LineLengthAndWidths) {
  const BeamPattern hann({.elevation = 0.0, .beam = LineBeam{.beamwidth = width}}, wavelength);
  EXPECT_NEAR(hann.line_length(), 5.161064269, 1e-8);  // hann_line.csv: 6° at 4 kHz, 1500 m/s
  const BeamPattern flat(
      {.elevation = 0.0, .beam = LineBeam{.taper = Taper::rectangular, .beamwidth = width}},
      wavelength);
  for (const BeamPattern* p : {&hann, &flat})
    for (double side : {-0.5, 0.5}) EXPECT_NEAR((*p)(side * width), std::sqrt(0.5), 1e-9);
  EXPECT_EQ(BeamPattern({.beam = LineBeam{.taper = Taper::omnidirectional}}, wavelength)(1.1), 1.0);
}

// Across u = 0 and u = ±1 the pattern is smooth: neighbours 1e-9 apart differ by slope × 1e-9.
TEST(BeamPattern, IsStableWhereNumeratorAndDenominatorVanish) {
  const BeamPattern pattern({.elevation = 0.0, .beam = LineBeam{.beamwidth = width}}, wavelength);
  for (double u : {-1.0, 0.0, 1.0})
    for (double du : {0.0, 1e-15, -1e-12, 1e-9, -1e-8})
      EXPECT_NEAR(pattern(elevation_of(u + du, pattern)), u == 0.0 ? 1.0 : 0.5, 2e-8);
}

TEST(BeamPattern, SideLobesAndSteering) {
  const BeamPattern hann({.elevation = radians(8.0), .beam = LineBeam{.beamwidth = width}},
                         wavelength);
  EXPECT_DOUBLE_EQ(hann(radians(8.0)), 1.0);
  double highest = 0.0;
  for (double u = 2.0; u < 3.0; u += 1e-4)
    highest = std::max(
        highest,
        std::abs(hann(std::asin(std::sin(radians(8.0)) + u * wavelength / hann.line_length()))));
  EXPECT_NEAR(db_from_amplitude(highest), -31.46730784, 1e-4);
}

TEST(BeamPattern, RefusesNonsense) {
  EXPECT_THROW(BeamPattern({.beam = LineBeam{.beamwidth = 0.0}}, wavelength), InputError);
  EXPECT_THROW(BeamPattern({}, 0.0), InputError);
}

// Ratios are given to 13 digits; the file's z points up, ours down: dot products do not care as
// long as both vectors are turned.
TEST(Doppler, MatchesTheExactReference) {
  for (const auto& r : reference_rows("doppler.csv")) {
    const auto vector = [&](std::size_t i) { return Vec3(r[i], r[i + 1], -r[i + 2]); };
    const double c_source = r[21], c_target = r[22], c_receiver = r[23];
    const MovingEnd source = {.velocity = vector(0), .slowness = vector(9) / c_source};
    const MovingEnd in = {.velocity = vector(3), .slowness = vector(12) / c_target};
    const MovingEnd out = {.velocity = vector(3), .slowness = vector(15) / c_target};
    const MovingEnd receiver = {.velocity = vector(6), .slowness = vector(18) / c_receiver};
    EXPECT_NEAR(echo_doppler(source, in, out, receiver), r[24], 1e-12);
  }
}

// A target that comes at v towards a sonar at rest: (1 + v/c)/(1 − v/c), Rayleigh.
TEST(Doppler, ClosingTarget) {
  const MovingEnd rest_out = {.slowness = Vec3(1, 0, 0) / 1500.0},
                  rest_back = {.slowness = Vec3(-1, 0, 0) / 1500.0};
  const MovingEnd in = {.velocity = Vec3(-7, 0, 0), .slowness = rest_out.slowness};
  const MovingEnd out = {.velocity = Vec3(-7, 0, 0), .slowness = rest_back.slowness};
  const double b = 7.0 / 1500.0;
  EXPECT_NEAR(echo_doppler(rest_out, in, out, rest_back), (1 + b) / (1 - b), 1e-15);
}

TEST(LineArray, HeadingPitchAndCentre) {
  const ReceiverArray north = line_array(16, 0.1875, 0.0, 0.0);
  ASSERT_EQ(north.phones.size(), 16U);
  EXPECT_NEAR((north.phones[15] - Vec3(0, 7.5 * 0.1875, 0)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((north.phones[0] + north.phones[15]).norm(), 0.0, 1e-14);
  const ReceiverArray east = line_array(3, 2.0, radians(90.0), 0.0);
  EXPECT_NEAR((east.phones[2] - Vec3(2, 0, 0)).norm(), 0.0, 1e-14);
  const ReceiverArray vertical = line_array(3, 2.0, 0.3, radians(90.0));
  EXPECT_NEAR((vertical.phones[0] - Vec3(0, 0, 2)).norm(), 0.0, 1e-14);  // the deepest first
  EXPECT_THROW((void)line_array(0, 1.0, 0.0, 0.0), InputError);
  EXPECT_THROW((void)line_array(4, 0.0, 0.0, 0.0), InputError);
}

TEST(Track, StraightAndByWaypoints) {
  const Track straight = {.start = {.position = Vec3(1, 2, 3), .velocity = Vec3(1, 0, -1)},
                          .waypoints = {}};
  EXPECT_EQ(straight.at(4.0).position, Vec3(5, 2, -1));
  EXPECT_EQ(straight.at(-1.0).velocity, Vec3(1, 0, -1));
  Track route;
  route.waypoints = {{.time = 10.0, .position = Vec3(0, 0, 100)},
                     {.time = 20.0, .position = Vec3(50, 0, 100)},
                     {.time = 30.0, .position = Vec3(50, 20, 0)}};
  EXPECT_EQ(route.at(0.0).position, Vec3(0, 0, 100));
  EXPECT_EQ(route.at(0.0).velocity, Vec3(0, 0, 0));
  EXPECT_EQ(route.at(12.0).position, Vec3(10, 0, 100));
  EXPECT_EQ(route.at(12.0).velocity, Vec3(5, 0, 0));
  EXPECT_EQ(route.at(20.0).velocity, Vec3(0, 2, -10));  // a waypoint belongs to what follows
  EXPECT_EQ(route.at(30.0).position, Vec3(50, 20, 0));
  EXPECT_EQ(route.at(99.0).velocity, Vec3(0, 0, 0));
}

}  // namespace
}  // namespace asdic::detail
