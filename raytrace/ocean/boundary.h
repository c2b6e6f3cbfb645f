#pragma once
#include <complex>
#include <limits>
#include <string_view>
#include <variant>
#include <vector>

namespace asdic::detail {

/// Pressure release: R = −1. The sea surface, seen from below.
struct Vacuum {
  static constexpr std::string_view name = "vacuum";

  [[nodiscard]] bool operator==(const Vacuum&) const = default;
};

/// Nothing moves: R = +1.
struct Rigid {
  static constexpr std::string_view name = "rigid";

  [[nodiscard]] bool operator==(const Rigid&) const = default;
};

/// A homogeneous fluid below (or above) the water. Defaults: sand.
struct FluidHalfSpace {
  static constexpr std::string_view name = "fluid";
  double speed = 1650.0;                       ///< [m/s]
  double density = 1900.0;                     ///< [kg/m³]
  double attenuation_db_per_wavelength = 0.8;  ///< [dB/λ]

  [[nodiscard]] bool operator==(const FluidHalfSpace&) const = default;
};

/// An elastic solid: compressional and shear waves. Defaults: chalk.
struct ElasticHalfSpace {
  static constexpr std::string_view name = "elastic";
  double speed = 2400.0;                             ///< compressional [m/s]
  double shear_speed = 1000.0;                       ///< [m/s]
  double density = 2200.0;                           ///< [kg/m³]
  double attenuation_db_per_wavelength = 0.2;        ///< compressional [dB/λ]
  double shear_attenuation_db_per_wavelength = 0.5;  ///< [dB/λ]

  [[nodiscard]] bool operator==(const ElasticHalfSpace&) const = default;
};

/// A measured or computed reflection coefficient over grazing angle: magnitude and phase linear
/// between rows, none beyond the table.
struct ReflectionTable {
  static constexpr std::string_view name = "table";
  std::vector<double> grazing;    ///< [n] increasing, 0..π/2 [rad]
  std::vector<double> magnitude;  ///< [n] |R|
  std::vector<double> phase;      ///< [n] [rad]

  [[nodiscard]] bool operator==(const ReflectionTable&) const = default;
};

/// Reflection coefficients over grazing angle, measured at several frequencies: magnitude and phase
/// linear between rows and over the logarithm of frequency, those of the first and the last
/// frequency beyond them.
struct ReflectionCurves {
  static constexpr std::string_view name = "curves";
  std::vector<double> frequency;       ///< [n] increasing [Hz]
  std::vector<ReflectionTable> curve;  ///< [n]

  [[nodiscard]] bool operator==(const ReflectionCurves&) const = default;
};

/// One layer of a sea floor: a fluid, or with shear waves a solid.
struct FloorLayer {
  double thickness = 1.0;                            ///< [m]
  double speed = 1650.0;                             ///< compressional [m/s]
  double shear_speed = 0.0;                          ///< [m/s]; 0: a fluid
  double density = 1900.0;                           ///< [kg/m³]
  double attenuation_db_per_wavelength = 0.8;        ///< compressional [dB/λ]
  double shear_attenuation_db_per_wavelength = 0.0;  ///< [dB/λ]

  [[nodiscard]] bool operator==(const FloorLayer&) const = default;
};

/// Layers from the water down, and the half space below them, whose thickness means nothing.
struct LayeredFloor {
  static constexpr std::string_view name = "layered";
  std::vector<FloorLayer> layers;
  FloorLayer below = {};

  [[nodiscard]] bool operator==(const LayeredFloor&) const = default;
};

using BoundaryMaterial = std::variant<Vacuum, Rigid, FluidHalfSpace, ElasticHalfSpace,
                                      ReflectionTable, ReflectionCurves, LayeredFloor>;

/// Whether its reflection does: half spaces know the angle alone.
[[nodiscard]] inline bool depends_on_frequency(const BoundaryMaterial& material) noexcept {
  return std::holds_alternative<ReflectionCurves>(material) ||
         std::holds_alternative<LayeredFloor>(material);
}

/// The fluid that a sediment of mean grain size Mz (φ units, −1 coarse sand … 9 clay) is, by the
/// regressions of the APL-UW High-Frequency Ocean Environmental Acoustic Models Handbook, APL-UW TR
/// 9407 (1994), ch. IV. \param water_speed  that the sediment's speed ratio refers to [m/s]
/// \throws InputError unless −1 ≤ Mz ≤ 9
[[nodiscard]] FluidHalfSpace sediment_of_grain_size(double grain_size_phi,
                                                    double water_speed = 1500.0,
                                                    double water_density = 1000.0);

/// The water beside a boundary, and the wave in it.
struct WaterAtBoundary {
  double speed = 1500.0;    ///< [m/s]
  double density = 1000.0;  ///< [kg/m³]
  /// Of the wave [Hz]: layers and curves ask for it, half spaces do not.
  double frequency = std::numeric_limits<double>::quiet_NaN();
};

/// Plane-wave pressure reflection coefficient, time dependence e^{+iωt}.
///
///   R = (m·sin θ − s)/(m·sin θ + s),  m = ρ₂/ρ₁,  n = (c₁/c₂)(1 − iα/54.575),
///   s = √(n² − cos²θ), Im s ≤ 0 (decaying away from the boundary)
///
/// α in dB per wavelength, 54.575 = 40π·log₁₀e. Over a solid m·sin θ is multiplied by
///
///   G = (1 − 2cos²θ/n_s²)² + 4cos²θ·s·s_s/n_s⁴,
///
/// n_s and s_s those of its shear wave; over layers see raytrace/ocean/layered_floor.h. Never above
/// 1 in magnitude, provided that the solid itself gives no energy: α_p·c_p² ≥ (4/3)·α_s·c_s².
/// Jensen et al., Computational Ocean Acoustics (2011), §1.6; docs/theory/boundaries.md. \param
/// grazing  angle between ray and boundary [rad], 0..π/2
[[nodiscard]] std::complex<double> reflection_coefficient(const BoundaryMaterial& material,
                                                          double grazing,
                                                          const WaterAtBoundary& water) noexcept;

}  // namespace asdic::detail
