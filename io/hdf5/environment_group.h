#pragma once
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "io/hdf5/hdf5_file.h"
#include "raytrace/ocean/environment.h"
#include "raytrace/ocean/ocean_origin.h"

namespace asdic::detail {

/// Writes the group /environment of field, rays and arrivals files (docs/formats/field.md): the sea
/// as a picture needs it, sampled finely enough to be drawn. The scenario text has it exactly.
/// \param first_range, last_range  the segment that results cover [m]
/// \param map_end  how far the maps go that it was cut out of, if not all the way [m]
void write_environment_group(Hdf5File& file, const Environment& ocean, double first_range,
                             double last_range,
                             double map_end = std::numeric_limits<double>::infinity());

/// What a file of results says of its ocean's place and making: root attributes latitude_deg and
/// longitude_deg of the map's [0, 0], ocean_time, and ocean_sources.
struct OriginAttributes {
  double latitude_deg = 0.0, longitude_deg = 0.0;
  std::string time{};
  std::vector<std::string> sources{};  ///< a text for each file that the ocean was made of
};
[[nodiscard]] std::optional<OriginAttributes> attributes_of(
    const std::optional<OceanOrigin>& origin);
/// Nothing for a sea that has no place on the Earth.
void write_origin(Hdf5File& file, const std::optional<OriginAttributes>& origin);
[[nodiscard]] std::optional<OriginAttributes> read_origin_attributes(const Hdf5File& file);

}  // namespace asdic::detail
