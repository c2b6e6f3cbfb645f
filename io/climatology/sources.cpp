#include "io/climatology/sources.h"

#include <cmath>
#include <fstream>

#include "core/error.h"
#include "core/text.h"
#include "io/climatology/raster_source.h"
#include "io/files/digest.h"

namespace asdic::detail {

DataFile data_file(std::string_view named) {
  const std::filesystem::path whole(named);
  const std::size_t colon = named.rfind(':');
  if (colon == std::string_view::npos || colon == 0 || std::filesystem::exists(whole))
    return {.path = whole};
  const std::string_view variable = named.substr(colon + 1);
  if (variable.empty() || variable.find('/') != std::string_view::npos) return {.path = whole};
  return {.path = named.substr(0, colon), .variable = std::string(variable)};
}

std::vector<DataFile> data_files(const std::vector<std::string>& named) {
  std::vector<DataFile> files;
  for (const std::string& name : named) files.push_back(data_file(name));
  return files;
}

std::vector<DataFile> OceanSources::all() const {
  std::vector<DataFile> files;
  for (const auto* of : {&temperature, &salinity, &sound_speed, &bathymetry, &wind, &sediment})
    files.insert(files.end(), of->begin(), of->end());
  return files;
}

std::vector<std::filesystem::path> OceanSources::paths() const {
  std::vector<std::filesystem::path> paths;
  for (const DataFile& file : all()) paths.push_back(file.path);
  return paths;
}

OceanSources default_ocean_sources(const std::filesystem::path& directory) {
  const DataFile levitus{directory / "levitus_climatology.cdf"};
  const DataFile coads{directory / "coads_climatology.cdf"};
  OceanSources sources{
      .temperature = {levitus}, .salinity = {levitus}, .bathymetry = {{directory / "etopo5.cdf"}}};
  if (std::filesystem::exists(coads.path)) sources.wind = {coads};
  return sources;
}

OceanSources or_default(OceanSources named, const OceanSources& otherwise) {
  const bool water = !named.temperature.empty() || !named.salinity.empty();
  if (!named.sound_speed.empty() && water)
    throw InputError({.where = "sound speed",
                      .got = "files of it and of temperature or salinity",
                      .expected = "either: the speed is computed of temperature and salinity"});
  if (named.temperature.empty() && !named.salinity.empty())
    throw InputError({.where = "temperature",
                      .got = "no file, beside one of salinity",
                      .expected = "both, of one origin"});
  if (!named.temperature.empty() && named.salinity.empty()) {
    for (DataFile file : named.temperature) {
      file.variable.clear();
      named.salinity.push_back(file);
    }
  } else if (named.sound_speed.empty() && !water) {
    named.temperature = otherwise.temperature;
    named.salinity = otherwise.salinity;
  }
  if (named.bathymetry.empty()) named.bathymetry = otherwise.bathymetry;
  if (named.wind.empty()) named.wind = otherwise.wind;
  if (named.sediment.empty()) named.sediment = otherwise.sediment;
  return named;
}

std::string digest_of(const std::filesystem::path& named) {
  const std::filesystem::path path = raster_values(named);
  constexpr std::uintmax_t whole = std::uintmax_t{1} << 30;
  constexpr std::size_t piece = std::size_t{1} << 20;
  std::ifstream file(path, std::ios::binary);
  const std::uintmax_t size = std::filesystem::file_size(path);
  std::vector<char> bytes(piece);
  Digest digest;
  const auto add_piece = [&] {
    file.read(bytes.data(), static_cast<std::streamsize>(piece));
    const auto n = static_cast<std::size_t>(file.gcount());
    digest.add(std::span<const char>(bytes.data(), n));
    return n;
  };
  if (size <= whole) {
    while (add_piece() > 0) {
    }
    return "sha256:" + digest.text();
  }
  const std::string digits = std::to_string(size);
  digest.add(std::span<const char>(digits.data(), digits.size()));
  add_piece();
  file.seekg(-static_cast<std::streamoff>(piece), std::ios::end);
  add_piece();
  return "sha256-ends:" + digest.text();
}

namespace climatology {

std::string place(double latitude, double longitude) {
  return to_text(latitude) + " N " + to_text(longitude) + " E";
}

void check_place(double latitude, double longitude) {
  if (!(std::abs(latitude) <= 90.0))
    throw InputError({.where = "latitude",
                      .got = to_text(latitude),
                      .expected = "a latitude from -90 to 90 degrees north"});
  if (!(std::abs(longitude) <= 360.0))
    throw InputError({.where = "longitude",
                      .got = to_text(longitude),
                      .expected = "a longitude from -180 to 360 degrees east"});
}

}  // namespace climatology
}  // namespace asdic::detail
