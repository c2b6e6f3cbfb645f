#pragma once

namespace asdic {

/// Spacing of the rings of a grid of scatterers [m]: the two-way delay from ring to ring is 1/(2B),
/// B the full −40 dB bandwidth of the pulse. The mean intensity is the pulse's |s|² sampled at the
/// rings' delays; its spectrum ends at B (−40 dB), so that at twice that rate the sum has no ripple
/// (a 1 s CW would get 187 m by c·τ/4, and a staircase).
[[nodiscard]] constexpr double ground_spacing(double bandwidth_40db,
                                              double surface_sound_speed) noexcept {
  return surface_sound_speed / (4.0 * bandwidth_40db);  // delay 2Δr/c = 1/(2B)
}

}  // namespace asdic
