#include "raytrace/cases/beam_error_text.h"

#include <cmath>
#include <cstdio>
#include <limits>

namespace asdic::detail {

std::string beam_error_text(double error_db, bool bounded) {
  if (!std::isfinite(error_db))
    return "what more beams would change cannot be bounded at 95 % of the receivers";
  char text[96];
  std::snprintf(text, sizeof text, "more beams would change %s %.2g dB at 95 %% of the receivers",
                bounded ? "no more than" : "about", error_db);
  return text;
}

double share_sure(std::span<const float> errors) {
  std::size_t known = 0, sure = 0;
  for (const float error : errors) {
    known += !std::isnan(error);
    sure += error <= static_cast<float>(sure_db);
  }
  return known > 0 ? static_cast<double>(sure) / static_cast<double>(known)
                   : std::numeric_limits<double>::quiet_NaN();
}

std::string certainty_text(double share) {
  char text[64];
  std::snprintf(text, sizeof text, "to %g dB at %d %% of the receivers", sure_db,
                static_cast<int>(std::floor(100.0 * share)));
  return text;
}

}  // namespace asdic::detail
