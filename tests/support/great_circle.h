#pragma once
#include <cmath>

namespace asdic::support {

/// From one place on a sphere to another, by the haversine and the formula of the inverse problem:
/// no projection is asked. \param lat1, lon1, lat2, lon2  [°]
struct GreatCircle {
  double distance;     ///< on a sphere of 6371 km [m]
  double bearing_deg;  ///< at the first place, −180 to 180
  GreatCircle(double lat1, double lon1, double lat2, double lon2) {
    const double degree = std::acos(-1.0) / 180.0;
    const double a = lat1 * degree, b = lat2 * degree, turn = (lon2 - lon1) * degree;
    const double h = std::pow(std::sin(0.5 * (b - a)), 2) +
                     std::cos(a) * std::cos(b) * std::pow(std::sin(0.5 * turn), 2);
    distance = 2.0 * 6.371e6 * std::asin(std::sqrt(h));
    bearing_deg =
        std::atan2(std::sin(turn) * std::cos(b),
                   std::cos(a) * std::sin(b) - std::sin(a) * std::cos(b) * std::cos(turn)) /
        degree;
  }
};

}  // namespace asdic::support
