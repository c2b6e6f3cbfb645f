#pragma once
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/units.h"
#include "sonar/noise_spectra/any_noise.h"

namespace asdic::detail {

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

/// How noise is related from phone to phone, and where it comes from.
struct NoiseField {
  NoiseCoherence coherence = NoiseCoherence::independent;
  NoiseDirections directions;

  void describe(Fields& field);
};

/// What the sea itself sounds like at the phones.
struct NoiseSettings {
  std::optional<AnyNoise> law;  ///< none: no noise
  bool thermal = false;         ///< the water's own thermal noise is added
  NoiseCoherence coherence = NoiseCoherence::independent;
  NoiseDirections directions;

  void describe(Fields& field);

  [[nodiscard]] bool any() const noexcept { return law.has_value(); }
  /// Of white noise without thermal noise, which has it at all frequencies [dB re 1 µPa²/Hz].
  [[nodiscard]] std::optional<double> flat_level_db() const noexcept;
  /// Flat and independent from phone to phone: needs no spectra (sonar/noise/noise.h).
  [[nodiscard]] bool plain() const noexcept {
    return flat_level_db() && coherence == NoiseCoherence::independent;
  }
};

}  // namespace asdic::detail
