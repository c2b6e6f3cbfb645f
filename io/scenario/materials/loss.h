#pragma once
#include "core/fields.h"

namespace asdic::detail::scenario {

inline constexpr Quantity shear_speed_quantity{
    .noun = "speed", .unit = "m/s", .low = 1.0, .high = 1e4, .or_zero = true};

/// What a wave loses: exactly one of several keys, each of a unit, or none and the default; written
/// in dB per wavelength.
/// \param shear  whether of the shear wave   \param speed  of the wave
void describe_loss(Fields& field, bool shear, double speed, double& db_per_wavelength);

}  // namespace asdic::detail::scenario
