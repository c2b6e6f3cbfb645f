#include "raytrace/tracing/boundary_hits.h"

#include <algorithm>
#include <cmath>

#include "raytrace/tracing/reflected.h"

namespace asdic::detail {
namespace {

/// A ray's state where it meets a line of slope tan(angle).
BoundaryHit met_at(const RayState& y, const RaySegment& s, double c, double angle) {
  const double tr = c * y.xi, tz = c * y.zeta;
  const double ur = std::cos(angle), uz = std::sin(angle);
  const double across = ur * tz - uz * tr;  // u·n, n = (t_z, −t_r): the beam's normal
  // q·n·dα moves to u·dℓ along the ray: dℓ = ±q dα/(u·n)
  const double d_along = mirror_sign(s.history) * y.q / across;
  BoundaryHit hit;
  hit.range = y.range;
  hit.d_range = ur * d_along;
  hit.time = y.time;
  hit.slowness = y.xi + y.zeta * uz / ur;  // ∇τ·u per range
  hit.d_time = hit.slowness * hit.d_range;
  hit.q_per_d_range = std::abs(across / ur);
  hit.speed = c;
  hit.nepers = y.nepers;
  hit.length = y.length;
  hit.mean_slowness = y.speed_integral > 0.0 ? y.range / y.speed_integral : y.xi;
  hit.down = tz > 0.0 ? 1.0 : -1.0;
  hit.reflection = reflected(s.history, false);
  const double sense = s.begin.q != 0.0 ? s.begin.q : s.begin.p;
  hit.caustics = s.history.caustics + (sense * y.q < 0.0 ? 1 : 0);
  hit.surface_bounces = s.history.surface_bounces;
  hit.bottom_bounces = s.history.bottom_bounces;
  return hit;
}

BoundaryHit hit_at(const RaySegment& s, const Boundary& boundary) {
  const double c = s.c_end, tr = c * s.end.xi, tz = c * s.end.zeta;
  BoundaryHit hit = met_at(s.end, s, c, std::atan(position_slope(boundary, s.end.range)));
  const double reflecting = boundary.shape ? std::atan(boundary.shape->at(s.end.range).slope) : 0.0;
  hit.grazing =
      std::asin(std::min(1.0, std::abs(std::cos(reflecting) * tz - std::sin(reflecting) * tr)));
  return hit;
}

/// Arc length in (low, high) where f changes its sign, which it does once: bisection and chords.
template <class F>
double root_between(double low, double high, F&& f) {
  double f_low = f(low), f_high = f(high);
  for (int i = 0; i < 60 && high - low > 1e-9 * (1.0 + high); ++i) {
    const double chord = high - f_high * (high - low) / (f_high - f_low);
    const double margin = 0.01 * (high - low);  // now and then from the other side
    const double s =
        i % 3 == 2 ? 0.5 * (low + high) : std::clamp(chord, low + margin, high - margin);
    const double value = f(s);
    if ((value < 0.0) == (f_low < 0.0))
      low = s, f_low = value;
    else
      high = s, f_high = value;
  }
  return 0.5 * (low + high);
}

/// Where a segment passes a depth: never, once, or twice if it turns beyond it.
void passes_of(const RaySegment& s, double depth, std::vector<BoundaryHit>& hits) {
  const double h = s.end.length - s.begin.length;
  if (h <= 0.0) return;
  const auto below = [&](double u) { return state_at(s, u).depth - depth; };
  const auto pass = [&](double low, double high) {
    const RayState y = state_at(s, root_between(low, high, below));
    const double c = 1.0 / std::hypot(y.xi, y.zeta);
    BoundaryHit hit = met_at(y, s, c, 0.0);
    hit.grazing = std::asin(std::min(1.0, std::abs(c * y.zeta)));
    hits.push_back(hit);
  };
  const bool begins = s.begin.depth >= depth, ends = s.end.depth >= depth;
  if (begins != ends) return pass(0.0, h);
  if ((s.begin.zeta < 0.0) == (s.end.zeta < 0.0)) return;
  const double turn = root_between(0.0, h, [&](double u) { return state_at(s, u).zeta; });
  if ((below(turn) >= 0.0) == begins) return;
  pass(0.0, turn);
  pass(turn, h);
}

/// The passes of a leg through a depth, each with a history of its own.
void digest_passes(const RayTrajectory& ray, const LegOfRay& leg, double depth, StrikingRay& out) {
  const std::size_t before = out.hits.size();
  for (std::size_t i = leg.first; i < leg.last; ++i) {
    out.widest = std::max(out.widest, std::abs(ray.segments[i].end.q));
    passes_of(ray.segments[i], depth, out.hits);
  }
  constexpr std::uint64_t golden = 0x9E3779B97F4A7C15ULL;
  for (std::size_t i = before; i < out.hits.size(); ++i) {
    BoundaryHit& hit = out.hits[i];
    hit.history = leg.history + golden * (2 * (i - before) + (hit.down > 0.0 ? 2 : 1));
    out.widest = std::max(out.widest, std::abs(hit.d_range));
  }
}

}  // namespace

void digest_hits(const RayTrajectory& ray, const Environment& environment, const GroundLevel& level,
                 StrikingRay& out) {
  out.angle = ray.launch_elevation;
  out.source_speed = ray.source_speed;
  out.ended = ray.ended;
  out.widest = 0.0;
  out.hits.clear();
  split_into_legs(ray, environment, out.parts);
  if (!level.boundary) {
    for (const LegOfRay& leg : out.parts) digest_passes(ray, leg, level.depth, out);
    return;
  }
  const BoundaryKind boundary = *level.boundary;
  const Boundary& wall =
      boundary == BoundaryKind::surface ? environment.surface : environment.bottom;
  std::size_t bounce = 0;
  for (const auto& [history, first, last] : out.parts) {
    const RaySegment& s = ray.segments[last - 1];
    out.widest = std::max(out.widest, std::abs(s.end.q));
    const int before = s.history.surface_bounces + s.history.bottom_bounces;
    bounce = static_cast<std::size_t>(before);
    const bool strikes =
        bounce < ray.bounces.size() &&
        (last == ray.segments.size() ||
         ray.segments[last].history.surface_bounces + ray.segments[last].history.bottom_bounces >
             before);
    if (!strikes || ray.bounces[bounce].boundary != boundary) continue;
    BoundaryHit hit = hit_at(s, wall);
    hit.history = history_after(history, wall, boundary, s.end.range);
    hit.down = boundary == BoundaryKind::surface ? -1.0 : 1.0;
    out.widest = std::max(out.widest, std::abs(hit.d_range));
    out.hits.push_back(hit);
  }
}

}  // namespace asdic::detail
