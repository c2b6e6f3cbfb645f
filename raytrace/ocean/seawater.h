#pragma once
#include <string_view>

#include "core/validity.h"

namespace asdic::detail {

/// Which measurements the speed of sound in sea water is taken from.
enum class SeawaterEquation {
  chen_millero,  ///< the UNESCO standard; the widest range
  mackenzie,     ///< nine terms, in depth; within about 0.1 m/s for oceans, quick by hand
  del_grosso,    ///< preferred by long-range travel times in deep water
};

/// "chen-millero", "mackenzie", "del-grosso"
[[nodiscard]] std::string_view name(SeawaterEquation equation) noexcept;

/// Where an equation holds: temperature [degC], salinity [psu], and depth [m] or pressure [MPa].
[[nodiscard]] const Validity& validity(SeawaterEquation equation) noexcept;

/// Speed of sound in sea water [m/s].
///
/// None of the functions here checks its range: outside, a polynomial answers, and answers wrongly
/// (the reader of scenarios warns). \param temperature_degc in situ, ITS-90 [°C]   \param salinity
/// practical [psu]   \param depth  [m], above the surface taken as 0   \param latitude_deg  [°],
/// for gravity. Source: docs/theory/sound-speed.md.
[[nodiscard]] double sound_speed(SeawaterEquation equation, double temperature_degc,
                                 double salinity, double depth, double latitude_deg) noexcept;

/// Chen & Millero, JASA 62, 1129 (1977), with the coefficients of Wong & Zhu, JASA 97, 1732 (1995),
/// for the temperature scale of 1990. Range: 0..40 °C, 0..40 psu, 0..1000 bar.
/// \param gauge_pressure  above the atmosphere's [Pa]
[[nodiscard]] double sound_speed_chen_millero(double temperature_degc, double salinity,
                                              double gauge_pressure) noexcept;

/// Del Grosso, JASA 56, 1084 (1974), with the coefficients of Wong & Zhu (1995). Range: 0..30 °C,
/// 30..40 psu, 0..1000 kg/cm² (98 MPa). \param gauge_pressure  [Pa]
[[nodiscard]] double sound_speed_del_grosso(double temperature_degc, double salinity,
                                            double gauge_pressure) noexcept;

/// Mackenzie, JASA 70, 807 (1981). Range: 2..30 °C, 25..40 psu, 0..8000 m.
[[nodiscard]] double sound_speed_mackenzie(double temperature_degc, double salinity,
                                           double depth) noexcept;

/// Pressure above the atmosphere's at a depth [Pa], 0 above the surface. Leroy & Parthiot, JASA
/// 103, 1346 (1998): their standard ocean (0 °C, 35 psu) with the correction for the common oceans
/// between 60° N and 40° S. Enclosed seas (Mediterranean, Black Sea, …) have corrections of their
/// own, not applied here: some 10 kPa, which is 1 m of depth or 0.02 m/s.
[[nodiscard]] double gauge_pressure(double depth, double latitude_deg) noexcept;

/// The same in the standard ocean itself, 0 °C and 35 psu at every depth: what published check
/// values are for.
[[nodiscard]] double gauge_pressure_standard_ocean(double depth, double latitude_deg) noexcept;

}  // namespace asdic::detail
