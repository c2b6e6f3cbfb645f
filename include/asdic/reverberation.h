#pragma once

/// \file
/// Scattering laws of surface, bottom and volume.
///
/// ```cpp
/// asdic::Scenario scenario;
/// scenario.set("reverberation.surface", asdic::ChapmanHarris{})
///     .set("reverberation.surface.motion", "bragg")
///     .set("reverberation.bottom", asdic::Lambert{.mu_db = -29.0})
///     .add("reverberation.volume",
///          asdic::VolumeLayer{.top = 300.0, .bottom = 400.0, .strength_db = -75.0});
/// std::cout << scenario.to_toml();
/// ```

#include <vector>

#include "asdic/value.h"

namespace asdic {

/// The surface as the Naval Research Laboratory has it.
struct ASDIC_API NrlSurface {
  double A_s = 5.5e-4, gamma2 = 3.9;
  double h0 = 1.0;  ///< [m]
  operator Value() const;
};

/// The surface, by wind speed and frequency.
struct ASDIC_API ChapmanHarris {
  operator Value() const;
};
struct ASDIC_API OgdenErskine {
  operator Value() const;
};

/// The bottom: 10·log₁₀(μ·sin θ_in·sin θ_out).
struct ASDIC_API Lambert {
  double mu_db = -27.0;
  operator Value() const;
};

/// The bottom: Lambert's law and a lobe about the mirrored direction.
struct ASDIC_API EllisCrowe {
  double mu_db = -27.0, nu_db = -15.0, slope_deg = 10.0;
  operator Value() const;
};

/// Measured strength over grazing angle, of either boundary.
struct ASDIC_API ScatteringTable {
  std::vector<double> grazing_deg{};  ///< [n] increasing, 0..90
  std::vector<double> strength_db{};  ///< [n] [dB re 1 m² per m²]
  operator Value() const;
};

/// A layer that scatters, one of the list "reverberation.volume".
struct ASDIC_API VolumeLayer {
  double top = 0.0, bottom = 0.0;  ///< [m]
  double strength_db = 0.0;        ///< S_v [dB re 1/m]
  operator Value() const;
};

}  // namespace asdic
