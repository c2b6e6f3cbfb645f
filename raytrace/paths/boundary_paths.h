#pragma once
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

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

/// The cells of a ground: rings around the source, `spacing` wide; beyond the first of them wider,
/// and right at a source that is near to the ground finer.
class GroundGrid {
 public:
  GroundGrid() = default;
  GroundGrid(double spacing) : spacing_(spacing), wide_(spacing) {}  // NOLINT: all alike
  /// \param wide  at least the spacing   \param near  up to which cells are no wider [m]
  GroundGrid(double spacing, double wide, double near)
      : spacing_(spacing),
        wide_(wide),
        near_cells_(wide > spacing ? std::ceil(near / spacing) : 0.0) {}

  /// The first rings, up to four times a source's height over the ground, no wider than an eighth
  /// of that. \param height  [m]
  [[nodiscard]] GroundGrid fine_below(double height) const noexcept {
    constexpr double per_height = 8.0, heights = 4.0, most = 64.0;
    GroundGrid grid = *this;
    const double parts = std::min(most, std::ceil(per_height * spacing_ / std::max(height, 1e-3)));
    if (!(parts > 1.0)) return grid;
    grid.divided_ = std::ceil(heights * height / spacing_);
    grid.parts_ = parts;
    return grid;
  }

  [[nodiscard]] double spacing() const noexcept { return spacing_; }  ///< [m]
  [[nodiscard]] double wide() const noexcept { return wide_; }        ///< [m]
  /// Of the cells about a range, but for wide ones [m].
  [[nodiscard]] double spacing_at(double range) const noexcept {
    return range < divided_ * spacing_ ? spacing_ / parts_ : spacing_;
  }
  /// The centre of a cell [m].
  [[nodiscard]] double range(std::size_t cell) const noexcept {
    const double fine = divided_ * parts_;
    if (double(cell) < fine) return (double(cell) + 0.5) * (spacing_ / parts_);
    const double i = double(cell) - fine + divided_;
    return i < near_cells_ ? (i + 0.5) * spacing_
                           : near_cells_ * spacing_ + (i - near_cells_ + 0.5) * wide_;
  }
  /// The cell that a range lies in, with what it lies beyond the cell's inner edge as a fraction.
  [[nodiscard]] double at(double range) const noexcept {
    const double cells = range / spacing_;
    if (cells < divided_) return cells * parts_;
    return divided_ * (parts_ - 1.0) +
           (cells < near_cells_ ? cells : near_cells_ + (range - near_cells_ * spacing_) / wide_);
  }
  /// How many cells have their centres before a range: the first of the others.
  [[nodiscard]] std::size_t count(double range) const noexcept {
    return std::size_t(std::max(0.0, std::ceil(at(range) - 0.5)));
  }

 private:
  double spacing_ = 1.0, wide_ = 1.0, near_cells_ = 0.0;
  double divided_ = 0.0, parts_ = 1.0;  // the first cells of `spacing`, each into so many
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
/// the water lies where the water reaches so deep. \param grid  wide cells in layered oceans alone;
/// paths are as right as the spacing asks for in all of them   \param max_range [m]
/// \param frequency  [Hz]
[[nodiscard]] BoundaryPaths boundary_paths(const EigenraySolver& solver, double source_depth,
                                           const GroundLevel& level, const GroundGrid& grid,
                                           double max_range, double frequency,
                                           const PathLimits& limits, const StopPoint& stop = {});

}  // namespace asdic::detail
