#pragma once
#include <string>
#include <string_view>

#include "core/units.h"

namespace asdic::detail {

/// What a number must be: "a speed above 0 m/s".
struct Quantity {
  std::string_view noun = "number";
  std::string_view unit = "";
  double low = -infinity;
  double high = infinity;
  bool above = false;               ///< `low` itself is not allowed
  bool or_zero = false;             ///< 0 is allowed, too, although `low` is above 0
  std::string_view reference = "";  ///< of a level: "1 µPa at 1 m"

  [[nodiscard]] bool holds(double value) const;
  [[nodiscard]] std::string expected() const;
};

/// What an angle must be. The program has radians; people write degrees.
struct AngleQuantity {
  std::string_view noun;
  double low_deg, high_deg;
  bool above = false;  ///< `low_deg` itself is not allowed

  [[nodiscard]] constexpr Quantity in_degrees() const {
    return {.noun = noun, .unit = "degrees", .low = low_deg, .high = high_deg, .above = above};
  }
  [[nodiscard]] constexpr Quantity in_radians() const {
    return {.noun = noun,
            .unit = "radians",
            .low = radians(low_deg),
            .high = radians(high_deg),
            .above = above};
  }
};

}  // namespace asdic::detail
