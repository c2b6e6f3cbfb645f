#pragma once
#include "raytrace/ocean/environment.h"

namespace asdic::detail {

/// The vertical plane that crosses an ocean along a line which leaves the transect at x0 under an
/// angle β. The ocean varies along the transect and is uniform across it, so a point at range r of
/// the line is one at
///
///   x = x0 + r·cos β
///
/// of the transect: the same ocean with its range axis shifted, made longer by 1/cos β, and
/// reversed where cos β < 0. Slopes shrink by cos β. Sound is followed in that plane alone (N ×
/// 2D): what a slope across it deflects is left out. docs/theory/transect.md
///
/// Almost across the transect (|cos β| < 10⁻⁹: a millimetre in a thousand kilometres), and in any
/// ocean that does not vary along it, the plane is layered: profile, depths and materials of x0.
/// \param environment  along the transect   \param x0  [m]   \param cos_beta  −1..1
[[nodiscard]] Environment slice(const Environment& environment, double x0, double cos_beta);

}  // namespace asdic::detail
