#pragma once
#include <string>
#include <vector>

#include "core/units.h"
#include "io/hdf5/scale.h"
#include "raytrace/area/earth_places.h"

namespace asdic::detail {

/// Latitudes and longitudes of many places [°].
struct LatitudesLongitudes {
  std::vector<double> latitude{}, longitude{};
};
/// \param places  on the map [m]
[[nodiscard]] LatitudesLongitudes on_earth(const EarthPlaces& earth,
                                           const std::vector<Vec2>& places);

/// Writes the datasets PREFIXlatitude and PREFIXlongitude, where they are known.
/// \param whose  of their long names: "of the target"   \param places  as many as `shape` has
void write_on_earth(Hdf5File& file, const EarthPlaces& earth, const std::string& prefix,
                    const std::string& whose, const std::vector<Vec2>& places, const Shape& shape,
                    const std::vector<std::string>& scales);

}  // namespace asdic::detail
