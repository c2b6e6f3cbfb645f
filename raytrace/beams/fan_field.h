#pragma once
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "raytrace/cases/propagation_case.h"

namespace asdic::detail {

/// The field of one source and one fan, and of every second beam of it.
struct FanField {
  std::vector<std::complex<double>> field;  ///< [rows × ranges], range fastest; a root of intensity
                                            ///< if it is not coherent
  std::vector<std::complex<double>>
      half;                   ///< the same of beams 0, 2, 4, …, twice as wide, if asked for
  std::vector<double> bound;  ///< [rows × columns looked at] majorant of the error of `field`; of
                              ///< its square if it is not coherent
  std::vector<double> tube_share;  ///< [beams − 1] of each ray tube in it (TubeError::add)
};

/// Columns of a grid that stand for all of them, evenly spread.
struct ColumnSample {
  std::size_t every = 1;

  [[nodiscard]] std::size_t first() const noexcept { return every / 2; }
  [[nodiscard]] std::size_t count(std::size_t columns) const noexcept {
    return columns > first() ? (columns - first() - 1) / every + 1 : 0;
  }
  /// The i-th of them. \param i  below count()
  [[nodiscard]] std::size_t column(std::size_t i) const noexcept { return first() + i * every; }
};

/// What is to be known of a field besides itself.
struct FieldCheck {
  bool half = false;            ///< every second beam of it (an odd number of beams)
  bool bound = false;           ///< its error bound; hat and Gaussian beams, Cartesian, on a grid
  bool between = false;         ///< rays between traced ones may be interpolated (RaysBetween)
  ColumnSample looked_at = {};  ///< the bound's columns
  std::span<const double>
      level;  ///< [ranges] the pressure that an error is held against (intensity
              ///< if not coherent); empty: that of the fan spread over depth
  std::size_t first_left_out = 0,
              last_left_out = 0;  ///< rows in [first, last) count for no tube_share
};

/// Whether FieldCheck::bound can be had.
[[nodiscard]] bool has_error_bound(const PropagationCase& run_case) noexcept;

}  // namespace asdic::detail
