#pragma once
#include "raytrace/bellhop_emulation/reflect.h"

namespace asdic::detail::bellhop_emulation {

/// Traces one ray until it leaves the box, has lost all but 0.005 of its amplitude, is outside a
/// boundary at two successive points, or has 100 000 points. A source on or outside a boundary
/// gives a ray of one point. \param out  its memory is reused; `out.declination` is set
void trace(const LiteralOcean& ocean, double source_depth, double declination, double amplitude,
           CervenyBeams::Curvature curvature, LiteralRay& out);

}  // namespace asdic::detail::bellhop_emulation
