#pragma once
#include <memory>
#include <span>

#include "raytrace/ocean/environment.h"
#include "raytrace/tracing/ray_trajectory.h"

namespace asdic::detail {

/// Where a ray is followed no further.
struct TraceLimits {
  double min_range = -1e300, max_range = 1e5;    ///< [m]
  double min_depth = -1e300, max_depth = 1e300;  ///< [m]
  int max_surface_bounces = 1 << 20, max_bottom_bounces = 1 << 20;
  double faintest = 0.0;  ///< product of reflection magnitudes below which a ray is dropped
  int max_segments = 1'000'000;
};

/// Where a ray leaves a boundary.
enum class Reflection : unsigned char {
  on_the_spot,
  displaced,  ///< carried along by the phase of the coefficient (ocean/beam_displacement.h)
};

/// Told where a ray passes ranges.
class RangeVisitor {
 public:
  /// \param range  index of it   \param y  there   \param history  up to there, caustics included
  virtual void pass(std::size_t range, const RayState& y, const RayHistory& history) = 0;

 protected:
  ~RangeVisitor() = default;
};

/// Marches rays through any ocean: closed forms in cells where they exist (c linear: arcs of
/// circles; 1/c² linear: parabolas), a high-order step with error control elsewhere, and events
/// (grid lines of the water, nodes and facets of the boundaries, turning points) located to
/// rounding. p jumps where the gradient of c or the boundary's tangent does. Built once per
/// environment and frequency; const and shared by threads after that. docs/theory/rays.md,
/// docs/theory/reflections.md
class RayTracer {
 public:
  /// \param frequency  sets attenuation and reflection [Hz]
  RayTracer(const Environment& environment, double frequency,
            Reflection reflection = Reflection::on_the_spot);
  ~RayTracer();
  RayTracer(RayTracer&&) noexcept;
  RayTracer& operator=(RayTracer&&) noexcept;

  [[nodiscard]] const Environment& environment() const noexcept;
  [[nodiscard]] double frequency() const noexcept;  ///< [Hz]
  /// Magnitude of slope that no facet of a boundary exceeds; 0 of a flat one.
  [[nodiscard]] double steepest_slope(BoundaryKind kind) const noexcept;

  /// Traces one ray from (source_range, source_depth). Angles beyond ±π/2 go to smaller ranges.
  /// \param out  its memory is reused
  void trace(double source_range, double source_depth, double launch_elevation,
             const TraceLimits& limits, RayTrajectory& out) const;

  /// The same ray without storing it: the visitor is told the exact state at each range that the
  /// ray passes, in the order in which it does; a turn on a range may be told once or not at all.
  /// \param ranges  increasing [m]   \return c₀, the speed at the source [m/s]
  double trace_past(std::span<const double> ranges, double source_range, double source_depth,
                    double launch_elevation, const TraceLimits& limits,
                    RangeVisitor& visitor) const;

  /// The state where one segment of a ray of this tracer crosses a range between those of its ends:
  /// as exact as its ends, where state_at interpolates.
  [[nodiscard]] RayState state_at_range(const RaySegment& segment, double range) const;

  struct Ocean;  ///< what is prepared once (ocean.h)

 private:
  std::unique_ptr<const Ocean> ocean_;
};

}  // namespace asdic::detail
