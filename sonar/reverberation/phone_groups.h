#pragma once
#include <cstddef>
#include <vector>

#include "sonar/paths/plane_wave.h"
#include "sonar/scenario/carried.h"

namespace asdic::detail {

/// Most that a plane wave of reverberation may be wrong at a phone [periods]: λ/16 is the far
/// field's border 2L²/λ of a line L. A beam loses 0.03 dB of a scatterer there.
inline constexpr double reverberation_periods = 1.0 / 16.0;

/// The front of the nearest scatterers that a record can hold, out of any direction, at
///
///     r = max(h, (c·t − D)/2),
///
/// h the height of the reference point above or below the nearest sheet that scatters, t when the
/// record or, if later, the pulse's end begins (what is received before lies under the ping
/// itself), D how far the transmitter is. r is infinite where nothing scatters. It lasts for the
/// record. \param duration  of the pulse [s]   \param highest_frequency  of it [Hz]
[[nodiscard]] Front nearest_reverberation(const PingGeometry& geometry, int array, double duration,
                                          double highest_frequency);

/// Parts of an array, each of which receives reverberation as plane waves about a point of its own.
struct PhoneGroups {
  std::vector<PhoneRange> parts;
  double error = 0.0;  ///< of the nearest scatterers' fronts at the worst phone [periods]
};

/// Whether a scenario's file tells of its groups: one of its arrays is longer than sixteen
/// wavelengths of its highest pulse.
[[nodiscard]] bool has_long_arrays(const Scenario& scenario);

/// The whole array about a point, as long as that front is a plane wave to λ/16 in it.
[[nodiscard]] PhoneGroups one_group(const Listening& here, const Front& front,
                                    const Carried& point);
/// Halves, and halves of these, until it is so in each. \param most  parts: where they do not
/// suffice, they are larger than they should be, and `error` says so \param allowed  [periods]
[[nodiscard]] PhoneGroups phone_groups(const Listening& here, const Front& front, double most,
                                       double allowed = reverberation_periods);

}  // namespace asdic::detail
