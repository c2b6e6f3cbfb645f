#include "io/text/measured.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

namespace asdic::detail {
namespace {

struct UnitName {
  std::string_view name, unit;
  double factor;
};

constexpr std::array<UnitName, 30> units{{
    {"m", "m", 1.0},
    {"km", "m", 1000.0},
    {"cm", "m", 0.01},
    {"mm", "m", 0.001},
    {"nmi", "m", 1852.0},
    {"s", "s", 1.0},
    {"ms", "s", 1e-3},
    {"us", "s", 1e-6},
    {"min", "s", 60.0},
    {"h", "s", 3600.0},
    {"Hz", "Hz", 1.0},
    {"kHz", "Hz", 1e3},
    {"MHz", "Hz", 1e6},
    {"m/s", "m/s", 1.0},
    {"km/h", "m/s", 1.0 / 3.6},
    {"kn", "m/s", 1852.0 / 3600.0},
    {"deg", "degrees", 1.0},
    {"rad", "radians", 1.0},
    {"dB", "dB", 1.0},
    {"dB/km", "dB/km", 1.0},
    {"degC", "degC", 1.0},
    {"psu", "psu", 1.0},
    {"kg/m3", "kg/m3", 1.0},
    {"g/cm3", "kg/m3", 1000.0},
    {"MB", "bytes", 1e6},
    {"GB", "bytes", 1e9},
    {"TB", "bytes", 1e12},
    {"MiB", "bytes", 1048576.0},
    {"GiB", "bytes", 1073741824.0},
    {"TiB", "bytes", 1099511627776.0},
}};

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
  return Measured{.value = value * found->factor, .unit = found->unit};
}

bool unit_fits(std::string_view unit, std::string_view expected) {
  return expected == unit || expected.starts_with(std::string(unit) + " north") ||
         expected.starts_with(std::string(unit) + " re ");
}

}  // namespace asdic::detail
