#include "core/unit_text.h"

namespace asdic::detail {

std::string unit_of(const Quantity& quantity) {
  std::string text(quantity.unit);
  if (!quantity.reference.empty()) text += " re " + std::string(quantity.reference);
  return text;
}

}  // namespace asdic::detail
