#include "raytrace/volume/volume_eigenrays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/geometry.h"
#include "raytrace/ocean/tube_amplitude.h"
#include "raytrace/parallel/progress.h"
#include "raytrace/parallel/stop.h"

namespace asdic::detail {
namespace volume {  // with names that others use, too
namespace {

constexpr double acceptable = 1e-3;      // the same where rounding and steps leave more: 1e-12 s
constexpr double on_the_leg = 1e-4;      // beyond the ends of a leg [m]
constexpr double coarse = 1e-3;          // of a step of Newton's first rays [m]
constexpr std::size_t patience = 12;     // of them, until the receiver is near
constexpr int cuts_of_near_borders = 3;  // where families part near a root, in bent water
constexpr double faint_cell = 0.3;       // of the faintest path: what a focus within it may add

double wrapped(double angle) noexcept { return std::remainder(angle, 2.0 * pi); }

/// How a ray's leg passes the receiver.
struct Pass {
  std::uint64_t key = 0, facets = 0;
  Vec3 miss;     // place − receiver
  Vec3 tangent;  // unit
  Mat32 x_launch;
  double strength = 0.0;  // its amplitude, but for absorption
  double least = 0.0;     // about the least turn of the launch that could mend the miss [rad]
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
  Refinement(const VolumeTracer& tracer, const Vec3& from, const Vec3& to, double longest,
             const VolumePrecision& precision)
      : tracer_(tracer),
        from_(from),
        to_(to),
        longest_(longest),
        near_enough_(precision.miss),
        acceptable_(std::max(acceptable, precision.miss)),
        fine_(precision.step) {}

  /// \param furthest  turn from the start [rad]
  std::optional<Root> operator()(const Vec3& start, std::size_t leg, std::uint64_t key,
                                 double furthest, std::size_t& traced) {
    Vec3 direction = start;
    if (!trace(direction, leg, key, coarse, false, traced)) return {};
    double miss = across(ray_.legs[leg]);
    double tolerance = coarse;
    const std::size_t begun = traced;
    for (int i = 0; i < 30; ++i) {
      if (tolerance == coarse && traced - begun > patience) return {};
      if (miss < near_enough_ && tolerance == fine_) break;
      if (tolerance != fine_ && miss < 10.0) {
        tolerance = fine_;
        if (!trace(direction, leg, key, tolerance, false, traced)) return {};
        miss = across(ray_.legs[leg]);
        if (miss < near_enough_) break;
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
        if (now < miss || now < near_enough_) {
          direction = next;
          miss = now;
          better = true;
          break;
        }
      }
      if (!better) break;
    }
    if (!(miss < acceptable_)) return {};
    if (!trace(direction, leg, key, fine_, true, traced)) return {};
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
  double near_enough_, acceptable_, fine_;
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

std::uint64_t key_of(std::span<const Bounce> bounces) {
  std::uint64_t key = 0;
  for (const Bounce& b : bounces) key = bounced_key(key, b.boundary);
  return key;
}

Vec3 launched(const Arrival& path, const Vec3& from, const Vec3& to) {
  return direction(separation(from, to).bearing + path.launch_deflection, path.launch_elevation);
}

/// The search in a fan for the roots of one receiver.
class Search {
 public:
  Search(const VolumeFan& fan, const Vec3& to, const VolumePrecision& precision,
         VolumeSearchReport& report)
      : fan_(fan),
        from_(fan.from()),
        to_(to),
        precision_(precision),
        too_faint_(faint_cell * fan.limits().faintest / (to - fan.from()).norm()),
        limits_(fan.limits()),
        report_(report),
        refine_(fan.tracer(), fan.from(), to, longest_path(fan.tracer().ocean(), fan.from(), to),
                precision) {}

  Arrivals operator()(const std::function<bool(double)>& told, std::span<const Arrival> in_plane) {
    for (int row = 0; row < fan_.rows(); ++row) {
      const int columns = fan_.columns_of(row);
      for (int column = -columns; column < columns; ++column) {
        std::vector<char> near;
        if (!fan_.legs_near(row, column, to_, near)) continue;
        cells_.push_back({row << cuts, column << cuts, 0, 0, near_legs_.size()});
        near_legs_.push_back(std::move(near));
      }
    }
    // Whole cells first, and then their parts, so that what is given up is the finest.
    const std::size_t whole = cells_.size();
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (told && i % 64 == 0 && !told(0.5 * looked(i, whole))) throw Interrupted();
      look(Cell(cells_[i]));
    }
    try_later(told);
    constexpr double beside = 0.004;  // of a path in the plane [rad]
    for (const Arrival& path : in_plane)
      try_root(launched(path, from_, to_), path.bounces.size(), key_of(path.bounces), beside);
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
  static constexpr int cuts = VolumeFan::cuts;

  /// Lower left corner on the finest lattice, and how often the cell was cut each way.
  struct Cell {
    int row, column, row_cuts, column_cuts;
    std::size_t of;  // the whole cell that it is a part of
  };
  /// A ray, and how those of its legs pass the receiver that were asked for.
  struct Vertex {
    std::shared_ptr<const VolumeCourse> course;
    std::vector<Pass> passes;  // least < 0: not asked for
    [[nodiscard]] std::size_t legs() const noexcept { return passes.size(); }
    [[nodiscard]] std::uint64_t key(std::size_t leg) const { return course->legs[leg].key; }
  };
  struct Corner {
    Vertex* vertex;
    Vec3 direction;
    double cosine;
  };

  [[nodiscard]] double elevation(int row) const noexcept { return fan_.elevation(row); }
  [[nodiscard]] double azimuth(int column) const noexcept { return fan_.azimuth(column); }

  static std::uint64_t name_of(int row, int column) noexcept {
    return (std::uint64_t(std::uint32_t(row)) << 32) | std::uint32_t(column);
  }

  Vertex& vertex(int row, int column) {
    const auto [at, fresh] = vertices_.try_emplace(name_of(row, column));
    if (!fresh) return at->second;
    if (((row | column) & ((1 << cuts) - 1)) != 0) ++report_.rays;
    if (vertices_.size() % 256 == 0) stop_point();
    at->second.course = fan_.course(row, column);
    at->second.passes.resize(at->second.course->legs.size());
    for (Pass& pass : at->second.passes) pass.least = -1.0;
    return at->second;
  }

  const Pass* pass_of(Vertex& vertex, std::size_t leg) const {
    Pass& pass = vertex.passes[leg];
    if (pass.least >= 0.0) return &pass;
    const CoursePass at = course_pass(*vertex.course, leg, to_);
    pass = {.key = vertex.key(leg),
            .facets = vertex.course->legs[leg].facets,
            .miss = at.x - to_,
            .tangent = at.tangent,
            .x_launch = at.x_launch};
    pass.strength =
        vertex.course->legs[leg].left / std::sqrt(std::abs(tube_area(pass.x_launch, pass.tangent)));
    const double size = pass.x_launch.norm();
    const double off = (pass.miss - pass.tangent * pass.tangent.dot(pass.miss)).norm();
    pass.least = size > 0.0 ? off / size : infinity;
    return &pass;
  }

  /// Whether a leg of a cell can come near the receiver, by the whole cell that it is cut from.
  [[nodiscard]] bool may_be_near(const Cell& cell, std::size_t leg) const noexcept {
    const std::vector<char>& near = near_legs_[cell.of];
    return leg >= near.size() || near[leg] != 0;
  }

  /// Of the work, when so many cells are looked at: how many more there will be is a guess.
  [[nodiscard]] double looked(std::size_t cells, std::size_t whole) const noexcept {
    const double budget = double(report_.rays) / double(precision_.most_rays);
    const double begun = double(cells) / double(std::max(cells_.size(), 2 * whole) + 1);
    return std::min(0.99, std::max(begun, budget));
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
      const std::size_t legs = corners[std::size_t(i)].vertex->legs();
      most = std::max(most, legs);
      least = std::min(least, legs);
    }
    const double up = elevation(cell.row + height) - elevation(cell.row);
    const double around = azimuth(cell.column + width) - azimuth(cell.column);
    const double diagonal = std::hypot(up, around * corners[0].cosine);
    bool cut = false, taller = false, near = false, near_border = false;
    for (std::size_t leg = 0; leg < most; ++leg) {
      if (!may_be_near(cell, leg)) continue;
      bool close = false, parted = false;
      std::array<bool, 4> done{};
      for (std::size_t i = 0; i < 4; ++i) {
        if (done[i] || corners[i].vertex->legs() <= leg) continue;
        const std::uint64_t key = corners[i].vertex->key(leg);
        std::array<const Pass*, 4> family{};
        std::size_t members = 0;
        for (std::size_t j = i; j < 4; ++j)
          if (corners[j].vertex->legs() > leg && corners[j].vertex->key(leg) == key) {
            family[j] = pass_of(*corners[j].vertex, leg);
            done[j] = true;
            close = close || (family[j]->least < diagonal && family[j]->strength >= too_faint_);
            ++members;
          }
        // Where one goes on and the other has ended nothing is hidden that has more bounces; where
        // they part, thin families may be.
        for (std::size_t j = i + 1; j < 4; ++j)
          parted = parted || (family[j] == nullptr && corners[j].vertex->legs() > leg);
        if (std::none_of(family.begin(), family.end(), [&](const Pass* pass) {
              return pass != nullptr && pass->strength >= too_faint_;
            }))
          continue;
        const Verdict verdict = members == 4 ? whole(corners, family, leg, key, up, around)
                                             : partial(corners, family, leg, key, up, around);
        if (verdict == Verdict::nothing) continue;
        if (verdict == Verdict::cut_elevation) taller = true;
        cut = true;
      }
      border = border || parted;
      near = near || close;
      near_border = near_border || (parted && close);
    }
    // In uniform water thin families may hide anywhere between others.
    const bool uniform = fan_.cuts_of_borders() > 0;
    const int border_cuts =
        uniform ? (near ? cuts : fan_.cuts_of_borders()) : (near_border ? cuts_of_near_borders : 0);
    const bool parts = border && cell.row_cuts < border_cuts && cell.column_cuts < cuts;
    if (!parts && !cut) return;
    if (report_.rays > precision_.most_rays) {
      ++report_.given_up;
      return;
    }
    if (parts) {
      for (const int i : {0, 1})
        for (const int j : {0, 1})
          cells_.push_back({cell.row + i * height / 2, cell.column + j * width / 2,
                            cell.row_cuts + 1, cell.column_cuts + 1, cell.of});
      return;
    }
    const bool rows = (taller && cell.row_cuts < cuts) || cell.column_cuts >= cuts;
    if ((rows ? cell.row_cuts : cell.column_cuts) >= cuts) {
      last_resort(cell, corners, most, up, around);
      return;
    }
    if (rows) {
      cells_.push_back({cell.row, cell.column, cell.row_cuts + 1, cell.column_cuts, cell.of});
      cells_.push_back(
          {cell.row + height / 2, cell.column, cell.row_cuts + 1, cell.column_cuts, cell.of});
    } else {
      cells_.push_back({cell.row, cell.column, cell.row_cuts, cell.column_cuts + 1, cell.of});
      cells_.push_back(
          {cell.row, cell.column + width / 2, cell.row_cuts, cell.column_cuts + 1, cell.of});
    }
  }

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
    Guess guess{.leg = leg, .key = key};
    double diagonal = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      if (family[i] == nullptr) continue;
      diagonal = std::max(diagonal, std::hypot(up, around * corners[i].cosine));
      if (family[i]->least > 2.0 * diagonal) continue;
      const auto turn = mending(family[i]->miss, family[i]->tangent, family[i]->x_launch);
      if (!turn || !(turn->norm() < std::min(best, 1.5 * diagonal))) continue;
      best = turn->norm();
      guess.start = turned(corners[i].direction, *turn);
      guess.corner = corners[i].direction;
      guess.strength = family[i]->strength;
    }
    if (std::isinf(best)) return Verdict::nothing;
    guess.cell = diagonal;
    guesses_.push_back(guess);
    return Verdict::nothing;
  }

  /// Where a root of a family that ends nearby may be.
  struct Guess {
    std::size_t leg;
    std::uint64_t key;
    Vec3 start = Vec3::Zero(), corner = Vec3::Zero();
    double strength = 0.0, cell = 0.0;
  };

  /// The guesses, the strongest first: most come to nothing.
  void try_later(const std::function<bool(double)>& told) {
    std::stable_sort(guesses_.begin(), guesses_.end(),
                     [](const Guess& a, const Guess& b) { return a.strength > b.strength; });
    if (guesses_.size() > precision_.most_rays) {
      report_.given_up += guesses_.size() - precision_.most_rays;
      guesses_.resize(precision_.most_rays);
    }
    std::unordered_map<std::uint64_t, std::vector<std::pair<Vec3, double>>> failed;
    const bool uniform = fan_.cuts_of_borders() > 0;
    const std::size_t begun = report_.refined;
    for (std::size_t i = 0; i < guesses_.size(); ++i) {
      const Guess& guess = guesses_[i];
      const std::size_t spent = report_.refined - begun;
      if (told && i % 16 == 0 &&
          !told(0.5 + 0.5 * std::max(double(i) / double(guesses_.size()),
                                     std::min(1.0, double(spent) / double(precision_.most_rays)))))
        throw Interrupted();
      if (i % 16 == 0) stop_point();
      if (spent > precision_.most_rays) {
        report_.given_up += guesses_.size() - i;
        return;
      }
      auto& before = failed[guess.key];
      constexpr double again = 0.2;  // of a cell beside one that failed
      if (std::any_of(before.begin(), before.end(), [&](const auto& one) {
            return (one.first - guess.start).norm() < again * std::min(one.second, guess.cell);
          }))
        continue;
      if (try_root(guess.start, guess.leg, guess.key, 2.0 * guess.cell)) continue;
      if (uniform && try_root(guess.corner, guess.leg, guess.key, 3.0 * guess.cell)) continue;
      before.emplace_back(guess.start, guess.cell);
    }
  }

  /// Where cutting has to end.
  void last_resort(const Cell& cell, const std::array<Corner, 4>& corners, std::size_t most,
                   double up, double around) {
    bool any = false;
    for (std::size_t leg = 0; leg < most; ++leg)
      for (const Corner& corner : corners) {
        if (!may_be_near(cell, leg) || corner.vertex->legs() <= leg) continue;
        const Pass& pass = *pass_of(*corner.vertex, leg);
        const double diagonal = std::hypot(up, around * corner.cosine);
        if (pass.least > 4.0 * diagonal || pass.strength < too_faint_) continue;
        any = true;
        if (report_.refined > 2 * precision_.most_rays) {
          ++report_.given_up;
          continue;
        }
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

  const VolumeFan& fan_;
  Vec3 from_, to_;
  VolumePrecision precision_;
  double too_faint_;  // a cell's strength
  const PathLimits& limits_;
  VolumeSearchReport& report_;
  Refinement refine_;
  std::vector<Cell> cells_;  // in hand, and to come
  std::unordered_map<std::uint64_t, Vertex> vertices_;
  std::vector<std::vector<char>> near_legs_;  // of whole cells
  std::vector<Root> roots_;
  std::vector<Guess> guesses_;
};

}  // namespace
}  // namespace volume

Arrivals volume_eigenrays(const VolumeFan& fan, const Vec3& to, VolumeSearchReport* report,
                          const VolumePrecision& precision, const std::function<bool(double)>& told,
                          std::span<const Arrival> in_plane) {
  VolumeSearchReport own;
  return volume::Search(fan, to, precision, report != nullptr ? *report : own)(told, in_plane);
}

Arrivals volume_eigenrays(const VolumeTracer& tracer, const Vec3& from, const Vec3& to,
                          const PathLimits& limits, VolumeSearchReport* report,
                          std::span<const Arrival> in_plane) {
  const VolumeFan fan(tracer, from, {&to, 1}, limits);
  Arrivals found = volume_eigenrays(fan, to, report, {}, {}, in_plane);
  if (report != nullptr) report->rays += fan.rays();
  return found;
}

std::optional<Arrival> followed_volume_path(const VolumeTracer& tracer, const Arrival& path,
                                            const Vec3& from, const Vec3& to) {
  constexpr double furthest_turn = 0.02;
  volume::Refinement refine(tracer, from, to, longest_path(tracer.ocean(), from, to), {});
  std::size_t traced = 0;
  const auto root = refine(volume::launched(path, from, to), path.bounces.size(),
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
  tracer.trace(from, volume::launched(path, from, to), to, limits, ray, true);
  return ray.track;
}

}  // namespace asdic::detail
