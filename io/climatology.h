#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace asdic {

/// Where the real ocean is read from: gridded netCDF files (docs/guide/real-ocean.md).
struct OceanSources {
  std::filesystem::path hydrography;  ///< temperature and salinity on depth
  std::filesystem::path bathymetry;   ///< height of the Earth's surface, or depth of the sea
  std::filesystem::path wind;         ///< wind speed, or its components; "": none is read
};

/// Levitus' temperature and salinity, ETOPO5 and COADS, as Debian's ferret-datasets installs them.
[[nodiscard]] OceanSources default_ocean_sources(
    const std::filesystem::path& directory = "/usr/share/ferret-vis/data");

/// The water column of one place.
struct OceanSample {
  double latitude = 0.0, longitude = 0.0;                  ///< asked for [° north], [° east]
  std::optional<int> month{};                              ///< 1..12; none: the year's mean
  std::vector<double> depth{}, temperature{}, salinity{};  ///< [levels] [m], [°C], [psu]
  double water_depth = 0.0;                                ///< [m]
  std::optional<double> wind_speed{};                      ///< [m/s]
  std::vector<std::string> origins{};                      ///< files and variables
  std::vector<std::string> notes{};                        ///< what the user should know
};

/// Profile and depth come from the nearest grid point (a mixture of sea and land, or of two water
/// masses, would be neither); wind is bilinear, missing neighbours left out. Levels end at the
/// first that is missing. \param latitude, longitude  [° north], [° east], −180..180 or 0..360
/// \param month  1..12 \throws InputError for a missing or unfit file, a place outside, or on land
[[nodiscard]] OceanSample sample_ocean(const OceanSources& sources, double latitude,
                                       double longitude, std::optional<int> month = std::nullopt);

/// Depth of the sea along a great circle.
struct OceanSection {
  double bearing_deg = 0.0;              ///< at its start, clockwise from north
  std::vector<double> range{}, depth{};  ///< [points] [m]
  std::vector<std::string> notes{};
};

/// Every 5 km or nearer, from the nearest grid points; ends at the coast. The Earth is a sphere of
/// 6371 km. \param range  [m], above 0
[[nodiscard]] OceanSection sample_transect(const OceanSources& sources, double latitude,
                                           double longitude, double bearing_deg, double range);

/// An [environment] for a scenario (docs/formats/scenario.md), as TOML text with its origins and
/// notes in comments.
[[nodiscard]] std::string write_scenario_fragment(const OceanSample& ocean,
                                                  const std::optional<OceanSection>& transect = {});

}  // namespace asdic
