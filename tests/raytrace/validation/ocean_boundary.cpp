#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <complex>

#include "core/error.h"
#include "core/units.h"
#include "raytrace/ocean/boundary.h"
#include "support/csv.h"

namespace asdic::detail {
namespace {

FluidHalfSpace fluid_of(const support::Csv& csv, std::size_t row) {
  return {.speed = csv["c2"][row],
          .density = csv["rho2"][row],
          .attenuation_db_per_wavelength = csv["alpha_dB_lambda"][row]};
}

// The table uses e^{−iωt}: ours is its conjugate. It prints ten significant digits of R and of the
// loss, which reaches 12.5 dB.
TEST(Boundary, RayleighCoefficient) {
  const support::Csv csv("physics-reference/boundary.csv");
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const WaterAtBoundary water = {.speed = csv["c1"][row], .density = csv["rho1"][row]};
    const auto r =
        reflection_coefficient(fluid_of(csv, row), radians(csv["grazing_deg"][row]), water);
    EXPECT_NEAR(r.real(), csv["R_re"][row], 1e-9) << row;
    EXPECT_NEAR(-r.imag(), csv["R_im"][row], 1e-9) << row;
    EXPECT_NEAR(-db_from_amplitude(std::abs(r)), csv["loss_dB"][row], 1e-8) << row;
  }
}

/// The reflection coefficient by solving the boundary conditions themselves. Displacement u = ∇φ in
/// the water, (φ_x − ψ_z, φ_z + ψ_x) in the solid; all ∝ e^{i(ωt − kx)}. Unknown: R, and the
/// amplitudes of φ ∝ e^{−ik_p·z} and ψ ∝ e^{−ik_s·z} behind. ω = 1 throughout.
std::complex<double> by_boundary_conditions(const ElasticHalfSpace& solid, double grazing,
                                            const WaterAtBoundary& water) {
  using Complex = std::complex<double>;
  const Complex i(0.0, 1.0);
  const auto wavenumber = [](double speed, double db_per_wavelength) {
    return Complex(1.0, -db_per_wavelength / (40.0 * pi * std::log10(std::exp(1.0)))) / speed;
  };
  const auto downward = [](Complex square) {
    const Complex root = std::sqrt(square);
    return root.imag() > 0.0 ? -root : root;
  };
  const Complex kp = wavenumber(solid.speed, solid.attenuation_db_per_wavelength);
  const Complex ks = wavenumber(solid.shear_speed, solid.shear_attenuation_db_per_wavelength);
  const double k = std::cos(grazing) / water.speed, kz = std::sin(grazing) / water.speed;
  const Complex p = downward(kp * kp - k * k), s = downward(ks * ks - k * k);
  const Complex mu = solid.density / (ks * ks), lambda = solid.density / (kp * kp) - 2.0 * mu;

  Eigen::Matrix3cd system;
  Eigen::Vector3cd incident;
  // u_z is continuous: −ik_z(1 − R) = −ik_p·P − ik·S
  system.row(0) << i * kz, i * p, i * k;
  incident[0] = i * kz;
  // σ_zz = −p: −(λk_p² + 2μp²)P − 2μks·S = −ρ₁(1 + R)
  system.row(1) << water.density, -(lambda * kp * kp + 2.0 * mu * p * p), -2.0 * mu * k * s;
  incident[1] = -water.density;
  // σ_xz = 0: −2kp·P + (s² − k²)S = 0
  system.row(2) << 0.0, -2.0 * k * p, s * s - k * k;
  incident[2] = 0.0;
  // Rows of very different size (1/c, ρ, 1/c²): a pivoting solver is enough, to 1e-9.
  for (int row = 0; row < 3; ++row) {
    const double scale = system.row(row).cwiseAbs().maxCoeff();
    system.row(row) /= scale;
    incident[row] /= scale;
  }
  return system.fullPivLu().solve(incident)[0];
}

// Displacement and stress at the plane, solved as a system, for four solids with and without loss,
// a solid slower than the water among them.
TEST(Boundary, ElasticCoefficientFulfilsTheBoundaryConditions) {
  const WaterAtBoundary water = {.speed = 1490.0, .density = 1027.0};
  const ElasticHalfSpace solids[] = {
      {2400.0, 1000.0, 2200.0, 0.2, 0.5},  // chalk
      {5250.0, 2500.0, 2700.0, 0.1, 0.2},  // basalt
      {3300.0, 1700.0, 900.0, 0.0, 0.0},   // ice, without loss
      {1430.0, 120.0, 1350.0, 0.4, 1.0},   // mud
  };
  for (const ElasticHalfSpace& solid : solids)
    for (double degrees = 0.5; degrees < 90.0; degrees += 0.5) {
      const auto expected = by_boundary_conditions(solid, radians(degrees), water);
      const auto found = reflection_coefficient(solid, radians(degrees), water);
      EXPECT_NEAR(std::abs(found - expected), 0.0, 1e-9) << solid.speed << ' ' << degrees;
    }
}

// Sandy gravel (−1), coarse sand (0.5), medium sand (1.5), very fine sand (3.5), silt (6) and clay
// (9): the handbook's regressions, worked out by an independent program to twelve digits.
TEST(Boundary, GrainSizesOfTheHandbook) {
  struct Row {
    double size, speed_ratio, density_ratio, db_per_metre_khz;
  };
  const Row rows[] = {
      {-1.0, 1.336961, 2.492267, 0.4556},       {0.5, 1.25025125, 2.23056425, 0.46785},
      {1.5, 1.1781937875, 1.84461605, 0.49235}, {3.5, 1.0567912375, 1.26765715, 0.63355},
      {6.0, 0.9873056, 1.1487162, 0.1397},      {9.0, 0.9800084, 1.1448243, 0.0539},
  };
  for (const Row& row : rows) {
    const FluidHalfSpace sediment = sediment_of_grain_size(row.size);
    EXPECT_NEAR(sediment.speed, 1500.0 * row.speed_ratio, 1e-9 * sediment.speed) << row.size;
    EXPECT_NEAR(sediment.density, 1000.0 * row.density_ratio, 1e-9 * sediment.density) << row.size;
    // dB/(m·kHz) over one wavelength at 1 kHz, c/1000 metres
    EXPECT_NEAR(sediment.attenuation_db_per_wavelength,
                1.5 * row.speed_ratio * row.db_per_metre_khz, 1e-9)
        << row.size;
  }
  EXPECT_DOUBLE_EQ(sediment_of_grain_size(1.5, 1450.0).speed, 1.1781937875 * 1450.0);
  EXPECT_THROW(static_cast<void>(sediment_of_grain_size(9.1)), InputError);
  EXPECT_THROW(static_cast<void>(sediment_of_grain_size(std::nan(""))), InputError);
}

}  // namespace
}  // namespace asdic::detail
