#include "reverb/scattering/motion.h"

#include "core/fields.h"
#include "core/quantities.h"

namespace asdic::detail {

void ScattererMotion::describe(Fields& field) {
  field("motion", kind, "how the scatterers move, but for the current");
  if (const auto only = field.only("motion", kind, Kind::bragg))
    field("receding_share", receding_share, {.noun = "share", .low = 0.0, .high = 1.0},
          "of the waves, those that lower the frequency");
  if (const auto only = field.only("motion", kind, Kind::spread))
    field(required("speed_rms"), speed_rms,
          {.noun = "speed", .unit = "m/s", .low = 0.0, .high = 20.0},
          "of each component of a scatterer's velocity");
  field("current", current, quantity::velocity, "with which all of them drift",
        "two numbers: towards east and north,");
}

}  // namespace asdic::detail
