#pragma once
#include <complex>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/memory_budget.h"
#include "raytrace/arrivals.h"
#include "raytrace/propagation_case.h"
#include "raytrace/ray_path.h"

namespace asdic {

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

/// A run was stopped by its Progress.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Called now and then with the share that is done (0..1) from any thread; returning false stops
/// the run (Interrupted is thrown).
using Progress = std::function<bool(double)>;

/// Runs a case with asdic's own tracer. Results do not depend on the number of threads.
/// \param budget  that the run keeps within
/// \throws InputError if the case makes no sense (a source outside the water, no receivers);
/// MemoryError if it is too large
[[nodiscard]] PropagationResult run(const PropagationCase& run_case, const Progress& progress = {},
                                    const MemoryBudget& budget = {});

/// The same case as BELLHOP does it: its own steps, landing rules, beam formulas and merging, for
/// comparison (docs/theory/like-bellhop.md). The field has asdic's sign.
[[nodiscard]] PropagationResult run_like_bellhop(const PropagationCase& run_case,
                                                 const Progress& progress = {},
                                                 const MemoryBudget& budget = {});

}  // namespace asdic
