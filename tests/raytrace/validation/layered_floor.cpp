// Layered sea floors against closed forms, and against the boundary conditions of all interfaces
// solved at once.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <vector>

#include "core/units.h"
#include "raytrace/ocean/boundary.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;

constexpr WaterAtBoundary water_at(double frequency) {
  return {.speed = 1490.0, .density = 1027.0, .frequency = frequency};
}

const FloorLayer silt{
    .thickness = 4.0, .speed = 1470.0, .density = 1400.0, .attenuation_db_per_wavelength = 0.15};
const FloorLayer sand{
    .thickness = 7.0, .speed = 1650.0, .density = 1900.0, .attenuation_db_per_wavelength = 0.8};
const FloorLayer till{.thickness = 12.0,
                      .speed = 1900.0,
                      .shear_speed = 500.0,
                      .density = 2100.0,
                      .attenuation_db_per_wavelength = 0.5,
                      .shear_attenuation_db_per_wavelength = 1.0};
const FloorLayer chalk{.thickness = 20.0,
                       .speed = 2400.0,
                       .shear_speed = 1000.0,
                       .density = 2200.0,
                       .attenuation_db_per_wavelength = 0.2,
                       .shear_attenuation_db_per_wavelength = 0.5};
const FloorLayer basalt{.thickness = 0.0,
                        .speed = 5250.0,
                        .shear_speed = 2500.0,
                        .density = 2700.0,
                        .attenuation_db_per_wavelength = 0.1,
                        .shear_attenuation_db_per_wavelength = 0.2};

/// Stacks of every order of fluid and solid.
std::vector<LayeredFloor> stacks() {
  return {{{silt}, sand},         {{sand}, basalt},
          {{till}, chalk},        {{chalk}, sand},
          {{silt, sand}, basalt}, {{silt, till, chalk}, basalt},
          {{chalk, silt}, till},  {{till, silt, sand, chalk}, silt}};
}

Complex index(double speed, double loss) { return Complex(1.0, -loss / 54.575054) / speed; }

/// R by one system of all potentials: φ = (D e^{−iωqz} + U e^{iωq(z − h)})e^{iω(t − px)} and ψ
/// alike in every layer, z from its top; u = ∇φ + (−ψ_z, ψ_x), displacements and stresses by
/// derivatives.
Complex by_all_interfaces(const LayeredFloor& floor, double grazing, const WaterAtBoundary& water) {
  const Complex i(0.0, 1.0);
  const double p = std::cos(grazing) / water.speed, omega = 2.0 * pi * water.frequency;
  struct Medium {
    FloorLayer layer;
    bool solid, last;
    Complex qp, qs, mu, lambda;
    Eigen::Index first;  // of its unknowns: D, U of φ, then of ψ (the half space has D alone)
  };
  std::vector<FloorLayer> all = floor.layers;
  all.push_back(floor.below);
  std::vector<Medium> media;
  Eigen::Index unknowns = 1;  // R
  for (std::size_t k = 0; k < all.size(); ++k) {
    const FloorLayer& m = all[k];
    const auto root = [](Complex square) {
      const Complex r = std::sqrt(square);
      return r.imag() > 0.0 ? -r : r;
    };
    Medium medium{.layer = m, .solid = m.shear_speed > 0.0, .last = k + 1 == all.size()};
    const Complex sp = index(m.speed, m.attenuation_db_per_wavelength);
    medium.qp = root(sp * sp - p * p);
    medium.mu = 0.0;
    if (medium.solid) {
      const Complex ss = index(m.shear_speed, m.shear_attenuation_db_per_wavelength);
      medium.qs = root(ss * ss - p * p);
      medium.mu = m.density / (ss * ss);
    }
    medium.lambda = m.density / (sp * sp) - 2.0 * medium.mu;
    medium.first = unknowns;
    unknowns += (medium.solid ? 2 : 1) * (medium.last ? 1 : 2);
    media.push_back(medium);
  }
  // Of each unknown at a depth z of its medium: u_x, u_z, σ_xz, σ_zz, over powers of iω
  struct Made {
    Eigen::Index column;
    Complex ux, uz, xz, zz;
  };
  const auto made = [&](const Medium& m, double z) {
    std::vector<Made> list;
    Eigen::Index column = m.first;
    for (const bool shear : {false, true}) {
      if (shear && !m.solid) break;
      const Complex q = shear ? m.qs : m.qp;
      for (const double way : {1.0, -1.0}) {  // down, up
        if (way < 0.0 && m.last) break;
        const Complex e = way > 0.0 ? std::exp(-i * omega * q * z)
                                    : std::exp(i * omega * q * (z - m.layer.thickness));
        const Complex dx = -p, dz = -way * q;  // ∂/∂x, ∂/∂z over iω
        const Complex ux = shear ? -dz : dx, uz = shear ? dx : dz;
        list.push_back({column++, e * ux, e * uz, e * m.mu * (dz * ux + dx * uz),
                        e * (m.lambda * (dx * ux + dz * uz) + 2.0 * m.mu * dz * uz)});
      }
    }
    return list;
  };
  Eigen::MatrixXcd system = Eigen::MatrixXcd::Zero(unknowns, unknowns);
  Eigen::VectorXcd given = Eigen::VectorXcd::Zero(unknowns);
  Eigen::Index row = 0;
  const auto put = [&](const std::vector<Made>& list, Complex Made::*what, double sign) {
    for (const Made& one : list) system(row, one.column) += sign * (one.*what);
  };
  for (std::size_t k = 0; k < media.size(); ++k) {
    const auto below = made(media[k], 0.0);
    std::vector<Made> above;
    bool solid_above = false;
    if (k == 0) {  // the water: incident 1, reflected R
      const double q = std::sin(grazing) / water.speed;
      system(row, 0) = q;
      given[row] = q;  // u_z: −q + R·q
      put(below, &Made::uz, -1.0);
      ++row;
      system(row, 0) = water.density;  // σ_zz = λ∇²φ = ρ over (iω)²
      given[row] = -water.density;
      put(below, &Made::zz, -1.0);
      ++row;
    } else {
      above = made(media[k - 1], media[k - 1].layer.thickness);
      solid_above = media[k - 1].solid;
      put(above, &Made::uz, 1.0), put(below, &Made::uz, -1.0), ++row;
      put(above, &Made::zz, 1.0), put(below, &Made::zz, -1.0), ++row;
    }
    if (solid_above && media[k].solid)
      put(above, &Made::ux, 1.0), put(below, &Made::ux, -1.0), ++row;
    if (solid_above || media[k].solid)
      put(above, &Made::xz, 1.0), put(below, &Made::xz, -1.0), ++row;
  }
  EXPECT_EQ(row, unknowns);
  for (Eigen::Index r = 0; r < unknowns; ++r) {
    const double size = system.row(r).cwiseAbs().maxCoeff();
    system.row(r) /= size;
    given[r] /= size;
  }
  return system.fullPivLu().solve(given)[0];
}

// Without thickness a layer is not there, and with next to none next to not.
TEST(LayeredFloor, WithoutThicknessIsItsHalfSpace) {
  for (const double thickness : {0.0, 1e-9})
    for (LayeredFloor floor : stacks()) {
      for (FloorLayer& layer : floor.layers) layer.thickness = thickness;
      const FloorLayer& b = floor.below;
      const BoundaryMaterial alone =
          b.shear_speed > 0.0
              ? BoundaryMaterial(ElasticHalfSpace{b.speed, b.shear_speed, b.density,
                                                  b.attenuation_db_per_wavelength,
                                                  b.shear_attenuation_db_per_wavelength})
              : BoundaryMaterial(
                    FluidHalfSpace{b.speed, b.density, b.attenuation_db_per_wavelength});
      for (double degrees = 0.5; degrees <= 90.0; degrees += 0.5) {
        const WaterAtBoundary water = water_at(800.0);
        EXPECT_NEAR(std::abs(reflection_coefficient(floor, radians(degrees), water) -
                             reflection_coefficient(alone, radians(degrees), water)),
                    0.0, thickness == 0.0 ? 1e-9 : 1e-6)  // k·10⁻⁹ m and its like
            << degrees << ' ' << floor.layers.size();
      }
    }
}

TEST(LayeredFloor, FulfilsTheConditionsOfAllInterfaces) {
  for (const LayeredFloor& floor : stacks())
    for (const double frequency : {30.0, 250.0, 1000.0})
      for (double degrees = 1.0; degrees < 90.0; degrees += 1.0) {
        const WaterAtBoundary water = water_at(frequency);
        EXPECT_NEAR(std::abs(reflection_coefficient(floor, radians(degrees), water) -
                             by_all_interfaces(floor, radians(degrees), water)),
                    0.0, 1e-9)
            << floor.layers.size() << ' ' << frequency << " Hz " << degrees;
      }
}

// A quarter of a wavelength of √(Z₁Z₃), lossless, lets all through at the vertical.
TEST(LayeredFloor, AQuarterWaveOfTheMeanImpedanceReflectsNothing) {
  const WaterAtBoundary water = water_at(500.0);
  const FloorLayer rock{.speed = 2000.0, .density = 2000.0, .attenuation_db_per_wavelength = 0.0};
  const double z = std::sqrt(water.speed * water.density * rock.speed * rock.density);
  FloorLayer match{.speed = 1700.0, .density = z / 1700.0, .attenuation_db_per_wavelength = 0.0};
  match.thickness = 0.25 * match.speed / water.frequency;
  const LayeredFloor floor{{match}, rock};
  EXPECT_LT(std::abs(reflection_coefficient(floor, pi / 2, water)), 1e-12);
  WaterAtBoundary octave = water;
  octave.frequency *= 2.0;  // half a wave: as if it were not there
  const double z1 = water.speed * water.density, z3 = rock.speed * rock.density;
  EXPECT_NEAR(std::abs(reflection_coefficient(floor, pi / 2, octave)), (z3 - z1) / (z3 + z1), 1e-9);
}

// No energy is made, and a layer of many wavelengths overflows nothing.
TEST(LayeredFloor, GivesNoEnergy) {
  for (LayeredFloor floor : stacks())
    for (const double piece : {1.0, 1000.0}) {
      for (FloorLayer& layer : floor.layers) layer.thickness *= piece;
      for (double frequency = 10.0; frequency < 2e4; frequency *= 1.7)
        for (double degrees = 0.0; degrees <= 90.0; degrees += 0.9) {
          const double r =
              std::abs(reflection_coefficient(floor, radians(degrees), water_at(frequency)));
          ASSERT_LE(r, 1.0 + 1e-9) << frequency << " Hz " << degrees;
          ASSERT_GE(r, 0.0);
        }
    }
  EXPECT_NEAR(std::abs(reflection_coefficient(stacks()[3], 0.0, water_at(100.0)) + 1.0), 0.0, 1e-6);
}

// Between measured frequencies magnitude and phase are linear in ln f; beyond them level.
TEST(ReflectionCurves, BetweenAndBeyondTheirFrequencies) {
  const ReflectionTable low{.grazing = {0.0, 1.5}, .magnitude = {1.0, 0.4}, .phase = {3.0, 3.0}};
  const ReflectionTable high{.grazing = {0.0, 1.5}, .magnitude = {0.8, 0.2}, .phase = {-3.0, -3.0}};
  const ReflectionCurves curves{.frequency = {100.0, 400.0}, .curve = {low, high}};
  const auto at = [&](double f) { return reflection_coefficient(curves, 0.75, water_at(f)); };
  EXPECT_NEAR(std::abs(at(100.0)), 0.7, 1e-12);
  EXPECT_NEAR(std::abs(at(200.0)), 0.6, 1e-12);
  EXPECT_NEAR(std::abs(std::arg(at(200.0))), pi, 1e-12);  // the short way round, by π
  EXPECT_NEAR(std::abs(at(50.0)), 0.7, 1e-12);
  EXPECT_NEAR(std::abs(at(5000.0)), 0.5, 1e-12);
}

}  // namespace
}  // namespace asdic::detail
