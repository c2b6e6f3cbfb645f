#pragma once
#include "core/units.h"

namespace asdic::detail {

/// One end of a ray: how the thing there moves, and the ray's slowness vector there, its direction
/// of travel over the local speed of sound. Same frame for both (x east, y north, z down).
struct MovingEnd {
  Vec3 velocity = Vec3::Zero();  ///< [m/s]
  Vec3 slowness = Vec3::Zero();  ///< [s/m]
};

/// Frequency received over frequency sent on one leg, (1 − v_R·s_R)/(1 − v_S·s_S): exact for
/// constant velocities, with the speed of sound where it happens. In a stratified sea the
/// horizontal part of s is the ray's Snell invariant. Source: docs/theory/doppler.md, eq. (1)
[[nodiscard]] inline double leg_doppler(const MovingEnd& sender,
                                        const MovingEnd& receiver) noexcept {
  return (1.0 - receiver.velocity.dot(receiver.slowness)) /
         (1.0 - sender.velocity.dot(sender.slowness));
}

/// The slowness of a front as an array that moves meets it, s/(1 − s·v): its phone at x receives
/// what the reference point receives s'·x later, having moved meanwhile.
[[nodiscard]] inline Vec3 met_by(const Vec3& velocity, const Vec3& slowness) noexcept {
  return slowness / (1.0 - slowness.dot(velocity));
}

/// The factor η of an echo: out to the target and back, s(η(t − τ)).
/// \param target_in, target_out  the target where the outgoing ray ends and the returning one
/// starts
[[nodiscard]] double echo_doppler(const MovingEnd& source, const MovingEnd& target_in,
                                  const MovingEnd& target_out, const MovingEnd& receiver) noexcept;

}  // namespace asdic::detail
