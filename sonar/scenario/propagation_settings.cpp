#include "sonar/scenario/propagation_settings.h"

#include "core/fields.h"

namespace asdic::detail {

void PropagationSettings::describe(Fields& field) {
  field(
      "dimension", dimension, 2, 3,
      "2: rays keep to the vertical plane through both places; 3: they are turned out of it, too");
  field(or_word("max_surface_bounces", "auto"), max_surface_bounces, 0, 1000,
        "of a path; auto: as many as there is sound in");
  field(or_word("max_bottom_bounces", "auto"), max_bottom_bounces, 0, 1000,
        "of a path; auto: as many as there is sound in");
  field("max_launch_angle", max_launch_angle,
        AngleQuantity{.noun = "angle", .low_deg = 0.01, .high_deg = 90.0},
        "of a path, from the horizontal");
  field("direct_blast", direct_blast,
        "whether arrays on other platforms receive the ping itself, without a target");
  field("fathometer", fathometer,
        "whether arrays on the transmitter's platform receive the ping mirrored by surface and "
        "bottom");
  field(
      "band", band,
      "losses, patterns and waves at the centre, or at every frequency of the pulse; auto: echoes "
      "and direct sound at every frequency where that changes them");
  field("exact_per_phone", exact_per_phone,
        "eigenrays to every phone, also where a plane wave is enough");
  field("diffraction", diffraction, "whether sound goes where no ray does, in stratified water");
}

}  // namespace asdic::detail
