#include "io/hdf5/earth.h"

namespace asdic::detail {

LatitudesLongitudes on_earth(const EarthPlaces& earth, const std::vector<Vec2>& places) {
  LatitudesLongitudes all;
  for (const Vec2& place : places) {
    const GeographicPlace there = earth.at(place.x(), place.y());
    all.latitude.push_back(there.latitude);
    all.longitude.push_back(there.longitude);
  }
  return all;
}

void place_on_earth(Hdf5File& file, bool known, const std::string& dataset,
                    const std::string& more) {
  const std::string here = known ? "latitude longitude" : "";
  const std::string all = more + (more.empty() || here.empty() ? "" : " ") + here;
  if (!all.empty()) file.set_attribute(dataset, "coordinates", all);
}

void write_on_earth(Hdf5File& file, const EarthPlaces& earth, const std::string& prefix,
                    const std::string& whose, const std::vector<Vec2>& places, const Shape& shape,
                    const std::vector<std::string>& scales) {
  if (!earth.known()) return;
  const LatitudesLongitudes all = on_earth(earth, places);
  const std::string latitude = prefix + "latitude", longitude = prefix + "longitude";
  file.write<double>(latitude, all.latitude, shape);
  describe(file, latitude, "latitude " + whose, "degrees_north", cf::latitude);
  file.attach_scales(latitude, scales);
  file.write<double>(longitude, all.longitude, shape);
  describe(file, longitude, "longitude " + whose, "degrees_east", cf::longitude);
  file.attach_scales(longitude, scales);
}

void write_on_earth(Hdf5File& file, const EarthLine& line, const std::string& prefix,
                    const std::string& whose, const std::vector<double>& ranges, const Shape& shape,
                    const std::vector<std::string>& scales) {
  if (!line.known()) return;
  std::vector<Vec2> places;
  for (const double range : ranges) places.push_back(line.on_map(range));
  write_on_earth(file, line.earth(), prefix, whose, places, shape, scales);
  const GeographicPlace source = line.at(0.0);
  file.set_attribute("", "bearing_deg", compass_degrees(line.bearing()));
  file.set_attribute("", "source_latitude_deg", source.latitude);
  file.set_attribute("", "source_longitude_deg", source.longitude);
}

}  // namespace asdic::detail
