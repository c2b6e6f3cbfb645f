#pragma once
#include <complex>
#include <cstddef>
#include <string>
#include <vector>

#include "raytrace/cases/ray_path.h"
#include "raytrace/ocean/arrivals.h"

namespace asdic::detail {

/// The answer of a run; what was not asked for is empty.
///
/// Pressure is relative to 1 m from the source, time dependence e^{+iωt}, TL = −20·log₁₀|p|, and
/// the coherent field is the sum of the arrivals. Incoherent and semi-coherent fields hold the root
/// of the intensity, as a real number.
struct PropagationResult {
  std::vector<std::complex<float>> field;  ///< [sources × rows × ranges], range fastest
  std::vector<Arrivals> arrivals;          ///< [sources × rows × ranges], range fastest
  std::vector<std::vector<RayPath>> rays;  ///< [sources] rays, or eigenrays to all receivers
  std::size_t beams = 0;                   ///< rays traced per source
  bool waves = false;                      ///< the field is that of the wave equation, without rays
  double beam_error_db = 0.0;       ///< field: what more beams would change at 95 % of receivers
  bool beam_error_bounded = false;  ///< that is a bound (hat and Gaussian beams on a grid), else an
                                    ///< estimate
  std::vector<float> beam_errors;  ///< [sources × rows × ranges] the same of each receiver [dB], ∞
                                   ///< where no number bounds it, NaN where it is not known; empty
                                   ///< where no beams were counted (ConvergedField::errors)
  std::vector<std::string> notes;  ///< what the user should know
};

}  // namespace asdic::detail
