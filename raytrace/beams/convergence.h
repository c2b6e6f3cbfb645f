#pragma once
#include <complex>
#include <functional>
#include <string>
#include <vector>

#include "raytrace/beams/fan.h"
#include "raytrace/beams/field_run.h"

namespace asdic {

/// A field and how sure it is of its number of beams.
struct ConvergedField {
  std::vector<std::complex<double>> field;  ///< [rows × ranges]
  std::size_t beams = 0;
  double error_db = 0.0;  ///< estimate of |ΔTL| to infinitely many beams, at 95 % of the cells
  std::string note;       ///< what the user should know
};

/// The field of a fan and of every second beam of it.
using FieldOfFan = std::function<FanField(const BeamFan&)>;

/// Makes the fan denser until it is as good as every second beam of it to `wanted_error_db`,
/// allowing for the rate at which that difference shrinks. docs/theory/fields.md
[[nodiscard]] ConvergedField converged_field(const PropagationCase& run_case,
                                             const FieldOfFan& field_of);

inline constexpr double wanted_error_db = 0.2;  ///< |ΔTL| at 95 % of the cells
inline constexpr int most_beams = 65'537;       ///< beyond this the error is told and left

/// |ΔTL| that a share of the cells stays below [dB], among those where either is above the floor:
/// 100 dB below 1 m, or 60 dB below the strongest, whatever is fainter.
[[nodiscard]] double level_difference_db(const std::vector<std::complex<double>>& a,
                                         const std::vector<std::complex<double>>& b, double share);

}  // namespace asdic
