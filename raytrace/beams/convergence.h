#pragma once
#include <complex>
#include <functional>
#include <string>
#include <vector>

#include "raytrace/beams/fan.h"
#include "raytrace/beams/fan_field.h"
#include "raytrace/beams/fan_progress.h"
#include "raytrace/cases/beam_error_text.h"
#include "raytrace/ocean/level_rays.h"

namespace asdic::detail {

/// A field and how sure it is of its number of beams.
struct ConvergedField {
  std::vector<std::complex<double>> field;  ///< [rows × ranges]
  std::size_t beams = 0;
  bool waves = false;     ///< it is that of the wave equation (waves/wave_field.h)
  double error_db = 0.0;  ///< |ΔTL| to infinitely many beams, at 95 % of the cells; no more than
  bool bounded = false;   ///< this is sure (TubeError), else an estimate
  std::vector<float> errors;  ///< [rows × ranges] the same of each receiver [dB]; ∞ where no number
                              ///< bounds it, NaN where it does not count (too faint, outside of the
                              ///< water, a row without limit) or was not looked at; empty where
                              ///< no two fans were compared
  std::string note;  ///< what the user should know
};

/// The field of a fan and what else is to be known of it.
using FieldOfFan = std::function<FanField(const BeamFan&, const FieldCheck&)>;

/// Makes the fan denser until the field is sure to `wanted_bound_db` where there is an error bound
/// (has_error_bound): hats where their tubes need it, Gaussians evenly. Other kinds: until it is as
/// good as every second beam of it to `wanted_error_db`, allowing for the rate at which that
/// difference shrinks. Or until two doublings have made it no surer (DoublingsInVain): what is left
/// is told. docs/theory/fields.md
/// \param level  of the source: its row of receivers, if not the only one, is left out of the rule,
/// and the note says so   \param progress  is told of every fan before it is summed
[[nodiscard]] ConvergedField converged_field(const PropagationCase& run_case,
                                             const FieldOfFan& field_of,
                                             const LevelRays& level = {}, double source_depth = 0.0,
                                             FanProgress* progress = nullptr);

/// Whether more beams still help. They do where a doubling makes half a percent more of the
/// receivers sure, or leaves 2 % fewer of them with an error of 1 or more, or a median error
/// smaller by 5 %. After two doublings that did none of it, no more can be expected: where a sea
/// scatters rays so that neighbours part at once, twice as many tell as little.
class DoublingsInVain {
 public:
  /// \param errors  of the receivers with that many beams, NaN where one does not count: bounds
  /// over the pressure, of which 1 is none, or estimates [dB]   \param sure  the largest of a sure
  /// one \return whether more beams are in vain
  bool add(std::size_t beams, const std::vector<double>& errors, double sure);

 private:
  struct Certainty {
    double sure = 0.0, unbounded = 1.0, median = 0.0;
  };
  Certainty before_;
  std::size_t beams_ = 0;
  int in_vain_ = 0;
};

inline constexpr double wanted_bound_db = sure_db;  ///< |ΔTL| at 95 % of the cells
inline constexpr double wanted_error_db = 0.2;      ///< the same where it can only be estimated
inline constexpr int most_beams = 32'769;           ///< beyond this the error is told and left

/// What a share of the cells is sure to, |ΔTL| [dB], ∞ where it is sure of no number; of those
/// where field or bound is above the floor of level_difference_db. \param bound  majorant of the
/// error of a pressure or, if not coherent, of its square
[[nodiscard]] double bound_db(const std::vector<std::complex<double>>& field,
                              const std::vector<double>& bound, bool coherent, double share);

/// |ΔTL| that a share of the cells stays below [dB], among those where either is above the floor:
/// 100 dB below 1 m, or 60 dB below the strongest, whatever is fainter.
[[nodiscard]] double level_difference_db(const std::vector<std::complex<double>>& a,
                                         const std::vector<std::complex<double>>& b, double share);

}  // namespace asdic::detail
