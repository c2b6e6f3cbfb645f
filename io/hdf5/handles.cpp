// The HDF5 library: its quirks, its types, its words.
#include <hdf5.h>

#include <algorithm>

#include "core/error.h"
#include "io/files/output_lock.h"
#include "io/hdf5/elements.h"
#include "io/hdf5/handles.h"

namespace asdic::detail::hdf5 {

void prepare() {
  // Once a write has failed (disk full), HDF5 1.10 crashes when it closes the file, at exit too if
  // left to itself. Files are closed by Hdf5File, so nothing is left to do at exit.
  [[maybe_unused]] static const herr_t nothing_at_exit = H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

std::int64_t open_file(const std::filesystem::path& path, unsigned flags) {
  const auto open = [&](std::int64_t access) {
    return (flags & H5F_ACC_TRUNC) != 0 ? H5Fcreate(path.c_str(), flags, H5P_DEFAULT, access)
                                        : H5Fopen(path.c_str(), flags, access);
  };
  const std::int64_t file = open(H5P_DEFAULT);
  if (file >= 0 || !refuses_locks(path)) return file;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access, 0, 1);
  return open(access);
}

std::string last_message() {
  std::vector<std::string> messages;  // innermost first
  const auto collect = [](unsigned, const H5E_error2_t* error, void* into) -> herr_t {
    if (error->desc != nullptr && *error->desc != '\0')
      static_cast<std::vector<std::string>*>(into)->emplace_back(error->desc);
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, collect, &messages);
  if (messages.empty()) return "HDF5 gives no reason";
  // "file write failed: time = …, errno = 28, error message = 'No space left on device', buf = …"
  const std::string& inner = messages.front();
  constexpr std::string_view mark = "error message = '";
  if (const auto at = inner.find(mark); at != std::string::npos) {
    const auto begin = at + mark.size();
    const std::string system = inner.substr(begin, inner.find('\'', begin) - begin);
    const std::string full = system.starts_with("No space left") ? "the disk is full: " : "";
    return full + system + " (HDF5: " + inner.substr(0, inner.find(':')) + ")";
  }
  return inner == messages.back() ? inner : inner + "; " + messages.back();
}

template <>
std::int64_t native_type<std::int8_t>() {
  return H5T_NATIVE_INT8;
}
template <>
std::int64_t native_type<std::int32_t>() {
  return H5T_NATIVE_INT32;
}
template <>
std::int64_t native_type<std::int64_t>() {
  return H5T_NATIVE_INT64;
}
template <>
std::int64_t native_type<float>() {
  return H5T_NATIVE_FLOAT;
}
template <>
std::int64_t native_type<double>() {
  return H5T_NATIVE_DOUBLE;
}

Handle text_type(std::size_t bytes) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, std::max<std::size_t>(bytes, 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

Handle make_parents() {
  Handle list(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(list, 1);
  H5Pset_char_encoding(list, H5T_CSET_UTF8);
  return list;
}

void fail(const std::filesystem::path& file, const std::string& object, const std::string& action) {
  std::string text = file.string() + ": ";
  if (!object.empty()) text += object + ": ";
  throw RunError(text + action + " failed: " + last_message());
}

}  // namespace asdic::detail::hdf5
