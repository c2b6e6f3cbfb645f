#include "io/scenario/materials/elastic.h"

#include <cmath>

#include "core/text.h"
#include "core/units.h"
#include "raytrace/ocean/strongest_reflection.h"

namespace asdic::detail::scenario {

ElasticHalfSpace ElasticForm::build(const MaterialPlace& place) const {
  const StrongestReflection most = strongest_reflection(solid, place.water);
  if (most.magnitude > most_reflection)
    throw place.table.fault(
        "kind",
        "a solid that reflects no more than comes in: attenuation x speed^2 at least "
        "4/3 of that of its shear waves",
        "one of reflection coefficient " + to_text(most.magnitude) + " at " +
            to_text(std::round(10.0 * degrees(most.grazing)) / 10.0) + " degrees");
  // A solid that takes energy in every deformation: Im of its bulk modulus not below 0.
  const double shear =
      4.0 / 3.0 * solid.shear_attenuation_db_per_wavelength * solid.shear_speed * solid.shear_speed;
  if (shear > (1.0 + 1e-9) * solid.attenuation_db_per_wavelength * solid.speed * solid.speed)
    place.reading.notes.push_back(
        place.table.where("kind") +
        ": its shear waves lose so much more than its compressional waves that squeezing it would "
        "give energy; beside other water it may reflect more than comes in");
  return solid;
}

}  // namespace asdic::detail::scenario
