#pragma once

/// \file
/// The ocean: sound speed, bottom, bathymetry, absorption.
///
/// ```cpp
/// asdic::Scenario scenario;
/// scenario.set("environment.sound_speed", asdic::Munk{.axis_depth = 1200.0})
///     .set("environment.bottom",
///          asdic::Bottom{.bathymetry = asdic::Bathymetry{.range = {0.0, 20e3, 60e3},
///                                                        .depth = {4800.0, 4500.0, 4900.0}},
///                        .kind = "grain-size",
///                        .grain_size = 5.0})
///     .set("environment.absorption.kind", "francois-garrison")
///     .set("environment.wind_speed", 8.0);
/// std::cout << scenario.to_toml();
/// ```

#include <optional>
#include <string>
#include <vector>

#include "asdic/value.h"

namespace asdic {

/// Measured sound speed over depth: "environment.sound_speed".
struct ASDIC_API SoundSpeed {
  std::vector<double> depth{};             ///< [n ≥ 1] increasing [m]
  std::vector<double> speed{};             ///< [n] [m/s]
  std::string interpolation = "c-linear";  ///< n2-linear, spline, pchip, pchip-spline-slopes
  operator Value() const;
};

/// Munk's profile.
struct ASDIC_API Munk {
  double axis_speed = 1500.0;   ///< [m/s]
  double axis_depth = 1300.0;   ///< [m]
  double scale_depth = 1300.0;  ///< [m]
  double perturbation = 0.00737;
  operator Value() const;
};

/// Temperature and salinity over depth.
struct ASDIC_API TemperatureSalinity {
  std::vector<double> depth{};            ///< [n] [m]
  std::vector<double> temperature{};      ///< [n] in situ [°C]
  std::vector<double> salinity{};         ///< [n] [psu]
  std::string equation = "chen-millero";  ///< mackenzie, del-grosso
  double latitude_deg = 45.0;
  std::string interpolation = "c-linear";  ///< of the speed; those of SoundSpeed
  operator Value() const;
};

/// Sound speed over range and depth.
struct ASDIC_API SoundSpeedSection {
  std::vector<double> range{};               ///< [n] increasing [m]
  std::vector<double> depth{};               ///< [m ≥ 2] increasing [m]
  std::vector<std::vector<double>> speed{};  ///< [n][m] [m/s]
  operator Value() const;
};

/// Depth over range: "environment.bottom.shape", or a part of Bottom.
struct ASDIC_API Bathymetry {
  std::vector<double> range{};                     ///< [n] increasing [m]
  std::vector<double> depth{};                     ///< [n] [m]
  std::string interpolation = "piecewise-linear";  ///< smooth, curvilinear
  operator Value() const;
};

/// "environment.bottom". What is not given is the library's default of that kind.
struct ASDIC_API Bottom {
  std::optional<double> depth = {};  ///< of the water [m]; or
  std::optional<Bathymetry> bathymetry = {};
  std::string kind = "fluid";          ///< vacuum, rigid, fluid, elastic, grain-size
  std::optional<double> speed = {};    ///< [m/s]
  std::optional<double> density = {};  ///< [kg/m³]
  std::optional<double> attenuation_db_per_wavelength = {};
  std::optional<double> shear_speed = {};  ///< elastic [m/s]
  std::optional<double> shear_attenuation_db_per_wavelength = {};
  std::optional<double> grain_size = {};  ///< grain-size [φ]
  operator Value() const;
};

}  // namespace asdic
