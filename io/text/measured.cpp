#include "io/text/measured.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

namespace asdic::detail {
namespace {

/// A unit: value·factor + offset is in `unit`.
struct UnitName {
  std::string_view name, unit;
  double factor = 1.0, offset = 0.0;
};

/// Short names as people type them, and the spellings of netCDF files.
constexpr auto units = std::to_array<UnitName>({
    {"m", "m"},
    {"metre", "m"},
    {"metres", "m"},
    {"meter", "m"},
    {"meters", "m"},
    {"km", "m", 1000.0},
    {"kilometre", "m", 1000.0},
    {"kilometres", "m", 1000.0},
    {"kilometer", "m", 1000.0},
    {"kilometers", "m", 1000.0},
    {"cm", "m", 0.01},
    {"mm", "m", 0.001},
    {"nmi", "m", 1852.0},
    {"ft", "m", 0.3048},
    {"feet", "m", 0.3048},
    {"s", "s"},
    {"second", "s"},
    {"seconds", "s"},
    {"ms", "s", 1e-3},
    {"us", "s", 1e-6},
    {"min", "s", 60.0},
    {"h", "s", 3600.0},
    {"Hz", "Hz"},
    {"kHz", "Hz", 1e3},
    {"MHz", "Hz", 1e6},
    {"m/s", "m/s"},
    {"m s-1", "m/s"},
    {"m s**-1", "m/s"},
    {"m s^-1", "m/s"},
    {"m.s-1", "m/s"},
    {"meters/second", "m/s"},
    {"cm/s", "m/s", 0.01},
    {"cm s-1", "m/s", 0.01},
    {"km/h", "m/s", 1.0 / 3.6},
    {"kn", "m/s", 1852.0 / 3600.0},
    {"knot", "m/s", 1852.0 / 3600.0},
    {"knots", "m/s", 1852.0 / 3600.0},
    {"ft/s", "m/s", 0.3048},
    {"deg", "degrees"},
    {"degree", "degrees"},
    {"degrees", "degrees"},
    {"degrees_north", "degrees"},
    {"degrees_east", "degrees"},
    {"rad", "radians"},
    {"dB", "dB"},
    {"dB/km", "dB/km"},
    {"Pa", "Pa"},
    {"uPa", "Pa", 1e-6},
    {"µPa", "Pa", 1e-6},
    {"kPa", "Pa", 1e3},
    {"degC", "degC"},
    {"celsius", "degC"},
    {"Celsius", "degC"},
    {"degree_Celsius", "degC"},
    {"degrees_Celsius", "degC"},
    {"degree_C", "degC"},
    {"degrees_C", "degC"},
    {"°C", "degC"},
    {"K", "degC", 1.0, -273.15},
    {"kelvin", "degC", 1.0, -273.15},
    {"psu", "psu"},
    {"PSU", "psu"},
    {"1e-3", "psu"},
    {"kg/m3", "kg/m3"},
    {"kg m-3", "kg/m3"},
    {"g/cm3", "kg/m3", 1000.0},
    {"MB", "bytes", 1e6},
    {"GB", "bytes", 1e9},
    {"TB", "bytes", 1e12},
    {"MiB", "bytes", 1048576.0},
    {"GiB", "bytes", 1073741824.0},
    {"TiB", "bytes", 1099511627776.0},
});

}  // namespace

std::optional<Measured> parse_measured(std::string_view text) {
  double value = 0.0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
  std::string_view name = text.substr(static_cast<std::size_t>(rest - text.data()));
  if (name.starts_with(' ')) name.remove_prefix(1);
  const auto* const found =
      std::find_if(units.begin(), units.end(), [&](const UnitName& u) { return u.name == name; });
  if (found == units.end()) return std::nullopt;
  return Measured{.value = value * found->factor + found->offset, .unit = found->unit};
}

bool unit_fits(std::string_view unit, std::string_view expected) {
  return expected == unit || expected.starts_with(std::string(unit) + " north") ||
         expected.starts_with(std::string(unit) + " re ");
}

}  // namespace asdic::detail
