#include "sonar/scenario/beams/beam.h"

#include <sstream>

#include "core/quantities.h"

namespace asdic::detail {

void BeamBearing::describe(Fields& field) {
  field("bearing", bearing, quantity::bearing,
        "that the beam is turned to, relative to bearing_from");
  field("bearing_from", frame,
        "what bearings and offsets count from: true north, or the platform's heading");
}

std::string BeamBearing::text() const {
  std::ostringstream text;
  text << compass_degrees(bearing)
       << (frame == BearingFrame::heading ? " deg relative to the heading" : " deg true");
  return text.str();
}

}  // namespace asdic::detail
