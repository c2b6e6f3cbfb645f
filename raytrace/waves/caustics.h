#pragma once
#include "raytrace/ocean/arrivals.h"
#include "raytrace/paths/eigenrays.h"

namespace asdic::detail {

/// Gives pairs of rays that meet at a smooth caustic the amplitudes that waves have there, and adds
/// such pairs on its dark side: Airy's function and its derivative instead of amplitudes that grow
/// without bound and end. Both of a pair are of kind `caustic`; their sum is the field (Chester,
/// Friedman & Ursell 1957; Ludwig 1966). docs/theory/waves.md, "Caustics"
///
/// Where the two are further apart than eight units of Airy's argument they stay rays; four units
/// beyond the caustic (50 dB) there is nothing. Left as they are: pairs next to the end of their
/// family, and three rays or more that meet.
/// \param solver  layered()   \param found  all eigenrays of these places within the limits
void put_caustics(const EigenraySolver& solver, double source_depth, double receiver_depth,
                  double range, double frequency, const PathLimits& limits, Arrivals& found);

}  // namespace asdic::detail
