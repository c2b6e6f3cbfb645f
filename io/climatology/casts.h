#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/climatology/calendar.h"

namespace asdic::detail {

/// One measured profile: of an Argo float, or a CTD cast.
struct Cast {
  std::string source{};                           ///< "R6901234.nc, float 6901234 cycle 12"
  std::optional<double> latitude{}, longitude{};  ///< [° north], [° east]
  std::optional<Moment> time{};
  /// [levels] rising [m]; those of the others that were not measured are empty
  std::vector<double> depth{}, temperature{}, salinity{}, speed{};  ///< [m], [°C], [psu], [m/s]
  std::vector<std::string> variables{};                             ///< by their names in the file
  std::vector<std::string> notes{};  ///< what was left out, or worked out
};

/// Whether a file holds casts: a text that is no grid, or netCDF with Argo's N_PROF.
[[nodiscard]] bool is_cast_file(const std::filesystem::path& path);

/// Argo's profiles (PRES, TEMP, PSAL on N_PROF × N_LEVELS, the adjusted ones where the data mode is
/// A or D, quality flags 1, 2, 5 and 8), a Sea-Bird .cnv, or CSV: lines of # are comments, columns
/// part at ";", tabs or ",", decimals may be commas unless these part them; the header says what
/// and in which unit ("Pressure [dbar];Temperature (°C);Salinity"), or a second line the units.
/// Of a cast down and up, the way down is taken. Pressures become depths by Leroy and Parthiot.
/// \param latitude  for those, where the file has none
/// \throws InputError naming file, line and column for what is missing or in another unit
[[nodiscard]] std::vector<Cast> read_casts(const std::filesystem::path& path, double latitude);

}  // namespace asdic::detail
