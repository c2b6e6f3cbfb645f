#pragma once
#include <array>
#include <span>
#include <vector>

#include "processing/coverage/beam_bank.h"
#include "reverb/pairs/scattering_sheet.h"
#include "reverb/power/pulse_coherence.h"

namespace asdic::detail {

/// Even bins of delay, from 0 on.
struct DelayAxis {
  double step = 0.05;  ///< [s]
  std::size_t bins = 0;
};

/// Ground around an array, or a level of the water, that one sheet of the sea is.
struct ScatteringGround {
  Vec2 middle = Vec2::Zero();  ///< of the rings: the array [m]
  std::vector<double> edges;   ///< of the rings [m], increasing
  double depth = 0.0;          ///< near the middle [m]
  double thickness = 0.0;      ///< of a sheet of the volume [m]
};

/// Edges of rings that are wide enough for a mean and narrow enough for its change with delay: an
/// eighth of the height above the ground at first, a 256th of their range at last.
[[nodiscard]] std::vector<double> ring_edges(double reach, double height, double delay_step);

/// Where phones are about the place that paths come back to, as an array under way receives.
struct ReceivingPhones {
  std::vector<Vec2> offsets;     ///< when the ping is sent [m]
  Vec2 velocity = Vec2::Zero();  ///< [m/s]

  /// Of their places along a direction when sound is received: the middle, and the mean square
  /// about it.
  struct Along {
    double middle = 0.0, square = 0.0;  // [m], [m²]
  };
  [[nodiscard]] Along along(const Vec2& outward, double delay) const;
  /// Whether that is the same of all directions.
  [[nodiscard]] bool alike_all_round() const;
};

/// Reverberation of a sector of bearing: mean power over delay and elevation, of a source of 1 at 1
/// m and for a pulse of energy 1 s. The mean of |Σp|² over weights and pieces of ground, p of all
/// pairs of paths: those whose phases turn against one another by Δ over a piece keep e^{−½Δ²}.
/// Those that come back along other paths also turn from phone to phone, and with the ship's way.
/// \param bearing, width  of the sector [rad]   \param pulse  who are received together
/// \param power  [bins × nodes] that it is added to [1/s]
void add_reverberation(const ScatteringSheet& sheet, const ScatteringGround& ground, double bearing,
                       double width, const PulseCoherence& pulse, const DelayAxis& axis,
                       const ElevationNodes& nodes, const ReceivingPhones& phones,
                       std::span<float> power);

}  // namespace asdic::detail
