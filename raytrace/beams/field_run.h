#pragma once
#include <complex>
#include <vector>

#include "raytrace/beams/fan.h"
#include "raytrace/propagation.h"
#include "raytrace/tracing/ray_tracer.h"

namespace asdic {

/// The field of a case (Task::field), for each of its sources. The number of beams is doubled until
/// the field stays what it is (docs/theory/fields.md), unless the case lists its elevations: then
/// these are the fan. The same bits for any number of threads. \throws InputError  a source outside
/// the water, no receivers, a fan without width \throws Interrupted when `progress` says so
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
      half;  ///< the same of beams 0, 2, 4, …, twice as wide, if asked for
};

/// What run_field repeats. \param with_half  fill `half` (the fan has an odd number of beams)
[[nodiscard]] FanField field_of_fan(const PropagationCase& run_case, const RayTracer& tracer,
                                    double source_depth, const BeamFan& fan,
                                    const Progress& progress = {},
                                    FieldMethod method = FieldMethod::fast, bool with_half = false);

}  // namespace asdic
