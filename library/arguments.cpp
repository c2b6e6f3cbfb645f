#include "library/arguments.h"

#include "asdic/error.h"
#include "core/text.h"

namespace asdic {

void require(const std::string& argument, double value, const detail::Quantity& must) {
  if (must.holds(value)) return;
  const std::string unit = must.unit.empty() ? "" : " " + std::string(must.unit);
  throw InputError(argument, detail::to_text(value) + unit, must.expected());
}

void require(const std::string& argument, const std::optional<double>& value,
             const detail::Quantity& must) {
  if (value) require(argument, *value, must);
}

void require(const std::string& argument, int value, int low, int high) {
  if (value < low || value > high)
    throw InputError(argument, std::to_string(value),
                     "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
}

}  // namespace asdic
