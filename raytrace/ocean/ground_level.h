#pragma once
#include <optional>

#include "raytrace/ocean/arrivals.h"

namespace asdic::detail {

/// Where paths end: at the surface, the bottom, or a depth in between, where sound passes both
/// ways.
struct GroundLevel {
  std::optional<BoundaryKind> boundary = BoundaryKind::surface;  ///< none: the depth below
  double depth = 0.0;                                            ///< of a level in the water [m]

  GroundLevel(BoundaryKind kind) : boundary(kind) {}  // NOLINT: a boundary is a level
  explicit GroundLevel(double metres) : boundary(), depth(metres) {}
};

}  // namespace asdic::detail
