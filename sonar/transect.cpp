#include "sonar/transect.h"

#include <cmath>

#include "raytrace/ocean/slice.h"

namespace asdic {

double Transect::range_of(double east, double north) const noexcept {
  return (east - x) * std::sin(bearing) + (north - y) * std::cos(bearing);
}

Environment ocean_along(const Environment& ocean, const Transect& transect, double east,
                        double north, double bearing) {
  return slice(ocean, transect.range_of(east, north), std::cos(bearing - transect.bearing));
}

}  // namespace asdic
