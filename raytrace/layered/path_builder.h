#pragma once
#include <span>

#include "raytrace/layered/branch_table.h"
#include "raytrace/layered/root_search.h"
#include "raytrace/layered/simd_reflection.h"
#include "raytrace/ocean/arrivals.h"
#include "raytrace/ocean/environment.h"

namespace asdic::detail {

/// What follows from a root: angles, losses, phase, delay. One per environment, pair of depths and
/// frequency.
class PathBuilder {
 public:
  PathBuilder(const Environment& environment, const Column& column, double frequency);

  /// Adds the path of every root of a batch whose reflections leave `faintest` to those of its
  /// receiver. \param found  [receivers]
  void build(const FanInterval& interval, const SimdTasks& tasks, const FoundRays& roots,
             double faintest, std::span<Arrivals> found) const;

  /// tube_amplitude() of a ray, with q = |dr/dξ|·(sin θ₀/c_s)·sin θ_r [1/m × 1 m].
  [[nodiscard]] double spreading(const RayParameter& ray, double range,
                                 double range_per_slowness) const noexcept;

  /// Product of the boundaries' reflection coefficients along a branch.
  [[nodiscard]] std::complex<double> reflections(const RayParameter& ray, int surface_bounces,
                                                 int bottom_bounces) const noexcept;

  /// What rough boundaries leave along a branch, beside `reflections`: pressure of the mean field,
  /// which those contain, and energy in all. Exactly 1 where they are smooth.
  [[nodiscard]] RoughReflection rough(const RayParameter& ray, int surface_bounces,
                                      int bottom_bounces) const noexcept;
  /// Whether any boundary is rough.
  [[nodiscard]] bool any_rough() const noexcept { return any_rough_; }
  /// As `reflections`, of boundaries that are smooth, times the root of `rough`'s energy: what the
  /// mean intensity along a branch is the square of.
  [[nodiscard]] std::complex<double> all_reflected(const RayParameter& ray, int surface_bounces,
                                                   int bottom_bounces) const noexcept;

  [[nodiscard]] double absorption_db_per_metre() const noexcept { return absorption_db_per_metre_; }
  [[nodiscard]] double sine_at_source(const RayParameter& ray) const noexcept;
  [[nodiscard]] double sine_at_receiver(const RayParameter& ray) const noexcept;

 private:
  /// What follows from a root in straight formulae, for a batch of them.
  struct SimdPaths {
    Rays miss;  // of the ray traced, at the receiver's depth [m]
    Rays slowness, range_per_slowness, q, spreading, delay, length;
    Rays launch, arrival, surface_grazing, bottom_grazing;  // angles from the horizontal
    SimdComplex reflection;
    std::array<double, rays_at_once>
        scattered{};                        // of reflection's square, beside the mean field's
    Rays first_up, first_down, half_cycle;  // ranges of vertices
  };
  [[nodiscard]] SimdPaths simd_paths(const FanInterval& interval, const SimdTasks& tasks,
                                     const FoundRays& roots) const noexcept;
  const Environment& environment_;
  const Column& column_;
  double absorption_db_per_metre_;
  double frequency_;
  bool any_rough_;
  [[nodiscard]] std::complex<double> mirrors(const RayParameter& ray, int surface_bounces,
                                             int bottom_bounces) const noexcept;
  WaterAtBoundary water_at_surface_, water_at_bottom_;
};

/// Zeros of q passed by a ray: one between any two turning points, and one after the last of them
/// once dr/dξ is positive again.
[[nodiscard]] inline int caustics_passed(int turning_points, double range_per_slowness) noexcept {
  return range_per_slowness < 0.0 ? turning_points - 1 : turning_points;
}

}  // namespace asdic::detail
