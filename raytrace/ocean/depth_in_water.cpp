#include "raytrace/ocean/depth_in_water.h"

#include "core/error.h"
#include "core/text.h"

namespace asdic::detail {

double depth_in_water(const Environment& environment, const std::string& what, double depth,
                      double range) {
  const double top = environment.surface.depth_at(range),
               bottom = environment.bottom.depth_at(range);
  if (depth >= top && depth <= bottom) return depth;
  throw InputError(
      {.where = what,
       .got = to_text(depth) + " m",
       .expected = "a depth between " + to_text(top) + " and " + to_text(bottom) + " m"});
}

}  // namespace asdic::detail
