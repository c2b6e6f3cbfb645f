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

/// The inverse: the depth at which there is a pressure above the atmosphere's [m], to 1e-6 m; 0 for
/// none. What a CTD measures becomes the depth of the formula by which sound speeds are computed.
[[nodiscard]] double depth_at_pressure(double gauge_pressure, double latitude_deg) noexcept;

/// The same in the standard ocean itself, 0 °C and 35 psu at every depth: what published check
/// values are for.
[[nodiscard]] double gauge_pressure_standard_ocean(double depth, double latitude_deg) noexcept;

/// The temperature in situ of water whose potential temperature is known, that which it would have
/// at the surface [°C, ITS-90]: its adiabatic lapse rate (Bryden, Deep-Sea Res. 20, 401, 1973, as
/// in UNESCO Techn. Papers in Marine Science 44, 1983), integrated from the surface down; models of
/// the ocean give potential temperatures. \param gauge_pressure  [Pa]
[[nodiscard]] double temperature_in_situ(double potential_degc, double salinity,
                                         double gauge_pressure) noexcept;

/// Potential temperature of a conservative temperature [°C] and an absolute salinity [g/kg]: the
/// potential enthalpy of TEOS-10, a polynomial, solved by iteration to 1e-9 K. IOC, SCOR and
/// IAPSO, The international thermodynamic equation of seawater – 2010, eq. (3.3.2).
[[nodiscard]] double potential_temperature(double conservative_degc,
                                           double absolute_salinity) noexcept;

/// [psu], but for the anomaly of absolute salinity by place (at most 0.03 g/kg): S_P =
/// S_A·35/35.16504.
[[nodiscard]] constexpr double practical_salinity(double absolute_salinity) noexcept {
  return absolute_salinity * (35.0 / 35.16504);
}

}  // namespace asdic::detail
