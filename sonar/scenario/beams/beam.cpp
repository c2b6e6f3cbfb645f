#include "sonar/scenario/beams/beam.h"

#include <sstream>

#include "core/quantities.h"

namespace asdic::detail {

void BeamBearing::describe(Fields& field) {
  field("bearing", bearing, quantity::bearing, "that the beam is turned to");
  field("bearing_from", frame, "what bearings and offsets count from");
}

std::string BeamBearing::text() const {
  std::ostringstream text;
  text << compass_degrees(bearing) << " deg from "
       << (frame == BearingFrame::heading ? "the heading" : "north");
  return text.str();
}

}  // namespace asdic::detail
