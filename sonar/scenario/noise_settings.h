#pragma once
#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "core/units.h"

namespace asdic {

/// Wenz's ambient noise: turbulence, distant ships, wind (JASA 34, 1936, 1962), in Coates' fit.
struct WenzNoise {
  double shipping = 0.5;     ///< 0 (none) … 1 (heavy)
  double wind_speed = 10.0;  ///< [m/s]
};

/// Knudsen, Alford & Emling's curves (J. Mar. Res. 7, 410, 1948): −17 dB a decade.
struct KnudsenNoise {
  double sea_state = 3.0;  ///< 0 … 6, between whole ones straight in dB
};

/// Measured levels: straight in dB over the logarithm of frequency, constant beyond the ends.
struct NoiseTable {
  std::vector<double> frequency;  ///< [n ≥ 1] increasing, above 0 [Hz]
  std::vector<double> level_db;   ///< [n] [dB re 1 µPa²/Hz]
};

using NoiseLaw = std::variant<WenzNoise, KnudsenNoise, NoiseTable>;

/// How the noise of one phone of an array is related to that of another.
enum class NoiseCoherence {
  independent,  ///< not at all
  isotropic,    ///< alike from all directions: sin(kd)/(kd)
  surface,      ///< from a sheet of sources under the surface
  profile       ///< a level over elevation, the same at all bearings
};
inline constexpr std::string_view noise_coherence_words[] = {"independent", "isotropic", "surface",
                                                             "profile"};
constexpr std::span<const std::string_view> words(NoiseCoherence /*any*/) {
  return noise_coherence_words;
}

/// Where noise comes from, over elevation.
struct NoiseDirections {
  double dipole_exponent = 1.0;   ///< m: a source of the sheet radiates cosᵐ of the angle from
                                  ///< the vertical in pressure; ½ … 10
  std::vector<double> elevation;  ///< [n ≥ 2] of a profile: increasing, positive where noise comes
                                  ///< from above [rad]
  std::vector<double> level_db;  ///< [n] power per solid angle, up to a constant [dB]
};

/// What the sea itself sounds like at the phones.
struct NoiseSettings {
  std::optional<double> spectral_level_db;  ///< white: NL [dB re 1 µPa²/Hz]
  std::optional<NoiseLaw> law;              ///< or one of these. Neither: no noise
  bool thermal = false;                     ///< the water's own thermal noise is added
  NoiseCoherence coherence = NoiseCoherence::independent;
  NoiseDirections directions;

  [[nodiscard]] bool any() const noexcept { return spectral_level_db || law; }
  /// White and independent from phone to phone: needs no spectra (sonar/noise/noise.h).
  [[nodiscard]] bool plain() const noexcept {
    return spectral_level_db && !thermal && coherence == NoiseCoherence::independent;
  }
};

}  // namespace asdic
