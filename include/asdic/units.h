#pragma once

/// \file
/// Units and the version. All numbers of the library are SI: m, s, Hz, Pa, kg/m³. Names that end
/// in _deg are in degrees, in _db in decibels. Positions are {east, north, depth}, depth positive
/// down; elevations are positive up; bearings and headings are true, clockwise from north.
///
/// ```cpp
/// const double pressure = 1e-6 * asdic::amplitude_from_db(120.0);  // 120 dB re 1 µPa is 1 Pa
/// const double up = asdic::radians(8.0);
/// std::cout << pressure << " Pa, " << up << " rad, asdic " << asdic::version() << '\n';
/// ```

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "asdic/export.h"

namespace asdic {

using Vector = std::array<double, 3>;  ///< east, north, depth [m], or [m/s]

[[nodiscard]] ASDIC_API double radians(double degrees) noexcept;
[[nodiscard]] ASDIC_API double degrees(double radians) noexcept;
[[nodiscard]] ASDIC_API double power_from_db(double db) noexcept;         ///< 10^(x/10)
[[nodiscard]] ASDIC_API double amplitude_from_db(double db) noexcept;     ///< 10^(x/20)
[[nodiscard]] ASDIC_API double db_from_power(double ratio) noexcept;      ///< 10·log₁₀ x
[[nodiscard]] ASDIC_API double db_from_amplitude(double ratio) noexcept;  ///< 20·log₁₀ x

/// A number with its unit as files may have it, "25km", in the unit of a setting ("m"); nothing for
/// what is no number, or a number of something else.
[[nodiscard]] ASDIC_API std::optional<double> measured(std::string_view text,
                                                       std::string_view unit);

/// "0.1.0"
[[nodiscard]] ASDIC_API std::string version();
/// How the library was built: compiler, options, and the instruction level that runs here.
[[nodiscard]] ASDIC_API std::string build();

}  // namespace asdic
