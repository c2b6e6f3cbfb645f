#pragma once
#include "raytrace/arrivals.h"
#include "raytrace/environment.h"
#include "raytrace/layered/branch_table.h"

namespace asdic {

/// What follows from a root: angles, losses, phase, delay. One per environment, pair of depths and
/// frequency.
class PathBuilder {
 public:
  PathBuilder(const Environment& environment, const Column& column, double frequency);

  /// \param sigma  the root on this interval and branch   \param range  of the receiver [m]
  [[nodiscard]] Arrival build(const FanInterval& interval, const Branch& branch, double sigma,
                              double range) const {
    const RayParameter ray(interval.reference_speed, sigma);
    return build(interval, branch, ray, column_.all(ray), range);
  }
  /// The same from what the ray's walk through the column gave.
  [[nodiscard]] Arrival build(const FanInterval& interval, const Branch& branch,
                              const RayParameter& traced, const Column::All& walk,
                              double range) const;

  /// √(c_r ξ /(r·|dr/dξ|·(sin θ₀/c_s)·sin θ_r)): the amplitude of a ray tube [1/m × 1 m].
  [[nodiscard]] double spreading(const RayParameter& ray, double range,
                                 double range_per_slowness) const noexcept;

  /// Product of the boundaries' reflection coefficients along a branch.
  [[nodiscard]] std::complex<double> reflections(const RayParameter& ray, int surface_bounces,
                                                 int bottom_bounces) const noexcept;

  [[nodiscard]] double absorption_db_per_metre() const noexcept { return absorption_db_per_metre_; }
  [[nodiscard]] double sine_at_source(const RayParameter& ray) const noexcept;
  [[nodiscard]] double sine_at_receiver(const RayParameter& ray) const noexcept;

 private:
  const Environment& environment_;
  const Column& column_;
  double absorption_db_per_metre_;
};

/// Zeros of q passed by a ray: one between any two turning points, and one after the last of them
/// once dr/dξ is positive again.
[[nodiscard]] inline int caustics_passed(int turning_points, double range_per_slowness) noexcept {
  return range_per_slowness < 0.0 ? turning_points - 1 : turning_points;
}

/// e^{+iπ/2} for every caustic.
[[nodiscard]] inline std::complex<double> caustic_phase(int caustics) noexcept {
  constexpr std::complex<double> quarter_turns[4] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  return quarter_turns[caustics & 3];  // a displaced reflection may take one back
}

}  // namespace asdic
