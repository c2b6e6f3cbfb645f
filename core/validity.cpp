#include "core/validity.h"

#include <array>
#include <cstdio>

namespace asdic::detail {
namespace {

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.7g", value);
  return text.data();
}

/// "5 Hz" or "5 to 9 Hz"
std::string values(double low, double high, std::string_view unit) {
  const std::string ends = low == high ? number(low) : number(low) + " to " + number(high);
  return unit.empty() ? ends : ends + ' ' + std::string(unit);
}

}  // namespace

std::string outside(const Validity& validity, std::span<const Asked> asked) {
  for (const ValidRange& range : validity.ranges)
    for (const Asked& one : asked) {
      if (one.quantity != range.quantity || (one.low >= range.low && one.high <= range.high))
        continue;
      return std::string(one.quantity) + ' ' + values(one.low, one.high, range.unit) +
             " is outside of " + values(range.low, range.high, range.unit) + ", where " +
             std::string(validity.law) + " holds (" + std::string(validity.source) + ")";
    }
  return "";
}

}  // namespace asdic::detail
