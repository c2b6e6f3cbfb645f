#pragma once
#include <complex>
#include <functional>
#include <string>
#include <vector>

#include "raytrace/beams/fan.h"

namespace asdic {

/// A field and how sure it is of its number of beams.
struct ConvergedField {
  std::vector<std::complex<double>> field;  ///< [rows × ranges]
  std::size_t beams = 0;
  double error_db =
      0.0;           ///< estimate of |ΔTL| to the limit of infinitely many, at 95 % of the cells
  std::string note;  ///< what the user should know
};

using FieldOfFan = std::function<std::vector<std::complex<double>>(const BeamFan&)>;

/// Doubles the number of beams until the field stays what it is. docs/theory/fields.md
[[nodiscard]] ConvergedField converged_field(const PropagationCase& run_case, double source_depth,
                                             const FieldOfFan& field_of);

/// The field of one given fan; its error is not known.
[[nodiscard]] ConvergedField fixed_field(const BeamFan& fan, const FieldOfFan& field_of);

/// |ΔTL| that a share of the cells stays below [dB], among those where either is above the floor:
/// 100 dB below 1 m, or 60 dB below the strongest, whatever is fainter.
[[nodiscard]] double level_difference_db(const std::vector<std::complex<double>>& a,
                                         const std::vector<std::complex<double>>& b, double share);

}  // namespace asdic
