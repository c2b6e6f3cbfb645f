#pragma once
#include <array>
#include <complex>
#include <cstdint>
#include <vector>

#include "raytrace/ocean/arrivals.h"

namespace asdic::detail {

/// A point on a ray in the (range, depth) plane, and the beam it carries. Slowness is tangent/c;
/// depth and ζ are positive down.
struct RayState {
  double range = 0.0;  ///< r [m]
  double depth = 0.0;  ///< z [m]
  double xi = 0.0;     ///< ξ, range component of slowness [s/m]
  double zeta = 0.0;   ///< ζ, depth component [s/m]
  double time = 0.0;   ///< τ [s]
  double q = 0.0;  ///< ∂n/∂(launch angle) of a point source: q(0) = 0, p(0) = 1/c₀ [m/rad]
  double p = 0.0;  ///< dq/ds = c·p
  double q_plane = 1.0;  ///< the second solution: q(0) = 1, p(0) = 0 (plane wave)
  double p_plane = 0.0;
  double nepers = 0.0;  ///< ∫α ds
  double length = 0.0;  ///< s [m]
  /// ∫c ds [m²/s]: ∂y/∂η, how far apart rays of different slowness η across the plane are
  double speed_integral = 0.0;
};

/// What has happened to a ray before a segment.
struct RayHistory {
  std::complex<double> reflection = 1.0;  ///< product of the boundaries' coefficients
  double reflection_phase = 0.0;          ///< its phase, not wrapped [rad]
  double scattered =
      0.0;  ///< energy that rough boundaries scattered about the ray, beside |reflection|²
  int surface_bounces = 0, bottom_bounces = 0;
  int upper_turns = 0, lower_turns = 0;  ///< turning points in the water
  int caustics = 0;  ///< zeros of q passed, less those a displaced reflection takes back
};

/// A piece of a ray within one cell of the ocean, where everything is smooth. `end` is the state
/// before, the next segment's `begin` the state after the jump of p (and direction) between them.
struct RaySegment {
  RaySegment() = default;
  RaySegment(const RayState& from, const RayState& to, const RayHistory& before)
      : begin(from), end(to), history(before) {}
  RayState begin, end;
  RayHistory history;                 ///< up to `begin`
  double c_begin = 0.0, c_end = 0.0;  ///< speed by the cell's law [m/s]
  double c_r_begin = 0.0, c_z_begin = 0.0, c_r_end = 0.0, c_z_end = 0.0;  ///< its gradient [1/s]
  double c_nn_begin = 0.0, c_nn_end = 0.0;    ///< ∂²c/∂n² across the ray [1/(m·s)]
  double alpha_begin = 0.0, alpha_end = 0.0;  ///< attenuation [Np/m]
  std::uint32_t row = 0, column = 0;          ///< of the cell
};

enum class RayEnd : std::uint8_t {
  box,       ///< the limit of range or depth
  bounces,   ///< as many bounces as allowed
  faint,     ///< amplitude below what is wanted
  absorbed,  ///< a boundary that reflects nothing
  trapped,   ///< too many segments
};

/// One ray, segment by segment. Memory is reused from ray to ray.
struct RayTrajectory {
  double launch_elevation = 0.0;  ///< [rad], positive up
  double source_speed = 0.0;      ///< c₀ [m/s]
  std::vector<RaySegment> segments;
  std::vector<Bounce> bounces;
  RayEnd ended = RayEnd::box;
};

/// The state inside a segment at arc length `s` from its begin, by quintic Hermite interpolation:
/// value, slope and second derivative of every quantity agree at both ends, so the error is of
/// sixth order in the segment's length. `caustics` of a receiver there: history.caustics plus one
/// if q has changed sign on the way.
[[nodiscard]] RayState state_at(const RaySegment& segment, double s) noexcept;

/// The same for one segment at many ranges, and only where it is and how wide the tube.
class SegmentCurve {
 public:
  explicit SegmentCurve(const RaySegment& segment) noexcept;

  struct Crossing {
    double depth = 0.0, xi = 0.0, zeta = 0.0, q = 0.0;
  };
  [[nodiscard]] Crossing at_range(double range) const noexcept;

 private:
  using Quintic = std::array<double, 6>;  // in u = s/h
  const RaySegment& segment_;
  double h_;
  Quintic range_{}, depth_{}, q_{};
  std::array<double, 4> c_{};
};

/// Arc length from the segment's begin at which the ray is at a range between the ranges of its
/// ends.
[[nodiscard]] double arc_at_range(const RaySegment& segment, double range) noexcept;

}  // namespace asdic::detail
