#include "raytrace/tracing/root_finder.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"
#include "raytrace/ocean/tube_amplitude.h"
#include "raytrace/tracing/neighbours.h"

namespace asdic::detail {
namespace {

constexpr double miss_wanted = 1e-6;    ///< distance of ray and receiver [m]
constexpr double miss_accepted = 1e-4;  ///< where rounding allows no better [m]

/// A receiver this close to an extremum of the cubic asks for the exact extremum [m]; the cubics
/// are right to 0.03 m (neighbours.cpp).
constexpr double close_to_caustic = 0.25;

/// How much further than the column a ray is traced, to know the boundary behind it [m].
constexpr double beyond_column = 20.0;

/// How far apart two rays begin the same leg [m].
double spread_of(const RayLeg& a, const RayLeg& b) {
  return std::abs(a.begin.range - b.begin.range);
}

}  // namespace

void RootFinder::trace(double angle, const TraceLimits& limits, RayTrajectory& out) {
  tracer_.trace(source_range_, source_depth_, angle, limits, out);
  cost_.add(out.segments.size());
}

void RootFinder::search(const FanRay& a, const FanRay& b, int max_turns, const Found& found) {
  found_ = &found;
  max_turns_ = max_turns;
  if (receivers_ < worth_a_family || expected(a, b, 0) < worth_a_family)
    return search_legs(a, b, 0);
  const double middle = 0.5 * (a.angle + b.angle);
  if (!(middle > a.angle && middle < b.angle)) return search_legs(a, b, 0);
  const WholeRay &first = whole_ray(0, a.angle), &last = whole_ray(2, b.angle);
  search_families(first, whole_ray(1, middle), last, 0, 3);
}

void RootFinder::search_level(const FanRay& a, const FanRay& b, const LevelRays& level,
                              int max_turns, const Found& found) {
  found_ = &found;
  max_turns_ = max_turns;
  if (a.angle <= 0.0 && b.angle >= 0.0) {
    tracer_.trace(source_range_, level.depth, 0.0, limits_, ray_);
    cost_.add(ray_.segments.size());
    std::vector<LegOfRay> legs;
    split_into_legs(ray_, tracer_.environment(), legs);
    for (const ReceiverColumn& column : columns_) {
      const ExactCrossing there = cross_leg(ray_, tracer_, legs.front(), column.range);
      if (!there.real) continue;
      column_ = &column;
      const auto on_it =
          column.between(there.crossing.depth - level.height, there.crossing.depth + level.height);
      for (std::size_t i = on_it.first; i < on_it.last; ++i)
        found(column.indices[i], arrival(there, column.depths[i]));
    }
  }
  search_legs(a, b, 1);
}

void RootFinder::search_legs(const FanRay& a, const FanRay& b, std::size_t first_leg) {
  farthest_ = source_range_;
  const std::size_t legs = std::min(a.legs.size(), b.legs.size());
  for (std::size_t i = 0; i < legs && a.legs[i].history == b.legs[i].history; ++i) {
    for (const RayLeg* leg : {&a.legs[i], &b.legs[i]})
      farthest_ =
          std::max({farthest_, leg->begin.range, std::min(leg->begin.range, leg->end.range)});
    if (i < first_leg) continue;
    const auto [first, last] = columns_between(a, b, i, columns_);
    for (std::uint32_t k = first; k < last; ++k) search_column(a, b, i, k);
  }
}

void RootFinder::search_column(const FanRay& a, const FanRay& b, std::size_t leg, std::uint32_t k) {
  column_ = &columns_[k];
  const auto za = a.crossing_or_continued(a.legs[leg], k, column_->range);
  const auto zb = b.crossing_or_continued(b.legs[leg], k, column_->range);
  if (!za || !zb || std::min(za->turns, zb->turns) > max_turns_) return;
  leg_ = leg;
  reach_ =
      std::max(farthest_ + spread_of(a.legs[leg], b.legs[leg]), column_->range) + beyond_column;
  history_ = a.legs[leg].history;
  cosine_ = std::min(za->cosine, zb->cosine);
  const HermiteNode na{a.angle, za->depth, za->slope}, nb{b.angle, zb->depth, zb->slope};
  const Hermite cubic(na, nb);
  const auto turns = cubic.extrema();
  double low = std::min(na.value, nb.value), high = std::max(na.value, nb.value);
  for (std::size_t i = 0; i < turns.size(); ++i) {
    low = std::min(low, cubic.value(turns.x[i]));
    high = std::max(high, cubic.value(turns.x[i]));
  }
  const double margin = close_to_caustic / std::max(cosine_, 1e-3);
  const auto wanted = column_->between(low - margin, high + margin);
  if (wanted.empty()) return;
  // Pieces over which the depth is monotone: between the extrema, exact where a receiver is
  // near.
  HermiteNode from = na;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    HermiteNode caustic{turns.x[i], cubic.value(turns.x[i]), 0.0};
    if (!column_->between(caustic.value - margin, caustic.value + margin).empty()) {
      const HermiteNode to =
          i + 1 < turns.size() ? HermiteNode{turns.x[1], cubic.value(turns.x[1]), 0.0} : nb;
      caustic = extremum(from, to, caustic.x);
    }
    search_piece(from, caustic, cubic);
    from = caustic;
  }
  search_piece(from, nb, cubic);
}

void RootFinder::search_piece(const HermiteNode& a, const HermiteNode& b, const Hermite& cubic) {
  if (!(b.x >= a.x)) return;
  const auto wanted = column_->between(std::min(a.value, b.value), std::max(a.value, b.value));
  for (std::size_t i = wanted.first; i < wanted.last; ++i)
    refine(a, b, cubic, column_->depths[i], column_->indices[i]);
}

std::optional<ExactCrossing> RootFinder::exact(double angle) {
  if (family_ != nullptr) return family_->at(angle);
  TraceLimits limits = limits_;
  limits.max_range = std::min(limits.max_range, reach_);
  trace(angle, limits, ray_);
  return cross_column(ray_, tracer_, leg_, history_, column_->range);
}

/// The zero of the exact slope between two nodes: secant steps inside a shrinking bracket.
HermiteNode RootFinder::extremum(HermiteNode a, HermiteNode b, double guess) {
  HermiteNode best{guess, 0.0, 0.0};
  double low = a.x, high = b.x, slope_low = a.slope, slope_high = b.slope;
  double x = guess;
  bool any = false;
  for (int i = 0; i < 40; ++i) {
    const auto there = exact(x);
    if (!there) break;
    any = true;
    best = {x, there->crossing.depth, 0.0};
    const double slope = there->crossing.slope;
    const bool like_low =
        slope_low != 0.0 ? (slope > 0.0) == (slope_low > 0.0) : (slope > 0.0) != (slope_high > 0.0);
    (like_low ? low : high) = x;
    (like_low ? slope_low : slope_high) = slope;
    const double curvature = (slope_high - slope_low) / (high - low);
    // with curvature z″ the depth differs from the extremum's by slope²/(2z″)
    if (slope * slope < 1e-6 * std::abs(curvature) || high - low < 1e-15) break;
    double next = x - slope / curvature;
    if (i % 3 == 2 || !(next > low && next < high)) next = 0.5 * (low + high);
    x = next;
  }
  if (!any) best.value = guess;
  return best;
}

/// The root of z(α) = depth inside a piece that has it between its ends.
void RootFinder::refine(const HermiteNode& a, const HermiteNode& b, const Hermite& cubic,
                        double depth, std::uint32_t receiver) {
  const bool rising = b.value > a.value;
  double low = a.x, high = b.x;
  double x =
      b.value != a.value
          ? low + (high - low) * std::clamp((depth - a.value) / (b.value - a.value), 0.0, 1.0)
          : low;
  if (const double root = cubic.root_near(x, depth); root >= low && root <= high) x = root;
  std::optional<ExactCrossing> there;
  double miss = 1e300, off_before = 1e300;
  HermiteNode before = std::abs(a.value - depth) < std::abs(b.value - depth) ? a : b;  // last known
  for (int i = 0; i < 80; ++i) {
    there = exact(x);
    if (!there) {  // a ray of another history in between: towards the nearer end
      const double next = 0.5 * (x + (x - low < high - x ? low : high));
      if (next == x) return;
      x = next;
      continue;
    }
    const double off = there->crossing.depth - depth;
    miss = std::abs(off) * there->crossing.cosine;
    if (miss < miss_wanted) break;
    ((off < 0.0) == rising ? low : high) = x;
    const HermiteNode here{x, there->crossing.depth, there->crossing.slope};
    double next = here.slope != 0.0 ? x - off / here.slope : low;
    // a slope that did not bring it near is not the curve's: over curvilinear facets q is another's
    if (std::abs(off) > 0.1 * std::abs(off_before) && x != before.x)
      next = x - off * (x - before.x) / (here.value - before.value);
    else if (const double root = Hermite(before, here).root_near(next, depth);
             root > low && root < high)
      next = root;
    off_before = off;
    before = here;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next == x || high - low < 2e-16 * (1.0 + std::abs(x))) break;
    x = next;
  }
  if (!there || !there->real || miss > miss_accepted) return;
  if (family_ != nullptr) {
    family_->complete(x, *there);
    ray_.launch_elevation = x;
    family_->bounces(x, family_rays_, ray_.bounces);
  }
  const RayHistory& h = there->history;
  if (h.upper_turns + h.lower_turns > max_turns_) return;
  Arrival path = arrival(*there, depth);
  if (std::isfinite(path.delay) && std::isfinite(path.spreading))
    (*found_)(receiver, std::move(path));
  pair_at_node(x, depth, receiver);
}

/// A receiver on a node between two facets of a boundary: what arrives there is reflected there,
/// but on either side rays of another facet begin, and no two neighbours enclose it. By the facet
/// that the ray itself strikes.
void RootFinder::pair_at_node(double angle, double depth, std::uint32_t receiver) {
  constexpr double on_node = 1e-3;  // [m]
  const double range = column_->range;
  const Environment& ocean = tracer_.environment();
  const bool at_node =
      std::ranges::any_of(std::array{&ocean.surface, &ocean.bottom}, [&](const Boundary* wall) {
        const auto& shape = wall->shape;
        return shape && shape->interpolation() == ShapeInterpolation::piecewise_linear &&
               shape->facet(range - on_node) != shape->facet(range + on_node) &&
               std::abs(shape->depth_at(range) - depth) < on_node;
      });
  if (!at_node) return;
  TraceLimits limits = limits_;
  limits.max_range = std::min(limits.max_range, reach_);
  trace(angle, limits, ray_);
  std::vector<LegOfRay> legs;
  split_into_legs(ray_, ocean, legs);
  if (leg_ + 1 >= legs.size() || legs[leg_].history != history_) return;
  const ExactCrossing before = cross_leg(ray_, tracer_, legs[leg_], range);
  const ExactCrossing there = cross_leg(ray_, tracer_, legs[leg_ + 1], range);
  const auto bounces = [](const ExactCrossing& x) {
    return x.history.surface_bounces + x.history.bottom_bounces;
  };
  const double away = std::abs(there.state.range - range) + std::abs(there.state.depth - depth);
  if (!there.real || away > 2.0 * on_node || bounces(there) != bounces(before) + 1) return;
  Arrival path = arrival(there, depth);
  if (std::isfinite(path.delay) && std::isfinite(path.spreading))
    (*found_)(receiver, std::move(path));
}

Arrival RootFinder::arrival(const ExactCrossing& there, double depth) const {
  const RayState& y = there.state;
  const RayHistory& h = there.history;
  Arrival path;
  path.launch_elevation = ray_.launch_elevation;
  path.arrival_elevation = std::atan2(-y.zeta, y.xi);
  path.delay = y.time + y.zeta * (depth - y.depth);  // ∇τ is the slowness
  path.q = y.q;
  path.caustics = h.caustics;
  path.spreading = tube_amplitude(
      spreading_, {.speed = there.c,
                   .q = y.q,
                   .range = std::abs(column_->range - source_range_),
                   .launch_slowness = launch_slowness(path.launch_elevation, ray_.source_speed),
                   .speed_integral = y.speed_integral});
  path.reflection = h.reflection;
  path.absorption_db = y.nepers * db_from_amplitude(std::exp(1.0));
  const double absorbed = std::exp(-y.nepers);
  path.amplitude = path_amplitude(path.spreading, absorbed, path.reflection, path.caustics);
  path.scattered = scattered_power(path.spreading, absorbed, h.scattered);
  path.path_length = y.length;
  path.horizontal_slowness = std::abs(y.xi);
  path.surface_bounces = h.surface_bounces;
  path.bottom_bounces = h.bottom_bounces;
  path.upper_turns = h.upper_turns;
  path.lower_turns = h.lower_turns;
  const auto bounces =
      std::min(ray_.bounces.size(), static_cast<std::size_t>(h.surface_bounces + h.bottom_bounces));
  path.bounces.assign(ray_.bounces.begin(),
                      ray_.bounces.begin() + static_cast<std::ptrdiff_t>(bounces));
  return path;
}

}  // namespace asdic::detail
