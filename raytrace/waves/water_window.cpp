#include "raytrace/waves/water_window.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"

namespace asdic::detail {
namespace {

constexpr double least_angle = radians(4.0), airy_spreads = 6.0;
constexpr double steepest_angle = radians(50.0);
constexpr double angle_step = 1.19;      // a quarter of an octave
constexpr double least_returned = 1e-3;  // of a wave's pressure, by the water itself
// What the edges of the window hold at the furthest range, at least: 80 dB off what lies outside,
// where g falls off as slowly as between depths less than a wavelength apart.
constexpr double edge_radians = 200.0;

/// The steepest |dc/dz| [1/s].
double steepest_gradient(const Environment& ocean) {
  double gradient = 0.0;
  const auto look = [&](double depth) {
    gradient = std::max(gradient, std::abs(ocean.water.at(depth).dc_dz));
  };
  for (std::size_t i = 0; i < ocean.water.intervals(); ++i) look(ocean.water.law(i).z0);
  look(ocean.surface.depth);
  look(ocean.bottom.depth);
  return gradient;
}

}  // namespace

double WaterWindow::weight(double s) const noexcept {
  const auto rise = [](double x) { return 0.5 * std::erfc(-4.0 * (2.0 * x - 1.0)); };
  return rise((s - begin) / low_width) * rise((end - s) / high_width);
}

std::complex<double> WaterWindow::factor(std::complex<double> xi) const noexcept {
  return 0.5 * spacing * std::sqrt(2.0 / pi) * weight(xi.real()) * std::sqrt(xi);
}

/// e^{−i(ξr − π/4)}/√r. Steps are products, of no more than sixteen.
std::vector<std::complex<double>> WaterWindow::factors(double range) const {
  constexpr std::size_t products = 16;
  const auto wave = [&](std::complex<double> xi) {
    return std::exp(std::complex<double>(0.0, -1.0) * (xi * range - 0.25 * pi));
  };
  std::array<std::complex<double>, products> steps;
  for (std::size_t i = 0; i < products; ++i)
    steps[i] = std::polar(1.0 / std::sqrt(range), -double(i) * spacing * range);
  std::vector<std::complex<double>> found(count);
  for (std::size_t j = 0; j < count; j += products) {
    const std::complex<double> here = wave(at(j));
    for (std::size_t i = j; i < std::min(j + products, count); ++i) found[i] = here * steps[i - j];
  }
  return found;
}

double angle_of_spreading(const Environment& ocean, double frequency) {
  const double spread = std::cbrt(2.0 * steepest_gradient(ocean) / (2.0 * pi * frequency));
  return std::clamp(airy_spreads * spread, least_angle, steepest_angle);
}

double angle_of_the_returned(const WaveColumn& column, double most) {
  double angle = most;
  for (double next = angle / angle_step; next > least_angle / angle_step; next /= angle_step) {
    const double xi = column.smallest_wavenumber() * std::cos(std::max(next, least_angle));
    if (column.returned_by_the_water(xi) > least_returned) break;
    angle = std::max(next, least_angle);
  }
  return angle;
}

WaterWindow water_window(const WaveColumn& column, double angle, double range) {
  const double slow = column.largest_wavenumber(), fast = column.smallest_wavenumber();
  const double flat = fast * std::cos(angle), steep = fast * std::cos(1.5 * angle);
  WaterWindow w;
  const double period = column.ranges_of_a_period() * range;
  w.spacing = 2.0 * pi / period;
  w.offset = suppressed_by_a_period / period;
  w.low_width = std::max(flat - steep, edge_radians / range);
  w.high_width = std::max(0.003 * slow, edge_radians / range);
  w.begin = std::max(flat - w.low_width, 0.02 * fast);
  w.end = slow + w.high_width;
  w.count = std::size_t((w.end - w.begin) / w.spacing);
  return w;
}

}  // namespace asdic::detail
