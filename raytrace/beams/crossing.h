#pragma once
#include <algorithm>
#include <cmath>
#include <complex>
#include <span>

#include "raytrace/beams/beam.h"
#include "raytrace/ocean/tube_amplitude.h"
#include "raytrace/tracing/ray_trajectory.h"
#include "raytrace/tracing/reflected.h"

namespace asdic::detail {

/// A ray and its beam where they cross the range of a column of receivers.
struct Crossing {
  double depth = 0.0;         ///< [m]
  double cosine = 1.0;        ///< of the angle between ray and horizon; below 0 the ray goes back
  double sine = 0.0;          ///< positive down
  double speed = 0.0;         ///< c [m/s]
  double time = 0.0;          ///< τ [s]
  double length = 0.0;        ///< arc length from the source [m]
  double q = 0.0;             ///< ∂n/∂α [m/rad]
  double dq_ds = 0.0;         ///< c·p [1/rad]
  std::complex<double> loss;  ///< reflections × exp(−∫α ds) × i^caustics × spread_across
  double mirror = 1.0;        ///< −1 after an odd number of reflections

  /// +1 where rays launched a little higher are deeper here, −1 where they are shallower.
  [[nodiscard]] double toward_higher() const noexcept { return q * cosine * mirror > 0.0 ? -1 : 1; }
};

/// Caustics passed at a state inside a segment.
inline int caustics_at(const RaySegment& segment, const RayState& state) noexcept {
  return segment.history.caustics + (segment.begin.q * state.q < 0.0 ? 1 : 0);
}

/// What spreading across the plane leaves where a ray is, unless field_scale says it: 1/√∫c ds, 0
/// at the source.
inline double spread_across(const BeamSetting& setting, const RayState& state) noexcept {
  if (!setting.point_source || setting.spreading == Spreading::cylindrical) return 1.0;
  return state.speed_integral > 0.0 ? 1.0 / std::sqrt(state.speed_integral) : 0.0;
}

inline Crossing crossing_of(const BeamSetting& setting, const RaySegment& segment,
                            const RayState& state) noexcept {
  const double c = 1.0 / std::hypot(state.xi, state.zeta);
  return {.depth = state.depth,
          .cosine = c * state.xi,
          .sine = c * state.zeta,
          .speed = c,
          .time = state.time,
          .length = state.length,
          .q = state.q,
          .dq_ds = c * state.p,
          .loss = reflected(segment.history, setting.coherent) *
                  (std::exp(-state.nepers) * spread_across(setting, state)) *
                  caustic_phase(caustics_at(segment, state)),
          .mirror = (segment.history.surface_bounces + segment.history.bottom_bounces) % 2 == 0
                        ? 1.0
                        : -1.0};
}

/// Calls visit(column, state) for each range that a segment crosses, in the order in which it does.
/// The segment owns its begin and not its end, so that consecutive segments share no crossing.
template <class Visit>
void for_each_crossing(const RaySegment& segment, std::span<const double> ranges, Visit&& visit) {
  const double from = segment.begin.range, to = segment.end.range;
  const auto index = [&](auto iterator) {
    return static_cast<std::size_t>(iterator - ranges.begin());
  };
  const auto at = [&](std::size_t column) {
    visit(column, state_at(segment, arc_at_range(segment, ranges[column])));
  };
  if (to > from) {
    const std::size_t end = index(std::lower_bound(ranges.begin(), ranges.end(), to));
    for (std::size_t j = index(std::lower_bound(ranges.begin(), ranges.end(), from)); j < end; ++j)
      at(j);
  } else if (to < from) {
    const std::size_t end = index(std::upper_bound(ranges.begin(), ranges.end(), to));
    for (std::size_t j = index(std::upper_bound(ranges.begin(), ranges.end(), from)); j > end; --j)
      at(j - 1);
  }
}

}  // namespace asdic::detail
