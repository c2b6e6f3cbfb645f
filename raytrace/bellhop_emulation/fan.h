#pragma once
#include <vector>

#include "raytrace/bellhop_emulation/bellhop_emulation.h"

namespace asdic::detail::bellhop_emulation {

/// The rays of a run as BELLHOP chooses them.
struct LiteralFan {
  std::vector<double> declinations;  ///< [n] increasing [rad], positive down
  double spacing = 0.0;              ///< mean [rad]
  std::size_t first = 0, last = 0;   ///< trace those with first ≤ i < last
};

/// \param depth  of the water, last depth of the profile less the first [m]
[[nodiscard]] LiteralFan make_fan(const PropagationCase& run_case,
                                  const BellhopEmulationOptions& options, double depth);

/// How many rays BELLHOP takes when left to itself: 50 to look at, otherwise max(⌊0.3·R·f/1500⌋,
/// 300, ⌊π/atan(D/(10R))⌋), R the farthest receiver.
[[nodiscard]] int automatic_beams(const PropagationCase& run_case, double depth);

/// How few beams a coherent run may have before BELLHOP warns: 2 + width/√(c/(6fR)).
[[nodiscard]] double least_beams(const PropagationCase& run_case, double source_speed,
                                 double fan_width);

/// Amplitude at launch: the source's pattern, and for a semi-coherent field the Lloyd mirror of a
/// surface at z = 0, √2·|sin(ω z_s sin α/c)|.
[[nodiscard]] double launch_amplitude(const PropagationCase& run_case, double source_depth,
                                      double source_speed, double declination);

}  // namespace asdic::detail::bellhop_emulation
