#include "raytrace/area/area.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/error.h"
#include "raytrace/math/hermite.h"
#include "raytrace/ocean/slice.h"

namespace asdic::detail {
namespace {

constexpr double straight_error = 0.04;  // of speeds between the levels of sections [m/s]
constexpr int land = -1;                 // as a kind of sea floor
constexpr int unmapped = -2;             // the one kind of a sea floor without a map of kinds

/// Distance from a place along a bearing to the edge of a map, to a millimetre, at most `most` [m].
/// \param step  of the search for the edge [m]
template <class Map>
double reach_on(const Map& map, const Vec2& place, double bearing, double step, double most) {
  const auto covers = [&](double r) {
    return map.covers(place.x() + r * std::sin(bearing), place.y() + r * std::cos(bearing));
  };
  double on = 0.0, off = 0.0;
  while (on < most) {
    off = std::min(on + step, most);
    if (!covers(off)) break;
    on = off;
  }
  constexpr double exact = 1e-3;
  while (off - on > exact) {
    const double middle = 0.5 * (on + off);
    (covers(middle) ? on : off) = middle;
  }
  return on;
}

/// Reflects nothing.
const BoundaryMaterial& beach() {
  static const BoundaryMaterial material =
      ReflectionTable{.grazing = {0.0, 0.5 * pi}, .magnitude = {0.0, 0.0}, .phase = {0.0, 0.0}};
  return material;
}

/// The sea floor at a range of a plane.
struct FloorSample {
  double range = 0.0, depth = 0.0, slope = 0.0;
  int kind = unmapped;
};

}  // namespace

Area::Area(Maps maps, Environment rest, AreaSettings settings, Transect transect)
    : maps_(std::move(maps)),
      settings_(std::move(settings)),
      everywhere_(std::move(rest)),
      transect_(transect) {}

SoundSpeed3D Area::speed_at(double x, double y, double z) const {
  if (maps_.water) return maps_.water->at(x, y, z);
  const SoundSpeed2D c = sound_speed(everywhere_, transect_.range_of(x, y), z);
  const double east = std::sin(transect_.bearing), north = std::cos(transect_.bearing);
  return {.c = c.c,
          .c_x = c.c_r * east,
          .c_y = c.c_r * north,
          .c_z = c.c_z,
          .c_xx = c.c_rr * east * east,
          .c_xy = c.c_rr * east * north,
          .c_xz = c.c_rz * east,
          .c_yy = c.c_rr * north * north,
          .c_yz = c.c_rz * north,
          .c_zz = c.c_zz};
}

const BoundaryMaterial& Area::material_at(double x, double y) const {
  if (is_land(x, y)) return beach();
  if (!maps_.seabed) return everywhere_.bottom.material;
  const int kind = maps_.seabed->at(x, y);
  const auto known = maps_.materials.find(kind);
  if (known == maps_.materials.end())
    throw InputError({.where = maps_.seabed->name(),
                      .got = "the number " + std::to_string(kind),
                      .expected = "a number of [[environment.area.seabed.class]]"});
  return known->second;
}

namespace {

/// Finds the nodes of a plane's sea floor.
class FloorTracer {
 public:
  FloorTracer(const Area& area, const Vec2& place, double bearing)
      : area_(area), place_(place), way_(std::sin(bearing), std::cos(bearing)) {}

  /// Of a bicubic floor. \param step  of the grid [m]
  std::vector<FloorSample> smooth(double step, double reach) {
    const auto steps = static_cast<std::size_t>(std::ceil(reach / step)) + 1;
    samples_.clear();
    for (std::size_t i = 0; i <= steps + behind; ++i)
      samples_.push_back(at((double(i) - double(behind)) * step));
    nodes_ = {samples_.front()};
    constexpr std::size_t longest = 32;
    for (std::size_t i = 0; i + 1 < samples_.size(); i += longest)
      span(i, std::min(i + longest, samples_.size() - 1));
    return nodes_;
  }

  /// Of a faceted floor: wherever the plane crosses the lines of the grid or the diagonals of its
  /// cells.
  std::vector<FloorSample> faceted(double step, double reach) {
    nodes_.clear();
    const auto steps = static_cast<std::size_t>(std::ceil(reach / step)) + 1;
    std::vector<double> ranges;
    for (std::size_t i = 0; i <= steps + behind; ++i) {
      const double begin = (double(i) - double(behind)) * step;
      ranges.push_back(begin);
      add_crossings(begin, begin + step, ranges);
    }
    std::sort(ranges.begin(), ranges.end());
    for (const double r : ranges) {
      if (!nodes_.empty() && r - nodes_.back().range < 1e-3) continue;  // corners of cells
      add_straight(at(r));
    }
    return nodes_;
  }

 private:
  static constexpr std::size_t behind = 2;  // steps before the plane's place

  [[nodiscard]] FloorSample at(double r) const {
    const double x = place_.x() + r * way_.x(), y = place_.y() + r * way_.y();
    const MapValue floor = area_.floor().at(x, y);
    const double top = area_.surface_depth() + Area::film;
    if (floor.value <= top) return {.range = r, .depth = top, .slope = 0.0, .kind = land};
    return {.range = r,
            .depth = floor.value,
            .slope = floor.x * way_.x() + floor.y * way_.y(),
            .kind = area_.seabed() ? area_.seabed()->at(x, y) : unmapped};
  }

  /// A few centimetres, and a slope that turns a bounce by 0.1° at most. More nodes would part rays
  /// that meet the floor on either side of one: a tenth of what moving ends follow at 2 mm.
  static bool fits(const Hermite& cubic, const FloorSample& sample) {
    return std::abs(cubic.value(sample.range) - sample.depth) <= 0.02 + 1e-5 * sample.depth &&
           std::abs(cubic.slope(sample.range) - sample.slope) <= 1e-3;
  }
  static Hermite cubic(const FloorSample& a, const FloorSample& b) {
    return {{a.range, a.depth, a.slope}, {b.range, b.depth, b.slope}};
  }

  /// Adds the nodes after samples_[first] up to samples_[last].
  void span(std::size_t first, std::size_t last) {
    if (last == first + 1) {
      between(samples_[first], samples_[last], 0);
      return;
    }
    const Hermite law = cubic(samples_[first], samples_[last]);
    bool one = samples_[first].kind == samples_[last].kind;
    for (std::size_t i = first + 1; one && i < last; ++i)
      one = samples_[i].kind == samples_[first].kind && fits(law, samples_[i]);
    if (one) {
      nodes_.push_back(samples_[last]);
      return;
    }
    const std::size_t middle = (first + last) / 2;
    span(first, middle);
    span(middle, last);
  }

  /// Within a step of the grid: down to a quarter of it, and to where the kind of floor changes.
  void between(const FloorSample& a, const FloorSample& b, int depth) {
    constexpr int deepest = 2;
    const FloorSample middle = at(0.5 * (a.range + b.range));
    const bool one = a.kind == b.kind && middle.kind == a.kind;
    const bool narrow = b.range - a.range < 1.0;
    if ((one && (depth >= deepest || fits(cubic(a, b), middle))) || (!one && narrow)) {
      nodes_.push_back(b);
      return;
    }
    between(a, middle, depth + 1);
    between(middle, b, depth + 1);
  }

  /// Where the line from begin to end crosses a line of the grid or a diagonal.
  void add_crossings(double begin, double end, std::vector<double>& ranges) const {
    const ScalarMap& floor = area_.floor();
    const MapAxis &across = floor.grid().x(), &up = floor.grid().y();
    const auto on_grid = [&](double r) {
      return floor.frame().on_grid(place_.x() + r * way_.x(), place_.y() + r * way_.y());
    };
    MapFrame::OnGrid a = on_grid(begin), b = on_grid(end);
    if (floor.frame().is_geographic()) {
      const double turn =
          across.begin() + std::remainder(a.u - across.begin() - 180.0, 360.0) + 180.0 - a.u;
      a.u += turn;
      b.u += turn;
    }
    const std::size_t first = ranges.size();
    const auto add_lines = [&](const MapAxis& axis, double p, double q) {
      if (p == q) return;
      const auto places = axis.places();
      const auto [low, high] = std::minmax(p, q);
      for (auto line = std::lower_bound(places.begin(), places.end(), low);
           line != places.end() && *line <= high; ++line)
        ranges.push_back(std::lerp(begin, end, (*line - p) / (q - p)));
    };
    add_lines(across, a.u, b.u);
    add_lines(up, a.v, b.v);
    std::sort(ranges.begin() + static_cast<std::ptrdiff_t>(first), ranges.end());
    // Between two of them lies one cell: where its diagonal is crossed.
    const std::vector<double> lines(ranges.begin() + static_cast<std::ptrdiff_t>(first),
                                    ranges.end());
    const auto add_diagonal = [&](double from, double to) {
      const auto above = [&](double share, std::size_t i, std::size_t j) {
        const auto x = across.places(), y = up.places();
        return (std::lerp(a.u, b.u, share) - x[i]) / (x[i + 1] - x[i]) -
               (std::lerp(a.v, b.v, share) - y[j]) / (y[j + 1] - y[j]);
      };
      const double p = (from - begin) / (end - begin), q = (to - begin) / (end - begin);
      const double u = std::lerp(a.u, b.u, 0.5 * (p + q)), v = std::lerp(a.v, b.v, 0.5 * (p + q));
      if (u < across.begin() || u > across.end() || v < up.begin() || v > up.end()) return;
      const std::size_t i = across.interval(u), j = up.interval(v);
      const double before = above(p, i, j), after = above(q, i, j);
      if (before * after < 0.0) ranges.push_back(std::lerp(from, to, before / (before - after)));
    };
    double from = begin;
    for (const double to : lines) {
      if (to > from) add_diagonal(from, to);
      from = std::max(from, to);
    }
    if (end > from) add_diagonal(from, end);
  }

  /// Adds a node, in place of the last one where that lies on a straight line.
  void add_straight(const FloorSample& next) {
    if (nodes_.size() >= 2) {
      const FloorSample &a = nodes_[nodes_.size() - 2], &b = nodes_.back();
      const double line =
          a.depth + (next.depth - a.depth) * (b.range - a.range) / (next.range - a.range);
      if (std::abs(line - b.depth) < 1e-6 && a.kind == b.kind && b.kind == next.kind)
        nodes_.pop_back();
    }
    nodes_.push_back(next);
  }

  const Area& area_;
  Vec2 place_, way_;
  std::vector<FloorSample> samples_, nodes_;
};

}  // namespace

Boundary Area::floor_along(const Vec2& place, double bearing, double reach) const {
  FloorTracer tracer(*this, place, bearing);
  const bool smooth = maps_.floor.interpolation() == MapInterpolation::bicubic;
  double step = spacing(place);
  if (maps_.seabed) step = std::min(step, maps_.seabed->spacing(place.x(), place.y()));
  const std::vector<FloorSample> nodes =
      smooth ? tracer.smooth(step, reach) : tracer.faceted(step, reach);
  const auto material = [&](const FloorSample& node) -> const BoundaryMaterial& {
    if (node.kind == land) return beach();
    if (node.kind == unmapped) return everywhere_.bottom.material;
    return material_at(place.x() + node.range * std::sin(bearing),
                       place.y() + node.range * std::cos(bearing));
  };
  constexpr double rounding = 1e-6;  // [m]
  const bool level = std::all_of(nodes.begin(), nodes.end(), [&](const FloorSample& node) {
    return std::abs(node.depth - nodes.front().depth) < rounding && node.kind == nodes.front().kind;
  });
  Boundary floor{.depth = nodes.front().depth,
                 .material = material(nodes.front()),
                 .shape = {},
                 .roughness = everywhere_.bottom.roughness};
  if (level) return floor;
  const bool one_kind = std::all_of(nodes.begin(), nodes.end(), [&](const FloorSample& node) {
    return node.kind == nodes.front().kind;
  });
  std::vector<double> ranges, depths, slopes;
  std::vector<BoundaryMaterial> materials;
  for (const FloorSample& node : nodes) {
    ranges.push_back(node.range);
    depths.push_back(node.depth);
    slopes.push_back(node.slope);
    if (!one_kind) materials.push_back(material(node));
  }
  floor.shape = smooth ? BoundaryShape::with_slopes(ranges, depths, slopes, std::move(materials))
                       : BoundaryShape(ranges, depths, ShapeInterpolation::piecewise_linear,
                                       std::move(materials));
  floor.depth = floor.shape->depth_at(0.0);
  return floor;
}

void Area::put_water(const Vec2& place, double bearing, double reach, Environment& plane) const {
  if (!maps_.water) return;
  const WaterMap& water = *maps_.water;
  // The last column lies at the edge of the water's own map, or at the first step that is no nearer
  // than `reach`.
  const double step = water.spacing(place.x(), place.y());
  const double end = reach_on(water, place, bearing, spacing(place), reach + step);
  std::vector<double> at = {0.0};
  while (at.back() < std::min(end, reach)) at.push_back(std::min(at.back() + step, end));
  if (at.size() == 1) at.push_back(step);
  const std::size_t steps = at.size() - 1;
  // Over land, where the map may have no water, the columns before go on.
  std::vector<Vec2> places;
  for (const double r : at) {
    const Vec2 there = place + r * Vec2(std::sin(bearing), std::cos(bearing));
    places.push_back(r > 0.0 && is_land(there.x(), there.y()) ? places.back() : there);
  }
  const std::vector<double> levels =
      water.straight_levels(places, everywhere_.surface.depth, straight_error);
  const std::size_t n = levels.size();
  std::vector<double> ranges, speeds;
  std::vector<std::vector<double>> columns;
  for (const Vec2& there : places) columns.push_back(water.column(there.x(), there.y(), levels));
  // Of columns that lie on straight lines between others the outer ones.
  constexpr double error = 0.25 * straight_error;
  const auto straight = [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first + 1; i < last; ++i) {
      const double share = (at[i] - at[first]) / (at[last] - at[first]);
      for (std::size_t k = 0; k < n; ++k)
        if (std::abs(std::lerp(columns[first][k], columns[last][k], share) - columns[i][k]) > error)
          return false;
    }
    return true;
  };
  const auto add = [&](std::size_t i) {
    ranges.push_back(at[i]);
    speeds.insert(speeds.end(), columns[i].begin(), columns[i].end());
  };
  add(0);
  for (std::size_t first = 0; first < steps;) {
    std::size_t last = first + 1;
    while (last < steps && straight(first, last + 1)) ++last;
    add(last);
    first = last;
  }
  plane.water = SoundSpeedProfile::table(levels, columns.front(), Interpolation::c_linear);
  // The same water everywhere, but for rounding between the map's columns.
  constexpr double same = 1e-12;
  const bool alike =
      ranges.size() == 2 &&
      std::equal(columns.front().begin(), columns.front().end(), columns.back().begin(),
                 [](double one, double other) { return std::abs(one - other) <= same * one; });
  if (!alike) plane.section = SoundSpeedSection(ranges, levels, speeds);
}

void Area::put_waves(const Vec2& place, double bearing, double reach, Environment& plane) const {
  Roughness& waves = plane.surface.roughness;
  if (!maps_.wind || waves.smooth()) return;
  const double step = maps_.wind->spacing(place.x(), place.y());
  const auto steps = static_cast<int>(std::ceil(reach / step));
  double wind = 0.0;  // the mean of the middles of steps
  for (int i = 0; i < steps; ++i) {
    const double r = (i + 0.5) * reach / steps;
    const Vec2 there = place + r * Vec2(std::sin(bearing), std::cos(bearing));
    wind += maps_.wind->at(there.x(), there.y()).value / steps;
  }
  // What was made of the wind at the map's [0, 0], and not given as a number, follows the wind.
  const double at_origin = maps_.wind->at(0.0, 0.0).value;
  if (waves.sea_wind == at_origin && waves.rms_height == pierson_moskowitz_height(at_origin)) {
    waves.sea_wind = wind;
    waves.rms_height = pierson_moskowitz_height(wind);
  }
  if (waves.bubble_wind == at_origin) waves.bubble_wind = wind;
}

Area Area::scattering(ScatteredElsewhere surface, ScatteredElsewhere bottom) const {
  Area same = *this;
  same.everywhere_.surface.roughness.elsewhere = std::move(surface);
  same.everywhere_.bottom.roughness.elsewhere = std::move(bottom);
  return same;
}

Environment Area::section(const Vec2& place, double bearing, double reach) const {
  Environment plane = slice(everywhere_, transect_.range_of(place.x(), place.y()),
                            std::cos(bearing - transect_.bearing));
  const double step = spacing(place);
  reach = std::max(reach_on(maps_.floor, place, bearing, step, reach), 10.0 * step);
  plane.bottom = floor_along(place, bearing, reach);
  put_water(place, bearing, reach, plane);
  put_waves(place, bearing, reach, plane);
  return plane;
}

double Area::reach_on_map(const Vec2& place, double bearing, double most) const {
  const double step = spacing(place), reach = reach_on(maps_.floor, place, bearing, step, most);
  return maps_.water ? reach_on(*maps_.water, place, bearing, step, reach) : reach;
}

Area::Edge Area::nearest_edge(const Vec2& place, double most) const {
  Edge found{.distance = most};
  const double step = spacing(place);
  for (int degree = 0; degree < 360; degree += 5) {
    const double bearing = radians(degree);
    const auto look = [&](const auto& map) {
      const double reach = reach_on(map, place, bearing, step, found.distance);
      if (reach < found.distance) found = {reach, bearing, map.name()};
    };
    look(maps_.floor);
    if (maps_.water) look(*maps_.water);
    if (maps_.seabed) look(*maps_.seabed);
    if (maps_.wind) look(*maps_.wind);
  }
  return found;
}

Area::End Area::end_at(double x, double y) const noexcept {
  if (!maps_.floor.covers(x, y)) return End::floor;
  if (maps_.water && !maps_.water->covers(x, y)) return End::water;
  const bool others =
      (!maps_.seabed || maps_.seabed->covers(x, y)) && (!maps_.wind || maps_.wind->covers(x, y));
  return others ? End::none : End::other;
}

Area::Winds Area::winds(const Vec2& place, double distance) const {
  Winds found{.least = infinity, .most = 0.0};
  constexpr int lines = 50;  // to either side
  for (int i = -lines; i <= lines; ++i)
    for (int j = -lines; j <= lines; ++j) {
      const Vec2 there = place + distance / lines * Vec2(i, j);
      const double wind = maps_.wind->at(there.x(), there.y()).value;
      found.least = std::min(found.least, wind);
      found.most = std::max(found.most, wind);
    }
  return found;
}

Area::Bounds Area::bounds(const Vec2& place, double distance) const {
  constexpr double lines = 100.0;  // to either side
  const double step = std::max(spacing(place), distance / lines);
  const int n = static_cast<int>(std::ceil(distance / step));
  Bounds found{.shallowest = infinity, .deepest = -infinity, .fastest = 0.0};
  for (int i = -n; i <= n; ++i)
    for (int j = -n; j <= n; ++j) {
      const Vec2 there = place + step * Vec2(i, j);
      if ((there - place).norm() > distance + step || !maps_.floor.covers(there.x(), there.y()))
        continue;
      const double depth = bottom_depth(there.x(), there.y());
      found.shallowest = std::min(found.shallowest, depth);
      found.deepest = std::max(found.deepest, depth);
    }
  if (!(found.deepest > -infinity))
    found.shallowest = found.deepest = bottom_depth(place.x(), place.y());
  if (!maps_.water) return found;
  const double wide = std::max(maps_.water->spacing(place.x(), place.y()), distance / 20.0);
  const int m = static_cast<int>(std::ceil(distance / wide));
  for (int i = -m; i <= m; ++i)
    for (int j = -m; j <= m; ++j) {
      const Vec2 there = place + wide * Vec2(i, j);
      if (!maps_.water->covers(there.x(), there.y()) || is_land(there.x(), there.y())) continue;
      for (const double c :
           maps_.water->column(there.x(), there.y(), maps_.water->depths().places()))
        found.fastest = std::max(found.fastest, c);
    }
  return found;
}

}  // namespace asdic::detail
