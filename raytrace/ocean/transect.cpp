#include "raytrace/ocean/transect.h"

#include <cmath>

namespace asdic::detail {

double Transect::range_of(double east, double north) const noexcept {
  return (east - x) * std::sin(bearing) + (north - y) * std::cos(bearing);
}

}  // namespace asdic::detail
