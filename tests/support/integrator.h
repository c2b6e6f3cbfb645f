#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "raytrace/ocean/sound_speed.h"

namespace asdic::detail::support {

/// Where a ray is, and the beam it carries.
struct RayPoint {
  double range = 0.0;  ///< [m]
  double depth = 0.0;  ///< [m]
  double xi = 0.0;     ///< horizontal slowness [s/m]
  double zeta = 0.0;   ///< vertical slowness, positive down [s/m]
  double time = 0.0;   ///< τ [s]
  double q = 0.0;      ///< ∂n/∂(launch angle), unsigned by bounces [m/rad]
  double p = 0.0;      ///< dq/ds = c·p [s/(m·rad)]
  double path = 0.0;   ///< arc length [m]
  int surface_bounces = 0;
  int bottom_bounces = 0;
  int upper_turns =
      0;  ///< turning points in the water, seen from above: the ray comes up and goes down
  int lower_turns = 0;
  int caustics = 0;  ///< changes of the sign of q
  /// Positive up, the direction of travel [rad].
  [[nodiscard]] double elevation() const { return std::atan2(-zeta, xi); }
};

/// One ray through a profile between flat boundaries, by plain integration along its arc: the
/// independent check of the solvers in raytrace/, slow and as exact as double precision allows.
///
/// Steps are of the Gragg–Bulirsch–Stoer kind (modified midpoint, extrapolated to order 16). Within
/// a step one smooth law holds: steps end exactly on samples of the profile, on turning points and
/// on boundaries. There p jumps (docs of at_knot and at_boundary below); nothing else does.
class RayIntegrator {
 public:
  RayIntegrator(const SoundSpeedProfile& water, double surface, double bottom,
                double tolerance = 1e-13)
      : water_(water), surface_(surface), bottom_(bottom), tolerance_(tolerance) {}

  /// \param elevation  of launch, positive up [rad]  \param range  where to stop [m]
  /// \throws std::runtime_error if the ray does not get there
  [[nodiscard]] RayPoint trace(double source_depth, double elevation, double range) {
    const double c = water_.at(source_depth).c;
    RayPoint ray;
    ray.depth = source_depth;
    ray.xi = std::cos(elevation) / c;
    ray.zeta = -std::sin(elevation) / c;
    ray.p = 1.0 / c;
    interval_ = interval_ahead(ray);
    double step = 50.0;
    for (int count = 0; count < 2'000'000; ++count) {
      Result next = integrate(ray, step);
      while (next.error > tolerance_ && step > 1e-6) {
        step *= std::clamp(0.9 * std::pow(tolerance_ / next.error, 1.0 / 15.0), 0.2, 0.9);
        next = integrate(ray, step);
      }
      const double grown =
          step *
          std::clamp(0.9 * std::pow(tolerance_ / (next.error + 1e-300), 1.0 / 15.0), 0.5, 2.0);
      if (advance(ray, step, next.ray, range)) return ray;
      step = std::min(grown, longest_step);
    }
    throw std::runtime_error("the ray does not reach the range");
  }

 private:
  static constexpr double longest_step = 500.0;
  using State = std::array<double, 7>;  // r, z, ξ, ζ, τ, q, p
  struct Result {
    RayPoint ray;
    double error;
  };

  [[nodiscard]] SoundSpeed speed(double depth) const {
    return water_.munk_parameters() ? water_.at(depth) : water_.at(depth, interval_);
  }
  [[nodiscard]] double top() const {
    const bool knot = !water_.munk_parameters() && interval_ > 0;
    return knot ? std::max(surface_, water_.depths()[interval_]) : surface_;
  }
  [[nodiscard]] double floor() const {
    const bool knot = !water_.munk_parameters() && interval_ + 1 < water_.intervals();
    return knot ? std::min(bottom_, water_.depths()[interval_ + 1]) : bottom_;
  }

  /// The interval the ray is about to run through: at a sample, the one it is heading for.
  [[nodiscard]] std::size_t interval_ahead(const RayPoint& ray) const {
    if (water_.munk_parameters()) return 0;
    const std::size_t below = water_.interval(ray.depth);
    if (below == 0 || ray.depth != water_.depths()[below]) return below;
    if (ray.zeta != 0.0) return ray.zeta > 0.0 ? below : below - 1;
    return water_.at(ray.depth, below).dc_dz < 0.0 ? below : below - 1;  // dζ/ds = −c_z/c²
  }

  /// d(state)/ds; Porter & Bucker, JASA 82, 1349 (1987).
  [[nodiscard]] State derivative(const State& y) const {
    const SoundSpeed s = speed(y[1]);
    const double c2 = s.c * s.c;
    const double c_nn = s.d2c_dz2 * c2 * y[2] * y[2];  // ∂²c/∂n²: n_z = c·ξ
    return {s.c * y[2], s.c * y[3], 0.0, -s.dc_dz / c2, 1.0 / s.c, s.c * y[6], -c_nn / c2 * y[5]};
  }

  /// Gragg's modified midpoint rule over one step in n parts; its error has even powers of 1/n
  /// only.
  [[nodiscard]] State midpoint(const State& y, double step, int n) const {
    const double h = step / n;
    State before = y, here = y;
    const State slope = derivative(y);
    for (std::size_t i = 0; i < y.size(); ++i) here[i] += h * slope[i];
    for (int k = 1; k < n; ++k) {
      const State middle = derivative(here);
      for (std::size_t i = 0; i < y.size(); ++i) {
        const double after = before[i] + 2.0 * h * middle[i];
        before[i] = here[i];
        here[i] = after;
      }
    }
    const State last = derivative(here);
    for (std::size_t i = 0; i < y.size(); ++i) here[i] = 0.5 * (here[i] + before[i] + h * last[i]);
    return here;
  }

  /// One step of any length by the law of the present interval. Works on increments, so that a long
  /// range costs no digits.
  [[nodiscard]] Result integrate(const RayPoint& from, double step) const {
    const State y = {0.0, from.depth, from.xi, from.zeta, 0.0, from.q, from.p};
    constexpr int columns = 8;
    std::array<State, columns> row{};
    State coarser{};
    for (int k = 0; k < columns; ++k) {
      State diagonal = midpoint(y, step, 2 * (k + 1));
      // Aitken–Neville in (1/n)²: row[j] holds T_{k−1,j} and becomes T_{k,j}.
      for (int j = 1; j <= k; ++j) {
        const double ratio = double(k + 1) / double(k + 1 - j);
        for (std::size_t i = 0; i < y.size(); ++i) {
          const double finer = diagonal[i];
          diagonal[i] += (finer - row[std::size_t(j - 1)][i]) / (ratio * ratio - 1.0);
          row[std::size_t(j - 1)][i] = finer;
        }
        if (j == k) coarser = row[std::size_t(j - 1)];
      }
      row[std::size_t(k)] = diagonal;
    }
    const State& best = row[columns - 1];
    const State scale = {1e3,
                         1e3,
                         from.xi + std::abs(from.zeta),
                         from.xi + std::abs(from.zeta),
                         1.0,
                         1e3 + std::abs(best[5]),
                         1e-3 + std::abs(best[6])};
    double error = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i)
      error = std::max(error, std::abs(best[i] - coarser[i]) / scale[i]);
    if (!std::isfinite(error)) error = 1e300;
    RayPoint to = from;
    to.range += best[0];
    to.depth = best[1];
    to.zeta = best[3];
    to.time += best[4];
    to.q = best[5];
    to.p = best[6];
    to.path += step;
    return {to, error};
  }

  /// The step at which `miss` (zero at the event, with opposite signs at 0 and `step`) vanishes, by
  /// regula falsi with halving (Illinois); then the ray there.
  RayPoint locate(const RayPoint& from, double& step,
                  const std::function<double(const RayPoint&)>& miss) const {
    double low = 0.0, high = step, miss_low = miss(from),
           miss_high = miss(integrate(from, step).ray);
    if (miss_low == 0.0) miss_low = -std::copysign(1e-300, miss_high);
    RayPoint found = from;
    for (int i = 0, side = 0; i < 200; ++i) {
      double middle = (low * miss_high - high * miss_low) / (miss_high - miss_low);
      if (!(middle > low && middle < high)) middle = 0.5 * (low + high);
      if (middle == low || middle == high) break;
      found = integrate(from, middle).ray;
      step = middle;
      const double m = miss(found);
      if (m == 0.0 || high - low < 1e-13 * (1.0 + high)) break;
      if ((m > 0.0) == (miss_high > 0.0)) {
        high = middle;
        miss_high = m;
        if (side == 1) miss_low *= 0.5;
        side = 1;
      } else {
        low = middle;
        miss_low = m;
        if (side == -1) miss_high *= 0.5;
        side = -1;
      }
    }
    return found;
  }

  /// Moves the ray on by at most `step`, to the first event; true when it has reached the range.
  bool advance(RayPoint& ray, double step, RayPoint next, double range) {
    bool turns = false, meets = false;
    if (ray.zeta * next.zeta < 0.0) {  // after this depth is monotone over the step
      next = locate(ray, step, [](const RayPoint& r) { return r.zeta; });
      next.zeta = 0.0;
      turns = true;
    }
    const double limit = next.depth > floor() ? floor() : top();
    if (next.depth > floor() || next.depth < top()) {
      next = locate(ray, step, [limit](const RayPoint& r) { return r.depth - limit; });
      next.depth = limit;
      turns = false;
      meets = true;
    }
    if (next.range >= range) {
      next = locate(ray, step, [range](const RayPoint& r) { return r.range - range; });
      next.range = range;
      turns = meets = false;
    }
    const double sense = ray.q != 0.0 ? ray.q : ray.p;
    if (sense * next.q < 0.0) ++next.caustics;
    if (turns) ++(ray.zeta < 0.0 ? next.upper_turns : next.lower_turns);
    ray = next;
    if (meets && (limit == surface_ || limit == bottom_)) {
      at_boundary(ray, limit == bottom_);
    } else if (meets) {
      at_knot(ray);
    }
    return ray.range == range;
  }

  /// Flat reflection: Δp = ±2·c_z·cos²θ·q/(c²·sin θ), + at the bottom, − at the surface.
  void at_boundary(RayPoint& ray, bool bottom) {
    const SoundSpeed s = speed(ray.depth);
    const double cosine = s.c * ray.xi, sine = s.c * std::abs(ray.zeta);
    const double jump = 2.0 * s.dc_dz * cosine * cosine * ray.q / (s.c * s.c * sine);
    ray.p += bottom ? jump : -jump;
    ray.zeta = -ray.zeta;
    ++(bottom ? ray.bottom_bounces : ray.surface_bounces);
    interval_ = interval_ahead(ray);
  }

  /// A kink of the profile: c_zz holds [c_z]·δ(z − z_k), and ds = dz/sin θ, so
  /// Δp = −(c_z below − c_z above)·cos²θ·q/(c²·sin θ).
  void at_knot(RayPoint& ray) {
    const SoundSpeed before = speed(ray.depth);
    interval_ = interval_ahead(ray);
    const SoundSpeed after = speed(ray.depth);
    const double cosine = before.c * ray.xi, sine = before.c * std::abs(ray.zeta);
    const double kink = (after.dc_dz - before.dc_dz) * (ray.zeta > 0.0 ? 1.0 : -1.0);
    ray.p -= kink * cosine * cosine * ray.q / (before.c * before.c * sine);
  }

  const SoundSpeedProfile& water_;
  double surface_, bottom_, tolerance_;
  std::size_t interval_ = 0;
};

}  // namespace asdic::detail::support
