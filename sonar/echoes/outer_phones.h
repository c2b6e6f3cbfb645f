#pragma once
#include <functional>

#include "sonar/echoes/echo.h"
#include "sonar/paths/moving_paths.h"

namespace asdic::detail {

/// A leg and the place at which it arrives.
struct ArrivedLeg {
  Leg leg;
  Vec3 place = Vec3::Zero();  ///< place of arrival [m]
};

/// Whether the paths to an array's reference point, as plane waves, describe the sound at its
/// phones, apart from the curvature of fronts (is_plane_wave()). They may not where waves carry
/// some of the energy, because their amplitude changes within wavelengths, and over slopes, where a
/// bounce moves with the phone. The paths to the array's outermost phones then have to agree to −30
/// dB at the highest received frequency. Source: docs/theory/echoes.md, "Phones"
/// \param at_phone  finds the leg to a phone
[[nodiscard]] bool is_alike_at_phones(const EchoContext& context, const ArrivedLeg& reference,
                                      const std::function<ArrivedLeg(int phone)>& at_phone);

/// Whether the paths to a place, as plane waves, describe the sound at another place to −30 dB at
/// the highest received frequency.
[[nodiscard]] bool is_alike(const EchoContext& context, const ArrivedLeg& reference,
                            const ArrivedLeg& elsewhere);

}  // namespace asdic::detail
