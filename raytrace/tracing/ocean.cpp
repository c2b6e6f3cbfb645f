#include "raytrace/tracing/ocean.h"

#include <algorithm>
#include <cmath>

namespace asdic {
namespace {

constexpr double outside = 1e30;    // depth of the outer rows' far ends
constexpr double same_line = 1e-7;  // lines closer than this are one [m]

/// Every depth at which something changes, in order. Boundaries come first, so that a sample within
/// rounding of one does not displace it.
std::vector<double> lines_of(const Environment& ocean, const DepthFunction& alpha) {
  std::vector<double> lines = {-outside, outside};
  const auto add = [&](double depth) {
    if (std::none_of(lines.begin(), lines.end(),
                     [&](double line) { return std::abs(line - depth) < same_line; }))
      lines.push_back(depth);
  };
  for (const Boundary* boundary : {&ocean.surface, &ocean.bottom}) {
    if (boundary->shape) {
      add(boundary->shape->shallowest());
      add(boundary->shape->deepest());
    } else {
      add(boundary->depth);
    }
  }
  const auto water = ocean.section ? ocean.section->depths() : ocean.water.depths();
  for (const double depth : water) add(depth);
  for (const double depth : alpha.depths()) add(depth);
  std::sort(lines.begin(), lines.end());
  return lines;
}

}  // namespace

RayTracer::Ocean::Ocean(const Environment& given, double at_frequency, Reflection how)
    : environment(given), frequency(at_frequency), reflection(how) {
  const DepthFunction alpha = attenuation_np_per_m(environment, frequency);
  const std::vector<double> lines = lines_of(environment, alpha);
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
    tracing::Row row;
    row.top = lines[i];
    row.bottom = lines[i + 1];
    const bool first = i == 0, last = i + 2 == lines.size();
    const double inside = first  ? row.bottom - 1.0
                          : last ? row.top + 1.0
                                 : 0.5 * (row.top + row.bottom);
    if (environment.section)
      row.interval = environment.section->cell(0.0, inside).row;
    else if (!environment.water.munk_parameters())
      row.interval = environment.water.interval(inside);
    // α is straight within a row; a row's own ends may be steps, so it is read off inside
    if (first || last || alpha.is_constant()) {
      row.alpha_top = alpha.at(inside);
    } else {
      const double d = 0.25 * (row.bottom - row.top);
      row.alpha_slope = (alpha.at(inside + d) - alpha.at(inside - d)) / (2.0 * d);
      row.alpha_top = alpha.at(inside) - row.alpha_slope * inside;
    }
    rows.push_back(row);
  }
}

tracing::Cell RayTracer::Ocean::cell(std::size_t row, std::size_t column) const noexcept {
  using tracing::Law;
  tracing::Cell cell{.ocean = &environment, .row = &rows[row], .column = column};
  if (environment.section) {
    const bool uniform = column == 0 || column == environment.section->ranges().size();
    cell.law = uniform ? Law::arc : Law::general;
  } else if (!environment.water.munk_parameters()) {
    if (environment.water.interpolation() == Interpolation::c_linear ||
        environment.water.depths().size() == 1)
      cell.law = Law::arc;
    else if (environment.water.interpolation() == Interpolation::n2_linear)
      cell.law = Law::parabola;
  }
  return cell;
}

std::size_t RayTracer::Ocean::row(double depth) const noexcept {
  const auto above =
      std::upper_bound(rows.begin(), rows.end(), depth,
                       [](double z, const tracing::Row& row) { return z < row.top; });
  return above == rows.begin() ? 0 : std::size_t(above - rows.begin()) - 1;
}

std::size_t RayTracer::Ocean::column(double range) const noexcept {
  return environment.section ? environment.section->cell(range, 0.0).column : 0;
}

double RayTracer::Ocean::column_begin(std::size_t column) const noexcept {
  if (!environment.section || column == 0) return -1e300;
  return environment.section->ranges()[column - 1];
}

double RayTracer::Ocean::column_end(std::size_t column) const noexcept {
  if (!environment.section || column == environment.section->ranges().size()) return 1e300;
  return environment.section->ranges()[column];
}

}  // namespace asdic
