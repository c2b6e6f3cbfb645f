#pragma once
#include <functional>

#include "sonar/echoes/echo.h"
#include "sonar/paths/moving_paths.h"

namespace asdic::detail {

/// A leg from one place, as it arrives at another.
struct ArrivedLeg {
  Leg leg;
  Vec3 place = Vec3::Zero();  ///< where it arrives [m]
};

/// Whether the paths at an array's reference point, as plane waves, are what its phones receive,
/// curvature of fronts apart (is_plane_wave() looks at that): where waves carry some of the energy,
/// whose amplitude changes within wavelengths, and over slopes, where a bounce moves with the
/// phone. Paths are found to the array's outermost phones: what they bring is to differ by −30 dB
/// at most, at the highest frequency that is received. Source: docs/theory/echoes.md, "Phones"
/// \param at_phone  finds the leg to a phone
[[nodiscard]] bool is_alike_at_phones(const EchoContext& context, const ArrivedLeg& reference,
                                      const std::function<ArrivedLeg(int phone)>& at_phone);

}  // namespace asdic::detail
