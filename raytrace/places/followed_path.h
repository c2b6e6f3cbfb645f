#pragma once
#include <optional>

#include "raytrace/ocean/arrivals.h"
#include "raytrace/tracing/ray_tracer.h"

namespace asdic::detail {

/// The same path after its ends, and with them its plane, have moved by metres: traced again from
/// its launch angle, which Newton's method turns until the ray passes within a tenth of a
/// millimetre of the receiver. Null if no ray of the same history does: then it has to be searched
/// for. \param tracer  of the plane as it is now, source at range 0   \param range  of the receiver
/// [m]
[[nodiscard]] std::optional<Arrival> followed_path(const RayTracer& tracer, const Arrival& path,
                                                   double source_depth, double receiver_depth,
                                                   double range);

/// Where that found none: the one of its history that leaves nearest, out of some thirty rays on
/// either side up to 0.15° from it. Metres at kilometres turn a path by hundredths of a degree,
/// beside a fold some times as much. Null if no two neighbours of them enclose the receiver.
[[nodiscard]] std::optional<Arrival> path_beside(const RayTracer& tracer, const Arrival& path,
                                                 double source_depth, double receiver_depth,
                                                 double range);

}  // namespace asdic::detail
