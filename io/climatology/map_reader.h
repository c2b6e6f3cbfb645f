#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "raytrace/area/map_grid.h"

namespace asdic::detail {

/// A variable of a netCDF file as a map, or as a volume of maps: opened, and read tile by tile as
/// it is asked for.
struct OpenedMap {
  std::shared_ptr<const MapGrid> grid;  ///< axes in [° east], [° north], or [m]
  std::vector<double> depths;           ///< of the levels [m]; empty: it is a map
  bool geographic = true;
  std::string name;      ///< "place.nc: elevation", for messages
  bool heights = false;  ///< values are heights, positive up, not depths
  std::string units;
};

/// What a map is of, and how it is called in files where nobody says so.
struct MapKind {
  std::string what;
  std::vector<std::string> names;
};
extern const MapKind bathymetry_map, sound_speed_map, seabed_map, wind_map;

/// \param variable  "": one of the kind's usual names   \param longitude  about which a grid that
/// goes round the globe is cut open, half way round [°]
/// \throws InputError for an unfit file or variable, or one of several times
[[nodiscard]] OpenedMap open_map(const std::filesystem::path& path, const std::string& variable,
                                 const MapKind& kind, double longitude);

/// Fills what is missing of volumes [rows × columns × levels]: with the nearest value of its own
/// level; where a level has none, the column goes on below its last value as pressure alone makes
/// it, 0.0165 m/s a metre.
void fill_volume(std::size_t columns, std::size_t rows, const std::vector<double>& depths,
                 std::span<float> values);

}  // namespace asdic::detail
