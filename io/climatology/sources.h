#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

// The files that an ocean is read from, and how they are named in messages and results.
namespace asdic::detail {

/// A file of data, and which of its variables; "": known by its name or standard_name.
struct DataFile {
  std::filesystem::path path{};
  std::string variable{};
  bool operator==(const DataFile&) const = default;
};

/// "FILE" or "FILE:VARIABLE". A name with a colon that is a file's is that file.
[[nodiscard]] DataFile data_file(std::string_view named);
[[nodiscard]] std::vector<DataFile> data_files(const std::vector<std::string>& named);

/// Where the real ocean is read from (docs/guide/real-ocean.md): more than one file a quantity
/// where they are tiles, times, or levels of one another.
struct OceanSources {
  std::vector<DataFile> temperature{}, salinity{};  ///< grids on depth, or casts
  std::vector<DataFile> sound_speed{};              ///< in place of them
  std::vector<DataFile> bathymetry{};               ///< heights, or depths of the sea
  std::vector<DataFile> wind{};                     ///< speed, or components; {}: none is read
  std::vector<DataFile> sediment{};                 ///< grain sizes or classes; {}: by depth

  [[nodiscard]] std::vector<DataFile> all() const;
  /// Paths of all these files. No result may be written over one of them.
  [[nodiscard]] std::vector<std::filesystem::path> paths() const;
};

/// Levitus' temperature and salinity, ETOPO5 and, where it is there, COADS' wind, as Debian's
/// ferret-datasets installs them.
[[nodiscard]] OceanSources default_ocean_sources(
    const std::filesystem::path& directory = "/usr/share/ferret-vis/data");

/// What these name, with the rest of the others: a sound speed goes without temperatures, and a
/// salinity is looked for in the file of the temperature.
[[nodiscard]] OceanSources or_default(OceanSources named, const OceanSources& otherwise);

/// "sha256:…" of a file's bytes; of one above 1 GiB "sha256-ends:…" of its size as decimal digits
/// and its first and last MiB, which tells versions apart without reading all of it. Of a folder of
/// ESRI's it is that of the file with the values.
[[nodiscard]] std::string digest_of(const std::filesystem::path& path);

namespace climatology {

/// "30.5 N -60.5 E", for messages.
[[nodiscard]] std::string place(double latitude, double longitude);
/// \throws InputError for what is no place on Earth [degrees]
void check_place(double latitude, double longitude);

}  // namespace climatology
}  // namespace asdic::detail
