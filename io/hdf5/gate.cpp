#include "io/hdf5/gate.h"

#include <hdf5.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/files/input_file.h"
#include "io/hdf5/handles.h"

namespace asdic::detail::hdf5 {
namespace {

namespace fs = std::filesystem;

/// No compression of HDF5's makes data smaller than by this (deflate: 1032).
constexpr double densest = 1100.0;
constexpr double allowance = 1 << 20;  // [bytes] of data that are nowhere written: fill values

InputError fault(const fs::path& path, const std::string& object, const std::string& got,
                 const std::string& expected) {
  return InputError({.where = path.string() + ": " + object, .got = got, .expected = expected});
}

bool is_virtual(std::int64_t properties) { return H5Pget_layout(properties) == H5D_VIRTUAL; }

/// The root's filetype; "" if there is none.
std::string filetype(std::int64_t file) {
  constexpr std::size_t longest = 64;
  if (H5Aexists(file, "filetype") <= 0) return "";
  const Handle attribute(H5Aopen(file, "filetype", H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
  if (H5Tget_class(type) != H5T_STRING || H5Sget_simple_extent_npoints(space) != 1) return "";
  if (H5Tis_variable_str(type) > 0) {  // files of before
    char* text = nullptr;
    if (H5Aread(attribute, type, &text) < 0 || text == nullptr) return "";
    const std::string result(text);
    H5free_memory(text);
    return result;
  }
  const std::size_t size = H5Tget_size(type);
  if (size == 0 || size > longest) return "";
  std::string text(size, '\0');
  if (H5Aread(attribute, type, text.data()) < 0) return "";
  return text.substr(0, text.find('\0'));
}

/// Bytes of a dataset's values; infinite if there is no telling.
double claimed(std::int64_t dataset) {
  const Handle type(H5Dget_type(dataset), H5Tclose), space(H5Dget_space(dataset), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space);
  if (type < 0 || rank < 0) return std::numeric_limits<double>::infinity();
  std::vector<hsize_t> shape(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  double bytes = static_cast<double>(H5Tget_size(type));
  for (const hsize_t n : shape) bytes *= static_cast<double>(n);
  return bytes;
}

/// A walk through a file. What is wrong is kept until HDF5, which knows no exceptions, is out of
/// it.
struct Walk {
  const fs::path& path;
  double room = 0.0;       ///< bytes that a dataset may claim
  bool catalogue = false;  ///< may have virtual datasets
  std::string object, got, expected;

  bool refuse(std::string what, std::string found, std::string wanted) {
    object = std::move(what);
    got = std::move(found);
    expected = std::move(wanted);
    return false;
  }
  [[nodiscard]] bool take(std::int64_t group, const char* name, H5L_type_t type);
  [[nodiscard]] bool take_dataset(std::int64_t dataset, const char* name);
};

bool Walk::take(std::int64_t group, const char* name, H5L_type_t type) {
  if (type == H5L_TYPE_SOFT) return true;  // to what is passed as well
  if (type != H5L_TYPE_HARD) return refuse(name, "a link to another file", "data in this one");
  const Handle id(H5Oopen(group, name, H5P_DEFAULT), H5Oclose);
  if (id < 0) return refuse(name, "what cannot be opened (" + last_message() + ")", "a whole file");
  return H5Iget_type(id) != H5I_DATASET || take_dataset(id, name);
}

bool Walk::take_dataset(std::int64_t dataset, const char* name) {
  const Handle properties(H5Dget_create_plist(dataset), H5Pclose);
  if (properties < 0 || H5Pget_external_count(properties) != 0)
    return refuse(name, "data in another file", "data in this one");
  if (is_virtual(properties))
    return catalogue ||
           refuse(name, "data in other files", "data in this one, but for a study's catalogue");
  return claimed(dataset) <= room ||
         refuse(name, "a dataset that claims more than the file can hold", "a whole file");
}

double size_of(const fs::path& path) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  return error ? 0.0 : static_cast<double>(size);
}

}  // namespace

std::vector<fs::path> virtual_sources(std::int64_t properties, const fs::path& path) {
  std::vector<fs::path> names;
  std::size_t count = 0;
  if (!is_virtual(properties)) return names;
  if (H5Pget_virtual_count(properties, &count) < 0) fail(path, "", "reading what it refers to");
  for (std::size_t i = 0; i < count; ++i) {
    const ssize_t size = H5Pget_virtual_filename(properties, i, nullptr, 0);
    if (size < 0) fail(path, "", "reading what it refers to");
    std::string name(static_cast<std::size_t>(size) + 1, '\0');
    H5Pget_virtual_filename(properties, i, name.data(), name.size());
    name.resize(static_cast<std::size_t>(size));
    if (std::find(names.begin(), names.end(), name) == names.end()) names.emplace_back(name);
  }
  return names;
}

void check_contents(std::int64_t file, const fs::path& path) {
  Walk walk{.path = path,
            .room = densest * size_of(path) + allowance,
            .catalogue = filetype(file) == "asdic study"};
  const auto visit = [](hid_t group, const char* name, const H5L_info_t* link,
                        void* into) -> herr_t {
    return static_cast<Walk*>(into)->take(group, name, link->type) ? 0 : 1;
  };
  const herr_t result = H5Lvisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, visit, &walk);
  if (result > 0) throw fault(path, walk.object, walk.got, walk.expected);
  if (result < 0)
    throw InputError({.where = path.string(),
                      .got = "a damaged file (" + last_message() + ")",
                      .expected = "a whole one"});
}

void check_contents(const fs::path& path) {
  prepare();
  if (H5Fis_hdf5(path.c_str()) <= 0) return;
  const Handle file(open_file(path, H5F_ACC_RDONLY), H5Fclose);
  if (file >= 0) check_contents(file, path);
}

void check_sources(std::int64_t dataset, const fs::path& path) {
  const Handle properties(H5Dget_create_plist(dataset), H5Pclose);
  if (!is_virtual(properties)) return;
  double bytes = size_of(path);
  for (const fs::path& name : virtual_sources(properties, path)) {
    const fs::path source = path.parent_path() / name;
    std::error_code error;
    if (!fs::exists(source, error)) continue;
    require_file(source, "a part of a study");
    const Handle part(open_file(source, H5F_ACC_RDONLY), H5Fclose);
    if (part < 0 || filetype(part) != "asdic study")
      throw fault(path, name.string(), "a part that is no study's file", "the study's own");
    check_contents(part, source);
    bytes += size_of(source);
  }
  if (claimed(dataset) > densest * bytes + allowance)
    throw InputError({.where = path.string(),
                      .got = "a dataset that claims more than its parts can hold",
                      .expected = "a whole catalogue"});
}

}  // namespace asdic::detail::hdf5
