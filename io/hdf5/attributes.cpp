// Attributes, listings and text of Hdf5File.
#include <hdf5.h>

#include <algorithm>

#include "core/error.h"
#include "core/text.h"
#include "core/utf8.h"
#include "io/hdf5/elements.h"
#include "io/hdf5/remote.h"

namespace asdic::detail {
namespace {

using hdf5::Handle;

std::string root_or(const std::string& object) { return object.empty() ? "/" : object; }

Handle variable_text() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

ElementType element_type(std::int64_t type) {
  const auto size = H5Tget_size(type);
  switch (H5Tget_class(type)) {
    case H5T_INTEGER:
      return size == 1   ? ElementType::int8
             : size == 4 ? ElementType::int32
             : size == 8 ? ElementType::int64
                         : ElementType::other;
    case H5T_FLOAT:
      return size == 4   ? ElementType::float32
             : size == 8 ? ElementType::float64
                         : ElementType::other;
    case H5T_STRING:
      return ElementType::text;
    default:
      return ElementType::other;
  }
}

/// Strings out of a buffer of HDF5's, whichever way they are stored.
std::vector<std::string> to_strings(const std::vector<char>& buffer, std::size_t size,
                                    bool variable) {
  std::vector<std::string> result;
  if (size == 0) return result;
  for (std::size_t at = 0; at + size <= buffer.size(); at += size) {
    const char* text = buffer.data() + at;
    if (variable) {
      const char* pointer = nullptr;
      std::copy_n(text, sizeof pointer, reinterpret_cast<char*>(&pointer));
      result.emplace_back(pointer == nullptr ? "" : pointer);
    } else {
      result.emplace_back(text, std::find(text, text + size, '\0'));
    }
  }
  return result;
}

}  // namespace

std::string_view name(ElementType type) noexcept {
  switch (type) {
    case ElementType::int8:
      return "int8";
    case ElementType::int32:
      return "int32";
    case ElementType::int64:
      return "int64";
    case ElementType::float32:
      return "float32";
    case ElementType::float64:
      return "float64";
    case ElementType::text:
      return "string";
    case ElementType::other:
      break;
  }
  return "other";
}

Handle Hdf5File::Impl::open_object(const std::string& object) const {
  return {check(H5Oopen(file, root_or(object).c_str(), H5P_DEFAULT), object, "opening"), H5Oclose};
}

namespace {

void write_attribute(const hdf5::Handle& object, const std::string& key, std::int64_t type,
                     std::int64_t space, const void* value, const std::filesystem::path& path,
                     const std::string& where) {
  if (H5Aexists(object, key.c_str()) > 0) H5Adelete(object, key.c_str());
  const Handle id(H5Acreate2(object, key.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (id < 0 || H5Awrite(id, type, value) < 0)
    hdf5::fail(path, where, "writing the attribute " + key);
}

}  // namespace

namespace {

/// Attributes are parts of their owner's header, which has no room for more.
constexpr std::size_t most_fixed = 60'000;  // [bytes]

void write_texts(const hdf5::Handle& object, const std::string& key, std::int64_t space,
                 std::vector<std::string> values, const std::filesystem::path& path,
                 const std::string& where) {
  for (std::string& value : values) value = as_utf8(value);  // their type declares it
  std::size_t longest = 1;  // with a zero at the end, see text_type()
  for (const std::string& value : values) longest = std::max(longest, value.size() + 1);
  if (longest * values.size() > most_fixed) {
    std::vector<const char*> pointers;
    for (const std::string& value : values) pointers.push_back(value.c_str());
    return write_attribute(object, key, variable_text(), space, pointers.data(), path, where);
  }
  std::string padded;
  for (const std::string& value : values) padded += value + std::string(longest - value.size(), 0);
  write_attribute(object, key, hdf5::text_type(longest), space, padded.data(), path, where);
}

}  // namespace

void Hdf5File::set_attribute(const std::string& object, const std::string& key,
                             std::string_view value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  write_texts(impl_->open_object(object), key, space, {std::string(value)}, impl_->path, object);
}

void Hdf5File::set_attribute(const std::string& object, const std::string& key, double value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  write_attribute(impl_->open_object(object), key, H5T_NATIVE_DOUBLE, space, &value, impl_->path,
                  object);
}

void Hdf5File::set_attribute(const std::string& object, const std::string& key,
                             std::int64_t value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  write_attribute(impl_->open_object(object), key, H5T_NATIVE_INT64, space, &value, impl_->path,
                  object);
}

void Hdf5File::set_attribute(const std::string& object, const std::string& key,
                             const std::vector<std::string>& values) {
  const hsize_t size = values.size();
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  write_texts(impl_->open_object(object), key, space, values, impl_->path, object);
}

void Hdf5File::set_flags(const std::string& dataset, const std::vector<std::int8_t>& values,
                         std::string_view meanings) {
  const hsize_t size = values.size();
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  write_attribute(impl_->open_object(dataset), "flag_values", H5T_NATIVE_INT8, space, values.data(),
                  impl_->path, dataset);
  set_attribute(dataset, "flag_meanings", meanings);
}

bool Hdf5File::has(const std::string& object) const {
  if (impl_->child) return hdf5::ask<&Hdf5File::has>(*impl_->child, object);
  const std::string path = root_or(object);
  for (std::size_t slash = path.find('/', 1); slash != std::string::npos;
       slash = path.find('/', slash + 1))  // H5Lexists wants every parent to exist
    if (H5Lexists(impl_->file, path.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
  return path == "/" || H5Lexists(impl_->file, path.c_str(), H5P_DEFAULT) > 0;
}

DatasetInfo Hdf5File::info(const std::string& dataset) const {
  if (impl_->child) return hdf5::ask<&Hdf5File::info>(*impl_->child, dataset);
  const Handle id = impl_->open_dataset(dataset);
  const Handle type(H5Dget_type(id), H5Tclose);
  return {.path = dataset.starts_with('/') ? dataset : "/" + dataset,
          .type = element_type(type),
          .shape = impl_->shape_of(id, dataset)};
}

std::vector<DatasetInfo> Hdf5File::datasets() const {
  if (impl_->child) return hdf5::ask<&Hdf5File::datasets>(*impl_->child);
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* path, const H5O_info_t* object, void* into) -> herr_t {
    if (object->type == H5O_TYPE_DATASET)
      static_cast<std::vector<std::string>*>(into)->emplace_back(path);
    return 0;
  };
  impl_->check(H5Ovisit(impl_->file, H5_INDEX_NAME, H5_ITER_NATIVE, collect, &names), "",
               "listing the datasets");
  std::sort(names.begin(), names.end());
  std::vector<DatasetInfo> result;
  for (const std::string& path : names) result.push_back(info(path));
  return result;
}

std::string Hdf5File::read_text(const std::string& dataset) const {
  if (impl_->child) return hdf5::ask<&Hdf5File::read_text>(*impl_->child, dataset);
  const Handle id = impl_->open_dataset(dataset);
  const Handle type(H5Dget_type(id), H5Tclose), space(H5Dget_space(id), H5Sclose);
  if (H5Tget_class(type) != H5T_STRING || H5Sget_simple_extent_npoints(space) != 1)
    throw InputError({.where = impl_->path.string() + ": " + dataset,
                      .got = std::string(name(element_type(type))),
                      .expected = "a string"});
  const bool variable = H5Tis_variable_str(type) > 0;  // files of before
  std::vector<char> buffer(H5Tget_size(type));
  impl_->check(H5Dread(id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, buffer.data()), dataset, "reading");
  const auto texts = to_strings(buffer, buffer.size(), variable);
  if (variable) H5Dvlen_reclaim(type, space, H5P_DEFAULT, buffer.data());
  return texts.empty() ? "" : texts.front();
}

std::vector<std::string> Hdf5File::attributes(const std::string& object) const {
  if (impl_->child) return hdf5::ask<&Hdf5File::attributes>(*impl_->child, object);
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* key, const H5A_info_t*, void* into) -> herr_t {
    static_cast<std::vector<std::string>*>(into)->emplace_back(key);
    return 0;
  };
  const Handle id = impl_->open_object(object);
  hsize_t index = 0;
  impl_->check(H5Aiterate2(id, H5_INDEX_NAME, H5_ITER_INC, &index, collect, &names), object,
               "listing the attributes");
  return names;
}

bool Hdf5File::has_attribute(const std::string& object, const std::string& key) const {
  if (impl_->child) return hdf5::ask<&Hdf5File::has_attribute>(*impl_->child, object, key);
  return H5Aexists(impl_->open_object(object), key.c_str()) > 0;
}

double Hdf5File::attribute_number(const std::string& object, const std::string& key) const {
  if (impl_->child) return hdf5::ask<&Hdf5File::attribute_number>(*impl_->child, object, key);
  const Handle owner = impl_->open_object(object);
  const Handle id(impl_->check(H5Aopen(owner, key.c_str(), H5P_DEFAULT), object,
                               "opening the attribute " + key),
                  H5Aclose);
  const Handle space(H5Aget_space(id), H5Sclose);
  double value = 0.0;
  if (H5Sget_simple_extent_npoints(space) != 1)
    hdf5::fail(impl_->path, object, "reading one " + key);
  impl_->check(H5Aread(id, H5T_NATIVE_DOUBLE, &value), object, "reading the attribute " + key);
  return value;
}

std::vector<std::string> Hdf5File::attribute_texts(const std::string& object,
                                                   const std::string& key) const {
  if (impl_->child) return hdf5::ask<&Hdf5File::attribute_texts>(*impl_->child, object, key);
  const Handle owner = impl_->open_object(object);
  const Handle id(impl_->check(H5Aopen(owner, key.c_str(), H5P_DEFAULT), object,
                               "opening the attribute " + key),
                  H5Aclose);
  const Handle type(H5Aget_type(id), H5Tclose);
  const Handle space(H5Aget_space(id), H5Sclose);
  const auto points =
      static_cast<std::size_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space)));
  std::vector<std::string> parts;
  const auto type_class = H5Tget_class(type);
  if (type_class == H5T_STRING) {
    std::vector<char> buffer(points * H5Tget_size(type));
    impl_->check(H5Aread(id, type, buffer.data()), object, "reading the attribute " + key);
    const bool variable = H5Tis_variable_str(type) > 0;
    parts = to_strings(buffer, H5Tget_size(type), variable);
    for (std::string& part : parts) part = as_utf8(part);  // older files may have other bytes
    if (variable) H5Dvlen_reclaim(type, space, H5P_DEFAULT, buffer.data());
  } else if (type_class == H5T_INTEGER || type_class == H5T_FLOAT) {
    std::vector<double> numbers(points);
    impl_->check(H5Aread(id, H5T_NATIVE_DOUBLE, numbers.data()), object,
                 "reading the attribute " + key);
    for (const double number : numbers) parts.push_back(to_text(number));
  }  // else: references of dimension scales, which say nothing in text
  return parts;
}

std::string Hdf5File::attribute_text(const std::string& object, const std::string& key) const {
  std::string text;
  for (const std::string& part : attribute_texts(object, key))
    text += (text.empty() ? "" : ", ") + part;
  return text;
}

std::string Hdf5File::attribute_or(const std::string& object, const std::string& key,
                                   std::string_view otherwise) const {
  return has(object) && has_attribute(object, key) ? attribute_text(object, key)
                                                   : std::string(otherwise);
}

}  // namespace asdic::detail
