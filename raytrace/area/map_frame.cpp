#include "raytrace/area/map_frame.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail {

MapFrame MapFrame::geographic(const GeographicPlace& origin) {
  MapFrame frame;
  frame.geographic_ = true;
  frame.origin_ = origin;
  frame.sine_ = std::sin(radians(origin.latitude));
  frame.cosine_ = std::cos(radians(origin.latitude));
  return frame;
}

MapFrame MapFrame::projected(double easting, double northing) {
  MapFrame frame;
  frame.easting_ = easting;
  frame.northing_ = northing;
  return frame;
}

MapFrame::OnGrid MapFrame::on_grid(double x, double y) const noexcept {
  if (!geographic_) return {.u = x + easting_, .v = y + northing_};
  const double distance = std::hypot(x, y), delta = distance / earth_radius;
  const double per_degree = degrees(1.0) / earth_radius;  // degrees of latitude in a metre
  if (distance < 1e-6)
    return {.u = origin_.longitude,
            .v = origin_.latitude,
            .u_x = per_degree / cosine_,
            .v_y = per_degree};
  // sin φ = sin φ₀ cos δ + cos φ₀ sin δ cos θ; the bearing of the great circle there, α, has
  // cos φ sin α = cos φ₀ sin θ.
  const double s = x / distance, c = y / distance;  // sin θ, cos θ
  const double sd = std::sin(delta), cd = std::cos(delta);
  const double sine = std::clamp(sine_ * cd + cosine_ * sd * c, -1.0, 1.0);
  const double cosine = std::max(std::sqrt(1.0 - sine * sine), 1e-12);
  const double turn = std::atan2(s * sd * cosine_, cd - sine_ * sine);
  const double sa = cosine_ * s / cosine, ca = (cosine_ * cd * c - sine_ * sd) / cosine;
  // A step along the great circle goes cos α north, sin α east; one across it, clockwise, is
  // shorter on the Earth than on the map by sin δ/δ.
  const double k = sd / delta;
  const double north_x = ca * s - sa * k * c, north_y = ca * c + sa * k * s;
  const double east_x = sa * s + ca * k * c, east_y = sa * c - ca * k * s;
  return {.u = origin_.longitude + degrees(turn),
          .v = degrees(std::asin(sine)),
          .u_x = per_degree * east_x / cosine,
          .u_y = per_degree * east_y / cosine,
          .v_x = per_degree * north_x,
          .v_y = per_degree * north_y};
}

Vec2 MapFrame::on_map(double u, double v) const noexcept {
  if (!geographic_) return {u - easting_, v - northing_};
  const double sine = std::sin(radians(v)), cosine = std::cos(radians(v));
  const double turn = radians(u - origin_.longitude);
  const double east = cosine * std::sin(turn);
  const double north = cosine_ * sine - sine_ * cosine * std::cos(turn);
  const double along = sine_ * sine + cosine_ * cosine * std::cos(turn);
  const double sd = std::hypot(east, north), delta = std::atan2(sd, along);
  const double scale = sd > 0.0 ? earth_radius * delta / sd : earth_radius;
  return {scale * east, scale * north};
}

Vec2 MapFrame::metres_per_unit(double x, double y) const noexcept {
  if (!geographic_) return {1.0, 1.0};
  const double a_degree = earth_radius * radians(1.0);
  return {a_degree * std::cos(radians(on_grid(x, y).v)), a_degree};
}

}  // namespace asdic::detail
