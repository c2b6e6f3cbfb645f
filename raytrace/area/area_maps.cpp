#include "raytrace/area/area_maps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/text.h"

namespace asdic::detail {
namespace {

/// "31.502 N -65.49 E", or "1200 m east, 300 m north".
std::string place_text(const MapFrame& frame, double u, double v) {
  if (!frame.is_geographic()) {
    const Vec2 place = frame.on_map(u, v);
    return to_text(std::round(place.x())) + " m east, " + to_text(std::round(place.y())) +
           " m north";
  }
  const auto rounded = [](double degree) { return to_text(std::round(1e4 * degree) / 1e4); };
  return rounded(v) + " N " + rounded(u) + " E";
}

/// Longitudes of a grid that begins elsewhere.
double on_axis(const MapFrame& frame, const MapAxis& axis, double u) noexcept {
  if (!frame.is_geographic()) return u;
  const double middle = 0.5 * (axis.begin() + axis.end());
  return middle + std::remainder(u - middle, 360.0);
}

bool covers(const MapGrid& grid, const MapFrame& frame, double x, double y) noexcept {
  const MapFrame::OnGrid place = frame.on_grid(x, y);
  const double u = on_axis(frame, grid.x(), place.u);
  // Half a step beyond the outer places: grids hold the middles of their cells.
  const double half_u = 0.5 * grid.x().mean_spacing(), half_v = 0.5 * grid.y().mean_spacing();
  return u >= grid.x().begin() - half_u && u <= grid.x().end() + half_u &&
         place.v >= grid.y().begin() - half_v && place.v <= grid.y().end() + half_v;
}

double spacing_of(const MapGrid& grid, const MapFrame& frame, double x, double y) noexcept {
  const Vec2 scale = frame.metres_per_unit(x, y);
  return std::min(grid.x().mean_spacing() * scale.x(), grid.y().mean_spacing() * scale.y());
}

/// Derivatives along the axes of a grid.
struct OnAxes {
  double value = 0.0, u = 0.0, v = 0.0, uu = 0.0, uv = 0.0, vv = 0.0;
};

/// The same along x and y. What the axes themselves bend on the map is left out: tan φ/R, 10⁻⁷ of
/// the slope a metre.
MapValue on_map(const OnAxes& f, const MapFrame::OnGrid& p) noexcept {
  return {
      .value = f.value,
      .x = f.u * p.u_x + f.v * p.v_x,
      .y = f.u * p.u_y + f.v * p.v_y,
      .xx = f.uu * p.u_x * p.u_x + 2.0 * f.uv * p.u_x * p.v_x + f.vv * p.v_x * p.v_x,
      .xy = f.uu * p.u_x * p.u_y + f.uv * (p.u_x * p.v_y + p.u_y * p.v_x) + f.vv * p.v_x * p.v_y,
      .yy = f.uu * p.u_y * p.u_y + 2.0 * f.uv * p.u_y * p.v_y + f.vv * p.v_y * p.v_y};
}

[[noreturn]] void throw_hole(const std::string& name, const MapFrame& frame, double u, double v,
                             const std::string& expected) {
  throw InputError(
      {.where = name + " at " + place_text(frame, u, v), .got = "no value", .expected = expected});
}

}  // namespace

ScalarMap::ScalarMap(std::shared_ptr<const MapGrid> grid, MapFrame frame,
                     MapInterpolation interpolation, double sign, MapOrigin origin, double more)
    : grid_(std::move(grid)),
      frame_(frame),
      interpolation_(interpolation),
      sign_(sign),
      more_(more),
      origin_(std::move(origin)) {}

bool ScalarMap::covers(double x, double y) const noexcept {
  return asdic::detail::covers(*grid_, frame_, x, y);
}

double ScalarMap::spacing(double x, double y) const noexcept {
  return spacing_of(*grid_, frame_, x, y);
}

void ScalarMap::check(double value, double u, double v) const {
  if (std::isnan(value))
    throw_hole(
        origin_.name, frame_, u, v,
        "a value everywhere that sound is followed to: a shorter reach, another file, or one "
        "by asdic ocean --area with a second --bathymetry on the same grid, which fills "
        "holes");
}

MapValue ScalarMap::at(double x, double y) const {
  MapFrame::OnGrid place = frame_.on_grid(x, y);
  place.u = on_axis(frame_, grid_->x(), place.u);
  return interpolation_ == MapInterpolation::bicubic ? bicubic(place) : faceted(place);
}

MapValue ScalarMap::bicubic(const MapFrame::OnGrid& place) const {
  const MapAxis::Cubic a = grid_->x().cubic(place.u), b = grid_->y().cubic(place.v);
  OnAxes f;
  for (std::size_t j = 0; j < 4; ++j) {
    double value = 0.0, slope = 0.0, bend = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double z = double(*grid_->at(a.index[i], b.index[j]));
      value += a.value[i] * z;
      slope += a.slope[i] * z;
      bend += a.bend[i] * z;
    }
    f.value += b.value[j] * value;
    f.u += b.value[j] * slope;
    f.uu += b.value[j] * bend;
    f.v += b.slope[j] * value;
    f.uv += b.slope[j] * slope;
    f.vv += b.bend[j] * value;
  }
  check(f.value, place.u, place.v);
  f = {sign_ * f.value + more_, sign_ * f.u, sign_ * f.v, sign_ * f.uu, sign_ * f.uv, sign_ * f.vv};
  return on_map(f, place);
}

MapValue ScalarMap::faceted(const MapFrame::OnGrid& place) const {
  const MapAxis &x = grid_->x(), &y = grid_->y();
  const double u = std::clamp(place.u, x.begin(), x.end()),
               v = std::clamp(place.v, y.begin(), y.end());
  const std::size_t i = x.interval(u), j = y.interval(v);
  const double width = x.places()[i + 1] - x.places()[i],
               height = y.places()[j + 1] - y.places()[j];
  const double s = (u - x.places()[i]) / width, t = (v - y.places()[j]) / height;
  const auto z = [&](std::size_t p, std::size_t q) { return double(*grid_->at(i + p, j + q)); };
  // Below the diagonal the corners (0,0), (1,0), (1,1); above it (0,0), (0,1), (1,1).
  const double along = s >= t ? z(1, 0) - z(0, 0) : z(1, 1) - z(0, 1);
  const double across = s >= t ? z(1, 1) - z(1, 0) : z(0, 1) - z(0, 0);
  OnAxes f{.value = sign_ * (z(0, 0) + s * along + t * across) + more_,
           .u = u == place.u ? sign_ * along / width : 0.0,
           .v = v == place.v ? sign_ * across / height : 0.0};
  check(f.value, place.u, place.v);
  return on_map(f, place);
}

double ScalarMap::least_within(const Vec2& low, const Vec2& high) const {
  const MapAxis &across = grid_->x(), &up = grid_->y();
  double u0 = infinity, u1 = -infinity, v0 = infinity, v1 = -infinity;
  for (const double s : {0.0, 0.5, 1.0})
    for (const double t : {0.0, 0.5, 1.0}) {
      const MapFrame::OnGrid place =
          frame_.on_grid(std::lerp(low.x(), high.x(), s), std::lerp(low.y(), high.y(), t));
      const double u = on_axis(frame_, across, place.u);
      u0 = std::min(u0, u);
      u1 = std::max(u1, u);
      v0 = std::min(v0, place.v);
      v1 = std::max(v1, place.v);
    }
  if (frame_.is_geographic() && u1 - u0 > 90.0) return -infinity;
  // On a sphere the sides of a box bend between the places that were looked at: a cell more.
  const std::size_t more = frame_.is_geographic() ? 1 : 0;
  const auto first = [&](const MapAxis& axis, double at) {
    const std::size_t i = axis.interval(at);
    return i - std::min(i, more);
  };
  const auto last = [&](const MapAxis& axis, double at) {
    return std::min(axis.interval(at) + 1 + more, axis.size() - 1);
  };
  MapGrid::Window nodes{.column = first(across, u0), .row = first(up, v0)};
  nodes.columns = last(across, u1) - nodes.column + 1;
  nodes.rows = last(up, v1) - nodes.row + 1;
  constexpr std::size_t too_many = 1 << 16;
  if (nodes.columns * nodes.rows > too_many) return -infinity;
  double least = infinity;
  if (interpolation_ == MapInterpolation::faceted) {
    for (std::size_t j = nodes.row; j < nodes.row + nodes.rows; ++j)
      for (std::size_t i = nodes.column; i < nodes.column + nodes.columns; ++i) {
        const double value = sign_ * double(*grid_->at(i, j)) + more_;
        if (std::isnan(value)) return -infinity;
        least = std::min(least, value);
      }
    return least;
  }
  return least_of_cubics(nodes) + more_;
}

/// The least control point of the cells' bicubics between some nodes, which hold all their values:
/// f + δu·f_u + δv·f_v + δu·δv·f_uv at every node, δ a third of the way to either neighbour, and 0.
double ScalarMap::least_of_cubics(const MapGrid::Window& nodes) const {
  const MapAxis &across = grid_->x(), &up = grid_->y();
  const auto thirds = [](const MapAxis& axis, std::size_t k) {
    const auto places = axis.places();
    return std::array{k > 0 ? (places[k - 1] - places[k]) / 3.0 : 0.0, 0.0,
                      k + 1 < places.size() ? (places[k + 1] - places[k]) / 3.0 : 0.0};
  };
  double least = infinity;
  for (std::size_t j = nodes.row; j < nodes.row + nodes.rows; ++j) {
    const MapAxis::Cubic b = up.cubic(up.places()[j]);
    const auto rise = thirds(up, j);
    for (std::size_t i = nodes.column; i < nodes.column + nodes.columns; ++i) {
      const MapAxis::Cubic a = across.cubic(across.places()[i]);
      double u = 0.0, v = 0.0, uv = 0.0;
      for (std::size_t m = 0; m < 4; ++m) {
        u += a.slope[m] * double(*grid_->at(a.index[m], j));
        v += b.slope[m] * double(*grid_->at(i, b.index[m]));
        for (std::size_t n = 0; n < 4; ++n)
          uv += a.slope[m] * b.slope[n] * double(*grid_->at(a.index[m], b.index[n]));
      }
      const double f = double(*grid_->at(i, j));
      for (const double du : thirds(across, i))
        for (const double dv : rise) {
          const double value = sign_ * (f + du * u + dv * v + du * dv * uv);
          if (std::isnan(value)) return -infinity;
          least = std::min(least, value);
        }
    }
  }
  return least;
}

std::size_t ScalarMap::facet(double x, double y) const noexcept {
  const MapFrame::OnGrid place = frame_.on_grid(x, y);
  const MapAxis &across = grid_->x(), &up = grid_->y();
  const double u = std::clamp(on_axis(frame_, across, place.u), across.begin(), across.end()),
               v = std::clamp(place.v, up.begin(), up.end());
  const std::size_t i = across.interval(u), j = up.interval(v);
  const double s = (u - across.places()[i]) / (across.places()[i + 1] - across.places()[i]),
               t = (v - up.places()[j]) / (up.places()[j + 1] - up.places()[j]);
  return 2 * (j * across.size() + i) + (s >= t ? 0 : 1);
}

WaterMap::WaterMap(std::shared_ptr<const MapGrid> grid, MapFrame frame, std::vector<double> depths,
                   MapOrigin origin)
    : grid_(std::move(grid)),
      frame_(frame),
      depths_("depth", std::move(depths)),
      origin_(std::move(origin)) {}

bool WaterMap::covers(double x, double y) const noexcept {
  return asdic::detail::covers(*grid_, frame_, x, y);
}

double WaterMap::spacing(double x, double y) const noexcept {
  return spacing_of(*grid_, frame_, x, y);
}

SoundSpeed3D WaterMap::at(double x, double y, double z) const {
  MapFrame::OnGrid place = frame_.on_grid(x, y);
  place.u = on_axis(frame_, grid_->x(), place.u);
  const MapAxis::Cubic a = grid_->x().cubic(place.u), b = grid_->y().cubic(place.v),
                       d = depths_.cubic_going_on(z);
  OnAxes c, c_z;
  double c_zz = 0.0;
  for (std::size_t j = 0; j < 4; ++j) {
    for (std::size_t i = 0; i < 4; ++i) {
      const float* speeds = grid_->at(a.index[i], b.index[j]);
      double value = 0.0, slope = 0.0, bend = 0.0;
      for (std::size_t k = 0; k < 4; ++k) {
        const double speed = double(speeds[d.index[k]]);
        value += d.value[k] * speed;
        slope += d.slope[k] * speed;
        bend += d.bend[k] * speed;
      }
      const double w = a.value[i] * b.value[j], w_u = a.slope[i] * b.value[j],
                   w_v = a.value[i] * b.slope[j];
      c.value += w * value;
      c.u += w_u * value;
      c.v += w_v * value;
      c.uu += a.bend[i] * b.value[j] * value;
      c.uv += a.slope[i] * b.slope[j] * value;
      c.vv += a.value[i] * b.bend[j] * value;
      c_z.value += w * slope;
      c_z.u += w_u * slope;
      c_z.v += w_v * slope;
      c_zz += w * bend;
    }
  }
  if (std::isnan(c.value))
    throw_hole(origin_.name, frame_, place.u, place.v, "a speed of sound wherever there is water");
  const MapValue level = on_map(c, place), sloped = on_map(c_z, place);
  return {.c = level.value,
          .c_x = level.x,
          .c_y = level.y,
          .c_z = c_z.value,
          .c_xx = level.xx,
          .c_xy = level.xy,
          .c_xz = sloped.x,
          .c_yy = level.yy,
          .c_yz = sloped.y,
          .c_zz = c_zz};
}

std::vector<double> WaterMap::column(double x, double y, std::span<const double> depths) const {
  MapFrame::OnGrid place = frame_.on_grid(x, y);
  place.u = on_axis(frame_, grid_->x(), place.u);
  const MapAxis::Cubic a = grid_->x().cubic(place.u), b = grid_->y().cubic(place.v);
  std::vector<double> level(grid_->levels(), 0.0);
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 4; ++i) {
      const float* speeds = grid_->at(a.index[i], b.index[j]);
      const double weight = a.value[i] * b.value[j];
      for (std::size_t k = 0; k < level.size(); ++k) level[k] += weight * double(speeds[k]);
    }
  std::vector<double> speed;
  speed.reserve(depths.size());
  for (const double depth : depths) {
    const MapAxis::Cubic d = depths_.cubic_going_on(depth);
    double c = 0.0;
    for (std::size_t k = 0; k < 4; ++k) c += d.value[k] * level[d.index[k]];
    if (std::isnan(c))
      throw_hole(origin_.name, frame_, place.u, place.v,
                 "a speed of sound wherever there is water");
    speed.push_back(c);
  }
  return speed;
}

std::vector<double> WaterMap::straight_levels(std::span<const Vec2> places, double top,
                                              double error) const {
  // Every depth that may become a level, and the speeds there.
  constexpr int parts = 8;
  const auto levels = depths_.places();
  std::vector<double> candidates;
  if (top < levels.front()) candidates.push_back(top);
  for (std::size_t k = 0; k + 1 < levels.size(); ++k)
    for (int part = 0; part < parts; ++part)
      candidates.push_back(std::lerp(levels[k], levels[k + 1], double(part) / parts));
  candidates.push_back(levels.back());
  std::vector<std::vector<double>> columns;
  for (const Vec2& place : places) columns.push_back(column(place.x(), place.y(), candidates));
  // As far as a straight line is near enough to all that it leaves out.
  const auto straight = [&](std::size_t a, std::size_t b) {
    const double width = candidates[b] - candidates[a];
    for (const std::vector<double>& c : columns)
      for (std::size_t i = a + 1; i < b; ++i)
        if (std::abs(c[a] + (c[b] - c[a]) * (candidates[i] - candidates[a]) / width - c[i]) > error)
          return false;
    return true;
  };
  std::vector<double> found = {candidates.front()};
  for (std::size_t a = 0; a + 1 < candidates.size();) {
    std::size_t b = a + 1;
    while (b + 1 < candidates.size() && straight(a, b + 1)) ++b;
    found.push_back(candidates[b]);
    a = b;
  }
  return found;
}

ClassMap::ClassMap(std::shared_ptr<const MapGrid> grid, MapFrame frame, MapOrigin origin)
    : grid_(std::move(grid)), frame_(frame), origin_(std::move(origin)) {}

int ClassMap::at(double x, double y) const {
  MapFrame::OnGrid place = frame_.on_grid(x, y);
  place.u = on_axis(frame_, grid_->x(), place.u);
  const MapAxis &across = grid_->x(), &up = grid_->y();
  const std::size_t column = across.nearest(place.u), row = up.nearest(place.v);
  double value = double(*grid_->at(column, row));
  if (!std::isnan(value)) return static_cast<int>(std::lround(value));
  // A coast runs through cells that the map counts as land: the next cell's kind goes on there.
  const Vec2 step = frame_.metres_per_unit(x, y);
  double nearest = infinity;
  const auto look = [&](std::size_t i, std::size_t j) {
    const double there = double(*grid_->at(i, j));
    const double away =
        Vec2((across.places()[i] - place.u) * step.x(), (up.places()[j] - place.v) * step.y())
            .norm();
    if (std::isnan(there) || away >= nearest) return;
    nearest = away;
    value = there;
  };
  for (std::size_t j = row - std::min<std::size_t>(row, 1); j < std::min(row + 2, up.size()); ++j)
    for (std::size_t i = column - std::min<std::size_t>(column, 1);
         i < std::min(column + 2, across.size()); ++i)
      look(i, j);
  if (std::isnan(value)) throw_hole(origin_.name, frame_, place.u, place.v, "a kind of sea floor");
  return static_cast<int>(std::lround(value));
}

bool ClassMap::covers(double x, double y) const noexcept {
  return asdic::detail::covers(*grid_, frame_, x, y);
}

double ClassMap::spacing(double x, double y) const noexcept {
  return spacing_of(*grid_, frame_, x, y);
}

}  // namespace asdic::detail
