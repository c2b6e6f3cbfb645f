#include "raytrace/warnings/warnings.h"

namespace asdic::detail::checks {
namespace {

/// The setting that leaves the beams no width; null: they have one.
const char* without_width(const CervenyBeams& beams, const ReceiverGrid& receivers) {
  if (beams.width_multiplier == 0.0) return "width_multiplier = 0";
  if (beams.window == 0) return "window = 0";
  if (beams.width == CervenyBeams::Width::minimum && beams.loop_range <= 0.0)
    return "width = \"minimum\" without a loop_range above 0";
  const bool at_source = !receivers.ranges.empty() && receivers.ranges.back() == 0.0;
  if (beams.width == CervenyBeams::Width::cerveny && at_source)
    return "width = \"cerveny\" with receivers at range 0 alone";
  return nullptr;
}

}  // namespace

std::string silent_beams(const PropagationCase& run_case) {
  const BeamKind kind = run_case.beams.kind;
  if (run_case.task != Task::field ||
      (kind != BeamKind::cerveny_cartesian && kind != BeamKind::cerveny_ray_centred))
    return "";
  const char* const setting =
      without_width(run_case.beams.cerveny.value_or(CervenyBeams{}), run_case.receivers);
  if (setting == nullptr) return "";
  return std::string("run.beams.cerveny: ") + setting +
         " makes beams of no width: no sound reaches any receiver";
}

}  // namespace asdic::detail::checks
