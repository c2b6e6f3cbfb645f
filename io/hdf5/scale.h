#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "io/hdf5/hdf5_file.h"

// How every file of ours names itself, its datasets and axes: by the Climate and Forecast
// conventions (CF 1.10, https://cfconventions.org), so that their readers know what they see.
namespace asdic::detail {

/// What a dataset is to CF, where that has a word for it. What is empty is not written.
struct Meaning {
  std::string_view standard_name{};  ///< of CF's table, and of that alone
  std::string_view positive{};       ///< "down" of a depth
  std::string_view axis{};           ///< "X" or "Z" of a coordinate
  std::string_view reference{};      ///< of a level, in words: units can only say "dB"
};

namespace cf {
inline constexpr std::string_view version = "CF-1.10";

inline constexpr Meaning depth{.standard_name = "depth", .positive = "down"};
inline constexpr Meaning depth_axis{.standard_name = "depth", .positive = "down", .axis = "Z"};
inline constexpr Meaning range_axis{.axis = "X"};
inline constexpr Meaning sea_floor{.standard_name = "sea_floor_depth_below_mean_sea_level"};
/// Of the depth of a boundary. \param side  "bottom", or "surface", for which CF has no word
[[nodiscard]] constexpr Meaning of_boundary(std::string_view side) noexcept {
  return side == "bottom" ? sea_floor : Meaning{};
}
inline constexpr Meaning latitude{.standard_name = "latitude"};
inline constexpr Meaning longitude{.standard_name = "longitude"};
inline constexpr Meaning sound_speed{.standard_name = "speed_of_sound_in_sea_water"};
inline constexpr Meaning pressure{.standard_name = "sound_pressure_in_water"};
/// Of a mean square. CF's levels in water are re 1 µPa.
inline constexpr Meaning pressure_level{.standard_name = "sound_pressure_level_in_water",
                                        .reference = "1 µPa"};
inline constexpr Meaning level{.reference = "1 µPa"};  ///< of a peak, or at another place
}  // namespace cf

/// Root attributes filetype, version (of that type's page in docs/formats) and Conventions.
void write_filetype(Hdf5File& file, const std::string& filetype, const std::string& version);

/// Attributes long_name and, where there are any, units (as UDUNITS reads them, or "dB") and
/// meaning.
void describe(Hdf5File& file, const std::string& dataset, const std::string& long_name,
              const std::string& units = "", const Meaning& meaning = {});

/// Writes a vector that is the scale of a dimension.
template <class T>
void write_scale(Hdf5File& file, const std::string& dataset, const std::string& dimension,
                 const std::vector<T>& values, const std::string& long_name,
                 const std::string& units = "", const Meaning& meaning = {}) {
  file.write<T>(dataset, values, {values.size()});
  describe(file, dataset, long_name, units, meaning);
  file.make_scale(dataset, dimension);
}

/// Even times along an axis of samples: sample k is at start + k·step [s].
struct TimeAxis {
  std::string dimension{};   ///< the dataset that stands for it while times are not written out
  std::string coordinate{};  ///< the dataset of the times, where they are
  std::string long_name{};   ///< what the times tell
  double start = 0.0, step = 0.0;  ///< [s]
  std::size_t size = 0;
};

/// Writes the dimension, of which start and step tell the times, or, `written_out`, all of them.
/// \return the dataset that is the scale of the axis
std::string write_time_axis(Hdf5File& file, const TimeAxis& axis, bool written_out);
/// The same start and step at a dataset along that axis: netCDF gives dimensions no attributes.
void write_times(Hdf5File& file, const std::string& dataset, const TimeAxis& axis);

/// When the first sample of a dataset is [s], by its attribute or, in files of before, by the scale
/// of its time axis.
[[nodiscard]] double time_of_first(const Hdf5File& file, const std::string& dataset,
                                   const std::string& coordinate);

}  // namespace asdic::detail
