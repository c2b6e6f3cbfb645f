#include "study/summary/error_ellipse.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "study/plan/no_value.h"

namespace asdic::detail::study {
namespace {

/// r√λ·e^{±½zσ_λ/λ}.
Interval axis_interval(double axis, double eigenvalue, double fourth, double n, double z) {
  if (!(eigenvalue > 0.0)) return {no_value, no_value};
  const double error = std::sqrt(std::max(0.0, fourth - eigenvalue * eigenvalue) / n) / eigenvalue;
  return {axis * std::exp(-0.5 * z * error), axis * std::exp(0.5 * z * error)};
}

}  // namespace

ErrorEllipse error_ellipse(std::span<const double> x, std::span<const double> y,
                           double confidence) {
  const double n = static_cast<double>(x.size());
  const Interval none{no_value, no_value};
  ErrorEllipse made{n,    no_value, no_value, none,     none,     no_value, no_value,
                    none, none,     no_value, no_value, no_value, no_value};
  if (x.size() < 3) return made;
  Moments of_x, of_y;
  double squares = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    of_x.add(x[i]);
    of_y.add(y[i]);
    squares += x[i] * x[i] + y[i] * y[i];
  }
  made.rms = std::sqrt(squares / n);
  made.mean_x = of_x.mean();
  made.mean_y = of_y.mean();
  made.mean_x_interval = of_x.mean_interval(confidence);
  made.mean_y_interval = of_y.mean_interval(confidence);
  double product = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) product += (x[i] - made.mean_x) * (y[i] - made.mean_y);
  const double xx = of_x.deviation() * of_x.deviation(), yy = of_y.deviation() * of_y.deviation();
  const double xy = product / (n - 1.0);
  const double half = 0.5 * (xx + yy), root = std::hypot(0.5 * (yy - xx), xy);
  const double first = half + root, second = std::max(0.0, half - root);
  // Of the axis (sin θ, cos θ): tan 2θ = 2xy/(yy − xx).
  const double turn = 0.5 * std::atan2(2.0 * xy, yy - xx);
  made.bearing = turn < 0.0 ? turn + pi : turn;
  const double squared_radius =
      (n * n - 1.0) / n * std::expm1(-2.0 / (n - 2.0) * std::log1p(-confidence));
  made.major = std::sqrt(squared_radius * first);
  made.minor = std::sqrt(squared_radius * second);
  double fourth_u = 0.0, fourth_v = 0.0, mixed = 0.0, inside = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = x[i] - made.mean_x, dy = y[i] - made.mean_y;
    const double u = dx * std::sin(turn) + dy * std::cos(turn);
    const double v = dx * std::cos(turn) - dy * std::sin(turn);
    fourth_u += u * u * u * u / n;
    fourth_v += v * v * v * v / n;
    mixed += u * u * v * v / n;
    const double distance =
        (first > 0.0 ? u * u / first : 0.0) + (second > 0.0 ? v * v / second : 0.0);
    if (distance <= squared_radius) inside += 1.0;
  }
  const double z = two_sided(confidence);
  made.major_interval = axis_interval(made.major, first, fourth_u, n, z);
  made.minor_interval = axis_interval(made.minor, second, fourth_v, n, z);
  made.bearing_half =
      root > 0.0 ? std::min(0.5 * pi, z * std::sqrt(mixed / n) / (first - second)) : 0.5 * pi;
  made.inside = inside / n;
  return made;
}

}  // namespace asdic::detail::study
