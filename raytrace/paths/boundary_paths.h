#pragma once
#include <cmath>
#include <complex>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "raytrace/ocean/ground_grid.h"
#include "raytrace/ocean/ground_level.h"
#include "raytrace/parallel/stop.h"
#include "raytrace/paths/eigenrays.h"

namespace asdic::detail {

/// One path from a source to one cell of a level: the incident field, before the boundary answers.
struct BoundaryPath {
  double delay = 0.0;  ///< [s]
  /// As Arrival::amplitude, up to the boundary but without its own reflection; its square is the
  /// mean intensity, with all that rough boundaries scattered about the path.
  std::complex<double> amplitude = 0.0;
  double launch_elevation = 0.0;     ///< [rad], positive up
  double grazing = 0.0;              ///< at the cell [rad]
  double horizontal_slowness = 0.0;  ///< dτ/dr along the boundary; over flat ground ξ [s/m]
  double slowness_slope = 0.0;  ///< d²τ/dr² [s/m²], held near caustics; 0 where it is not known
  double downward = 0.0;        ///< +1 where the path goes down at its end, −1 up
  double length = 0.0;          ///< of the path [m]
  /// Reflections before the end.
  std::uint16_t surface_bounces = 0, bottom_bounces = 0;
};

/// Every path of a fan to every cell of one ground grid. Paths of one cell add coherently; the
/// cells are the same whatever the fan.
class BoundaryPaths {
 public:
  [[nodiscard]] const GroundGrid& grid() const noexcept { return grid_; }
  [[nodiscard]] std::size_t cells() const noexcept {
    return first_.empty() ? 0 : first_.size() - 1;
  }
  [[nodiscard]] double range(std::size_t cell) const noexcept {
    return grid_.range(cell);
  }  ///< of its centre [m]
  [[nodiscard]] std::span<const BoundaryPath> paths(std::size_t cell) const noexcept {
    return {paths_.data() + first_[cell], first_[cell + 1] - first_[cell]};
  }
  [[nodiscard]] std::span<const BoundaryPath> all() const noexcept { return paths_; }
  [[nodiscard]] std::size_t size() const noexcept { return paths_.size(); }
  [[nodiscard]] std::size_t bytes() const noexcept {
    return paths_.size() * sizeof(BoundaryPath) + first_.size() * sizeof(std::uint32_t);
  }

 private:
  friend BoundaryPaths boundary_paths(const EigenraySolver&, double, const GroundLevel&,
                                      const GroundGrid&, double, double, const PathLimits&,
                                      const StopPoint&);
  friend std::vector<BoundaryPaths> mean_paths(const EigenraySolver&, double,
                                               std::span<const GroundLevel>, const GroundGrid&,
                                               double, double, const PathLimits&, int);

  GroundGrid grid_;
  std::vector<std::uint32_t> first_;  // [cells + 1]
  std::vector<BoundaryPath> paths_;
};

/// Of paths that go up and down very often, in layered water, not every cycle is followed: from
/// `all_cycles` on the middle one of 3, from three times as many on of 9 and so on, each as strong
/// as all for which it stands. A sum of energy over cycles is right to some 10⁻³, and the paths of
/// a cell grow as the logarithm of their bounces. docs/theory/reverberation.md, "Many paths"
inline constexpr int all_cycles = 63;
/// How many cycles the followed one of a number stands for; 0 where it is not followed.
[[nodiscard]] int cycles_told_by(int cycle) noexcept;
/// Of the cycles up to a number, those that are followed.
[[nodiscard]] int followed_cycles(int most) noexcept;

/// Where the fan of a source meets a boundary, interpolated along each branch of the fan onto one
/// ground grid: delay and range by cubics whose slopes are exact (dτ/dr = ξ), refined until range
/// and delay are right to a hundredth of the spacing; the amplitude follows from dr/dξ there. Near
/// a caustic |dr/dξ| is held at the value where two coalescing rays have their greatest (Airy)
/// amplitude, for the integral of intensity² over range diverges in ray theory. Over slopes, swell
/// and fronts the fan is marched and `grazing` is the angle to the local tangent. A depth in
/// the water lies where the water reaches so deep. \param grid  in layered oceans paths
/// are as right as the spacing asks for in wide cells, too; elsewhere as a cell's own width does,
/// and no cells are finer than the spacing   \param max_range [m] \param frequency  [Hz]
[[nodiscard]] BoundaryPaths boundary_paths(const EigenraySolver& solver, double source_depth,
                                           const GroundLevel& level, const GroundGrid& grid,
                                           double max_range, double frequency,
                                           const PathLimits& limits, const StopPoint& stop = {});

/// The same to several levels of a plane that is not layered out of one fan of so many rays, right
/// as means over cells (raytrace/tracing/level_hits.h). \param grid  without fine cells
/// \return [levels]
[[nodiscard]] std::vector<BoundaryPaths> mean_paths(
    const EigenraySolver& solver, double source_depth, std::span<const GroundLevel> levels,
    const GroundGrid& grid, double max_range, double frequency, const PathLimits& limits, int rays);

}  // namespace asdic::detail
