#include "raytrace/beam_error_text.h"

#include <cmath>
#include <cstdio>

namespace asdic {

std::string beam_error_text(double error_db, bool bounded) {
  if (!std::isfinite(error_db))
    return "what more beams would change cannot be bounded at 95 % of the receivers";
  char text[96];
  std::snprintf(text, sizeof text, "more beams would change %s %.2g dB at 95 %% of the receivers",
                bounded ? "no more than" : "about", error_db);
  return text;
}

}  // namespace asdic
