#pragma once
#include <complex>
#include <span>
#include <vector>

#include "raytrace/beams/fan.h"
#include "raytrace/propagation.h"
#include "raytrace/tracing/ray_tracer.h"

namespace asdic {

/// The field of a case (Task::field), for each of its sources. The number of beams grows until the
/// field is sure (docs/theory/fields.md), unless the case lists its elevations: then
/// these are the fan; in isovelocity water between flat boundaries images are summed instead of
/// beams (runs/image_field.h), and in other stratified water, if the case's `solver` lets it, the
/// wave equation is solved (waves/wave_field.h). The same bits for any number of threads. \throws
/// InputError  a source outside the water, no receivers, a fan without width \throws Interrupted
/// when `progress` says so
[[nodiscard]] PropagationResult run_field(const PropagationCase& run_case,
                                          const Progress& progress = {});

/// How far rays of a field are followed: to the receivers and a little beyond, within the box.
[[nodiscard]] TraceLimits field_limits(const PropagationCase& run_case);

/// The same numbers by two ways: closed forms and eight receivers at a time where they apply, or
/// one ray, one receiver after the other.
enum class FieldMethod { fast, plain };

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

/// What run_field repeats.
[[nodiscard]] FanField field_of_fan(const PropagationCase& run_case, const RayTracer& tracer,
                                    double source_depth, const BeamFan& fan,
                                    const Progress& progress = {},
                                    FieldMethod method = FieldMethod::fast,
                                    const FieldCheck& also = {});

}  // namespace asdic
