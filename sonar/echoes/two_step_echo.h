#pragma once
#include <span>

#include "reverb/scattering/sea_draws.h"
#include "sonar/echoes/echo.h"
#include "sonar/echoes/sparse_sound.h"
#include "sonar/synthesis/synthesis.h"

namespace asdic::detail {

/// Which of an array's phones receive echoes in two steps.
struct TwoStepReceivers {
  std::span<const Vec3> phones;  ///< [n] from the array's reference point [m]
  /// Whether they have paths of their own, or of a phone beside them that receives alike. They are
  /// then the first phones of the array and, if there are more, the reference point.
  bool by_themselves = false;
};

/// The echoes of a target whose pairs of paths are too many: first the sound at each of its
/// highlights, by all paths to it, then what the phones receive of that sound, by all paths from
/// it. Cost and memory grow with the sum of the paths there and back, not with their product.
///
/// Where ranges change at changing rates (or something turns), a leg is straight in time for a
/// while only: its sound is cut into segments that fade into one another, each with delays,
/// Doppler factors and directions of its own; phases are off by 0.02 rad at most (−34 dB of the
/// path). What rough boundaries scatter is drawn for each leg by itself.
/// Source: docs/theory/echoes.md, "Many paths"
/// \param many  as target_echoes() found them   \param followed  bounces off either boundary
/// \param draws  of the scenario's seed
/// \param band  two_step_band(); empty: amplitudes at the centre serve the whole band
/// \return [phones] over the pulse's peak at 1 m
[[nodiscard]] Baseband two_step_echo(const EchoContext& context, const ManyEchoes& many,
                                     const TwoStepReceivers& receivers, const Recording& recording,
                                     double max_doppler, SeaDraws& draws,
                                     const TwoStepBand& band = {});

/// The same at the phones that the context asks for, with its peak.
struct TwoStepSound {
  Baseband received;  ///< without channels if no phones are asked for
  /// Largest envelope at the array's reference point (at its first phone, where every phone has
  /// paths of its own by the scenario's wish), over the pulse's peak at 1 m.
  double peak = 0.0;
};
[[nodiscard]] TwoStepSound two_step_sound(const EchoContext& context, const ManyEchoes& many,
                                          const Recording& recording, double max_doppler,
                                          const TwoStepBand& band = {});

}  // namespace asdic::detail
