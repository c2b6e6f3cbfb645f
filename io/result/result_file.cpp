#include "io/result/result_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "core/error.h"
#include "io/bellhop/bellhop_files.h"
#include "io/files/input_file.h"
#include "io/hdf5/scale.h"
#include "io/result/field_file.h"
#include "io/result/tables.h"

namespace asdic::detail {
namespace {

std::string ending(const std::filesystem::path& path) {
  std::string text = path.extension().string();
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// How a BELLHOP file was written, for the way back; Fortran's headers and text go without saying.
constexpr const char *wide_key = "bellhop_wide_header", *binary_key = "bellhop_binary";

template <class BellhopFile>
void write_layout(Hdf5File& file, const BellhopFile& result) {
  if (result.dialect == bellhop::Dialect::wide) file.set_attribute("", wide_key, std::int64_t{1});
  if constexpr (std::is_same_v<BellhopFile, bellhop::ArrivalsFile>)
    if (result.binary) file.set_attribute("", binary_key, std::int64_t{1});
}

template <class BellhopFile>
BellhopFile with_layout(const Hdf5File& file, BellhopFile result) {
  const auto is_set = [&](const char* key) {
    return file.has_attribute("", key) && file.attribute_number("", key) != 0.0;
  };
  if (is_set(wide_key)) result.dialect = bellhop::Dialect::wide;
  if constexpr (std::is_same_v<BellhopFile, bellhop::ArrivalsFile>)
    result.binary = is_set(binary_key);
  return result;
}

constexpr const char* known_files =
    "a result of the propagation model: .shd, .arr, .ray, or HDF5 of asdic field, arrivals or rays";

}  // namespace

std::string_view kind_of(const PropagationFile& file) noexcept {
  constexpr std::array<std::string_view, 3> kinds = {"field", "arrivals", "rays"};
  return kinds[file.index()];
}

bool is_hdf5(const std::filesystem::path& path) {
  constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  return InputFile(path, known_files).read(signature.size()) == signature;
}

std::string filetype_of(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored) || !is_hdf5(path)) return {};
  return Hdf5File::open(path).attribute_or("", "filetype", "");
}

PropagationFile read_result(const std::filesystem::path& path) {
  if (is_hdf5(path)) return read_hdf5_result(Hdf5File::open(path));
  const std::string type = ending(path);
  if (type == ".shd") return bellhop::read_shade_file(path);
  if (type == ".arr") return bellhop::read_arrivals_file(path);
  if (type == ".ray") return bellhop::read_ray_file(path);
  throw InputError({.where = path.string(),
                    .got = "a file that is not HDF5 and whose name ends in \"" + type + '"',
                    .expected = known_files});
}

PropagationFile read_hdf5_result(const Hdf5File& file) {
  const std::string type = file.attribute_or("", "filetype", "none");
  if (type == "asdic field") return with_layout(file, to_shade_file(read_field(file)));
  if (type == "asdic arrivals") return with_layout(file, result_tables::read_arrivals(file));
  if (type == "asdic rays") return result_tables::read_rays(file);
  throw InputError({.where = file.path().string() + ": filetype",
                    .got = '"' + type + '"',
                    .expected = "\"asdic field\", \"asdic arrivals\" or \"asdic rays\""});
}

void write_hdf5_result(Hdf5File& file, const PropagationFile& result, const EarthLine& earth) {
  write_filetype(file, "asdic " + std::string(kind_of(result)), result_version);
  if (const auto* field = std::get_if<bellhop::ShadeFile>(&result)) {
    file.set_attribute("", "title", field->title);
    write_layout(file, *field);
    FieldData data = from_shade_file(*field);
    data.earth = earth;
    write_field(file, data);
  } else if (const auto* arrivals = std::get_if<bellhop::ArrivalsFile>(&result)) {
    file.set_attribute("", "title", "");
    write_layout(file, *arrivals);
    result_tables::write_arrivals(file, *arrivals, earth);
  } else {
    const auto& rays = std::get<bellhop::RayFile>(result);
    file.set_attribute("", "title", rays.title);
    result_tables::write_rays(file, rays, earth);
  }
}

}  // namespace asdic::detail
