#pragma once
#include <span>

#include "raytrace/places/propagation_paths.h"
#include "sonar/paths/leg.h"
#include "sonar/scenario/track.h"

namespace asdic::detail {

/// Unit vector of travel over the local speed of sound [s/m].
[[nodiscard]] Vec3 slowness_vector(double bearing, double elevation, double sound_speed);

/// The same of a path as it leaves and as it arrives. \param line  bearing of the straight line
/// between its ends [rad]
[[nodiscard]] Vec3 leaving_slowness(double line, const Arrival& path, double sound_speed);
[[nodiscard]] Vec3 arriving_slowness(double line, const Arrival& path, double sound_speed);

/// How much later the echo of a moving body's point at x is received than that of its reference
/// point, as a vector a: a·x, fronts being plane. The front that passes the reference point with
/// the slowness s_in meets the point δ = s_in·x/(1 − s_in·v_T) later, v_T·δ farther on; what that
/// sends back with s_out comes δ(1 − s_out·v_T) − s_out·x later to a place at rest, and a phone
/// that moves meets it η_R = 1/(1 − s_R·v_R) times as much later. Source: docs/theory/target.md,
/// eq. (2)
struct BodyLag {
  Vec3 into = Vec3::Zero(), out = Vec3::Zero();  ///< slownesses at the body [s/m]
  Vec3 at_phone = Vec3::Zero();
  Vec3 body_velocity = Vec3::Zero(), phone_velocity = Vec3::Zero();  ///< [m/s]

  /// a [s/m]
  [[nodiscard]] Vec3 per_offset() const noexcept {
    const double meets = (1.0 - out.dot(body_velocity)) / (1.0 - into.dot(body_velocity));
    return (meets * into - out) / (1.0 - at_phone.dot(phone_velocity));
  }
};

/// Directions in which the points of a body are received along a path: straight lines of its
/// length, unfolded at its bounces. Ten metres at a kilometre are half a degree.
struct SeenAside {
  Vec3 at_phone = Vec3::Zero();  ///< slowness of the body's reference point there [s/m]
  double length = infinity;      ///< of the path [m]
  bool mirrored = false;         ///< by an odd number of bounces

  SeenAside(const Vec3& slowness, const Arrival& path)
      : at_phone(slowness),
        length(std::max(path.path_length, 1e-3)),
        mirrored((path.surface_bounces + path.bottom_bounces) % 2 != 0) {}

  /// Change of the slowness for a point at x from the reference point [s/m].
  [[nodiscard]] Vec3 of(const Vec3& x) const {
    const Vec3 away(x.x(), x.y(), mirrored ? -x.z() : x.z());
    const double slowness = at_phone.norm();
    const Vec3 ahead = at_phone / slowness;
    const Vec3 line = length * ahead - away;  // from the point to the phone
    return slowness * (line.normalized() - ahead);
  }
};

/// One way from a fixed point at a known time to something that moves: eigenrays to where it is at
/// a reference time. Times count from the start of the ping.
struct Way {
  Leg leg;
  Kinematics end;               ///< of the thing at the reference time
  double reference_time = 0.0;  ///< [s]
};

/// One path to where the thing is when that path arrives.
struct MetPath {
  Way way;  ///< without the other paths
  Arrival path;
  double time = 0.0;  ///< of arrival, since the start of the ping [s]
};

/// The same path after its ends have moved by metres: same history, and launched within a degree
/// of what it was, against the line between the ends.
///
/// In a layered ocean of those the nearest horizontal slowness ξ = cos θ/c, which the ray keeps, or
/// one that is as near as that of level rays two degrees apart: a ray that leaves almost level
/// turns by degrees, √(2Δc/c), when its end sinks by metres through a thermocline, and ξ hardly
/// changes. Two paths of one history that leave upwards and downwards (a duct) have almost the same
/// ξ: the direction keeps them apart. Elsewhere the nearest launch angle, within ten degrees if it
/// is the only path of its history. Null if it is there no more.
[[nodiscard]] const Arrival* same_path(const Arrivals& arrivals, const Arrival& path, bool layered);

/// Finds where sound meets things that move: 7 m/s over 20 s is 144 m. Source:
/// docs/theory/echoes.md
class MovingPaths {
 public:
  /// \param frequency  [Hz]   \param ping_time  since the start of the scenario [s]
  /// \param tolerance  of a delay that the linear step below leaves, a hundredth of a radian at
  /// most [s]
  /// \param reuse  counts the eigenrays that were known; null: nobody does
  MovingPaths(const PropagationPaths& paths, const PathLimits& limits, double frequency,
              double ping_time, double tolerance = 1e-7, Reuse* reuse = nullptr)
      : paths_(paths),
        limits_(limits),
        frequency_(frequency),
        ping_time_(ping_time),
        tolerance_(std::min(tolerance, 2e-3 / frequency)),
        reuse_(reuse) {}

  /// Eigenrays from a point, left at `start`, to where a track is about when the first of them
  /// comes: so near that meet() leaves no more than the tolerance.
  /// \param offset  from the track [m]   \param known  the same paths when something was metres
  /// away; none: they are searched for
  [[nodiscard]] Way way(const Vec3& from, double start, const Track& track, const Vec3& offset,
                        std::span<const Arrival> known = {}) const;

  /// One of its paths to where the track is when *that path* arrives: found again there until the
  /// linear step t = t₀ + τ + s·v(t − t_ref) is enough.
  [[nodiscard]] MetPath meet(const Vec3& from, double start, const Track& track, const Vec3& offset,
                             const Way& reference, const Arrival& path) const;

 private:
  [[nodiscard]] double straight_arrival(const Vec3& from, double start, const Track& track,
                                        const Vec3& offset) const;
  [[nodiscard]] Way way_at(const Vec3& from, const Track& track, const Vec3& offset, double time,
                           std::span<const Arrival> known) const;
  [[nodiscard]] Kinematics place(const Track& track, const Vec3& offset, double time) const;
  [[nodiscard]] bool settled(double moved, double c, double range) const;

  const PropagationPaths& paths_;
  PathLimits limits_;
  double frequency_, ping_time_, tolerance_;
  Reuse* reuse_;
};

}  // namespace asdic::detail
