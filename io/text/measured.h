#pragma once
#include <optional>
#include <string_view>

namespace asdic::detail {

/// A number with its unit as people type it: "25km", "12.5 kHz", "-3dB".
struct Measured {
  double value = 0.0;     ///< in `unit`
  std::string_view unit;  ///< that keys of a scenario have: "m", "Hz", "degrees", …
};

/// \return none for text that is not a number and a unit that is known (docs/formats/scenario.md)
[[nodiscard]] std::optional<Measured> parse_measured(std::string_view text);

/// Whether a value in a unit may stand where another is expected: "degrees" where "degrees north"
/// are, "dB" where levels re anything are.
[[nodiscard]] bool unit_fits(std::string_view unit, std::string_view expected);

}  // namespace asdic::detail
