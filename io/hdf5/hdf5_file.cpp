#include "io/hdf5/hdf5_file.h"

#include <hdf5.h>
#include <hdf5_hl.h>

#include <algorithm>
#include <functional>

#include "core/error.h"
#include "core/utf8.h"
#include "io/files/files_read.h"
#include "io/files/input_file.h"
#include "io/hdf5/elements.h"
#include "io/hdf5/gate.h"
#include "io/hdf5/remote.h"

namespace asdic::detail {

namespace {

using hdf5::dims;
using hdf5::Handle;
using hdf5::make_parents;
using hdf5::native_type;
using hdf5::product;

}  // namespace

Hdf5File::Hdf5File(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Hdf5File::Hdf5File(Hdf5File&&) noexcept = default;
Hdf5File& Hdf5File::operator=(Hdf5File&&) noexcept = default;

Hdf5File::~Hdf5File() {
  if (impl_ != nullptr && impl_->file >= 0 && !impl_->failed) H5Fclose(impl_->file);
}

Hdf5File Hdf5File::create(const std::filesystem::path& path) {
  hdf5::prepare();
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  impl->file = hdf5::open_file(path, H5F_ACC_TRUNC);
  impl->check(impl->file, "", "creating the file");
  return Hdf5File(std::move(impl));
}

std::unique_ptr<Hdf5File::Impl> Hdf5File::open_existing(const std::filesystem::path& path,
                                                        bool change) {
  hdf5::prepare();
  std::error_code error;
  const auto wrong = [&](const std::string& got) {
    return InputError({.where = path.string(), .got = got, .expected = "an HDF5 file"});
  };
  require_file(path, "an HDF5 file");
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  if (std::filesystem::file_size(path, error) == 0) throw wrong("an empty file");
  if (H5Fis_hdf5(path.c_str()) == 0) throw wrong("a file that is not HDF5");
  impl->file = hdf5::open_file(path, change ? H5F_ACC_RDWR : H5F_ACC_RDONLY);
  if (impl->file < 0) throw wrong("a file that cannot be opened (" + hdf5::last_message() + ")");
  hdf5::check_contents(impl->file, path);
  return impl;
}

Hdf5File Hdf5File::open(const std::filesystem::path& path) {
  note_read(path);
  return peek(path);
}

Hdf5File Hdf5File::peek(const std::filesystem::path& path) {
  hdf5::prepare();  // once here, so that children need not
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  impl->child = std::make_unique<isolated::Child>(path, "HDF5", [&path] {
    auto file = std::make_shared<const Hdf5File>(Hdf5File(open_existing(path, false)));
    return [file](std::string_view question) { return hdf5::answer(*file, question); };
  });
  return Hdf5File(std::move(impl));
}

Hdf5File Hdf5File::edit(const std::filesystem::path& path) {
  return Hdf5File(open_existing(path, true));
}

void Hdf5File::remove(const std::string& object) {
  if (has(object))
    impl_->check(H5Ldelete(impl_->file, object.c_str(), H5P_DEFAULT), object, "removing");
}

const std::filesystem::path& Hdf5File::path() const noexcept { return impl_->path; }

void Hdf5File::flush() {
  impl_->check(H5Fflush(impl_->file, H5F_SCOPE_LOCAL), "", "writing the file");
}

void Hdf5File::close() {
  if (impl_->file < 0) return;
  flush();
  const hid_t file = std::exchange(impl_->file, -1);
  impl_->check(H5Fclose(file), "", "closing the file");
}

Handle Hdf5File::Impl::open_dataset(const std::string& dataset) const {
  return {check(H5Dopen2(file, dataset.c_str(), H5P_DEFAULT), dataset, "opening the dataset"),
          H5Dclose};
}

Shape Hdf5File::Impl::shape_of(std::int64_t dataset_id, const std::string& dataset) const {
  const Handle space(check(H5Dget_space(dataset_id), dataset, "reading the shape"), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space);
  std::vector<hsize_t> size(static_cast<std::size_t>(std::max(rank, 0)));
  H5Sget_simple_extent_dims(space, size.data(), nullptr);
  return {size.begin(), size.end()};
}

template <class T>
void Hdf5File::write(const std::string& dataset, std::span<const T> values, const Shape& shape) {
  if (values.size() != product(shape))
    throw std::logic_error(dataset + ": values do not fill the shape");
  const auto size = dims(shape);
  const Handle space(shape.empty()
                         ? H5Screate(H5S_SCALAR)
                         : H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr),
                     H5Sclose);
  const Handle parents = make_parents();
  const Handle id(impl_->check(H5Dcreate2(impl_->file, dataset.c_str(), native_type<T>(), space,
                                          parents, H5P_DEFAULT, H5P_DEFAULT),
                               dataset, "creating the dataset"),
                  H5Dclose);
  if (values.empty()) return;
  impl_->check(H5Dwrite(id, native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
               dataset, "writing");
}

void Hdf5File::write_text(const std::string& dataset, std::string_view given) {
  std::string text = as_utf8(given);  // its type declares it
  const Handle type = hdf5::text_type(text.size() + 1);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle parents = make_parents();
  const Handle id(impl_->check(H5Dcreate2(impl_->file, dataset.c_str(), type, space, parents,
                                          H5P_DEFAULT, H5P_DEFAULT),
                               dataset, "creating the dataset"),
                  H5Dclose);
  text.resize(H5Tget_size(type));
  impl_->check(H5Dwrite(id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()), dataset, "writing");
}

void Hdf5File::make_dimension(const std::string& dataset, std::size_t size) {
  const hsize_t extent = size;
  const Handle space(H5Screate_simple(1, &extent, nullptr), H5Sclose);
  const Handle parents = make_parents();
  {
    // Never written, so HDF5 gives it no room. The type is what netCDF-C itself takes.
    const Handle id(impl_->check(H5Dcreate2(impl_->file, dataset.c_str(), H5T_IEEE_F32BE, space,
                                            parents, H5P_DEFAULT, H5P_DEFAULT),
                                 dataset, "creating the dimension"),
                    H5Dclose);
  }
  // By this name all netCDF-4 readers know it ("NetCDF-4 dimensions", netCDF user's guide, app. C).
  std::string length = std::to_string(size);
  length.insert(0, 10 - std::min<std::size_t>(10, length.size()), ' ');
  make_scale(dataset, "This is a netCDF dimension but not a netCDF variable." + length);
}

void Hdf5File::make_scale(const std::string& dataset, const std::string& dimension) {
  const Handle id = impl_->open_dataset(dataset);
  impl_->check(H5DSset_scale(id, dimension.c_str()), dataset, "making a scale");
}

void Hdf5File::attach_scales(const std::string& dataset, const std::vector<std::string>& scales) {
  const Handle id = impl_->open_dataset(dataset);
  for (std::size_t axis = 0; axis < scales.size(); ++axis) {
    const Handle scale = impl_->open_dataset(scales[axis]);
    impl_->check(H5DSattach_scale(id, scale, static_cast<unsigned>(axis)), dataset,
                 "attaching the scale " + scales[axis]);
  }
}

void Hdf5File::make_group(const std::string& group) {
  if (has(group)) return;
  const Handle parents = make_parents();
  const Handle id(
      impl_->check(H5Gcreate2(impl_->file, group.c_str(), parents, H5P_DEFAULT, H5P_DEFAULT), group,
                   "creating the group"),
      H5Gclose);
}

namespace {

/// What is asked of the child at a time: neither process holds much more than the values [bytes].
constexpr std::size_t most_at_once = std::size_t{1} << 24;

/// Cuts a block into pieces of at most so many elements, in row-major order.
void in_pieces(Shape start, Shape count, std::size_t most,
               const std::function<void(const Shape&, const Shape&)>& take) {
  const auto axis = std::find_if(count.begin(), count.end(), [](std::size_t n) { return n > 1; });
  const std::size_t all = product(count);
  if (all <= most || axis == count.end()) return take(start, count);
  const std::size_t n = *axis, rows = std::max<std::size_t>(1, most / (all / n));
  std::size_t& from = start[static_cast<std::size_t>(axis - count.begin())];
  for (std::size_t done = 0; done < n; done += rows, from += rows) {
    *axis = std::min(rows, n - done);
    in_pieces(start, count, most, take);
  }
}

/// \throws InputError where there is not so much memory: a damaged file may claim any number
template <class T>
void make_room(std::vector<T>& values, std::size_t count, const std::filesystem::path& path,
               const std::string& dataset) {
  const auto refuse = [&] {
    return InputError({.where = path.string() + ": " + dataset,
                       .got = std::to_string(count) + " values",
                       .expected = "as many as there is memory for"});
  };
  try {
    values.reserve(count);
  } catch (const std::bad_alloc&) {
    throw refuse();
  } catch (const std::length_error&) {
    throw refuse();
  }
}

}  // namespace

template <class T>
std::vector<T> Hdf5File::Impl::read_by_child(const std::string& dataset, const Shape& start,
                                             const Shape& count) const {
  const Shape shape = hdf5::ask<&Hdf5File::info>(*child, dataset).shape;
  for (std::size_t i = 0; i < std::min(shape.size(), count.size()); ++i)
    if (count[i] > shape[i] || start.at(i) > shape[i] - count[i])
      throw InputError({.where = path.string() + ": " + dataset,
                        .got = "fewer values than another dataset tells of",
                        .expected = "a whole file"});
  std::vector<T> values;
  make_room(values, product(count), path, dataset);
  in_pieces(start, count, most_at_once / sizeof(T), [&](const Shape& from, const Shape& size) {
    const auto piece = hdf5::ask<hdf5::read_block<T>>(*child, dataset, from, size);
    values.insert(values.end(), piece.begin(), piece.end());
  });
  return values;
}

template <class T>
std::vector<T> Hdf5File::read(const std::string& dataset) const {
  const Shape shape = info(dataset).shape;
  return read<T>(dataset, Shape(shape.size(), 0), shape);
}

template <class T>
std::vector<T> Hdf5File::read(const std::string& dataset, const Shape& start,
                              const Shape& count) const {
  if (impl_->child) return impl_->read_by_child<T>(dataset, start, count);
  const Handle id = impl_->open_dataset(dataset);
  const Shape shape = impl_->shape_of(id, dataset);
  if (start.size() != shape.size() || start.size() != count.size())
    throw std::logic_error(dataset + ": a block of another rank");
  hdf5::check_sources(id, impl_->path);
  std::vector<T> values;
  make_room(values, product(count), impl_->path, dataset);
  values.resize(product(count));
  if (values.empty()) return values;
  const Handle space(H5Dget_space(id), H5Sclose);
  const auto from = dims(start), size = dims(count);
  if (!shape.empty())
    impl_->check(
        H5Sselect_hyperslab(space, H5S_SELECT_SET, from.data(), nullptr, size.data(), nullptr),
        dataset, "selecting a block");
  const Handle memory(shape.empty()
                          ? H5Screate(H5S_SCALAR)
                          : H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr),
                      H5Sclose);
  impl_->check(H5Dread(id, native_type<T>(), memory, space, H5P_DEFAULT, values.data()), dataset,
               "reading");
  return values;
}

#define ASDIC_HDF5_ELEMENT(T)                                                             \
  template void Hdf5File::write<T>(const std::string&, std::span<const T>, const Shape&); \
  template std::vector<T> Hdf5File::read<T>(const std::string&) const;                    \
  template std::vector<T> Hdf5File::read<T>(const std::string&, const Shape&, const Shape&) const;
ASDIC_HDF5_ELEMENTS(ASDIC_HDF5_ELEMENT)
#undef ASDIC_HDF5_ELEMENT

}  // namespace asdic::detail
