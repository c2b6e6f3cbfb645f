#include "raytrace/tracing/ocean.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail {
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

namespace tracing {

Wall::Wall(const Boundary& boundary, BoundaryKind kind) {
  if (!boundary.shape) return;
  const BoundaryShape& shape = *boundary.shape;
  straight = shape.interpolation() != ShapeInterpolation::smooth;
  const bool above = kind == BoundaryKind::surface;
  for (std::size_t i = 0; i < shape.facets(); ++i) {
    const bool inner = i > 0 && i + 1 < shape.facets();
    const double begin = inner || i > 0 ? shape.facet_begin(i) : shape.facet_end(i);
    const double end = inner ? shape.facet_end(i) : begin;
    const double z0 = shape.depth_at(begin, i), z1 = shape.depth_at(end, i);
    const double slope = inner ? (z1 - z0) / (end - begin) : 0.0;
    const double unit = (above ? 1.0 : -1.0) / std::sqrt(1.0 + slope * slope);
    double high = std::min(z0, z1), low = std::max(z0, z1);
    if (!straight && inner) {  // a cubic stays among its control points
      const double third = (end - begin) / 3.0;
      const double a = z0 + third * shape.at(begin, i).slope;
      const double b = z1 - third * shape.at(end, i).slope;
      high = std::min({high, a, b});
      low = std::max({low, a, b});
      for (const double rise : {a - z0, b - a, z1 - b})  // and its slope among theirs
        steepest = std::max(steepest, std::abs(rise) / third);
    }
    steepest = std::max(steepest, std::abs(slope));
    facets.push_back({.begin = shape.facet_begin(i),
                      .end = shape.facet_end(i),
                      .extreme = above ? low : high,
                      .slope = slope,
                      .line = {.range = begin, .depth = z0, .nr = -slope * unit, .nz = unit}});
  }
}

}  // namespace tracing

RayTracer::Ocean::Ocean(const Environment& given, double at_frequency, Reflection how)
    : environment(given),
      frequency(at_frequency),
      reflection(how),
      surface(environment.surface, BoundaryKind::surface),
      bottom(environment.bottom, BoundaryKind::bottom) {
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
    if (environment.surface.shape)
      row.near_surface = row.top < environment.surface.shape->deepest();
    if (environment.bottom.shape)
      row.near_bottom = row.bottom > environment.bottom.shape->shallowest();
    rows.push_back(row);
  }
  if (environment.section) columns = environment.section->ranges().size() + 1;
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < columns; ++j) cells.push_back(make_cell(i, j));
}

tracing::Cell RayTracer::Ocean::make_cell(std::size_t row, std::size_t column) const noexcept {
  using tracing::Law;
  tracing::Cell cell{.row = &rows[row]};
  const std::size_t j = cell.row->interval;
  if (environment.section) {
    const SoundSpeedSection& section = *environment.section;
    const auto depths = section.depths(), ranges = section.ranges();
    const std::size_t n = depths.size(), last = ranges.size() - 1;
    const std::size_t left = column == 0 ? 0 : column - 1;
    const double height = depths[j + 1] - depths[j];
    const auto speed = [&](std::size_t i, std::size_t k) { return section.speeds()[i * n + k]; };
    cell.z0 = depths[j];
    cell.a[0] = speed(left, j);
    cell.a[1] = (speed(left, j + 1) - speed(left, j)) / height;
    if (column == 0 || column > last) return cell;
    const double slope = (speed(column, j + 1) - speed(column, j)) / height;
    const double width = ranges[column] - ranges[left];
    cell.law = Law::bilinear;
    cell.r0 = ranges[left];
    cell.b = {(speed(column, j) - speed(left, j)) / width, (slope - cell.a[1]) / width};
    return cell;
  }
  const SoundSpeedProfile& water = environment.water;
  if (water.munk_parameters()) {
    cell.law = Law::munk;
    cell.munk = &*water.munk_parameters();
    return cell;
  }
  const IntervalLaw& law = water.law(j);
  cell.z0 = law.z0;
  cell.a = law.a;
  if (water.interpolation() == Interpolation::n2_linear)
    cell.law = Law::parabola;
  else if (law.a[2] != 0.0 || law.a[3] != 0.0)
    cell.law = Law::cubic;
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

}  // namespace asdic::detail
