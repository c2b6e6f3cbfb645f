#include "raytrace/volume/volume_eigenrays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/geometry.h"
#include "raytrace/ocean/tube_amplitude.h"
#include "raytrace/parallel/parallel.h"
#include "raytrace/parallel/stop.h"

namespace asdic::detail {
namespace volume {  // with names that others use, too
namespace {

constexpr double near_enough = 1e-5;       // miss at the receiver [m]
constexpr double acceptable = 1e-3;        // the same where rounding and steps leave more: 1e-12 s
constexpr double on_the_leg = 1e-4;        // beyond the ends of a leg [m]
constexpr double coarse = 1e-3;            // of a step of the mesh's rays [m]
constexpr double fine = 1e-7;              // of a step of an eigenray [m]
constexpr double uniform_mesh = 6.0;       // of launch angles, where rays are straight [deg]
constexpr double bent_mesh = 1.5;          // and elsewhere, twice that of steep rays
constexpr double flat_rays = 30.0;         // those that may turn in the water [deg]
constexpr int cuts = 7;                    // a cell is cut in halves so often, each way
constexpr int cuts_of_borders = 3;         // the same where families part, in uniform water
constexpr int cuts_of_bent_borders = 0;    // and elsewhere
constexpr std::size_t most_rays = 100000;  // of a mesh

double wrapped(double angle) noexcept { return std::remainder(angle, 2.0 * pi); }

/// How a ray's leg passes the receiver.
struct Pass {
  std::uint64_t key = 0, facets = 0;
  Vec3 miss;     // place − receiver
  Vec3 tangent;  // unit
  Mat32 x_launch;
  double least = 0.0;  // about the least turn of the launch that could mend the miss [rad]
};

/// Components of the launch's turn that mend a miss: X·a + s·t = −miss. Null at a caustic.
std::optional<Vec2> mending(const Vec3& miss, const Vec3& tangent, const Mat32& x_launch) {
  Mat2 normal;
  Vec2 right;
  const Vec3 m = miss - tangent * tangent.dot(miss);
  const Vec3 a = x_launch.col(0) - tangent * tangent.dot(x_launch.col(0));
  const Vec3 b = x_launch.col(1) - tangent * tangent.dot(x_launch.col(1));
  // two equations across the ray; its frame is whatever two unit vectors are
  const Mat32 frame = launch_basis(tangent);
  const Vec3 f = frame.col(0), g = frame.col(1);
  normal << f.dot(a), f.dot(b), g.dot(a), g.dot(b);
  right << -f.dot(m), -g.dot(m);
  const double det = normal(0, 0) * normal(1, 1) - normal(0, 1) * normal(1, 0);
  if (!(std::abs(det) > 1e-12 * normal.squaredNorm())) return {};
  return Vec2((right[0] * normal(1, 1) - right[1] * normal(0, 1)) / det,
              (right[1] * normal(0, 0) - right[0] * normal(1, 0)) / det);
}

Vec3 turned(const Vec3& direction, const Vec2& turn) {
  const Mat32 basis = launch_basis(direction);
  const double angle = turn.norm();
  if (angle == 0.0) return direction;
  const Vec3 aside = (basis.col(0) * turn[0] + basis.col(1) * turn[1]) / angle;
  return (direction * std::cos(angle) + aside * std::sin(angle)).normalized();
}

/// One eigenray found.
struct Root {
  Vec3 direction;
  LegPass pass;
  std::vector<Bounce> bounces;
  double source_speed = 0.0;
};

/// Newton's method in two launch angles for a leg of one history.
class Refinement {
 public:
  Refinement(const VolumeTracer& tracer, const Vec3& from, const Vec3& to, double longest)
      : tracer_(tracer), from_(from), to_(to), longest_(longest) {}

  /// \param furthest  turn from the start [rad]
  std::optional<Root> operator()(const Vec3& start, std::size_t leg, std::uint64_t key,
                                 double furthest, std::size_t& traced) {
    Vec3 direction = start;
    if (!trace(direction, leg, key, coarse, false, traced)) return {};
    double miss = across(ray_.legs[leg]);
    double tolerance = coarse;
    for (int i = 0; i < 30; ++i) {
      if (miss < near_enough && tolerance == fine) break;
      if (tolerance != fine && miss < 10.0) {
        tolerance = fine;
        if (!trace(direction, leg, key, tolerance, false, traced)) return {};
        miss = across(ray_.legs[leg]);
        if (miss < near_enough) break;
      }
      const LegPass& pass = ray_.legs[leg];
      auto turn = mending(pass.state.x - to_, pass.state.p.normalized(), pass.state.x_launch);
      if (!turn) return {};
      if (turn->norm() > 0.5 * furthest) *turn *= 0.5 * furthest / turn->norm();
      bool better = false;
      for (int half = 0; half < 8; ++half, *turn *= 0.5) {
        const Vec3 next = turned(direction, *turn);
        if ((next - start).norm() > furthest) continue;
        if (!trace(next, leg, key, tolerance, false, traced)) continue;
        const double now = across(ray_.legs[leg]);
        if (now < miss || now < near_enough) {
          direction = next;
          miss = now;
          better = true;
          break;
        }
      }
      if (!better) break;
    }
    if (!(miss < acceptable)) return {};
    if (!trace(direction, leg, key, fine, true, traced)) return {};
    const LegPass& pass = ray_.legs[leg];
    if (pass.beyond > on_the_leg) return {};
    return Root{direction,
                pass,
                {ray_.bounces.begin(), ray_.bounces.begin() + std::ptrdiff_t(leg)},
                ray_.source_speed};
  }

 private:
  bool trace(const Vec3& direction, std::size_t leg, std::uint64_t key, double tolerance,
             bool losses, std::size_t& traced) {
    ++traced;
    const VolumeLimits limits{.max_surface_bounces = int(leg) + 1,
                              .max_bottom_bounces = int(leg) + 1,
                              .most_bounces = leg,
                              .longest = longest_,
                              .tolerance = tolerance,
                              .losses = losses};
    tracer_.trace(from_, direction, to_, limits, ray_);
    return ray_.legs.size() > leg && ray_.legs[leg].history.key == key;
  }

  [[nodiscard]] double across(const LegPass& pass) const {
    const Vec3 d = to_ - pass.state.x;
    const Vec3 t = pass.state.p.normalized();
    return (d - t * t.dot(d)).norm();
  }

  const VolumeTracer& tracer_;
  Vec3 from_, to_;
  double longest_;
  VolumeRay ray_;
};

Arrival arrival_of(const Root& root, const Vec3& from, const Vec3& to) {
  const VolumeState& s = root.pass.state;
  const VolumeHistory& h = root.pass.history;
  const Vec3 t = s.p.normalized();
  const double line = separation(from, to).bearing;
  const auto deflection = [&](const Vec3& d) {
    return std::hypot(d.x(), d.y()) > 1e-9 ? wrapped(std::atan2(d.x(), d.y()) - line) : 0.0;
  };
  const double area = tube_area(s);
  Arrival path;
  path.launch_elevation = std::asin(std::clamp(-root.direction.z(), -1.0, 1.0));
  path.arrival_elevation = std::asin(std::clamp(-t.z(), -1.0, 1.0));
  path.launch_deflection = deflection(root.direction);
  path.arrival_deflection = deflection(t);
  path.delay = s.time + s.p.dot(to - s.x);
  path.path_length = s.length + t.dot(to - s.x);
  path.spreading = std::sqrt(root.pass.c / (root.source_speed * std::abs(area)));
  path.reflection = h.reflection;
  path.absorption_db = db_per_neper * s.nepers;
  const double absorbed = std::exp(-s.nepers);
  path.amplitude = path_amplitude(path.spreading, absorbed, h.reflection, h.caustics);
  path.scattered = scattered_power(path.spreading, absorbed, h.scattered);
  // across the ray in its vertical plane, per elevation
  path.q = launch_basis(t).col(0).dot(Vec3(s.x_launch.col(0)));
  if ((path.q < 0.0) != (h.caustics % 2 != 0)) path.q = -path.q;
  path.horizontal_slowness = std::hypot(s.p.x(), s.p.y());
  path.surface_bounces = h.surface_bounces;
  path.bottom_bounces = h.bottom_bounces;
  path.upper_turns = h.upper_turns;
  path.lower_turns = h.lower_turns;
  path.caustics = h.caustics;
  path.bounces = root.bounces;
  return path;
}

/// The mesh of launch directions around a source, and the roots found in it.
class Mesh {
 public:
  Mesh(const VolumeTracer& tracer, const Vec3& from, const Vec3& to, const PathLimits& limits,
       VolumeSearchReport& report)
      : tracer_(tracer),
        from_(from),
        to_(to),
        limits_(limits),
        report_(report),
        longest_(longest_path(tracer.ocean(), from, to)),
        bearing_(separation(from, to).bearing),
        refine_(tracer, from, to, longest_) {
    const VolumeOcean& ocean = tracer.ocean();
    const WaterCell cell = ocean.water_cell(from, Vec3::UnitZ());
    const double c = ocean.speed(from, cell.index).c;
    slope_ = ocean.steepest_floor();
    if (ocean.sideways_bending() > 0.0) by_water_ = ocean.sideways_bending() * longest_ * c;
    const bool uniform = cell.uniform && cell.walls == 0;
    const double mesh = radians(uniform ? uniform_mesh : bent_mesh);
    bent_ = !uniform;
    border_cuts_ = uniform ? cuts_of_borders : cuts_of_bent_borders;
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
    coarse_ = std::clamp(1e-6 * (to - from).norm(), coarse, 0.1);
    d_azimuth_ = std::clamp(0.5 * std::asin(std::min(1.0, turn(0.0))), 2e-3, radians(uniform_mesh));
    // a whole number to the half turn, so that no cell is beyond it
    columns_ = int(std::ceil(pi / d_azimuth_));
    d_azimuth_ = pi / columns_;
  }

  Arrivals search() {
    if (bent_ && turn(0.0) > 0.2) measure_turns();
    trace_corners();
    for (int row = 0; row + 1 < int(rows_.size()); ++row) {
      const int columns = columns_of(row);
      for (int column = -columns; column < columns; ++column)
        look({row << cuts, column << cuts, 0, 0});
    }
    Arrivals found;
    for (const Root& root : roots_) {
      Arrival path = arrival_of(root, from_, to_);
      const double left = std::sqrt(std::norm(path.reflection) + root.pass.history.scattered);
      if (left < limits_.faintest) continue;
      if (std::abs(path.launch_elevation) > limits_.max_launch_angle) continue;
      found.push_back(std::move(path));
    }
    std::sort(found.begin(), found.end(), [](const Arrival& a, const Arrival& b) {
      return a.delay != b.delay ? a.delay < b.delay : a.launch_elevation < b.launch_elevation;
    });
    return found;
  }

 private:
  /// By how much bounces off slopes and bent water change the horizontal slowness of a ray at
  /// most, in units of the slowness. A bounce of grazing angle θ off a slope m does by 2m·sin θ,
  /// and makes the next one steeper by 2·atan m; slower water does, too.
  [[nodiscard]] double turn(double steepest) const noexcept {
    double sum = by_water_;
    const double each = std::atan(slope_);
    double grazing = std::acos(slowing_ * std::cos(steepest)) + each;
    for (int i = 0; i < limits_.max_bottom_bounces && sum < 1.0; ++i, grazing += 2.0 * each)
      sum += 2.0 * slope_ * std::sin(std::min(grazing, 0.5 * pi));
    return 1.05 * sum;
  }

  /// Lower left corner on the finest lattice, and how often the cell was cut each way.
  struct Cell {
    int row, column, row_cuts, column_cuts;
  };
  struct Vertex {
    std::vector<Pass> passes;
  };
  struct Corner {
    const Vertex* vertex;
    Vec3 direction;
    double cosine;
  };

  [[nodiscard]] double elevation(int row) const noexcept {
    const auto base = std::size_t(row >> cuts);
    if (base + 1 >= rows_.size()) return rows_.back();
    const double part = double(row & ((1 << cuts) - 1)) / double(1 << cuts);
    return rows_[base] + part * (rows_[base + 1] - rows_[base]);
  }
  /// Cells either side of the receiver's bearing that rays of a row can reach it from.
  [[nodiscard]] int columns_of(int row) const noexcept {
    const double steepest =
        std::max(std::abs(rows_[std::size_t(row)]), std::abs(rows_[std::size_t(row) + 1]));
    const double cosine = std::cos(steepest), most = turn(steepest);
    double reach = most >= cosine ? pi : std::asin(most / cosine);
    if (!turns_.empty())
      reach =
          std::min(reach, 2.0 * std::max(turns_[std::size_t(row)], turns_[std::size_t(row) + 1]) +
                              radians(6.0));
    return std::clamp(int(std::ceil(reach / d_azimuth_ + 1e-9)), 1, columns_);
  }
  [[nodiscard]] double azimuth(int column) const noexcept {
    return bearing_ + double(column) / double(1 << cuts) * d_azimuth_;
  }

  /// How far the rays of a coarse ring turn, row by row: where water bends rays the bound above
  /// costs too many of them.
  void measure_turns() {
    constexpr int directions = 24;
    std::vector<double> turned(rows_.size() * directions);
    in_parallel_chunks(turned.size(), directions, [&](std::size_t begin, std::size_t end) {
      VolumeRay ray;
      for (std::size_t i = begin; i < end; ++i) {
        const double e = rows_[i / directions],
                     a = bearing_ + 2.0 * pi * double(i % directions) / directions;
        tracer_.trace(from_, direction(a, e), to_, mesh_limits(), ray);
        turned[i] = ray.turned;
      }
    });
    for (std::size_t row = 0; row < rows_.size(); ++row)
      turns_.push_back(*std::max_element(turned.begin() + std::ptrdiff_t(row * directions),
                                         turned.begin() + std::ptrdiff_t((row + 1) * directions)));
    report_.rays += turned.size();
  }

  [[nodiscard]] VolumeLimits mesh_limits() const noexcept {
    return {.max_surface_bounces = limits_.max_surface_bounces,
            .max_bottom_bounces = limits_.max_bottom_bounces,
            .longest = longest_,
            .faintest = limits_.faintest,
            .tolerance = coarse_,
            .losses = limits_.faintest > 0.0};
  }

  /// The rays of all cells before any is cut, many at a time.
  void trace_corners() {
    std::vector<std::pair<int, int>> corners;
    for (int row = 0; row < int(rows_.size()); ++row) {
      int columns = 0;
      for (const int beside : {row - 1, row})
        if (beside >= 0 && beside + 1 < int(rows_.size()))
          columns = std::max(columns, columns_of(beside));
      for (int column = -columns; column <= columns; ++column)
        corners.emplace_back(row << cuts, column << cuts);
    }
    std::vector<Vertex> traced(corners.size());
    constexpr std::size_t side_by_side = 64;
    in_parallel_chunks(corners.size(), side_by_side, [&](std::size_t begin, std::size_t end) {
      VolumeRay ray;
      for (std::size_t i = begin; i < end; ++i)
        traced[i].passes = passes(corners[i].first, corners[i].second, ray);
    });
    for (std::size_t i = 0; i < corners.size(); ++i)
      vertices_.emplace(name_of(corners[i].first, corners[i].second), std::move(traced[i]));
    report_.rays += corners.size();
  }

  static std::uint64_t name_of(int row, int column) noexcept {
    return (std::uint64_t(std::uint32_t(row)) << 32) | std::uint32_t(column);
  }

  const Vertex& vertex(int row, int column) {
    const auto [at, fresh] = vertices_.try_emplace(name_of(row, column));
    if (!fresh) return at->second;
    ++report_.rays;
    if (report_.rays % 256 == 0) stop_point();
    at->second.passes = passes(row, column, ray_);
    return at->second;
  }

  [[nodiscard]] std::vector<Pass> passes(int row, int column, VolumeRay& ray) const {
    tracer_.trace(from_, direction(azimuth(column), elevation(row)), to_, mesh_limits(), ray);
    std::vector<Pass> found;
    found.reserve(ray.legs.size());
    for (const LegPass& leg : ray.legs) {
      Pass pass{.key = leg.history.key,
                .facets = leg.history.facets,
                .miss = leg.state.x - to_,
                .tangent = leg.state.p.normalized(),
                .x_launch = leg.state.x_launch};
      const double size = pass.x_launch.norm();
      const double off = (pass.miss - pass.tangent * pass.tangent.dot(pass.miss)).norm();
      pass.least = size > 0.0 ? off / size : infinity;
      found.push_back(pass);
    }
    return found;
  }

  void look(const Cell& cell) {
    const int height = (1 << cuts) >> cell.row_cuts, width = (1 << cuts) >> cell.column_cuts;
    std::array<Corner, 4> corners;
    std::size_t most = 0, least = std::size_t(-1);
    bool border = false;
    for (int i = 0; i < 4; ++i) {
      const int row = cell.row + (i & 1) * height, column = cell.column + (i >> 1) * width;
      const double e = elevation(row);
      corners[std::size_t(i)] = {&vertex(row, column), direction(azimuth(column), e),
                                 std::max(std::cos(e), 1e-9)};
      const std::size_t legs = corners[std::size_t(i)].vertex->passes.size();
      most = std::max(most, legs);
      least = std::min(least, legs);
    }
    const double up = elevation(cell.row + height) - elevation(cell.row);
    const double around = azimuth(cell.column + width) - azimuth(cell.column);
    const double diagonal = std::hypot(up, around * corners[0].cosine);
    bool cut = false, taller = false, near = false;
    for (std::size_t leg = 0; leg < most; ++leg) {
      std::array<bool, 4> done{};
      for (std::size_t i = 0; i < 4; ++i) {
        if (done[i] || corners[i].vertex->passes.size() <= leg) continue;
        const std::uint64_t key = corners[i].vertex->passes[leg].key;
        std::array<const Pass*, 4> family{};
        std::size_t members = 0;
        for (std::size_t j = i; j < 4; ++j)
          if (corners[j].vertex->passes.size() > leg && corners[j].vertex->passes[leg].key == key) {
            family[j] = &corners[j].vertex->passes[leg];
            done[j] = true;
            near = near || family[j]->least < diagonal;
            ++members;
          }
        // Where one goes on and the other has ended nothing is hidden that has more bounces; where
        // they part, thin families may be.
        for (std::size_t j = i + 1; j < 4; ++j)
          border = border || (family[j] == nullptr && corners[j].vertex->passes.size() > leg);
        const Verdict verdict = members == 4 ? whole(corners, family, leg, key, up, around)
                                             : partial(corners, family, leg, key, up, around);
        if (verdict == Verdict::nothing) continue;
        if (verdict == Verdict::cut_elevation) taller = true;
        cut = true;
      }
    }
    if (border && cell.row_cuts < (near ? cuts : border_cuts_) && cell.column_cuts < cuts) {
      for (const int i : {0, 1})
        for (const int j : {0, 1})
          divide({cell.row + i * height / 2, cell.column + j * width / 2, cell.row_cuts + 1,
                  cell.column_cuts + 1});
      return;
    }
    if (!cut) return;
    const bool rows = (taller && cell.row_cuts < cuts) || cell.column_cuts >= cuts;
    if ((rows ? cell.row_cuts : cell.column_cuts) >= cuts || report_.rays > most_rays) {
      last_resort(corners, most, up, around);
      return;
    }
    if (rows) {
      divide({cell.row, cell.column, cell.row_cuts + 1, cell.column_cuts});
      divide({cell.row + height / 2, cell.column, cell.row_cuts + 1, cell.column_cuts});
    } else {
      divide({cell.row, cell.column, cell.row_cuts, cell.column_cuts + 1});
      divide({cell.row, cell.column + width / 2, cell.row_cuts, cell.column_cuts + 1});
    }
  }
  void divide(const Cell& cell) { look(cell); }

  enum class Verdict { nothing, cut_elevation, cut_azimuth };

  /// A family that all corners have.
  Verdict whole(const std::array<Corner, 4>& corners, const std::array<const Pass*, 4>& family,
                std::size_t leg, std::uint64_t key, double up, double around) {
    double cosine = 0.0, least = infinity;
    Vec3 mean = Vec3::Zero();
    for (std::size_t i = 0; i < 4; ++i) {
      cosine = std::max(cosine, corners[i].cosine);
      least = std::min(least, family[i]->least);
      mean += family[i]->tangent;
    }
    const double diagonal = std::hypot(up, around * cosine);
    if (least > 3.0 * diagonal) return Verdict::nothing;
    const double size = mean.norm();
    if (size < 3.0) return up >= around * cosine ? Verdict::cut_elevation : Verdict::cut_azimuth;
    mean /= size;
    // Places and their derivatives over both angles on the plane through the receiver across the
    // mean direction, along the rays.
    const Mat32 frame = launch_basis(mean);
    std::array<Vec2, 4> place;
    std::array<Mat2, 4> moves;  // per whole cell
    Mat2 average = Mat2::Zero();
    for (std::size_t i = 0; i < 4; ++i) {
      const Pass& pass = *family[i];
      const double forward = pass.tangent.dot(mean);
      const auto onto = [&](const Vec3& v) {
        const Vec3 w = v - pass.tangent * (v.dot(mean) / forward);
        return Vec2(frame.col(0).dot(w), frame.col(1).dot(w));
      };
      place[i] = onto(pass.miss);
      moves[i].col(0) = onto(pass.x_launch.col(0)) * up;
      moves[i].col(1) = onto(pass.x_launch.col(1)) * (around * corners[i].cosine);
      average += 0.25 * moves[i];
    }
    const double det = average(0, 0) * average(1, 1) - average(0, 1) * average(1, 0);
    const bool one_facet = std::all_of(family.begin(), family.end(), [&](const Pass* pass) {
      return pass->facets == family[0]->facets;
    });
    if (one_facet && std::abs(det) > 1e-6 * average.squaredNorm()) {
      Mat2 inverse;
      inverse << average(1, 1), -average(0, 1), -average(1, 0), average(0, 0);
      inverse /= det;
      // in units of the cell
      std::array<Vec2, 4> at;
      Vec2 low(infinity, infinity), high(-infinity, -infinity), centre = Vec2::Zero();
      for (std::size_t i = 0; i < 4; ++i) {
        at[i] = inverse * place[i];
        low = low.cwiseMin(at[i]);
        high = high.cwiseMax(at[i]);
        centre += 0.25 * at[i];
      }
      Vec2 bent = Vec2::Zero();  // how far lines differ from the map, by direction of the edge
      for (const auto& [a, b, side] :
           {std::array<std::size_t, 3>{0, 1, 0}, {2, 3, 0}, {0, 2, 1}, {1, 3, 1}}) {
        const Vec2 edge = at[b] - at[a];
        double off = 0.0;
        for (const std::size_t k : {a, b})
          off = std::max(off, (inverse * moves[k].col(Eigen::Index(side)) - edge).norm());
        bent[Eigen::Index(side)] = std::max(bent[Eigen::Index(side)], off);
      }
      const double slack = 0.1 + 0.5 * bent.maxCoeff();
      if (low.maxCoeff() > slack || high.minCoeff() < -slack || (low.array() > slack).any() ||
          (high.array() < -slack).any())
        return Verdict::nothing;
      if (bent.maxCoeff() < 0.35) {
        const double e = elevation_of(corners[0].direction) + up * (0.5 - centre[0]);
        const double a = azimuth_of(corners, around * (0.5 - centre[1]));
        try_root(direction(a, std::clamp(e, -0.5 * pi, 0.5 * pi)), leg, key, diagonal);
        return Verdict::nothing;
      }
      return bent[0] >= bent[1] ? Verdict::cut_elevation : Verdict::cut_azimuth;
    }
    // A caustic in the cell, or an edge between facets: by places alone.
    Vec2 low(infinity, infinity), high(-infinity, -infinity);
    double widest = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      low = low.cwiseMin(place[i]);
      high = high.cwiseMax(place[i]);
      widest = std::max(widest, moves[i].norm());
    }
    if ((low.array() > widest).any() || (high.array() < -widest).any()) return Verdict::nothing;
    const double by_elevation = (moves[0].col(0) - moves[3].col(0)).norm(),
                 by_azimuth = (moves[0].col(1) - moves[3].col(1)).norm();
    return by_elevation >= by_azimuth ? Verdict::cut_elevation : Verdict::cut_azimuth;
  }

  static double elevation_of(const Vec3& d) { return std::asin(std::clamp(-d.z(), -1.0, 1.0)); }
  /// Of the first corner, and so much more.
  [[nodiscard]] double azimuth_of(const std::array<Corner, 4>& corners, double more) const {
    const Vec3& d = corners[0].direction;
    return std::atan2(d.x(), d.y()) + more;
  }

  /// A family that ends in the cell: from the corner that is nearest to a root.
  Verdict partial(const std::array<Corner, 4>& corners, const std::array<const Pass*, 4>& family,
                  std::size_t leg, std::uint64_t key, double up, double around) {
    double best = infinity;
    Vec3 start = Vec3::Zero();
    double diagonal = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      if (family[i] == nullptr) continue;
      diagonal = std::max(diagonal, std::hypot(up, around * corners[i].cosine));
      if (family[i]->least > 2.0 * diagonal) continue;
      const auto turn = mending(family[i]->miss, family[i]->tangent, family[i]->x_launch);
      if (!turn || !(turn->norm() < std::min(best, 1.5 * diagonal))) continue;
      best = turn->norm();
      start = turned(corners[i].direction, *turn);
      if (best > 0.0) from_corner_ = corners[i].direction;
    }
    if (std::isinf(best)) return Verdict::nothing;
    if (!try_root(start, leg, key, 2.0 * diagonal))
      try_root(from_corner_, leg, key, 3.0 * diagonal);
    return Verdict::nothing;
  }

  /// Where cutting has to end.
  void last_resort(const std::array<Corner, 4>& corners, std::size_t most, double up,
                   double around) {
    bool any = false;
    for (std::size_t leg = 0; leg < most; ++leg)
      for (const Corner& corner : corners) {
        if (corner.vertex->passes.size() <= leg) continue;
        const Pass& pass = corner.vertex->passes[leg];
        const double diagonal = std::hypot(up, around * corner.cosine);
        if (pass.least > 4.0 * diagonal) continue;
        any = true;
        try_root(corner.direction, leg, pass.key, 8.0 * diagonal);
      }
    if (any) ++report_.unfinished;
  }

  bool known(const Vec3& direction, std::uint64_t key, double within) const {
    return std::any_of(roots_.begin(), roots_.end(), [&](const Root& r) {
      return r.pass.history.key == key && (r.direction - direction).norm() < within;
    });
  }

  /// Whether two directions are one root: the turn between them moves the ray by less than both
  /// misses may be.
  static bool same(const Root& a, const Root& b) {
    if (a.pass.history.caustics != b.pass.history.caustics) return false;
    const Vec3 between = b.direction - a.direction;
    const Mat32 basis = launch_basis(a.direction);
    const Vec3 t = a.pass.state.p.normalized(),
               moved = a.pass.state.x_launch.col(0) * Vec3(basis.col(0)).dot(between) +
                       a.pass.state.x_launch.col(1) * Vec3(basis.col(1)).dot(between);
    return (moved - t * t.dot(moved)).norm() < 5.0 * acceptable && between.norm() < 1e-2;
  }

  bool try_root(const Vec3& start, std::size_t leg, std::uint64_t key, double cell) {
    if (known(start, key, 0.05 * cell)) return true;
    const auto root = refine_(start, leg, key, 2.0 * cell, report_.refined);
    if (!root) return false;
    for (const Root& r : roots_)
      if (r.pass.history.key == key && same(r, *root)) return true;
    roots_.push_back(*root);
    return true;
  }

  const VolumeTracer& tracer_;
  Vec3 from_, to_;
  const PathLimits& limits_;
  VolumeSearchReport& report_;
  double longest_, bearing_;
  Refinement refine_;
  double slope_ = 0.0, by_water_ = 0.0, slowing_ = 1.0;  // for turn()
  int border_cuts_ = 0;
  bool bent_ = false;
  std::vector<double> turns_;  // of rays of a row, at most, by a coarse ring [rad]
  std::vector<double> rows_;   // elevations between which cells lie [rad]
  int columns_ = 0;
  double d_azimuth_ = 0.0, coarse_ = coarse;
  std::unordered_map<std::uint64_t, Vertex> vertices_;
  VolumeRay ray_;
  std::vector<Root> roots_;
  Vec3 from_corner_ = Vec3::Zero();
};

std::uint64_t key_of(std::span<const Bounce> bounces) {
  std::uint64_t key = 0;
  for (const Bounce& b : bounces) key = bounced_key(key, b.boundary);
  return key;
}

}  // namespace
}  // namespace volume

double longest_path(const VolumeOcean& ocean, const Vec3& from, const Vec3& to) {
  const WaterCell cell = ocean.water_cell(from, Vec3::UnitZ());
  if (cell.uniform && cell.walls == 0) return 1e7;  // a quarter of the Earth
  const double depth = std::min(ocean.deepest_floor(), 12000.0);
  return 3.0 * (to - from).norm() + 10.0 * depth;
}

Arrivals volume_eigenrays(const VolumeTracer& tracer, const Vec3& from, const Vec3& to,
                          const PathLimits& limits, VolumeSearchReport* report) {
  VolumeSearchReport own;
  return volume::Mesh(tracer, from, to, limits, report != nullptr ? *report : own).search();
}

std::optional<Arrival> followed_volume_path(const VolumeTracer& tracer, const Arrival& path,
                                            const Vec3& from, const Vec3& to) {
  constexpr double furthest_turn = 0.02;
  volume::Refinement refine(tracer, from, to, longest_path(tracer.ocean(), from, to));
  std::size_t traced = 0;
  const double bearing = separation(from, to).bearing + path.launch_deflection;
  const auto root = refine(direction(bearing, path.launch_elevation), path.bounces.size(),
                           volume::key_of(path.bounces), furthest_turn, traced);
  if (!root) return {};
  const VolumeHistory& h = root->pass.history;
  if (h.upper_turns != path.upper_turns || h.lower_turns != path.lower_turns) return {};
  return volume::arrival_of(*root, from, to);
}

std::vector<Vec3> volume_track(const VolumeTracer& tracer, const Arrival& path, const Vec3& from,
                               const Vec3& to) {
  const VolumeLimits limits{.max_surface_bounces = path.surface_bounces + 1,
                            .max_bottom_bounces = path.bottom_bounces + 1,
                            .most_bounces = path.bounces.size(),
                            .longest = path.path_length,
                            .tolerance = 1e-4,
                            .losses = false};
  VolumeRay ray;
  const double bearing = separation(from, to).bearing + path.launch_deflection;
  tracer.trace(from, direction(bearing, path.launch_elevation), to, limits, ray, true);
  return ray.track;
}

}  // namespace asdic::detail
