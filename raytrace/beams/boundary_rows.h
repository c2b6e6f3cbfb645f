#pragma once
#include <cstdint>
#include <vector>

#include "raytrace/beams/beam.h"
#include "raytrace/beams/crossing.h"

namespace asdic::detail {

/// A ray near a receiver on a boundary, as Snell's law has it there.
struct WallMeeting {
  bool there = false;               ///< false: it turns before the boundary
  bool reflected = false;           ///< it leaves the boundary
  double slope = 0.0;               ///< dz/dr of the boundary
  std::complex<double> reflection;  ///< R
  /// What the partner of its beam is to the beam: R, or 1/R behind the reflection; 0: it has none.
  [[nodiscard]] std::complex<double> partner() const noexcept;
};

/// Receivers that lie on the surface or on the bottom, where a wave and its reflection arrive at
/// once.
///
/// A ray is at a column either before its reflection or behind it, and a beam reaches a receiver on
/// the boundary from one side only: of two neighbours that enclose it one brings its incident, the
/// other its reflected wave, each by its weight. With w the weights of all incident beams and of
/// the reflected ones taken back to before their reflection, Σ w = 1; so each brings its own and
/// its partner, R of it or 1/R of it, and the sum is (1 + R) times the incident wave: nothing at a
/// vacuum. R at the angle that Snell's law gives the ray there. docs/theory/fields.md
class BoundaryRows {
 public:
  /// \param coherent  pressures are added, else intensities
  BoundaryRows(const Environment& environment, double frequency, const ReceiverGrid& grid,
               bool coherent);

  [[nodiscard]] bool any() const noexcept { return !surface_.empty() || !bottom_.empty(); }
  /// Whether a column's receiver on this boundary is not silent.
  [[nodiscard]] bool received(BoundaryKind kind) const noexcept {
    return received_[kind == BoundaryKind::surface ? 0 : 1];
  }
  /// The row that is on the boundary in all columns; −1: none is.
  [[nodiscard]] std::int32_t row_of_all(BoundaryKind kind) const noexcept {
    return same_row_[kind == BoundaryKind::surface ? 0 : 1];
  }
  /// The row of a column's receiver on a boundary; −1: none.
  [[nodiscard]] std::int32_t row(BoundaryKind kind, std::size_t column) const noexcept {
    const auto& rows = of(kind);
    return rows.empty() ? -1 : rows[column];
  }
  /// Whether the sum of both is nothing whatever arrives: of pressures, at a smooth boundary with a
  /// vacuum.
  [[nodiscard]] bool silent(BoundaryKind kind, std::size_t column) const noexcept {
    return (kind == BoundaryKind::surface ? silent_surface_ : silent_bottom_)[column] != 0;
  }
  /// A ray with these at its column. \param cosine, sine, speed  of it (Crossing)
  [[nodiscard]] WallMeeting meeting(BoundaryKind kind, std::size_t column, double cosine,
                                    double sine, double speed) const noexcept;
  /// What the partner of a beam is to the beam.
  [[nodiscard]] std::complex<double> partner(BoundaryKind kind, std::size_t column,
                                             const Crossing& x) const noexcept {
    return meeting(kind, column, x.cosine, x.sine, x.speed).partner();
  }

 private:
  [[nodiscard]] const std::vector<std::int32_t>& of(BoundaryKind kind) const noexcept {
    return kind == BoundaryKind::surface ? surface_ : bottom_;
  }
  [[nodiscard]] const Boundary& wall(BoundaryKind kind) const noexcept {
    return kind == BoundaryKind::surface ? environment_.surface : environment_.bottom;
  }
  const Environment& environment_;
  double frequency_;
  bool coherent_;
  std::span<const double> ranges_;
  std::vector<std::int32_t> surface_, bottom_;               // [columns], or empty
  std::vector<std::int8_t> silent_surface_, silent_bottom_;  // likewise
  bool received_[2] = {false, false};
  std::int32_t same_row_[2] = {-1, -1};
};

/// The partners of one ray's beam, receiver by receiver: of every geometric kind. (Cerveny's beams
/// have their images.)
class BeamPairs {
 public:
  /// \param rows  kept by reference
  BeamPairs(const BoundaryRows& rows, const FieldSum& field);
  BeamPairs(const BeamPairs&) = delete;
  BeamPairs& operator=(const BeamPairs&) = delete;
  void add(const BeamSetting& setting, const BeamLaunch& launch, const RayTrajectory& ray,
           FieldSum& field);
  /// Leaves nothing where there is nothing to be had (BoundaryRows::silent), also of rays that turn
  /// just before the boundary.
  void silence(FieldSum& field) const;

 private:
  void add_ray_centred(const BeamSetting& setting, double launched, const RayTrajectory& ray,
                       FieldSum& field);

  const BoundaryRows& rows_;
  /// Receivers on one boundary as an irregular grid, whose spans are its own arrays.
  struct AtWall {
    BoundaryKind kind;
    std::vector<double> ranges, depths;
    std::vector<std::size_t> column, row;
    FieldSum field;
  };
  AtWall walls_[2] = {{.kind = BoundaryKind::surface}, {.kind = BoundaryKind::bottom}};
};

}  // namespace asdic::detail
