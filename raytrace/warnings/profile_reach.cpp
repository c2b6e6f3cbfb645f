#include <cstdio>

#include "raytrace/warnings/warnings.h"

namespace asdic::detail::checks {

std::string profile_reach(double first, double last, const Environment& ocean,
                          const std::string& beyond) {
  const double top = ocean.surface.shape ? ocean.surface.shape->shallowest() : ocean.surface.depth;
  const double bottom = ocean.bottom.shape ? ocean.bottom.shape->deepest() : ocean.bottom.depth;
  const double slack = 0.01 * (bottom - top);  // of casts that begin below the hull
  if (first <= top + slack && last >= bottom - slack) return "";
  char text[256];
  std::snprintf(text, sizeof text,
                "environment.sound_speed: levels from %g to %g m stand for water from %g to %g m; "
                "above and below them %s",
                first, last, top, bottom, beyond.c_str());
  return text;
}

std::string profile_reach(const Environment& ocean) {
  const std::span<const double> depth =
      ocean.section ? ocean.section->depths() : ocean.water.depths();
  if (depth.size() < 2) return "";  // a law, or the same speed everywhere
  return profile_reach(depth.front(), depth.back(), ocean,
                       "the law of the first and last interval goes on");
}

}  // namespace asdic::detail::checks
