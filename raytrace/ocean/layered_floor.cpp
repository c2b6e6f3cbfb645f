#include "raytrace/ocean/layered_floor.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "raytrace/ocean/reflection_formulas.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;
using Small = Eigen::Matrix<Complex, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 4>;

/// What waves make: rows of the matrices below. Stresses are over −iω.
enum Row : Eigen::Index { along, across, shear, normal };  // displacements, stresses

constexpr double least_slowness = 1e-9;  // of q, over that of the water: up and down would be one

/// In wavelengths. What is thinner is not there: a solid without inertia between fluids would slide
/// as it likes, and the system have no one solution.
constexpr double thinnest = 1e-12;

/// The waves of one medium at one horizontal slowness p.
struct Waves {
  Eigen::Index count = 1;  ///< 1 in a fluid, 2 in a solid: compressional, shear
  Small down, up;          ///< [4 × count] what a unit of each makes
  Complex q[2];            ///< vertical slownesses [s/m]
};

/// 1/c of a wave that decays as it goes, in s/m.
Complex slowness(double speed, double loss, const WaterAtBoundary& water) {
  return reflection::refraction_index(speed, loss, water) / water.speed;
}

/// √(1/c² − p²), Im ≤ 0.
template <class Slowness>
Complex vertical(const Complex& slowness, const Slowness& p, double water_slowness) {
  const Complex q = reflection::vertical_index(slowness, p);
  return std::abs(q) < least_slowness * water_slowness ? Complex(least_slowness * water_slowness)
                                                       : q;
}

/// Compressional: displacement (p, ±q)/s_p, stresses ±2μpq and ρ(1 − 2β²p²) over s_p, with μ = ρβ²;
/// shear: (±q_s, −p)/s_s, ρ(1 − 2β²p²) and ∓2μpq_s over s_s. Signs: down, up.
/// \param p  horizontal slowness, double or complex [s/m]
template <class Slowness>
Waves waves_of(const FloorLayer& layer, const Slowness& p, const WaterAtBoundary& water) {
  const double c1 = 1.0 / water.speed;
  const Complex s_p = slowness(layer.speed, layer.attenuation_db_per_wavelength, water);
  Waves w;
  w.count = layer.shear_speed > 0.0 ? 2 : 1;
  w.down = Small::Zero(4, w.count);
  w.q[0] = vertical(s_p, p, c1);
  const double rho = layer.density;
  Complex beta2 = 0.0;
  if (w.count == 2) {
    const Complex s_s =
        slowness(layer.shear_speed, layer.shear_attenuation_db_per_wavelength, water);
    beta2 = 1.0 / (s_s * s_s);
    w.q[1] = vertical(s_s, p, c1);
    w.down(along, 1) = w.q[1] / s_s;
    w.down(across, 1) = -p / s_s;
    w.down(shear, 1) = rho * (1.0 - 2.0 * beta2 * p * p) / s_s;
    w.down(normal, 1) = -2.0 * rho * beta2 * p * w.q[1] / s_s;
  }
  w.down(along, 0) = p / s_p;
  w.down(across, 0) = w.q[0] / s_p;
  w.down(shear, 0) = 2.0 * rho * beta2 * p * w.q[0] / s_p;
  w.down(normal, 0) = rho * (1.0 - 2.0 * beta2 * p * p) / s_p;
  w.up = w.down;  // q → −q
  w.up(across, 0) = -w.up(across, 0);
  w.up(shear, 0) = -w.up(shear, 0);
  if (w.count == 2) {
    w.up(along, 1) = -w.up(along, 1);
    w.up(normal, 1) = -w.up(normal, 1);
  }
  return w;
}

/// ℛ just above an interface. \param below  [4 × m] what each wave that comes down makes there,
/// with all that it brings up again
Small above_interface(const Waves& above, const Small& below) {
  const Eigen::Index n = above.count, m = below.cols();
  Eigen::Index rows[4] = {across, normal, shear, along};  // n + m of them count
  const Eigen::Index equations = n + m;
  Small left(equations, equations), right(equations, n);
  for (Eigen::Index i = 0; i < equations; ++i) {
    // Stresses over ρ of the water and slownesses: rows are of one size to a few powers of ten.
    left.block(i, 0, 1, n) = above.up.row(rows[i]);
    left.block(i, n, 1, m) = -below.row(rows[i]);
    right.row(i) = -above.down.row(rows[i]);
    const double size = left.row(i).cwiseAbs().maxCoeff();
    if (size > 0.0) {
      left.row(i) /= size;
      right.row(i) /= size;
    }
  }
  const Small solved = left.partialPivLu().solve(right);
  return solved.topRows(n);
}

/// ℛ of all layers, seen from the water.
template <class Slowness>
Complex reflection_of(const LayeredFloor& floor, const Slowness& p, const WaterAtBoundary& water) {
  const double omega = 2.0 * pi * water.frequency;
  const Waves deepest = waves_of(floor.below, p, water);
  Small below = deepest.down;  // nothing comes back
  for (std::size_t i = floor.layers.size(); i-- > 0;) {
    const FloorLayer& layer = floor.layers[i];
    if (layer.thickness * water.frequency < thinnest * layer.speed) continue;
    const Waves waves = waves_of(layer, p, water);
    Small r = above_interface(waves, below);
    Complex passed[2];
    for (Eigen::Index k = 0; k < waves.count; ++k)
      passed[k] = std::exp(Complex(0.0, -omega * layer.thickness) * waves.q[k]);
    for (Eigen::Index k = 0; k < waves.count; ++k)
      for (Eigen::Index j = 0; j < waves.count; ++j) r(k, j) *= passed[k] * passed[j];
    below = waves.down + waves.up * r;
  }
  // Pressure is minus the normal stress: the same ratio.
  const FloorLayer sea{
      .speed = water.speed, .density = water.density, .attenuation_db_per_wavelength = 0.0};
  return above_interface(waves_of(sea, p, water), below)(0, 0);
}

}  // namespace

std::complex<double> layered_reflection(const LayeredFloor& floor, double grazing,
                                        const WaterAtBoundary& water) noexcept {
  return reflection_of(floor, std::cos(grazing) / water.speed, water);
}

std::complex<double> layered_reflection(const LayeredFloor& floor,
                                        const std::complex<double>& cosine,
                                        const WaterAtBoundary& water) noexcept {
  return reflection_of(floor, cosine / water.speed, water);
}

}  // namespace asdic::detail
