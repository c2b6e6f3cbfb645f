#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "core/units.h"
#include "sonar/synthesis.h"

namespace asdic {

/// Power of every beam over time.
struct BeamPower {
  double sample_rate = 0.0;  ///< [Hz]
  double start = 0.0;        ///< [s]
  std::size_t beams = 0, samples = 0;
  std::vector<float> power;  ///< [beams × samples] |mean over phones|²: a plane wave of peak
                             ///< envelope A looked at gives A²

  [[nodiscard]] std::span<const float> beam(std::size_t b) const {
    return {power.data() + b * samples, samples};
  }
  /// The beam with the most energy between two times [s].
  [[nodiscard]] std::size_t loudest(double from, double to) const noexcept;
};

/// Unit vector from the array towards where sound comes from (x east, y north, z down).
/// \param bearing  clockwise from north [rad]   \param elevation  positive up [rad]
[[nodiscard]] Vec3 look_direction(double bearing, double elevation) noexcept;

/// Conventional delay-and-sum beams of phones anywhere, by phase shifts in the frequency domain:
/// exact for plane waves over the whole band. b(t) = Σ_n w_n p_n(t − look·x_n/c), since a phone
/// further towards the source hears the wave earlier.
/// \param phones   [channels] relative to the reference point [m]
/// \param looks    [beams] unit vectors towards the source
/// \param weights  [channels] shading, or empty for none; normalised to a sum of 1
/// \throws InputError if phones or weights do not match the baseband's channels
[[nodiscard]] BeamPower beamform(const Baseband& baseband, std::span<const Vec3> phones,
                                 std::span<const Vec3> looks, double sound_speed,
                                 std::span<const double> weights = {});

}  // namespace asdic
