#pragma once
#include <cstddef>
#include <functional>
#include <memory>

#include "raytrace/ocean/arrivals.h"
#include "raytrace/paths/eigenrays.h"

namespace asdic::detail {

/// Caustics at the receiver's depth in an interval of ranges, and the fields about them.
class Caustics;
[[nodiscard]] std::size_t bytes_of(const Caustics& caustics) noexcept;

/// All that decides the Caustics of one ocean, except the limits of its paths.
struct CausticsNeed {
  double source_depth, receiver_depth, frequency;
  double nearest, furthest;  ///< ranges [m]
};
using CausticsMaker = std::function<std::shared_ptr<Caustics>()>;
/// Gives what is known, or makes it and keeps it.
using CausticsKeeper =
    std::function<std::shared_ptr<const Caustics>(const CausticsNeed&, const CausticsMaker&)>;

/// Gives pairs of rays that meet at a smooth caustic the amplitudes that waves have there, and adds
/// such pairs on its dark side: Airy's function and its derivative instead of amplitudes that grow
/// without bound and end. Both of a pair are of kind `caustic`; their sum is the field (Chester,
/// Friedman & Ursell 1957; Ludwig 1966). docs/theory/waves.md, "Caustics"
///
/// Where the two are further apart than eight units of Airy's argument they stay rays; four units
/// beyond the caustic (50 dB) there is nothing. Left as they are: pairs next to the end of their
/// family, and three rays or more that meet.
/// \param solver  layered()   \param found  all eigenrays of these places within the limits
/// \param keeper  caustics of one interval serve all its ranges; without it none are kept
void put_caustics(const EigenraySolver& solver, double source_depth, double receiver_depth,
                  double range, double frequency, const PathLimits& limits, Arrivals& found,
                  const CausticsKeeper& keeper = {});

}  // namespace asdic::detail
