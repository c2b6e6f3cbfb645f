#pragma once
#include <optional>

#include "raytrace/cases/propagation_case.h"
#include "raytrace/cases/propagation_result.h"
#include "raytrace/parallel/progress.h"

namespace asdic::detail {

/// Which of BELLHOP's habits a literal run keeps. Each can be changed alone, so that what it costs
/// can be told (`asdic explain`).
struct BellhopEmulationOptions {
  std::optional<double> step;  ///< instead of the case's [m]
  std::optional<int> beams;    ///< instead of the case's number
  bool merge = true;  ///< an arrival joins the last one stored if delay and phase are close;
                      ///< without, every beam leaves its own
  bool single_precision =
      true;  ///< fields are summed in float32, delays of arrivals stored in float32
  bool unit_normals =
      false;  ///< curvilinear boundaries reflect with normals made unit vectors, and
              ///< bend as their tangents turn: what BELLHOP would do without its slip
};

/// A case as 2-D BELLHOP does it: second-order steps of hundreds of metres that land on every depth
/// of the profile, its reflections and its seven kinds of beams, its rule for the number of beams,
/// its merging of arrivals and its single precision. The field has asdic's sign: minus BELLHOP's.
/// Arrivals stay in the order in which BELLHOP stores them, several for a path. Written from a
/// description in words; docs/theory/bellhop-emulation.md.
[[nodiscard]] PropagationResult run_bellhop_emulation(const PropagationCase& run_case,
                                                      const BellhopEmulationOptions& options,
                                                      const Progress& progress = {});

}  // namespace asdic::detail
