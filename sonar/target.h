#pragma once
#include <limits>
#include <string>

#include "sonar/track.h"

namespace asdic {

struct Target {
  std::string name = "target";
  Track track;
  double strength_db = 10.0;                        ///< TS [dB]
  int first_ping = 1;                               ///< the target is there from this ping …
  int last_ping = std::numeric_limits<int>::max();  ///< … to this one
};

}  // namespace asdic
