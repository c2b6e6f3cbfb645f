#include "core/quantity.h"

#include <cmath>

#include "core/text.h"

namespace asdic::detail {
bool Quantity::holds(double value) const {
  if (or_zero && value == 0.0) return true;
  return std::isfinite(value) && (above ? value > low : value >= low) && value <= high;
}

std::string Quantity::expected() const {
  const bool has_low = std::isfinite(low), has_high = std::isfinite(high);
  std::string text = has_low || has_high ? with_article(noun) : "a finite " + std::string(noun);
  if (has_low && has_high) {
    text += above ? " above " : or_zero ? " of 0, or from " : " from ";
    text += to_text(low) + (above ? " and at most " : " to ") + to_text(high);
  } else if (has_low) {
    text += (above ? " above " : " of at least ") + to_text(low);
  } else if (has_high) {
    text += " of at most " + to_text(high);
  }
  if (!unit.empty()) {
    text += has_low || has_high ? " " : " in ";
    text += unit;
  }
  return text;
}

}  // namespace asdic::detail
