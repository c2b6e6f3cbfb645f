#include "raytrace/runs/single_beam.h"

#include <string>

#include "core/error.h"
#include "raytrace/bellhop_emulation/fan.h"
#include "raytrace/bellhop_emulation/water.h"

namespace asdic::detail {

std::optional<SingleBeam> single_beam(const PropagationCase& run_case) {
  const std::optional<int>& wanted = run_case.literal.single_beam;
  if (!wanted) return std::nullopt;
  const bellhop_emulation::LiteralWater water(run_case.environment, run_case.frequency);
  const bellhop_emulation::LiteralFan fan =
      bellhop_emulation::make_fan(run_case, {}, water.last_depth() - water.first_depth());
  const std::size_t n = fan.declinations.size();
  if (*wanted < 1 || static_cast<std::size_t>(*wanted) > n)
    throw InputError({.where = "literal.single_beam",
                      .got = std::to_string(*wanted),
                      .expected = "a beam of the fan, 1 to " + std::to_string(n)});
  return SingleBeam{.elevation = -fan.declinations[fan.first], .spacing = fan.spacing};
}

PropagationCase narrowed_to(const SingleBeam& beam, const PropagationCase& run_case) {
  PropagationCase narrow = run_case;
  narrow.literal.single_beam.reset();
  narrow.beams.elevations.clear();
  narrow.beams.lowest = beam.elevation - 0.5 * beam.spacing;
  narrow.beams.highest = beam.elevation + 0.5 * beam.spacing;
  return narrow;
}

}  // namespace asdic::detail
