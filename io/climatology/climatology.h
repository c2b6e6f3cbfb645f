#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace asdic::detail {

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

/// The sea along a great circle: its floor, and its water wherever the grid has another profile.
struct OceanSection {
  double bearing_deg = 0.0;              ///< at its start, clockwise from north
  std::vector<double> range{}, floor{};  ///< [points] range and depth of the sea floor [m]
  std::vector<double> station{};         ///< [stations] ranges of the profiles [m]
  std::vector<double> depth{};           ///< [levels] of all of them [m]
  std::vector<double> speed{};           ///< [stations × levels] speed of sound [m/s]
  std::vector<std::string> notes{};
};

/// Floor every 5 km or nearer, bilinear between grid points; ends at the coast. A profile stands in
/// the middle of the span whose nearest grid point is its own; speeds by Chen and Millero's
/// equation, PCHIP between measured levels, at levels near enough for straight lines (0.04 m/s).
/// The Earth is a sphere of 6371 km. \param range  [m], above 0
[[nodiscard]] OceanSection sample_section(const OceanSources& sources, double latitude,
                                          double longitude, double bearing_deg, double range,
                                          std::optional<int> month = std::nullopt);

/// An [environment] for a scenario (docs/formats/scenario.md), as TOML text with its origins and
/// notes in comments.
[[nodiscard]] std::string write_scenario_fragment(const OceanSample& ocean,
                                                  const std::optional<OceanSection>& section = {});

}  // namespace asdic::detail
