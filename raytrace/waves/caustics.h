#pragma once
#include <cstddef>
#include <functional>
#include <memory>

#include "raytrace/ocean/arrivals.h"
#include "raytrace/paths/eigenrays.h"

namespace asdic::detail {

/// Field about the place at the receiver's depth where two rays meet at a caustic.
class FoldField;
[[nodiscard]] std::size_t bytes_of(const FoldField& field) noexcept;

/// All that decides a FoldField of one ocean, except the limits of its paths.
struct FoldNeed {
  double source_depth, receiver_depth, frequency;
  double range, side, scale, launch;  ///< of the caustic
  int surface_bounces, bottom_bounces, vertices;
};
using FoldMaker = std::function<std::shared_ptr<FoldField>()>;
/// Gives what is known, or makes it and keeps it.
using FoldKeeper =
    std::function<std::shared_ptr<const FoldField>(const FoldNeed&, const FoldMaker&)>;

/// Gives pairs of rays that meet at a smooth caustic the amplitudes that waves have there, and adds
/// such pairs on its dark side: Airy's function and its derivative instead of amplitudes that grow
/// without bound and end. Both of a pair are of kind `caustic`; their sum is the field (Chester,
/// Friedman & Ursell 1957; Ludwig 1966). docs/theory/waves.md, "Caustics"
///
/// Where the two are further apart than eight units of Airy's argument they stay rays; four units
/// beyond the caustic (50 dB) there is nothing. Left as they are: pairs next to the end of their
/// family, and three rays or more that meet.
/// \param solver  layered()   \param found  all eigenrays of these places within the limits
/// \param keeper  fields depend on the depths, not on the range; without it none is kept
void put_caustics(const EigenraySolver& solver, double source_depth, double receiver_depth,
                  double range, double frequency, const PathLimits& limits, Arrivals& found,
                  const FoldKeeper& keeper = {});

}  // namespace asdic::detail
