#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "core/units.h"
#include "raytrace/ocean/environment.h"

namespace asdic::detail::support {

/// An ocean that is not layered, and a fan that suits it.
struct CurvedOcean {
  std::string name;
  Environment environment;
  double source_depth = 50.0, range = 8000.0;  ///< [m]
  double lowest = -0.5, highest = 0.5;         ///< launch elevations [rad]
  double tolerance = 2e-5;                     ///< of |q| against the tube's width
};

inline std::vector<double> samples(double from, double to, std::size_t n) {
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = from + (to - from) * double(i) / double(n - 1);
  return x;
}

inline BoundaryShape ridge(ShapeInterpolation interpolation, std::size_t nodes = 41) {
  const auto r = samples(-2000.0, 14000.0, nodes);
  std::vector<double> z;
  for (const double x : r)
    z.push_back(900.0 - 450.0 * std::exp(-std::pow((x - 5000.0) / 2500.0, 2)));
  return {r, z, interpolation};
}

inline BoundaryShape swell(ShapeInterpolation interpolation, std::size_t nodes = 801) {
  const auto r = samples(-1000.0, 9000.0, nodes);
  std::vector<double> z;
  for (const double x : r) z.push_back(2.0 * std::sin(2.0 * pi * x / 500.0));
  return {r, z, interpolation};
}

/// Slopes, curved boundaries, knots and fronts, one of each and all together.
inline std::vector<CurvedOcean> curved_oceans() {
  const std::vector<double> z = {-10, 60, 150, 300, 500, 950};
  const std::vector<double> c = {1520, 1518, 1505, 1496, 1494, 1499};
  const std::vector<double> r = {-3000, 0, 2500, 5000, 9000};
  std::vector<double> section;
  for (const double x : r)
    for (std::size_t j = 0; j < z.size(); ++j)
      section.push_back(c[j] + 6.0 * std::tanh(x / 4000.0) * std::exp(-z[j] / 200.0));
  Environment flat;
  flat.water = SoundSpeedProfile::table(z, c, Interpolation::c_linear);
  flat.bottom = {.depth = 900.0, .material = Rigid{}};

  std::vector<CurvedOcean> all;
  Environment e = flat;
  all.push_back({"flat", e});
  e.bottom.shape = BoundaryShape(std::vector{0.0, 12000.0}, std::vector{900.0, 300.0},
                                 ShapeInterpolation::piecewise_linear);
  all.push_back({"wedge", e});
  e.bottom.shape = ridge(ShapeInterpolation::smooth);
  all.push_back({"smooth ridge", e});
  e.bottom.shape = ridge(ShapeInterpolation::piecewise_linear);
  all.push_back({"faceted ridge", e});
  e = flat;
  e.surface.shape = swell(ShapeInterpolation::smooth);
  all.push_back({"swell", e, 100.0, 3000.0});
  e = flat;
  e.section = SoundSpeedSection(r, z, section);
  all.push_back({"front", e});
  e.bottom.shape = ridge(ShapeInterpolation::smooth);
  all.push_back({"front over a ridge", e});
  e.section.reset();
  for (const auto law : {Interpolation::n2_linear, Interpolation::pchip, Interpolation::spline}) {
    e.water = SoundSpeedProfile::table(z, c, law);
    all.push_back({"ridge under " + std::string(name(law)), e});
  }
  return all;
}

}  // namespace asdic::detail::support
