#include "raytrace/beams/beam.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "raytrace/beams/fan.h"

// Kernels alone, on rays that need no tracer: straight lines through water of one speed.
namespace asdic::detail {
namespace {

constexpr double c = 1500.0;

/// A ray from (0, depth) in free space, one segment of a length.
RayTrajectory straight_ray(double depth, double elevation, double length) {
  RayTrajectory ray{.launch_elevation = elevation, .source_speed = c};
  const double cosine = std::cos(elevation), sine = -std::sin(elevation);
  RaySegment s;
  s.begin = {.depth = depth, .xi = cosine / c, .zeta = sine / c, .p = 1.0 / c};
  s.end = s.begin;
  s.end.range = length * cosine;
  s.end.depth = depth + length * sine;
  s.end.time = length / c;
  s.end.q = length;  // dq/ds = c·p = 1
  s.end.length = length;
  s.c_begin = s.c_end = c;
  ray.segments.push_back(s);
  return ray;
}

struct FreeSpace {
  std::vector<double> ranges = {200.0, 500.0, 1000.0, 2000.0};
  std::vector<double> depths = {-150.0, 0.0, 40.0, 100.0};
  double frequency = 1000.0;
  int beams = 4001;

  std::vector<std::complex<double>> sum(BeamSetting setting) const {
    setting.frequency = frequency;
    const BeamFan fan = even_fan(-radians(60.0), radians(60.0), beams);
    setting.spacing = fan.spacing;
    FieldSum field{.ranges = ranges,
                   .depths = depths,
                   .irregular = false,
                   .sum = std::vector<std::complex<double>>(ranges.size() * depths.size())};
    for (const double elevation : fan.elevation)
      add_beam(setting, {.elevation = elevation}, straight_ray(0.0, elevation, 9000.0), field);
    for (std::size_t j = 0; j < ranges.size(); ++j)
      for (std::size_t k = 0; k < depths.size(); ++k)
        field.column(j)[k] *= field_scale(setting, ranges[j]);
    return field.sum;
  }
};

double worst_level(const std::vector<std::complex<double>>& p, const FreeSpace& space) {
  double worst = 0.0;
  for (std::size_t j = 0; j < space.ranges.size(); ++j)
    for (std::size_t k = 0; k < space.depths.size(); ++k) {
      const double r = std::hypot(space.ranges[j], space.depths[k]);
      worst = std::max(worst, std::abs(std::abs(p[j * space.depths.size() + k]) * r - 1.0));
    }
  return worst;
}

double worst_complex(const std::vector<std::complex<double>>& p, const FreeSpace& space) {
  double worst = 0.0;
  for (std::size_t j = 0; j < space.ranges.size(); ++j)
    for (std::size_t k = 0; k < space.depths.size(); ++k) {
      const double r = std::hypot(space.ranges[j], space.depths[k]);
      const auto truth = std::polar(1.0 / r, -2.0 * pi * space.frequency * r / c);
      worst = std::max(worst, std::abs(p[j * space.depths.size() + k] - truth) * r);
    }
  return worst;
}

// A point source in free space is e^(−ikr)/r. A hat is off by the bend of the wavefront between two
// rays, k·(rΔα)²/(8r) at most: 2.9e-4 rad at 2 km for Δα = 2π/3/4000, of which weighting leaves ¾.
TEST(HatBeams, AddUpToASphericalWave) {
  const FreeSpace space;
  EXPECT_LT(worst_complex(space.sum({.kind = BeamKind::hat}), space), 3e-4);
  EXPECT_LT(worst_level(space.sum({.kind = BeamKind::hat}), space), 1e-6);
  EXPECT_LT(worst_complex(space.sum({.kind = BeamKind::ray_centred_hat}), space), 3e-4);
}

// Twice the beams, a quarter of that error.
TEST(HatBeams, AreOfSecondOrderInTheirSpacing) {
  FreeSpace coarse, fine;
  coarse.beams = 1001;
  fine.beams = 2001;
  const BeamSetting hat{.kind = BeamKind::hat};
  // the receivers' places between their rays differ from fan to fan: a quarter only roughly
  EXPECT_LT(worst_complex(fine.sum(hat), fine), 0.4 * worst_complex(coarse.sum(hat), coarse));
}

// Without a wavefront curvature a beam of width σ is late by kσ²/2R on the average of its weight:
// the sum is (1 + ikσ²/R)^(−½) of a spherical wave, σ = min(0.2·f·τ, πλ). Along the horizontal; at
// an angle the receivers of a column see the same.
TEST(GaussianBeams, AddUpToASphericalWaveButForTheirWidth) {
  const FreeSpace space;
  const auto p = space.sum({.kind = BeamKind::gaussian});
  const double k = 2.0 * pi * space.frequency / c;
  for (std::size_t j = 0; j < space.ranges.size(); ++j) {
    const double r = space.ranges[j], sigma = std::min(0.2 * 1000.0 * r / c, pi * c / 1000.0);
    const std::complex<double> loss =
        1.0 / std::sqrt(std::complex<double>(1.0, -k * sigma * sigma / r));
    const auto truth = std::polar(1.0 / r, -k * r) * loss;
    // cut at 4σ: 3e-4 of the weight's edge; σ itself changes by 1e-3 across the beam
    EXPECT_LT(std::abs(p[j * space.depths.size() + 1] - truth) * r, 3e-3) << r;
  }
}

TEST(Intensities, AddUpToSphericalSpreading) {
  const FreeSpace space;
  for (const BeamKind kind : {BeamKind::hat, BeamKind::ray_centred_hat}) {
    const auto p = space.sum({.kind = kind, .coherent = false});
    for (std::size_t j = 0; j < space.ranges.size(); ++j)
      for (std::size_t k = 0; k < space.depths.size(); ++k) {
        const double r2 = space.ranges[j] * space.ranges[j] + space.depths[k] * space.depths[k];
        // Σ A²·W with weights that add to 1 is 1/R²; field_scale was meant for a pressure
        EXPECT_NEAR(p[j * space.depths.size() + k].real() * r2 / std::sqrt(space.ranges[j]), 1.0,
                    1e-5);
      }
  }
  for (const BeamKind kind : {BeamKind::gaussian, BeamKind::ray_centred_gaussian}) {
    const auto p = space.sum({.kind = kind, .coherent = false});
    // 1/R varies across a beam of σ = πλ = 4.7 m and 4σ leave out 6e-5
    EXPECT_NEAR(p[3 * space.depths.size() + 1].real() * 4e6 / std::sqrt(2000.0), 1.0, 3e-4);
  }
}

// Each kind: exp(−Aθ²) sums to √(π/A)/Δα; Cerveny's constant makes the integral over α, by
// stationary phase, the ray's pressure. The bounds are the next terms: wide beams feel the end of
// the fan and the cut at 100 wavelengths.
TEST(OtherBeams, AddUpToASphericalWave) {
  FreeSpace space;
  EXPECT_LT(worst_level(space.sum({.kind = BeamKind::simple_gaussian}), space), 1e-4);
  EXPECT_LT(worst_complex(space.sum({.kind = BeamKind::simple_gaussian}), space), 1e-2);
  space.beams = 2001;
  space.depths = {-10.0, 0.0, 10.0};
  const CervenyBeams narrow{.width = CervenyBeams::Width::minimum, .loop_range = 2000.0};
  for (const BeamKind kind : {BeamKind::cerveny_cartesian, BeamKind::cerveny_ray_centred})
    EXPECT_LT(worst_complex(space.sum({.kind = kind, .cerveny = narrow}), space), 1e-2)
        << int(kind);
}

// A line source spreads as 1/√R, times BELLHOP's 4√π.
TEST(LineSource, SpreadsCylindrically) {
  const FreeSpace space;
  const auto p = space.sum({.kind = BeamKind::hat, .point_source = false});
  for (std::size_t j = 0; j < space.ranges.size(); ++j)
    EXPECT_NEAR(std::abs(p[j * space.depths.size() + 1]) * std::sqrt(space.ranges[j]),
                4.0 * std::sqrt(pi), 1e-5);
}

// Behind a caustic that lies between the ray and the receiver's foot the phase is the ray's plus
// π/2, with the reflections that the ray has had; before one, minus.
TEST(GaussianBeams, KeepReflectionsAcrossACaustic) {
  RayTrajectory ray = straight_ray(0.0, -radians(30.0), 4000.0);
  RaySegment& s = ray.segments[0];
  s.history.reflection = -1.0;
  s.begin.q = 1000.0 * std::cos(radians(30.0)) + 1.0;  // shrinks to 1 m where r = 1000 cos² …
  s.begin.p = -std::cos(radians(30.0)) / c;
  s.end.p = s.begin.p;
  s.end.q = s.begin.q + s.begin.p * c * 4000.0;
  const std::vector<double> ranges = {1000.0 * std::cos(radians(30.0))};
  const double z = 1000.0 * std::sin(radians(30.0));  // of the ray
  const std::vector<double> depths = {z + 20.0};      // s = 10 m: q = 1 − 10·cos 30°, past it
  FieldSum field{.ranges = ranges, .depths = depths, .irregular = false, .sum = {0.0}};
  add_beam({.kind = BeamKind::gaussian, .frequency = 100.0, .spacing = 1e-3},
           {.elevation = ray.launch_elevation}, ray, field);
  const double time = 1010.0 / c;
  const double expected = pi - 2.0 * pi * 100.0 * time + 0.5 * pi;
  EXPECT_NEAR(std::abs(std::arg(field.sum[0] * std::polar(1.0, -expected))), 0.0, 1e-9);
}

TEST(Fan, HasBothEndsAndNoDoubleBeam) {
  const BeamFan half = even_fan(-1.0, 1.0, 5);
  EXPECT_EQ(half.elevation.size(), 5U);
  EXPECT_DOUBLE_EQ(half.spacing, 0.5);
  EXPECT_DOUBLE_EQ(half.elevation.back(), 1.0);
  const BeamFan circle = even_fan(-pi, pi, 8);
  EXPECT_EQ(circle.elevation.size(), 8U);
  EXPECT_NEAR(circle.elevation.back(), 0.75 * pi, 1e-12);
}

// The velocity of a spherical wave, times ρc, is along the line to the receiver: p·dz/R and p·r/R,
// but for the near field, 1/kR = 1.2e-3 at the nearest, and what wide beams are off at 200 m
// (2e-3). Červený's additional component, c·n·P/Q along the beam's normal, would change 5e-8.
TEST(CervenyBeams, ComponentsAreTheVelocity) {
  FreeSpace space;
  space.depths = {-40.0, 0.0, 40.0, 100.0};
  for (const BeamKind kind : {BeamKind::cerveny_cartesian, BeamKind::cerveny_ray_centred})
    for (const auto component :
         {CervenyBeams::Component::vertical, CervenyBeams::Component::horizontal}) {
      CervenyBeams beam;
      const auto pressure = space.sum({.kind = kind, .cerveny = beam});
      beam.component = component;
      const auto velocity = space.sum({.kind = kind, .cerveny = beam});
      for (std::size_t j = 0; j < space.ranges.size(); ++j)
        for (std::size_t k = 0; k < space.depths.size(); ++k) {
          const double r = space.ranges[j], z = space.depths[k], distance = std::hypot(r, z);
          const double share = (component == CervenyBeams::Component::vertical ? z : r) / distance;
          const auto ratio =
              velocity[j * space.depths.size() + k] / pressure[j * space.depths.size() + k];
          EXPECT_NEAR(std::abs(ratio - share), 0.0, 3e-3) << r << ' ' << z;
        }
    }
}

}  // namespace
}  // namespace asdic::detail
