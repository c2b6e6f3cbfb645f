#pragma once
#include <string>
#include <vector>

#include "core/units.h"
#include "io/hdf5/scale.h"
#include "raytrace/cases/earth_line.h"

namespace asdic::detail {

/// Latitudes and longitudes of many places [°].
struct LatitudesLongitudes {
  std::vector<double> latitude{}, longitude{};
};
/// \param places  on the map [m]
[[nodiscard]] LatitudesLongitudes on_earth(const EarthPlaces& earth,
                                           const std::vector<Vec2>& places);

/// CF's word for where the values of a dataset are: its latitude and longitude in the same group.
/// \param more  other coordinates of it, between spaces
void place_on_earth(Hdf5File& file, bool known, const std::string& dataset,
                    const std::string& more = "");

/// Writes the datasets PREFIXlatitude and PREFIXlongitude, where they are known.
/// \param whose  of their long names: "of the target"   \param places  as many as `shape` has
void write_on_earth(Hdf5File& file, const EarthPlaces& earth, const std::string& prefix,
                    const std::string& whose, const std::vector<Vec2>& places, const Shape& shape,
                    const std::vector<std::string>& scales);

/// The same of ranges in the plane of a run, and the root's attributes bearing_deg,
/// source_latitude_deg and source_longitude_deg.
void write_on_earth(Hdf5File& file, const EarthLine& line, const std::string& prefix,
                    const std::string& whose, const std::vector<double>& ranges, const Shape& shape,
                    const std::vector<std::string>& scales);

}  // namespace asdic::detail
