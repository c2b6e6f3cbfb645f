#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "raytrace/beams/beam.h"
#include "raytrace/beams/boundary_rows.h"
#include "raytrace/beams/ray_at_columns.h"

namespace asdic::detail {

/// A majorant of the error that comes of a fan's being finite, receiver by receiver, for hat and
/// Gaussian beams in Cartesian coordinates: how badly two neighbouring rays foretell each other
/// (place, delay, amplitude, width) bounds what is wrong between them, and bounds of all ray tubes
/// are added without regard to sign. docs/theory/fields.md, "Error bound"
class TubeError {
 public:
  /// \param first_left_out, last_left_out  rows in [first, last) count for no share
  /// \param walls  receivers on the boundaries, where each beam brings its partner; null: none
  TubeError(const BeamSetting& setting, std::span<const double> depths, std::size_t columns,
            std::size_t first_left_out = 0, std::size_t last_left_out = 0,
            const BoundaryRows* walls = nullptr);

  /// Adds the tube between two neighbouring rays, `width` rad apart.
  /// \param level  [columns] what an error is held against, in units of the sum before field_scale
  /// \return the tube's share: receivers × error / level, errors above the level counting as that
  double add(const RayAtColumns& lower, const RayAtColumns& higher, double width,
             std::span<const double> level);

  /// Adds what the fan's first or last ray brings: its beam stands for rays beyond it too.
  double add_end(const RayAtColumns& ray, double width, std::span<const double> level);

  /// To be called once, after the last tube: at(column, row) is the majorant from then on, of the
  /// pressure, or of the intensity, before field_scale.
  void finish();
  [[nodiscard]] double at(std::size_t column, std::size_t row) const noexcept {
    return sum_[column * stride_ + row];
  }

 private:
  /// An error between two depths, falling off like a Gaussian of width `sigma` beyond them.
  struct Piece {
    double error, from, to, sigma;
    [[nodiscard]] double at(double depth) const noexcept;
  };
  /// An array for each.
  struct Pieces {
    std::vector<double> error, from, to, sigma;
    void resize(std::size_t n);
    [[nodiscard]] Piece operator[](std::size_t n) const noexcept {
      return {error[n], from[n], to[n], sigma[n]};
    }
  };
  /// Of one tube, [crossings]: all over it; and where it is torn also what its two rays bring.
  struct Bounds {
    Pieces tube, lower, higher;
    void resize(std::size_t n);
  };
  /// Crossings of two neighbours with the same column.
  struct Pair {
    const RayAtColumns &a, &b;
    std::size_t i, j;
    double width;
  };
  void bound(const RayAtColumns& a, std::size_t i, const RayAtColumns& b, std::size_t j,
             std::size_t count, double width, Bounds& out) const;
  template <bool hat, bool coherent>
  void bound_of_kind(const RayAtColumns& a, std::size_t i, const RayAtColumns& b, std::size_t j,
                     std::size_t count, double width, Bounds& out) const;
  [[nodiscard]] Piece alone(const RayAtColumns& ray, std::size_t i, double width) const noexcept;
  double put_alone(const RayAtColumns& ray, std::size_t i, double width, double level);
  double put_tube(std::size_t column, std::size_t n, double level, const Pair& pair);
  double put(std::size_t column, const Piece& piece, double level);
  double put_between(std::size_t column, double error, double from, double to);

  // At receivers on the boundaries, where nothing else counts: tube_error.cpp.
  double put_tube_at_walls(std::size_t column, std::size_t n, double level, const Pair& pair);
  double put_alone_at_walls(const Piece& piece, const RayAtColumns& ray, std::size_t i,
                            double level);
  double put_at_wall(BoundaryKind kind, std::size_t column, double error, double level);
  bool unfold(const RayAtColumns& ray, std::size_t i, BoundaryKind kind,
              const WallMeeting& meeting);
  [[nodiscard]] std::size_t on_walls(std::size_t column, std::size_t first,
                                     std::size_t last) const noexcept;
  void finish_walls();

  BeamSetting setting_;
  std::span<const double> depths_;
  double first_depth_ = 0.0, per_spacing_ = 0.0;        // of evenly spaced depths, else 0
  std::size_t first_left_out_ = 0, last_left_out_ = 0;  // rows
  std::size_t stride_ = 0;
  std::vector<double> sum_;  // [columns × (rows + 1)] changes from row to row
  Bounds bounds_, wall_bounds_;
  RayAtColumns unfolded_;  // one crossing, as if it had not been reflected yet
  const BoundaryRows* walls_ = nullptr;
  std::vector<double> at_walls_[2];        // [columns] of surface and bottom
  std::vector<std::int32_t> head_, next_;  // of crossings of the same column
};

}  // namespace asdic::detail
