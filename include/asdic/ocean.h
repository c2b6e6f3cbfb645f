#pragma once

/// \file
/// The ocean of a real place, out of measured data: what `asdic ocean` writes.
/// docs/guide/real-ocean.md
///
/// ```cpp
/// const asdic::Ocean sargasso = asdic::ocean({.latitude_deg = 30.5, .longitude_deg = -60.5});
/// for (const std::string& note : sargasso.notes) std::cout << note << '\n';
/// std::cout << sargasso.water_depth << " m of water\n" << sargasso.scenario.to_toml();
/// const asdic::Ocean rise = asdic::ocean(
///     {.latitude_deg = 31.5, .longitude_deg = -65.5, .bearing_deg = 45.0, .range = 60e3});
/// std::cout << rise.scenario.has("environment.bottom.shape") << '\n';
/// ```

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "asdic/export.h"
#include "asdic/scenario.h"

namespace asdic {

/// A place at sea, or a track from it.
struct OceanPlace {
  double latitude_deg = 0.0;   ///< north, −90 to 90
  double longitude_deg = 0.0;  ///< east, −180..180 or 0..360
  /// 1 to 12: the mean of the data's times in it; without: of all. Of data without times too, as a
  /// note then says.
  std::optional<int> month = {};
  /// In place of a month: "2024-02-29" or "2024-02-29T06:00", interpolated between the data's
  /// times.
  std::string date = {};
  /// True bearing of a track: sea floor and water along it in place of one place's. With `range`.
  std::optional<double> bearing_deg = {};
  std::optional<double> range = {};  ///< length of that track [m]
  std::optional<double> step = {};   ///< between its depths [m]; without: the grid's own spacing
  /// Side of a square about the place [m], in place of a track: maps in a netCDF file beside
  /// `output`, which is then needed.
  std::optional<double> area = {};
  std::filesystem::path output = {};  ///< of an area: the fragment's file, NAME.toml
  // Files, each "FILE" or "FILE:VARIABLE"; of a quantity without any, that of `data`.
  std::vector<std::string> temperature = {};  ///< grids on depth, Argo profiles or CTD casts
  std::vector<std::string> salinity = {};     ///< without: in the files of the temperature
  std::vector<std::string> sound_speed = {};  ///< in place of both
  std::vector<std::string> bathymetry = {};   ///< heights or depths, in tiles
  std::vector<std::string> wind = {};         ///< speeds, or components
  std::vector<std::string> sediment = {};     ///< grain sizes or classes; without: by the depth
  /// Folder of the climatologies; empty: where Debian's package ferret-datasets has them.
  std::filesystem::path data = {};
};

/// What the data say of it.
struct Ocean {
  Scenario scenario{};                 ///< an [environment], and nothing else
  double water_depth = 0.0;            ///< at the place [m]
  std::optional<double> wind_speed{};  ///< at 10 m; none: the data know none [m/s]
  std::vector<std::string> origins{};  ///< files and their variables
  std::vector<std::string> notes{};    ///< what to know before trusting it
};

/// Profile and depth of the nearest grid point. Sound speed is that of temperature and salinity,
/// along a track a section. Without a map of sediments the kind of sea floor is that which is most
/// common at its depth, and a note says so. Files, digests, times and place are in the scenario's
/// environment.origin.
/// \throws InputError for data that are missing or unfit, a place on land or out of them
[[nodiscard]] ASDIC_API Ocean ocean(const OceanPlace& place);

/// Sound speed as rays meet it, interpolation and equations in it. [depths] [m/s]
/// \param scenario  with a sonar or a [run]   \param depths  [m]   \param range  along the
/// transect, from the first platform [m]   \throws InputError
[[nodiscard]] ASDIC_API std::vector<double> sound_speed(const Scenario& scenario,
                                                        const std::vector<double>& depths,
                                                        double range = 0.0);

}  // namespace asdic
