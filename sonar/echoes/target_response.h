#pragma once
#include <complex>
#include <cstdint>
#include <vector>

#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// Who looks at a target, and in which ping: what fluctuation is keyed by.
struct Look {
  int transmitter = 0;
  int platform = 0;  ///< of the array that receives it: arrays of one platform see the same
  int ping = 1;      ///< of the run, counted from 1
  int own_ping = 1;  ///< of the transmitter's own pings, counted from 1
};

/// Number that names a target in its draws. It follows from the target's name, so it does not
/// depend on the target's place in the list. Targets of equal names are numbered in their order.
[[nodiscard]] std::uint64_t target_identity(const Scenario& scenario, int target);

/// Factor of a highlight's amplitude, E|w|² = 1 (1 where it does not fluctuate).
[[nodiscard]] std::complex<double> fluctuation(const Scenario& scenario, int target, int highlight,
                                               const Look& look);

/// A place that answers.
struct Glint {
  int highlight = -1;                    ///< index, −1: the target as a point
  Vec3 offset = Vec3::Zero();            ///< from the target's reference point, map axes [m]
  std::complex<double> amplitude = 1.0;  ///< pressure at 1 m over the pressure that comes in
};

/// What a pair of paths meets of a target: the point, or all highlights that are hidden neither
/// from where the sound comes nor from where it goes. Source: docs/theory/target.md
/// \param in, out  directions of travel   \param time  when it is struck [s]
[[nodiscard]] std::vector<Glint> glints(const Scenario& scenario, int target, const Look& look,
                                        const Vec3& in, const Vec3& out, double time);

}  // namespace asdic::detail
