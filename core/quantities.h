#pragma once
#include "core/quantity.h"

/// The quantities that more than one setting is of.
namespace asdic::detail::quantity {

inline constexpr Quantity coordinate{.noun = "coordinate", .unit = "m", .low = -1e7, .high = 1e7};
/// Of what swims, below the mean surface.
inline constexpr Quantity depth{.noun = "depth", .unit = "m", .low = 0.0, .high = 12000.0};
/// Of water and of boundaries: beyond the bottom, and above a mean surface that is not at 0.
inline constexpr Quantity water_depth{
    .noun = "depth", .unit = "m", .low = -20000.0, .high = 20000.0};
inline constexpr Quantity range{.noun = "range", .unit = "m", .low = -1e10, .high = 1e10};
inline constexpr Quantity velocity{.noun = "velocity", .unit = "m/s", .low = -100.0, .high = 100.0};
/// Length of time, at least one period of the highest frequency.
inline constexpr Quantity duration{.noun = "duration", .unit = "s", .low = 1e-6, .high = 1e5};
inline constexpr Quantity pulse_duration{.noun = "duration", .unit = "s", .low = 1e-6, .high = 1e3};
/// Frequency of sound. At the lowest one the deepest sea is about one wavelength deep.
inline constexpr Quantity frequency{.noun = "frequency", .unit = "Hz", .low = 0.1, .high = 1e6};
/// Distance of two frequencies, or the frequency of a slow change, such as a modulation.
inline constexpr Quantity frequency_step{
    .noun = "frequency", .unit = "Hz", .low = 1e-5, .high = 1e6};
/// Time from one ping to the next.
inline constexpr Quantity interval{.noun = "interval", .unit = "s", .low = 1e-6, .high = 1e7};
/// One sample of a sound that stands in a scenario, in any unit, and the rate of the samples.
inline constexpr Quantity sound_sample{.noun = "sample", .low = -1e30, .high = 1e30};
inline constexpr Quantity sound_rate{.noun = "sample rate", .unit = "Hz", .low = 0.1, .high = 1e9};
inline constexpr Quantity level{.noun = "level", .unit = "dB", .low = -300.0, .high = 400.0};
constexpr Quantity level_re(std::string_view reference) {
  Quantity quantity = level;
  quantity.reference = reference;
  return quantity;
}
/// 10·log₁₀ of a scattering cross-section per area or volume.
inline constexpr Quantity scattering_strength{
    .noun = "strength", .unit = "dB", .low = -200.0, .high = 20.0};

/// Of sound in water and in half spaces: numbers in km/s are outside.
inline constexpr Quantity sound_speed{.noun = "speed", .unit = "m/s", .low = 200.0, .high = 1e4};
/// Of water and of half spaces: numbers in g/cm3 are outside.
inline constexpr Quantity density{
    .noun = "density", .unit = "kg/m3", .low = 100.0, .high = 20000.0};
inline constexpr Quantity temperature{
    .noun = "temperature", .unit = "degC", .low = -3.0, .high = 45.0};
inline constexpr Quantity salinity{.noun = "salinity", .unit = "psu", .low = 0.0, .high = 50.0};
inline constexpr Quantity wind_speed{.noun = "wind speed", .unit = "m/s", .low = 0.0, .high = 60.0};

/// Of a process; files may write it with a unit, "4 GB".
inline constexpr Quantity memory{.noun = "memory", .unit = "bytes", .low = 1e6, .high = 1e18};
/// Since the start of a scenario.
inline constexpr Quantity time{.noun = "time", .unit = "s", .low = 0.0, .high = 1e9};

inline constexpr AngleQuantity heading{.noun = "heading", .low_deg = -360.0, .high_deg = 360.0};
inline constexpr AngleQuantity bearing{.noun = "bearing", .low_deg = -360.0, .high_deg = 360.0};
inline constexpr AngleQuantity elevation{.noun = "elevation", .low_deg = -90.0, .high_deg = 90.0};
inline constexpr AngleQuantity grazing{.noun = "grazing angle", .low_deg = 0.0, .high_deg = 90.0};

}  // namespace asdic::detail::quantity
