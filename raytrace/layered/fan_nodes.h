#pragma once
#include <span>
#include <vector>

#include "core/units.h"
#include "raytrace/layered/layer.h"

namespace asdic::detail {

/// A speed at which the fan of an ocean is singular; `logarithmic` where it is a smooth extremum of
/// the profile, near which a ray lingers.
struct CriticalSpeed {
  double speed = 0.0;
  bool logarithmic = false;
};

/// Between two speeds, these included: of rays that turn at a knot, graze a boundary, or are
/// horizontal at a cut. \return increasing
[[nodiscard]] std::vector<CriticalSpeed> critical_speeds(std::span<const Layer> layers,
                                                         double slowest, double fastest);

/// Nodes of the fan between two neighbours of them: sines at the slower one's depth, denser towards
/// 0, where r(σ) bends within the distance to the next slower knot; geometric towards logarithmic
/// ends. \param analytic  one law over the whole depth: few, wide intervals; a table has one from
/// sample to sample   \param bend  that distance in σ (bend_within()); ∞: no more nodes
void put_nodes(const CriticalSpeed& slow, const CriticalSpeed& fast, bool analytic,
               std::vector<double>& sigma, double bend = infinity);

/// The distance in σ from a singular speed to the next slower one among others: the sine, at the
/// depth of `speed`, of the ray that is horizontal at the slower one's depth. ∞ if none is slower.
[[nodiscard]] double bend_within(double speed, std::span<const double> others);

}  // namespace asdic::detail
