#pragma once
#include <algorithm>

#include "raytrace/tracing/cell.h"
#include "raytrace/tracing/power_series.h"

namespace asdic::detail::tracing {

/// A straight line of the (range, depth) plane, seen from one side: through (range, depth), with
/// the unit normal (nr, nz) on the side where `distance` is positive.
struct Line {
  double range = 0.0, depth = 0.0;
  double nr = 0.0, nz = 1.0;
  [[nodiscard]] double distance(double r, double z) const noexcept {
    return nr * (r - range) + nz * (z - depth);
  }
};

/// A point of a course, and how it moves with the course's parameter.
struct Place {
  double range = 0.0, depth = 0.0;
  double dr = 0.0, dz = 0.0;  ///< d(range)/dh, d(depth)/dh
};

/// The curve that a ray follows from a state through its cell, as a function of a parameter h:
/// arc length [m] on an arc, ∫c ds on a parabola, travel time [s] on a power series. Points of it
/// cost little, the state at its end more. Exact on arcs and parabolas for turns below π.
class Course {
 public:
  /// \param here  of the cell, at y. The cell has to outlive the course
  void begin(const Cell& cell, const RayState& y, const Local& here) noexcept;
  /// To be called before anything else is asked of a course that is not closed. \param wanted  how
  /// far it will be needed at most [s]; see reach()
  void expand(double wanted) noexcept { series_.expand(*cell_, y_, here_, wanted); }

  /// dh/ds where the course begins.
  [[nodiscard]] double per_metre() const noexcept { return per_metre_; }
  /// Whether line() and turn() know the answer.
  [[nodiscard]] bool closed() const noexcept { return closed_; }
  /// Where the course first passes a line from its positive side to the other, within a turn of
  /// 0.3 rad; infinity if it does not. Closed courses only.
  [[nodiscard]] double to_line(const Line& line) const noexcept;
  /// Where it next turns (ζ = 0), likewise.
  [[nodiscard]] double to_turn() const noexcept;
  /// Up to where a power series is as good as its error bound: what was wanted, or less.
  [[nodiscard]] double reach() const noexcept { return series_.reach; }

  /// Where it crosses a range between those where it begins and where, at h = `last`, it ends.
  [[nodiscard]] double to_range(double range, double begin, double end, double last) const noexcept;

  [[nodiscard]] Place at(double h) const noexcept;
  /// Sine and cosine of the angle below the horizon, and their derivatives; power series only.
  [[nodiscard]] ValueSlope rise(double h) const noexcept {
    return series_.value_and_slope(series_.motion, PowerSeries::tz, h);
  }
  [[nodiscard]] ValueSlope advance(double h) const noexcept {
    return series_.value_and_slope(series_.motion, PowerSeries::tr, h);
  }
  /// Depth less that of the begin, likewise.
  [[nodiscard]] ValueSlope sink(double h) const noexcept {
    return series_.value_and_slope(series_.place, PowerSeries::depth, h);
  }
  [[nodiscard]] RayState end(double h) const noexcept;

 private:
  [[nodiscard]] RayState end_of_arc(double s) const noexcept;
  [[nodiscard]] RayState end_of_parabola(double w) const noexcept;
  [[nodiscard]] RayState end_of_series(double time) const noexcept;

  const Cell* cell_ = nullptr;
  RayState y_;
  Local here_{};
  bool closed_ = true;
  double tr_ = 1.0, tz_ = 0.0;  // tangent
  double bend_ = 0.0;           // dφ/ds of an arc; d(1/c²)/dz of a parabola
  double per_metre_ = 1.0;
  PowerSeries series_;
};

/// \returns f = 0 where f changes from ≥ 0 at `low` to < 0 at `high`.
template <class F>
double falling_root(double low, double high, double guess, F&& f) noexcept {
  double x = guess;
  for (int i = 0; i < 100; ++i) {
    const auto [value, slope] = f(x);
    (value >= 0.0 ? low : high) = x;
    double next = slope < 0.0 ? x - value / slope : low;
    if (!(next > low && next < high)) {
      if (value == 0.0) return x;
      next = 0.5 * (low + high);
    } else if (std::abs(next - x) <= 1e-9 * high) {
      return next;  // Newton's next step would be of the order of the square of this one
    }

    if (next == x) return x;
    x = next;
  }
  return x;
}

}  // namespace asdic::detail::tracing
