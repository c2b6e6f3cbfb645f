#include "sonar/scenario/array.h"

#include <cmath>
#include <string>

#include "core/error.h"

namespace asdic {

ReceiverArray line_array(int phones, double spacing, double heading, double pitch) {
  if (phones < 1)
    throw InputError(
        {.where = "phones", .got = std::to_string(phones), .expected = "at least 1 phone"});
  if (!((spacing > 0.0 || phones == 1) && std::isfinite(spacing)))
    throw InputError(
        {.where = "spacing", .got = std::to_string(spacing) + " m", .expected = "above 0 m"});
  if (!std::isfinite(heading) || !std::isfinite(pitch))
    throw InputError({.where = std::isfinite(heading) ? "pitch" : "heading",
                      .got = "nan or infinity",
                      .expected = "an angle"});
  // Along the line from the first phone to the last; positive pitch raises the last (z is down).
  const Vec3 along(std::sin(heading) * std::cos(pitch), std::cos(heading) * std::cos(pitch),
                   -std::sin(pitch));
  ReceiverArray array;
  for (int i = 0; i < phones; ++i)
    array.phones.push_back((i - 0.5 * (phones - 1)) * spacing * along);
  return array;
}

}  // namespace asdic
