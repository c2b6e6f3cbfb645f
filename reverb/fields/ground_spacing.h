#pragma once
#include "raytrace/ocean/environment.h"
#include "reverb/fields/reverberation_settings.h"

namespace asdic::detail {

/// Spacing of the rings of a grid of scatterers [m]: as the settings say, else by the bandwidth of
/// what is sent; a surface with a shape is sampled facet by facet.
///
/// The two-way delay from ring to ring is 1/(2B), B the full bandwidth that holds 99 % of the
/// pulse's energy, so that two rings fall into what a matched filter resolves. Scatterers lie
/// anywhere in their rings, so the mean intensity has no ripple whatever the spacing, and slow side
/// lobes, which hold a hundredth of the sound, ask for no more (the −40 dB width of an unwindowed
/// sweep of 200 Hz and 1 s is 790 Hz).
/// \param bandwidth  B [Hz]   \param sound_speed  at the surface [m/s]
[[nodiscard]] double ground_spacing(const ReverberationSettings& settings, const Environment& ocean,
                                    double bandwidth, double sound_speed);

}  // namespace asdic::detail
