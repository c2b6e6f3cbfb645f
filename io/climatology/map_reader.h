#pragma once
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/climatology/data_grid.h"
#include "io/climatology/tiles.h"
#include "raytrace/area/map_grid.h"

namespace asdic::detail {

/// A variable of a gridded file as a map, or as a volume of maps: opened, and read tile by tile as
/// it is asked for.
struct OpenedMap {
  std::shared_ptr<const MapGrid> grid;  ///< axes in [° east], [° north], or [m]; values in our unit
  std::vector<double> depths;           ///< of the levels [m]; empty: it is a map
  bool geographic = true;
  std::string name;                      ///< "place.nc: elevation", for messages
  double depth_sign = 1.0;               ///< of bathymetry: what makes depths of its values
  std::shared_ptr<const DataGrid> file;  ///< that it is read from
};

/// \param variable  "": one of the quantity's usual names
/// \param longitude  about which a grid that goes round the globe is cut open, half way round [°]
/// \param notes  grows by what had to be assumed
/// \throws InputError for an unfit file, variable or unit, or one of several times
[[nodiscard]] OpenedMap open_map(const std::filesystem::path& path, const std::string& variable,
                                 const climatology::GriddedQuantity& quantity, double longitude,
                                 std::vector<std::string>& notes);

/// Fills what is missing of volumes [rows × columns × levels]: with the nearest value of its own
/// level; where a level has none, the column goes on below its last value as pressure alone makes
/// it, 0.0165 m/s a metre.
void fill_volume(std::size_t columns, std::size_t rows, const std::vector<double>& depths,
                 std::span<float> values);

}  // namespace asdic::detail
