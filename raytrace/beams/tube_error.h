#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "raytrace/beams/beam.h"
#include "raytrace/beams/crossings.h"

namespace asdic {

/// One ray of a fan where it crosses the columns, and its beam's launch_factor.
struct RayAtColumns {
  double launched = 1.0;
  Crossings crossings;
};

/// A majorant of the error that comes of a fan's being finite, receiver by receiver, for hat and
/// Gaussian beams in Cartesian coordinates: how badly two neighbouring rays foretell each other
/// (place, delay, amplitude, width) bounds what is wrong between them, and bounds of all ray tubes
/// are added without regard to sign. docs/theory/fields.md, "Error bound"
class TubeError {
 public:
  TubeError(const BeamSetting& setting, std::span<const double> depths, std::size_t columns);

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
  /// An error between two depths, where it falls off like a Gaussian of width `sigma` beyond them.
  struct Piece {
    double error, from, to, sigma;
  };
  /// The bound of one tube at one column: all over it or, where its rays do not foretell each
  /// other, also what each of the two brings.
  struct Bound {
    Piece tube, lower, higher;
  };
  [[nodiscard]] Bound bound(const RayAtColumns& a, std::size_t i, const RayAtColumns& b,
                            std::size_t j, double width) const noexcept;
  [[nodiscard]] Bound alone(const RayAtColumns& a, std::size_t i, double width) const noexcept;
  double put(std::size_t column, const Bound& bound, double level);
  double put(std::size_t column, const Piece& piece, double level);
  double put_between(std::size_t column, double error, double from, double to);

  BeamSetting setting_;
  std::span<const double> depths_;
  double first_depth_ = 0.0, per_spacing_ = 0.0;  // of evenly spaced depths, else 0
  std::size_t stride_ = 0;
  std::vector<double> sum_;                // [columns × (rows + 1)] changes from row to row
  std::vector<Bound> bounds_;              // of one tube, [crossings]
  std::vector<std::int32_t> head_, next_;  // of crossings of the same column
};

}  // namespace asdic
