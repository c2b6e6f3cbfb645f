#pragma once

namespace asdic::detail {

/// Spacing of the rings of a grid of scatterers [m]: the two-way delay from ring to ring is 1/(2B),
/// B the full bandwidth that holds 99 % of the pulse's energy, so that two rings fall into what a
/// matched filter resolves. Scatterers lie anywhere in their rings, so the mean intensity has no
/// ripple whatever the spacing, and slow side lobes, which hold a hundredth of the sound, ask for
/// no more (the −40 dB width of an unwindowed sweep of 200 Hz and 1 s is 790 Hz).
[[nodiscard]] constexpr double ground_spacing(double bandwidth,
                                              double surface_sound_speed) noexcept {
  return surface_sound_speed / (4.0 * bandwidth);  // delay 2Δr/c = 1/(2B)
}

}  // namespace asdic::detail
