#include "raytrace/area/map_frame.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail {
namespace {

// WGS 84.
constexpr double equator = 6378137.0, flattening = 1.0 / 298.257223563;
constexpr double e2 = flattening * (2.0 - flattening);
constexpr double e = 0.0818191908426215;  // √e²

/// Of an ellipsoid at a latitude φ, by sin φ [m].
struct Curvature {
  double along = 0.0, across = 0.0;  // M of the meridian, N across it

  explicit Curvature(double sine) {
    const double w2 = 1.0 - e2 * sine * sine;
    across = equator / std::sqrt(w2);
    along = across * (1.0 - e2) / w2;
  }
};

/// ψ of sin φ: equal steps of it and of longitude are equally long on the ellipsoid.
double isometric(double sine) noexcept { return std::atanh(sine) - e * std::atanh(e * sine); }

/// φ of ψ [rad]: by the conformal latitude, whose sine is tanh ψ, in a series. Snyder (3-5).
double latitude_of(double isometric_latitude) noexcept {
  constexpr double e4 = e2 * e2, e6 = e4 * e2, e8 = e4 * e4;
  constexpr double a2 = e2 / 2.0 + 5.0 * e4 / 24.0 + e6 / 12.0 + 13.0 * e8 / 360.0,
                   a4 = 7.0 * e4 / 48.0 + 29.0 * e6 / 240.0 + 811.0 * e8 / 11520.0,
                   a6 = 7.0 * e6 / 120.0 + 81.0 * e8 / 1120.0, a8 = 4279.0 * e8 / 161280.0;
  const double chi = std::asin(std::tanh(isometric_latitude));
  return chi + a2 * std::sin(2.0 * chi) + a4 * std::sin(4.0 * chi) + a6 * std::sin(6.0 * chi) +
         a8 * std::sin(8.0 * chi);
}

}  // namespace

MapFrame MapFrame::geographic(const GeographicPlace& origin) {
  MapFrame frame;
  frame.geographic_ = true;
  frame.origin_ = origin;
  const double sine = std::sin(radians(origin.latitude));
  const double cosine2 = 1.0 - sine * sine;
  const Curvature here(sine);
  frame.radius_ = std::sqrt(here.along * here.across);
  frame.stretch_ = std::sqrt(1.0 + e2 / (1.0 - e2) * cosine2 * cosine2);
  frame.sine_ = sine / frame.stretch_;
  frame.cosine_ = std::sqrt(1.0 - frame.sine_ * frame.sine_);
  frame.shift_ = std::atanh(frame.sine_) - frame.stretch_ * isometric(sine);
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
  const double distance = std::hypot(x, y), delta = distance / radius_;
  // sin χ = sin χ₀ cos δ + cos χ₀ sin δ cos θ on the sphere; the bearing of the great circle there,
  // α, has cos χ sin α = cos χ₀ sin θ.
  const bool here = distance < 1e-6;
  const double s = here ? 0.0 : x / distance, c = here ? 1.0 : y / distance;  // sin θ, cos θ
  const double sd = std::sin(delta), cd = std::cos(delta);
  const double sine = std::clamp(sine_ * cd + cosine_ * sd * c, -1.0, 1.0);
  const double cosine = std::max(std::sqrt(1.0 - sine * sine), 1e-12);
  const double turn = std::atan2(s * sd * cosine_, cd - sine_ * sine);
  const double sa = cosine_ * s / cosine, ca = (cosine_ * cd * c - sine_ * sd) / cosine;
  // A step along the great circle goes cos α north, sin α east; one across it, clockwise, is
  // shorter on the sphere than on the map by sin δ/δ.
  const double k = here ? 1.0 : sd / delta;
  const double north_x = ca * s - sa * k * c, north_y = ca * c + sa * k * s;
  const double east_x = sa * s + ca * k * c, east_y = sa * c - ca * k * s;
  const double phi =
      here ? radians(origin_.latitude) : latitude_of((std::atanh(sine) - shift_) / stretch_);
  const Curvature there(std::sin(phi));
  // A step on the sphere over the same on the ellipsoid, in any direction.
  const double scale =
      stretch_ * radius_ * cosine / (there.across * std::max(std::cos(phi), 1e-12));
  const double per_east = degrees(1.0) / (stretch_ * radius_ * cosine),
               per_north = degrees(1.0) / (scale * there.along);
  return {.u = origin_.longitude + degrees(turn) / stretch_,
          .v = degrees(phi),
          .u_x = per_east * east_x,
          .u_y = per_east * east_y,
          .v_x = per_north * north_x,
          .v_y = per_north * north_y};
}

Vec2 MapFrame::on_map(double u, double v) const noexcept {
  if (!geographic_) return {u - easting_, v - northing_};
  const double sine = std::tanh(stretch_ * isometric(std::sin(radians(v))) + shift_);
  const double cosine = std::sqrt(1.0 - sine * sine);
  const double turn = stretch_ * radians(u - origin_.longitude);
  const double east = cosine * std::sin(turn);
  const double north = cosine_ * sine - sine_ * cosine * std::cos(turn);
  const double along = sine_ * sine + cosine_ * cosine * std::cos(turn);
  const double sd = std::hypot(east, north), delta = std::atan2(sd, along);
  const double scale = sd > 0.0 ? radius_ * delta / sd : radius_;
  return {scale * east, scale * north};
}

Vec2 MapFrame::metres_per_unit(double x, double y) const noexcept {
  if (!geographic_) return {1.0, 1.0};
  const double phi = radians(on_grid(x, y).v);
  const Curvature there(std::sin(phi));
  return radians(1.0) * Vec2(there.across * std::cos(phi), there.along);
}

}  // namespace asdic::detail
