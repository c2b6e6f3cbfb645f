#pragma once
#include <cstdint>
#include <vector>

#include "raytrace/beams/beam.h"
#include "raytrace/beams/crossing.h"

namespace asdic {

/// Receivers that lie on the surface or on the bottom, where a wave and its reflection arrive at
/// once.
///
/// A ray is at a column either before its reflection or behind it, and a beam reaches a receiver on
/// the boundary from one side only: of two neighbours that enclose it one brings its incident, the
/// other its reflected wave, each by its weight. With w the weights of all incident beams and of
/// the reflected ones taken back to before their reflection, Σ w = 1; so each brings its own and
/// its twin, R of it or 1/R of it, and the sum is (1 + R) times the incident wave: nothing at a
/// vacuum. R at the angle that Snell's law gives the ray there. docs/theory/fields.md
class BoundaryRows {
 public:
  BoundaryRows(const Environment& environment, double frequency, const ReceiverGrid& grid);

  [[nodiscard]] bool any() const noexcept { return !surface_.empty() || !bottom_.empty(); }
  /// The row of a column's receiver on a boundary; −1: none.
  [[nodiscard]] std::int32_t row(BoundaryKind kind, std::size_t column) const noexcept {
    const auto& rows = kind == BoundaryKind::surface ? surface_ : bottom_;
    return rows.empty() ? -1 : rows[column];
  }
  /// Whether the sum of both is nothing whatever arrives: a smooth boundary with a vacuum.
  [[nodiscard]] bool silent(BoundaryKind kind, std::size_t column) const noexcept;
  /// What the twin of a beam is to the beam; 0 for a ray that turns before the boundary.
  [[nodiscard]] std::complex<double> twin(BoundaryKind kind, std::size_t column,
                                          const Crossing& x) const noexcept;

 private:
  [[nodiscard]] const Boundary& wall(BoundaryKind kind) const noexcept {
    return kind == BoundaryKind::surface ? environment_.surface : environment_.bottom;
  }
  const Environment& environment_;
  double frequency_;
  std::span<const double> ranges_;
  std::vector<std::int32_t> surface_, bottom_;  // [columns], or empty
};

namespace beams {
/// The twins of one ray's hat or Gaussian beam (Cartesian), receiver by receiver.
void add_twins(const BeamSetting& setting, const BeamLaunch& launch, const RayTrajectory& ray,
               const BoundaryRows& rows, FieldSum& field);
}  // namespace beams

}  // namespace asdic
