#pragma once
#include <string>

#include "sonar/scenario/track.h"

namespace asdic::detail {

/// What carries transmitters and arrays: a ship, a vehicle, a buoy.
struct Platform {
  std::string name = "platform";
  Track track;  ///< of its reference point

  void describe(Fields& field);
};

}  // namespace asdic::detail
