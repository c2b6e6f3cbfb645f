#pragma once
#include <cmath>

namespace asdic::detail::support {

/// From one place of the ellipsoid of WGS 84 to another, by Vincenty's inverse formula (Survey
/// Review 23, 88, 1975): no projection is asked. \param lat1, lon1, lat2, lon2  [°]
struct Geodesic {
  double distance;  ///< [m]
  double bearing;   ///< at the first place [rad], −π to π

  Geodesic(double lat1, double lon1, double lat2, double lon2) {
    constexpr double a = 6378137.0, f = 1.0 / 298.257223563, b = a * (1.0 - f);
    const double degree = std::acos(-1.0) / 180.0;
    const double u1 = std::atan((1.0 - f) * std::tan(lat1 * degree)),
                 u2 = std::atan((1.0 - f) * std::tan(lat2 * degree));
    const double s1 = std::sin(u1), c1 = std::cos(u1), s2 = std::sin(u2), c2 = std::cos(u2);
    const double apart = (lon2 - lon1) * degree;
    double turn = apart, sine = 0.0, cosine = 1.0, sigma = 0.0, cos2 = 1.0, middle = 0.0;
    for (int i = 0; i < 20; ++i) {
      sine = std::hypot(c2 * std::sin(turn), c1 * s2 - s1 * c2 * std::cos(turn));
      cosine = s1 * s2 + c1 * c2 * std::cos(turn);
      sigma = std::atan2(sine, cosine);
      const double across = c1 * c2 * std::sin(turn) / sine;
      cos2 = 1.0 - across * across;
      middle = cos2 > 0.0 ? cosine - 2.0 * s1 * s2 / cos2 : 0.0;
      const double c = f / 16.0 * cos2 * (4.0 + f * (4.0 - 3.0 * cos2));
      turn = apart + (1.0 - c) * f * across *
                         (sigma + c * sine * (middle + c * cosine * (2.0 * middle * middle - 1.0)));
    }
    const double k = cos2 * (a * a - b * b) / (b * b);
    const double p = 1.0 + k / 16384.0 * (4096.0 + k * (-768.0 + k * (320.0 - 175.0 * k)));
    const double q = k / 1024.0 * (256.0 + k * (-128.0 + k * (74.0 - 47.0 * k)));
    const double more = q * sine * (middle + 0.25 * q * cosine * (2.0 * middle * middle - 1.0));
    distance = b * p * (sigma - more);
    bearing = std::atan2(c2 * std::sin(turn), c1 * s2 - s1 * c2 * std::cos(turn));
  }
};

}  // namespace asdic::detail::support
