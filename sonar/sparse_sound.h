#pragma once
#include <span>

#include "sonar/echo.h"
#include "sonar/synthesis.h"

namespace asdic {

/// Echoes and direct blasts at the phones of an array, amplitudes as at the pulse's centre
/// frequency. \param phones  [n] from the array's reference point [m]
[[nodiscard]] Baseband narrow_band_sound(const Synthesizer& synthesizer,
                                         std::span<const EchoPath> paths,
                                         std::span<const Vec3> phones);

/// The same with the water's absorption and the transmitter's pattern at every frequency of the
/// pulse: K pulses, each passed through one of Lagrange's polynomials over the band, each with the
/// amplitudes of its own frequency. K times the cost. Source: docs/theory/synthesis.md, "Across the
/// band". Legs that are no rays have the amplitude of waves at up to `most_wave_frequencies`.
/// \param projector  as it pings   \param legs  that the paths belong to
[[nodiscard]] Baseband wide_band_sound(const EchoContext& context, const Transmitter& projector,
                                       std::span<const EchoPath> paths, std::span<const Leg> legs,
                                       std::span<const Vec3> phones, const Recording& recording,
                                       double max_doppler);

}  // namespace asdic
