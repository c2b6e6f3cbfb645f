#include "io/bellhop/finite_field.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"

namespace asdic::detail {

void require_finite(std::span<const std::complex<float>> pressure) {
  const auto count = std::count_if(pressure.begin(), pressure.end(), [](std::complex<float> p) {
    return !std::isfinite(p.real()) || !std::isfinite(p.imag());
  });
  if (count > 0)
    throw RunError("the field is not a finite number at " + std::to_string(count) + " of " +
                   std::to_string(pressure.size()) + " receivers; no file of it was written");
}

}  // namespace asdic::detail
