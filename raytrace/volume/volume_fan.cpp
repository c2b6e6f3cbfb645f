#include "raytrace/volume/volume_fan.h"

#include <algorithm>
#include <cmath>

#include "core/geometry.h"
#include "raytrace/parallel/parallel.h"
#include "raytrace/parallel/progress.h"

namespace asdic::detail {
namespace {

constexpr double least_step = 1e-3, most_step = 0.1;  // bounds of the error of a step [m]
constexpr double uniform_mesh = 6.0;  // of launch angles, where rays are straight [deg]
constexpr double bent_mesh = 1.5;     // and elsewhere, twice that of steep rays
constexpr double flat_rays = 30.0;    // those that may turn in the water [deg]
constexpr int cuts_of_borders_uniform = 3, cuts_of_borders_bent = 0;
constexpr double room_of_a_box = 3.0;                       // in cells
constexpr std::size_t kept_bytes = std::size_t{256} << 20;  // of rays within cells

std::uint64_t name_of(int row, int column) noexcept {
  return (std::uint64_t(std::uint32_t(row)) << 32) | std::uint32_t(column);
}

/// Corners of the upright rectangle that holds all receivers.
std::vector<Vec3> hull_of(const Vec3& from, std::span<const Vec3> receivers) {
  if (receivers.size() == 1) return {receivers.front()};
  const auto nearer = [&](const Vec3& a, const Vec3& b) {
    return separation(from, a).range < separation(from, b).range;
  };
  const auto [near, far] = std::minmax_element(receivers.begin(), receivers.end(), nearer);
  const auto [top, bottom] =
      std::minmax_element(receivers.begin(), receivers.end(),
                          [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); });
  std::vector<Vec3> corners;
  for (const Vec3& place : {*near, *far})
    for (const double z : {top->z(), bottom->z()}) corners.emplace_back(place.x(), place.y(), z);
  return corners;
}

}  // namespace

double longest_path(const VolumeOcean& ocean, const Vec3& from, const Vec3& to) {
  const WaterCell cell = ocean.water_cell(from, Vec3::UnitZ());
  if (cell.uniform && cell.walls == 0) return 1e7;  // a quarter of the Earth
  const double depth = std::min(ocean.deepest_known(), 12000.0);
  return 3.0 * (to - from).norm() + 10.0 * depth;
}

VolumeFan::VolumeFan(const VolumeTracer& tracer, const Vec3& from, std::span<const Vec3> receivers,
                     const PathLimits& limits, const std::function<bool(double)>& told)
    : tracer_(tracer), from_(from), hull_(hull_of(from, receivers)), limits_(limits) {
  const VolumeOcean& ocean = tracer.ocean();
  const WaterCell cell = ocean.water_cell(from, Vec3::UnitZ());
  const double c = ocean.speed(from, cell.index).c;
  double furthest = 0.0;
  for (const Vec3& to : receivers) {
    const double way = (to - from).norm();
    if (longest_ == 0.0 || separation(from, to).range > 0.0)
      bearing_ = separation(from, to).bearing;
    longest_ = std::max(longest_, longest_path(ocean, from, to));
    furthest = std::max(furthest, way);
  }
  slope_ = ocean.steepest_floor();
  if (ocean.sideways_bending() > 0.0) by_water_ = ocean.sideways_bending() * longest_ * c;
  const bool uniform = cell.uniform && cell.walls == 0;
  const double mesh = radians(uniform ? uniform_mesh : bent_mesh);
  border_cuts_ = uniform ? cuts_of_borders_uniform : cuts_of_borders_bent;
  slowing_ = uniform ? 1.0 : 0.94;
  // Never quite at a pole, where directions have no azimuth.
  const double most = std::min(limits.max_launch_angle, 0.5 * pi - 1e-6);
  const double level = std::min(most, uniform ? most : radians(flat_rays));
  const int half = std::max(1, int(std::ceil(level / mesh)));
  const int steep = most > level ? std::max(1, int(std::ceil((most - level) / (2.0 * mesh)))) : 0;
  for (int i = -half - steep; i <= half + steep; ++i) {
    const int n = std::abs(i);
    const double e = n <= half ? level * n / half : level + (most - level) * (n - half) / steep;
    rows_.push_back(std::copysign(e, double(i)));
  }
  coarse_ = std::clamp(1e-6 * furthest, least_step, most_step);
  d_azimuth_ = std::clamp(0.5 * std::asin(std::min(1.0, turn(0.0))), 2e-3, radians(uniform_mesh));
  // a whole number to the half turn, so that no cell is beyond it
  columns_ = int(std::ceil(pi / d_azimuth_));
  d_azimuth_ = pi / columns_;
  if (!uniform && turn(0.0) > 0.2) measure_turns();
  trace_corners(told);
  along_ = {std::sin(bearing_), std::cos(bearing_)};
  if (border_cuts_ == 0) put_boxes();  // else no leg is passed over
}

/// By how much bounces off slopes and bent water change the horizontal slowness of a ray at most,
/// in units of the slowness. A bounce of grazing angle θ off a slope m does by 2m·sin θ, and makes
/// the next one steeper by 2·atan m; slower water does, too.
double VolumeFan::turn(double steepest) const noexcept {
  double sum = by_water_;
  const double each = std::atan(slope_);
  double grazing = std::acos(slowing_ * std::cos(steepest)) + each;
  for (int i = 0; i < limits_.max_bottom_bounces && sum < 1.0; ++i, grazing += 2.0 * each)
    sum += 2.0 * slope_ * std::sin(std::min(grazing, 0.5 * pi));
  return 1.05 * sum;
}

double VolumeFan::elevation(int row) const noexcept {
  const auto base = std::size_t(row >> cuts);
  if (base + 1 >= rows_.size()) return rows_.back();
  const double part = double(row & ((1 << cuts) - 1)) / double(1 << cuts);
  return rows_[base] + part * (rows_[base + 1] - rows_[base]);
}

/// Cells either side of the bearing that rays of a row can reach a receiver from.
int VolumeFan::columns_of(int row) const noexcept {
  const double steepest =
      std::max(std::abs(rows_[std::size_t(row)]), std::abs(rows_[std::size_t(row) + 1]));
  const double cosine = std::cos(steepest), most = turn(steepest);
  double reach = most >= cosine ? pi : std::asin(most / cosine);
  if (!turns_.empty())
    reach = std::min(reach, 2.0 * std::max(turns_[std::size_t(row)], turns_[std::size_t(row) + 1]) +
                                radians(6.0));
  return std::clamp(int(std::ceil(reach / d_azimuth_ + 1e-9)), 1, columns_);
}

double VolumeFan::azimuth(int column) const noexcept {
  return bearing_ + double(column) / double(1 << cuts) * d_azimuth_;
}

VolumeLimits VolumeFan::ray_limits() const noexcept {
  return {.max_surface_bounces = limits_.max_surface_bounces,
          .max_bottom_bounces = limits_.max_bottom_bounces,
          .longest = longest_,
          .faintest = limits_.faintest,
          .tolerance = coarse_,
          .losses = limits_.faintest > 0.0};
}

/// How far the rays of a coarse ring turn, row by row: where water bends rays the bound above costs
/// too many of them.
void VolumeFan::measure_turns() {
  constexpr int directions = 24;
  std::vector<double> turned(rows_.size() * directions);
  in_parallel_chunks(turned.size(), directions, [&](std::size_t begin, std::size_t end) {
    VolumeCourse ray;
    for (std::size_t i = begin; i < end; ++i) {
      const double e = rows_[i / directions],
                   a = bearing_ + 2.0 * pi * double(i % directions) / directions;
      tracer_.trace(from_, direction(a, e), hull_, ray_limits(), ray);
      turned[i] = ray.turned;
    }
  });
  for (std::size_t row = 0; row < rows_.size(); ++row)
    turns_.push_back(*std::max_element(turned.begin() + std::ptrdiff_t(row * directions),
                                       turned.begin() + std::ptrdiff_t((row + 1) * directions)));
  rays_ += turned.size();
}

std::shared_ptr<const VolumeCourse> VolumeFan::traced(int row, int column) const {
  auto course = std::make_shared<VolumeCourse>();
  tracer_.trace(from_, direction(azimuth(column), elevation(row)), hull_, ray_limits(), *course);
  course->knots.shrink_to_fit();
  course->legs.shrink_to_fit();
  return course;
}

/// The rays of all cells before any is cut, many at a time.
void VolumeFan::trace_corners(const std::function<bool(double)>& told) {
  std::vector<std::pair<int, int>> corners;
  for (int row = 0; row < int(rows_.size()); ++row) {
    int columns = 0;
    for (const int beside : {row - 1, row})
      if (beside >= 0 && beside < rows()) columns = std::max(columns, columns_of(beside));
    for (int column = -columns; column <= columns; ++column)
      corners.emplace_back(row << cuts, column << cuts);
  }
  std::vector<std::shared_ptr<const VolumeCourse>> made(corners.size());
  constexpr std::size_t side_by_side = 16;
  std::atomic<std::size_t> done = 0;
  std::atomic<bool> stopped = false;
  in_parallel_chunks(corners.size(), side_by_side, [&](std::size_t begin, std::size_t end) {
    if (stopped) return;
    for (std::size_t i = begin; i < end; ++i) made[i] = traced(corners[i].first, corners[i].second);
    done += end - begin;
    if (told && !told(double(done) / double(corners.size()))) stopped = true;
  });
  if (stopped) throw Interrupted();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::uint64_t name = name_of(corners[i].first, corners[i].second);
    kept_[std::hash<std::uint64_t>()(name * 0x9E3779B97F4A7C15ULL >> 32) % kept_.size()]
        .courses.emplace(name, std::move(made[i]));
  }
  rays_ += corners.size();
}

std::shared_ptr<const VolumeCourse> VolumeFan::course(int row, int column) const {
  const std::uint64_t name = name_of(row, column);
  Kept& kept = kept_[std::hash<std::uint64_t>()(name * 0x9E3779B97F4A7C15ULL >> 32) % kept_.size()];
  {
    const std::shared_lock lock(kept.lock);
    if (const auto at = kept.courses.find(name); at != kept.courses.end()) return at->second;
  }
  auto made = traced(row, column);
  if (bytes_.load(std::memory_order_relaxed) < kept_bytes) {
    const std::unique_lock lock(kept.lock);
    if (kept.courses.emplace(name, made).second) bytes_ += made->bytes();
  }
  return made;
}

Vec3 VolumeFan::beside_line(const Vec3& place) const noexcept {
  const Vec2 d = (place - from_).head<2>();
  return {d.dot(along_), d.x() * along_.y() - d.y() * along_.x(), place.z()};
}

VolumeFan::Box VolumeFan::box_of(const VolumeCourse& course, const VolumeCourse::Leg& leg,
                                 double cell) const {
  Vec3 low = Vec3::Constant(infinity), high = -low;
  double spread = 0.0;
  for (std::size_t k = leg.begin; k < leg.end; ++k) {
    const VolumeCourse::Knot& knot = course.knots[k];
    const Vec3 place = beside_line(knot.x);
    low = low.cwiseMin(place);
    high = high.cwiseMax(place);
    double square = 0.0;
    for (const float x : knot.x_launch) square += double(x) * double(x);
    spread = std::max(spread, square);
  }
  const double room = room_of_a_box * cell * std::sqrt(spread) + 1.0;
  Box box;
  for (int k = 0; k < 3; ++k) {
    box.low[std::size_t(k)] = float(low[k] - room);
    box.high[std::size_t(k)] = float(high[k] + room);
  }
  return box;
}

void VolumeFan::put_boxes() {
  const auto join = [](Box& a, const Box& b) {
    for (std::size_t k = 0; k < 3; ++k) {
      a.low[k] = std::min(a.low[k], b.low[k]);
      a.high[k] = std::max(a.high[k], b.high[k]);
    }
  };
  for (int row = 0; row < rows(); ++row) {
    first_of_row_.push_back(cells_.size());
    const int columns = columns_of(row);
    const double up = rows_[std::size_t(row) + 1] - rows_[std::size_t(row)];
    const double cosine =
        std::max(std::cos(rows_[std::size_t(row)]), std::cos(rows_[std::size_t(row) + 1]));
    const double diagonal = std::hypot(up, d_azimuth_ * cosine);
    for (int column = -columns; column < columns; ++column) {
      std::array<std::shared_ptr<const VolumeCourse>, 4> corners;
      for (int i = 0; i < 4; ++i)
        corners[std::size_t(i)] = course((row + (i & 1)) << cuts, (column + (i >> 1)) << cuts);
      Cell cell;
      cell.begin = boxes_.size();
      std::size_t legs = 0;
      for (const auto& corner : corners) legs = std::max(legs, corner->legs.size());
      for (std::size_t leg = 0; leg < legs; ++leg) {
        bool any = false;
        Box box{};
        for (const auto& corner : corners) {
          if (corner->legs.size() <= leg) continue;
          const Box one = box_of(*corner, corner->legs[leg], diagonal);
          if (any)
            join(box, one);
          else
            box = one;
          any = true;
        }
        boxes_.push_back(box);
        if (leg == 0)
          cell.whole = box;
        else
          join(cell.whole, box);
      }
      cell.end = boxes_.size();
      cells_.push_back(cell);
    }
  }
}

bool VolumeFan::legs_near(int row, int column, const Vec3& to, std::vector<char>& near) const {
  if (border_cuts_ > 0) {  // thin families may be hidden where others part
    near.clear();
    return true;
  }
  const Cell& cell =
      cells_[first_of_row_[std::size_t(row)] + std::size_t(column + columns_of(row))];
  const Vec3 place = beside_line(to);
  const auto inside = [&](const Box& box) {
    bool in = true;
    for (std::size_t k = 0; k < 3; ++k)
      in = in && double(box.low[k]) <= place[Eigen::Index(k)] &&
           place[Eigen::Index(k)] <= double(box.high[k]);
    return in;
  };
  if (cell.begin == cell.end || !inside(cell.whole)) return false;
  near.assign(cell.end - cell.begin, 0);
  bool any = false;
  for (std::size_t i = cell.begin; i < cell.end; ++i)
    if (inside(boxes_[i])) {
      near[i - cell.begin] = 1;
      any = true;
    }
  return any;
}

}  // namespace asdic::detail
