#include "raytrace/tracing/ray_family.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail {
namespace {

constexpr std::array<double, family_size> places = {0.0, 0.25, 0.5, 0.75, 1.0};

/// What the quintic through three rays may miss the others by [m]: the polynomial through all five
/// has four more conditions, and is right to about its 5/3rd power in proportion, less than a
/// micrometre.
constexpr double quintic_miss = 1e-4;

/// What the cubic through four rays may miss the fifth by: depth and delay [m], where these have no
/// slopes; all else in proportion or [rad]. The quartic is right to a few per cent of it.
constexpr double cubic_depth_miss = 2e-5, cubic_miss = 2e-5;

using Weights = std::array<double, family_size>;

/// Lagrange's polynomials for the five places.
Weights weights_at(double t) noexcept {
  const double u = 4.0 * t;  // places 0..4
  const double a = u, b = u - 1.0, c = u - 2.0, d = u - 3.0, e = u - 4.0;
  return {b * c * d * e / 24.0, -a * c * d * e / 6.0, a * b * d * e / 4.0, -a * b * c * e / 6.0,
          a * b * c * d / 24.0};
}

template <class F>
double sum(const Weights& w, F&& f) {
  double s = 0.0;
  for (std::size_t i = 0; i < family_size; ++i) s += w[i] * f(i);
  return s;
}

/// The middle one less the cubic through the others.
template <class F>
double middle_miss(F&& f) {
  return f(2) - (4.0 * (f(1) + f(3)) - (f(0) + f(4))) / 6.0;
}

/// Whether ∂z/∂α is what q says.
bool slopes_tell(const Environment& ocean) noexcept {
  for (const Boundary* wall : {&ocean.surface, &ocean.bottom})
    if (wall->shape && wall->shape->interpolation() == ShapeInterpolation::curvilinear)
      return false;
  return true;
}

double elevation(const ExactCrossing& x) noexcept { return std::atan2(-x.state.zeta, x.state.xi); }

}  // namespace

void WholeRay::sign(const Environment& environment) {
  signature.clear();
  std::uint64_t hash = 0;
  const auto mix = [&](std::uint64_t x) {
    hash = (hash ^ (x + 0x9e3779b97f4a7c15U)) * 0xbf58476d1ce4e5b9U;
    hash ^= hash >> 29;
  };
  for (std::size_t i = 0; i < fan.parts.size(); ++i) {
    const LegOfRay& part = fan.parts[i];
    const RayLeg& leg = fan.legs[i];
    mix(part.history);
    if (leg.from_boundary) {
      const Boundary& wall =
          leg.begins_at == BoundaryKind::surface ? environment.surface : environment.bottom;
      if (wall.shape) mix(wall.shape->facet(leg.begin.range));
    }
    std::uint64_t before = ~std::uint64_t{0};
    for (std::size_t k = part.first; k < part.last; ++k) {
      const RaySegment& s = ray.segments[k];
      const std::uint64_t cell = (std::uint64_t{s.row} << 32) | s.column;
      if (cell != before) mix(cell);
      before = cell;
    }
    signature.push_back(hash);
  }
}

RayFamily::Made RayFamily::make(const FamilyRays& rays, const RayTracer& tracer, std::size_t leg,
                                std::uint32_t column, double range) {
  column_ = column;
  leg_ = leg;
  from_ = rays[0]->fan.angle;
  width_ = rays[4]->fan.angle - from_;
  sign_ = rays[0]->fan.legs[leg].sign;
  by_slopes_ = slopes_tell(tracer.environment());
  std::array<double, family_size> z{}, dz{}, t{}, dt{};
  for (std::size_t i = 0; i < family_size; ++i) {
    known_[i] = cross_leg(rays[i]->ray, tracer, rays[i]->fan.parts[leg], range);
    const ExactCrossing& x = known_[i];
    if (!x.real || !std::isfinite(x.crossing.slope)) return Made::too_wide;
    if (x.row != known_[0].row) return Made::rows_differ;
    z[i] = x.crossing.depth;
    dz[i] = x.crossing.slope * width_;
    t[i] = x.state.time;
    dt[i] = x.state.zeta * dz[i];
  }
  if (by_slopes_) {
    depth_ = {places, z, dz};
    delay_ = {places, t, dt};
  } else {
    depth_ = {places, z};
    delay_ = {places, t};
  }
  return tells_places() && tells_the_rest() && counts_agree() ? Made::good : Made::too_wide;
}

bool RayFamily::tells_places() const noexcept {
  const auto& k = known_;
  const auto z = [&](std::size_t i) { return k[i].crossing.depth; };
  const auto dz = [&](std::size_t i) { return k[i].crossing.slope * width_; };
  const auto t = [&](std::size_t i) { return k[i].state.time; };
  const auto dt = [&](std::size_t i) { return k[i].state.zeta * dz(i); };
  if (!by_slopes_)
    return std::abs(middle_miss(z)) * k[2].crossing.cosine < cubic_depth_miss &&
           std::abs(middle_miss(t)) * k[2].c < cubic_depth_miss;
  const OsculatingPolynomial<3> depth({0.0, 0.5, 1.0}, {z(0), z(2), z(4)}, {dz(0), dz(2), dz(4)});
  const OsculatingPolynomial<3> delay({0.0, 0.5, 1.0}, {t(0), t(2), t(4)}, {dt(0), dt(2), dt(4)});
  for (const std::size_t i : {std::size_t{1}, std::size_t{3}}) {
    const auto [there, slope] = depth.at(places[i]);
    const double miss = std::max(std::abs(there - z(i)), 0.1 * std::abs(slope - dz(i)));
    if (!(miss * k[i].crossing.cosine < quintic_miss)) return false;
    if (!(std::abs(delay.at(places[i]).value - t(i)) * k[i].c < quintic_miss)) return false;
  }
  return true;
}

bool RayFamily::tells_the_rest() const noexcept {
  const auto good = [&](auto&& f, double scale) {
    return std::abs(middle_miss(f)) <= cubic_miss * scale;
  };
  const auto& k = known_;
  const double time = k[2].state.time, strength = std::abs(k[2].history.reflection);
  const double widest =
      std::max({std::abs(k[0].state.q), std::abs(k[2].state.q), std::abs(k[4].state.q)});
  return good([&](std::size_t i) { return elevation(k[i]); }, 1.0) &&
         (by_slopes_ || good([&](std::size_t i) { return k[i].state.q; }, widest)) &&
         good([&](std::size_t i) { return k[i].history.reflection.real(); }, strength) &&
         good([&](std::size_t i) { return k[i].history.reflection.imag(); }, strength) &&
         (k[2].history.scattered == 0.0 ||
          good([&](std::size_t i) { return k[i].history.scattered; }, k[2].history.scattered)) &&
         good([&](std::size_t i) { return k[i].state.length; }, k[2].c * time) &&
         good([&](std::size_t i) { return k[i].state.speed_integral; },
              k[2].state.speed_integral) &&
         good([&](std::size_t i) { return k[i].state.nepers; }, 1.0);
}

/// Caustics and turning points pass the column where q and ζ change sign, and nowhere else.
bool RayFamily::counts_agree() const noexcept {
  for (std::size_t i = 0; i + 1 < family_size; ++i) {
    const ExactCrossing &a = known_[i], &b = known_[i + 1];
    const auto turns = [](const ExactCrossing& x) {
      return x.history.upper_turns + x.history.lower_turns;
    };
    const bool caustic = (a.state.q > 0.0) != (b.state.q > 0.0);
    const bool turn = (a.state.zeta > 0.0) != (b.state.zeta > 0.0);
    if (std::abs(a.history.caustics - b.history.caustics) != (caustic ? 1 : 0)) return false;
    if (std::abs(turns(a) - turns(b)) != (turn ? 1 : 0)) return false;
  }
  return true;
}

ExactCrossing RayFamily::at(double angle) const noexcept {
  const double t = (angle - from_) / width_;
  const auto [value, slope] = depth_.at(t);
  const auto nearest = static_cast<std::size_t>(std::clamp(4.0 * t + 0.5, 0.0, 4.0));
  ExactCrossing there;
  there.crossing = {
      .depth = value, .slope = slope / width_, .cosine = known_[nearest].crossing.cosine};
  there.c = known_[nearest].c;
  there.real = true;
  return there;
}

void RayFamily::complete(double angle, ExactCrossing& there) const noexcept {
  const double t = (angle - from_) / width_;
  const Weights w = weights_at(t);
  const auto& k = known_;
  const double up = sum(w, [&](std::size_t i) { return elevation(k[i]); });
  there.c = sum(w, [&](std::size_t i) { return k[i].c; });
  RayState& y = there.state;
  y.range = k[0].state.range;
  y.depth = there.crossing.depth;
  y.time = delay_.at(t).value;
  y.xi = std::cos(up) / there.c;
  y.zeta = -std::sin(up) / there.c;
  y.q = by_slopes_ ? sign_ * there.crossing.slope * std::cos(up)  // ∂z/∂α = sign·q/(c·ξ)
                   : sum(w, [&](std::size_t i) { return k[i].state.q; });
  // each over time, which hardly varies
  const auto gathered = [&](double RayState::*what) {
    return y.time * sum(w, [&](std::size_t i) { return k[i].state.*what / k[i].state.time; });
  };
  y.length = gathered(&RayState::length);
  y.nepers = gathered(&RayState::nepers);
  y.speed_integral = gathered(&RayState::speed_integral);
  const auto low = static_cast<std::size_t>(std::clamp(4.0 * t, 0.0, 3.0));
  const ExactCrossing &a = k[low], &b = k[low + 1];
  const bool nearer_b = 4.0 * t - static_cast<double>(low) > 0.5;
  const auto like = [&](auto&& same) -> const ExactCrossing& {
    const bool is_a = same(a), is_b = same(b);
    if (is_a != is_b) return is_a ? a : b;
    return nearer_b ? b : a;
  };
  there.history =
      like([&](const ExactCrossing& x) { return (x.state.zeta > 0.0) == (y.zeta > 0.0); }).history;
  there.history.caustics = like([&](const ExactCrossing& x) {
                             return (x.state.q > 0.0) == (y.q > 0.0);
                           }).history.caustics;
  there.history.reflection = {
      sum(w, [&](std::size_t i) { return k[i].history.reflection.real(); }),
      sum(w, [&](std::size_t i) { return k[i].history.reflection.imag(); })};
  if (k[2].history.scattered > 0.0)
    there.history.scattered =
        std::max(0.0, sum(w, [&](std::size_t i) { return k[i].history.scattered; }));
}

void RayFamily::bounces(double angle, const FamilyRays& rays, std::vector<Bounce>& out) const {
  const Weights w = weights_at((angle - from_) / width_);
  const RayHistory& history = known_[0].history;
  const int bounced = history.surface_bounces + history.bottom_bounces;
  const auto count = static_cast<std::size_t>(bounced);
  out.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    out[k].boundary = rays[0]->ray.bounces[k].boundary;
    out[k].grazing = sum(w, [&](std::size_t i) { return rays[i]->ray.bounces[k].grazing; });
    out[k].range = sum(w, [&](std::size_t i) { return rays[i]->ray.bounces[k].range; });
  }
}

}  // namespace asdic::detail
