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

}  // namespace asdic::detail
