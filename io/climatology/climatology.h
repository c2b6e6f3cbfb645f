#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/climatology/sediment.h"
#include "io/climatology/sources.h"
#include "io/climatology/times.h"
#include "io/files/output_file.h"
#include "raytrace/ocean/ocean_origin.h"

namespace asdic::detail {

/// A place, a time, and perhaps a track from there.
struct OceanRequest {
  double latitude = 0.0, longitude = 0.0;  ///< [° north], [° east], −180..180 or 0..360
  OceanTime when{};
  double bearing_deg = 0.0;      ///< of the track at its start, clockwise from north
  double range = 0.0;            ///< of the track [m]
  std::optional<double> step{};  ///< of the floor's samples [m]; none: the grid's own
};

/// The water column of one place.
struct OceanSample {
  double latitude = 0.0, longitude = 0.0;                  ///< asked for [° north], [° east]
  OceanTime when{};                                        ///< asked for
  std::vector<double> depth{}, temperature{}, salinity{};  ///< [levels] [m], [°C], [psu]
  std::vector<double> speed{};                             ///< [m/s], in place of T and S
  double water_depth = 0.0;                                ///< [m]
  std::optional<double> wind_speed{};                      ///< [m/s]
  Sediment sediment{};
  std::string sediment_by{};           ///< "of the map …", or what it was taken for
  std::vector<std::string> origins{};  ///< files and variables
  std::vector<OceanSource> sources{};  ///< the same with digests and times
  std::vector<std::string> notes{};    ///< what the user should know

  [[nodiscard]] OceanOrigin origin() const;
};

/// Profile and depth come from the nearest grid point (a mixture of sea and land, or of two water
/// masses, would be neither); wind is bilinear, missing neighbours left out. Levels end at the
/// first that is missing. Longitudes may be −180..180 or 0..360.
/// \throws InputError for a missing or unfit file, a place outside, or on land
[[nodiscard]] OceanSample sample_ocean(const OceanSources& sources, const OceanRequest& request);

/// The sea along a great circle: its floor, and its water wherever the grid has another profile.
struct OceanSection {
  double bearing_deg = 0.0;              ///< at its start, clockwise from north
  std::vector<double> range{}, floor{};  ///< [points] range and depth of the sea floor [m]
  std::vector<Sediment> sediment{};      ///< [points] of a map; empty: the place's everywhere
  std::vector<double> station{};         ///< [stations] ranges of the profiles [m]
  std::vector<double> depth{};           ///< [levels] of all of them [m]
  std::vector<double> speed{};           ///< [stations × levels] speed of sound [m/s]
  std::vector<std::string> notes{};
};

/// Floor at the grid's own spacing, or at request.step, bilinear between grid points, over tiles;
/// it ends at the coast, at a hole, or where the last tile does, and says which. A profile stands
/// in the middle of the span whose nearest grid point is its own; speeds by Chen and Millero's
/// equation, PCHIP between measured levels, at levels near enough for straight lines (0.04 m/s).
/// The Earth is a sphere of 6371 km.
[[nodiscard]] OceanSection sample_section(const OceanSources& sources, const OceanRequest& request);

/// An [environment] for a scenario (docs/formats/scenario.md), as TOML text with its origin in a
/// table and its notes in comments.
[[nodiscard]] std::string write_scenario_fragment(const OceanSample& ocean,
                                                  const std::optional<OceanSection>& section = {});

/// The water, floor, sediment and wind of a square area, in one file.
struct OceanArea {
  double side = 0.0;                ///< of the square [m]
  std::filesystem::path file{};     ///< netCDF, beside the fragment
  std::vector<Sediment> classes{};  ///< that its map has
  bool sound_speed = false, wind = false;
  std::vector<std::string> notes{};
};

/// Writes what lies within half a side of the place, in the data's own resolution, as CF netCDF-4
/// (docs/formats/ocean-area.md). \param centre  its note of a sediment taken by the depth gives way
/// to one of the area's, where that has several \throws InputError, RunError
[[nodiscard]] OceanArea write_ocean_area(const OceanSources& sources, const OceanRequest& request,
                                         OceanSample& centre, double side, OutputFile&& output);

/// The [environment] of an area.
[[nodiscard]] std::string write_area_fragment(const OceanSample& centre, const OceanArea& area);

}  // namespace asdic::detail
