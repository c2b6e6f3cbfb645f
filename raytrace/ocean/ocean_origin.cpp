#include "raytrace/ocean/ocean_origin.h"

namespace asdic::detail {

void OceanSource::describe(Fields& field) {
  field(required("quantity"), quantity, "that was read from the file");
  field(required("name"), name, "of the file");
  field(seldom("variable"), variable, "of it");
  field(seldom("digest"), digest, "of the file: which version of it");
  field(seldom("time"), time, "what was averaged or interpolated in time");
}

void OceanOrigin::describe(Fields& field) {
  constexpr AngleQuantity north{.noun = "latitude", .low_deg = -90.0, .high_deg = 90.0};
  constexpr AngleQuantity east{.noun = "longitude", .low_deg = -360.0, .high_deg = 360.0};
  field(required("latitude"), latitude, north, "of the map's [0, 0], north");
  field(required("longitude"), longitude, east, "of the map's [0, 0], east");
  field(seldom("time"), time, "that the ocean is of");
  field("source", sources, "files that the ocean was made of");
}

std::vector<std::string> OceanOrigin::source_lines() const {
  std::vector<std::string> lines;
  for (const OceanSource& source : sources) {
    lines.push_back(source.quantity + ": " + source.name);
    for (const std::string* part : {&source.variable, &source.time})
      if (!part->empty()) lines.back() += ", " + *part;
    if (!source.digest.empty()) lines.back() += " (" + source.digest + ")";
  }
  return lines;
}

}  // namespace asdic::detail
