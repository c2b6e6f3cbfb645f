#pragma once
#include <string>

#include "sonar/scenario/track.h"

namespace asdic {

/// What carries transmitters and arrays: a ship, a vehicle, a buoy.
struct Platform {
  std::string name = "platform";
  Track track;  ///< of its reference point
};

}  // namespace asdic
