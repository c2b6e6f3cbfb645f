#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/climatology/grid_source.h"

namespace asdic::detail {

/// What kind of raster a file is by its first bytes or its name, for messages: "a GeoTIFF", "a
/// binary grid of ESRI's"; nothing if it is none that GDAL is asked to read.
[[nodiscard]] std::optional<std::string> raster_kind(const std::filesystem::path& path);

/// The file in which a raster has its values: of a folder of ESRI's, w001001.adf; else itself.
[[nodiscard]] std::filesystem::path raster_values(const std::filesystem::path& path);

/// Whether this asdic was built to read rasters.
[[nodiscard]] bool reads_rasters() noexcept;

/// What is asked of a raster.
struct RasterBand {
  std::string named{};               ///< by the user: "2", "band 2", or its description
  std::vector<std::string> names{};  ///< of the quantity, if there are several bands
  bool colours = false;              ///< whether a palette will do: of classes
  bool required = true;              ///< else there may be none of these names
};

/// A band of a raster (raster_kind) in a child process that has it open, by GDAL, which is loaded
/// there. Pixels are the grid's points at their middles. Its variable is called "band 2", its
/// long_name is the band's description, its units are the band's unit type, its missing value is
/// the band's no-data value; what a mask hides is NaN. Names of categories become flag_meanings.
/// \return one whose variable is not `found` if no band has such a name, and none is required
/// \throws InputError for a raster without places or a coordinate reference system, for one that is
/// rotated, or whose longitudes do not count from Greenwich in degrees; for colours; without GDAL
[[nodiscard]] std::unique_ptr<const GridSource> open_raster(const std::filesystem::path& path,
                                                            const RasterBand& band);

}  // namespace asdic::detail
