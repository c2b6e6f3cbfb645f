// Many receivers between two rays: families of rays instead of a traced ray for each.
#include <algorithm>
#include <cmath>

#include "raytrace/tracing/neighbours.h"
#include "raytrace/tracing/root_finder.h"

namespace asdic::detail {
namespace {

/// Receivers this close to where the cubics turn are looked at [m].
constexpr double margin = 0.25;

/// Depths of splitting; below, rays are re-traced.
constexpr std::size_t deepest = 14;

/// The depths that rays between two neighbours pass, by the cubic.
struct FamilySpan {
  double low, high;
};
FamilySpan span_of(const HermiteNode& a, const HermiteNode& b) {
  const Hermite cubic(a, b);
  const auto turns = cubic.extrema();
  FamilySpan span{std::min(a.value, b.value), std::max(a.value, b.value)};
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const double z = cubic.value(turns.x[i]);
    span.low = std::min(span.low, z - margin);
    span.high = std::max(span.high, z + margin);
  }
  return span;
}

}  // namespace

/// How many roots two neighbours enclose, about.
std::size_t RootFinder::expected(const FanRay& a, const FanRay& b, std::size_t first_leg) const {
  std::size_t count = 0;
  const std::size_t legs = std::min(a.legs.size(), b.legs.size());
  for (std::size_t i = 0; i < legs && a.legs[i].history == b.legs[i].history; ++i) {
    if (i < first_leg) continue;
    const auto [first, last] = columns_between(a, b, i, columns_);
    for (std::uint32_t k = first; k < last; ++k) {
      const auto za = a.crossing_or_continued(a.legs[i], k, columns_[k].range);
      const auto zb = b.crossing_or_continued(b.legs[i], k, columns_[k].range);
      if (!za || !zb) continue;
      const FamilySpan span =
          span_of({a.angle, za->depth, za->slope}, {b.angle, zb->depth, zb->slope});
      const auto wanted = columns_[k].between(span.low, span.high);
      count += wanted.last - wanted.first;
    }
  }
  return count;
}

WholeRay& RootFinder::whole_ray(std::size_t slot, double angle) {
  while (whole_rays_.size() <= slot) whole_rays_.emplace_back();  // a deque: references stay
  WholeRay& whole = whole_rays_[slot];
  trace(angle, limits_, whole.ray);
  digest(whole.ray, tracer_.environment(), columns_, whole.fan);
  whole.sign(tracer_.environment());
  return whole;
}

/// Leg after leg, as far as the family of five tells them; the rest from the halves.
void RootFinder::search_families(const WholeRay& a, const WholeRay& m, const WholeRay& b,
                                 std::size_t first_leg, std::size_t slot) {
  const WholeRay& before = whole_ray(slot, 0.5 * (a.fan.angle + m.fan.angle));
  const WholeRay& behind = whole_ray(slot + 1, 0.5 * (m.fan.angle + b.fan.angle));
  const FamilyRays rays = {&a, &before, &m, &behind, &b};
  const std::size_t legs = std::min(a.fan.legs.size(), b.fan.legs.size());
  std::size_t leg = first_leg;
  while (leg < legs && search_family(rays, leg)) ++leg;
  if (leg == legs) return;
  const auto half = [&](const WholeRay& from, const WholeRay& middle, const WholeRay& to) {
    const std::size_t count = expected(from.fan, to.fan, leg);
    const bool narrow = !(middle.fan.angle > from.fan.angle && middle.fan.angle < to.fan.angle);
    if (count >= worth_a_family && slot < 3 + 2 * deepest && !narrow)
      return search_families(from, middle, to, leg, slot + 2);
    search_legs(from.fan, to.fan, leg);
  };
  half(a, before, m);
  half(m, behind, b);
}

/// \return false: the five are not of one kind up to this leg, or do not tell it
bool RootFinder::search_family(const FamilyRays& rays, std::size_t leg) {
  const WholeRay &a = *rays.front(), &b = *rays.back();
  std::uint32_t first = 0xffffffffU, last = 0;
  for (std::size_t i = 0; i < family_size; ++i) {
    const WholeRay& ray = *rays[i];
    if (leg >= ray.fan.legs.size() || ray.signature[leg] != a.signature[leg]) return false;
    if (i == 0) continue;
    const ColumnSpan span = columns_between(rays[i - 1]->fan, ray.fan, leg, columns_);
    if (span.first >= span.last) continue;
    first = std::min(first, span.first);
    last = std::max(last, span.last);
  }
  families_.clear();
  edge_columns_.clear();
  family_columns_.clear();
  double before_angle = 0.0;
  for (std::uint32_t k = first; k < last; ++k) {
    const double range = columns_[k].range;
    FamilySpan span{1e300, -1e300};
    bool covered = true;
    std::optional<ColumnCrossing> before;
    for (const WholeRay* ray : rays) {
      const RayLeg& l = ray->fan.legs[leg];
      covered = covered && l.covers(k);
      const auto z = ray->fan.crossing_or_continued(l, k, range);
      if (z && before) {
        const FamilySpan here = span_of({before_angle, before->depth, before->slope},
                                        {ray->fan.angle, z->depth, z->slope});
        span.low = std::min(span.low, here.low);
        span.high = std::max(span.high, here.high);
      }
      before = z;
      before_angle = ray->fan.angle;
    }
    if (columns_[k].between(span.low, span.high).empty()) continue;
    (covered ? family_columns_ : edge_columns_).push_back(k);
  }
  // the farthest first: where polynomials fail, they fail there
  const bool forward = a.fan.legs[leg].end.range >= a.fan.legs[leg].begin.range;
  if (forward) std::reverse(family_columns_.begin(), family_columns_.end());
  std::size_t apart = 0;
  for (const std::uint32_t k : family_columns_) {
    const auto made = families_.emplace_back().make(rays, tracer_, leg, k, columns_[k].range);
    if (made == RayFamily::Made::good) continue;
    if (made == RayFamily::Made::too_wide || ++apart >= worth_a_family) return false;
    families_.pop_back();
    edge_columns_.push_back(k);
  }
  family_rays_ = rays;
  ray_.source_speed = a.ray.source_speed;
  const auto search_between_all = [&](std::uint32_t k) {
    for (std::size_t i = 1; i < family_size; ++i)
      search_column(rays[i - 1]->fan, rays[i]->fan, leg, k);
  };
  for (const RayFamily& family : families_) {
    family_ = &family;
    search_between_all(family.column());
  }
  family_ = nullptr;
  farthest_ = source_range_;
  for (std::size_t i = 0; i <= leg; ++i)
    for (const RayLeg* l : {&a.fan.legs[i], &b.fan.legs[i]})
      farthest_ = std::max({farthest_, l->begin.range, std::min(l->begin.range, l->end.range)});
  for (const std::uint32_t k : edge_columns_) search_between_all(k);
  return true;
}

}  // namespace asdic::detail
