// Datasets of Hdf5File whose first dimension grows.
#include <hdf5.h>

#include <algorithm>
#include <stdexcept>

#include "io/hdf5/elements.h"
#include "io/hdf5/fletcher.h"
#include "io/hdf5/remote.h"

namespace asdic::detail {
namespace {

using hdf5::dims;
using hdf5::Handle;
using hdf5::make_parents;
using hdf5::native_type;
using hdf5::product;

/// The shape of chunks that are lines of memory (1, …, 1, the rest whole), behind which stands
/// nothing but a checksum; {} for others.
Shape plain_lines(std::int64_t dataset, const Shape& shape, std::int64_t type) {
  const Handle properties(H5Dget_create_plist(dataset), H5Pclose),
      stored(H5Dget_type(dataset), H5Tclose);
  std::vector<hsize_t> chunk(shape.size());
  const bool chunked = H5Pget_layout(properties) == H5D_CHUNKED &&
                       H5Pget_chunk(properties, static_cast<int>(chunk.size()), chunk.data()) > 0;
  if (!chunked || H5Tequal(stored, type) <= 0 || H5Pget_nfilters(properties) != 1) return {};
  unsigned flags = 0, config = 0;
  std::size_t values = 0;
  if (H5Pget_filter2(properties, 0, &flags, &values, nullptr, 0, nullptr, &config) !=
      H5Z_FILTER_FLETCHER32)
    return {};
  const auto whole = std::find_if(chunk.begin(), chunk.end(), [](hsize_t n) { return n != 1; });
  const auto tail = shape.begin() + (whole - chunk.begin());
  const bool lines = whole != chunk.begin() && whole != chunk.end() &&
                     std::equal(whole, chunk.end(), tail, shape.end());
  return lines ? Shape(chunk.begin(), chunk.end()) : Shape{};
}

/// Writes rows of such a dataset as HDF5 would with its filter, which takes five times as long: it
/// copies every chunk into new memory. \param start  of the rows \return the first failure, or 0
herr_t write_lines(std::int64_t dataset, std::span<const std::byte> bytes, const Shape& shape,
                   const Shape& chunk, std::size_t first_row) {
  const std::size_t lines = product(shape) / shape[0] / product(chunk);  // a row
  const std::size_t rows = bytes.size() == 0 ? 0 : shape[0] - first_row;
  const std::size_t size = bytes.size() / (rows * lines);  // of a line [bytes]
  std::vector<std::byte> line(size + sizeof(std::uint32_t));
  std::vector<hsize_t> at(shape.size(), 0);
  herr_t status = 0;
  for (std::size_t i = 0; i < rows * lines && status >= 0; ++i) {
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(i * size), size, line.begin());
    const std::uint32_t sum = hdf5::fletcher32(std::span(line).first(size));
    for (std::size_t b = 0; b < sizeof sum; ++b)
      line[size + b] = static_cast<std::byte>(sum >> (8 * b) & 0xffU);
    std::size_t rest = i;
    for (std::size_t axis = shape.size(); axis-- > 1;) {
      const std::size_t count = shape[axis] / chunk[axis];
      at[axis] = rest % count * chunk[axis];
      rest /= count;
    }
    at[0] = first_row + rest;
    status = H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, at.data(), line.size(), line.data());
  }
  return status;
}

}  // namespace

template <class T>
void Hdf5File::create_growing(const std::string& dataset, const Shape& row, std::size_t chunk_rows,
                              int deflate) {
  Shape chunk{chunk_rows};
  chunk.insert(chunk.end(), row.begin(), row.end());
  create_growing<T>(dataset, row, chunk, deflate);
}

template <class T>
void Hdf5File::create_growing(const std::string& dataset, const Shape& row, const Shape& chunk,
                              int deflate) {
  std::vector<hsize_t> size{0}, most{H5S_UNLIMITED};
  for (const std::size_t n : row) {
    size.push_back(n);
    most.push_back(n);
  }
  const Handle space(H5Screate_simple(static_cast<int>(size.size()), size.data(), most.data()),
                     H5Sclose);
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_chunk(properties, static_cast<int>(chunk.size()), dims(chunk).data());
  if (deflate > 0) H5Pset_deflate(properties, static_cast<unsigned>(deflate));
  H5Pset_fletcher32(properties);
  const Handle parents = make_parents();
  const Handle id(impl_->check(H5Dcreate2(impl_->file, dataset.c_str(), native_type<T>(), space,
                                          parents, properties, H5P_DEFAULT),
                               dataset, "creating the dataset"),
                  H5Dclose);
}

template <class T>
void Hdf5File::append(const std::string& dataset, std::span<const T> values) {
  if (values.empty()) return;
  const Handle id = impl_->open_dataset(dataset);
  Shape shape = impl_->shape_of(id, dataset);
  Shape block(shape);
  block.at(0) = 1;
  const std::size_t row = product(block);
  if (row == 0 || values.size() % row != 0)
    throw std::logic_error(dataset + ": not a whole number of rows");
  block.at(0) = values.size() / row;
  std::vector<hsize_t> start(shape.size(), 0);
  start.at(0) = shape.at(0);
  shape.at(0) += block.at(0);
  impl_->check(H5Dset_extent(id, dims(shape).data()), dataset, "growing");
  if (const Shape chunk = plain_lines(id, shape, native_type<T>()); !chunk.empty()) {
    const auto first = static_cast<std::size_t>(start.at(0));
    impl_->check(write_lines(id, std::as_bytes(values), shape, chunk, first), dataset, "writing");
    return;
  }
  const Handle space(H5Dget_space(id), H5Sclose);
  const auto count = dims(block);
  H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  const Handle memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr),
                      H5Sclose);
  impl_->check(H5Dwrite(id, native_type<T>(), memory, space, H5P_DEFAULT, values.data()), dataset,
               "writing");
}

template <class T>
void Hdf5File::append_padded(const std::string& dataset, std::span<const T> values,
                             std::size_t length) {
  Shape shape;
  {
    const Handle id = impl_->open_dataset(dataset);
    shape = impl_->shape_of(id, dataset);
  }
  const std::size_t full = shape.back();
  if (length == full) return append(dataset, values);
  if (length > full || length == 0 || values.size() % length != 0)
    throw std::logic_error(dataset + ": lines longer than the dataset's");
  std::vector<T> padded(values.size() / length * full, T{});
  for (std::size_t line = 0; line < values.size() / length; ++line)
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(line * length), length,
                padded.begin() + static_cast<std::ptrdiff_t>(line * full));
  append<T>(dataset, padded);
}

bool Hdf5File::grows(const std::string& dataset) const {
  const Handle id = impl_->open_dataset(dataset);
  const Handle space(impl_->check(H5Dget_space(id), dataset, "reading the shape"), H5Sclose);
  std::vector<hsize_t> most(impl_->shape_of(id, dataset).size());
  if (!most.empty()) H5Sget_simple_extent_dims(space, nullptr, most.data());
  return !most.empty() && most.front() == H5S_UNLIMITED;
}

void Hdf5File::shrink(const std::string& dataset, std::size_t rows) {
  const Handle id = impl_->open_dataset(dataset);
  Shape shape = impl_->shape_of(id, dataset);
  if (shape.empty() || rows > shape.front())
    throw std::logic_error(dataset + ": it has no more rows");
  shape.front() = rows;
  impl_->check(H5Dset_extent(id, dims(shape).data()), dataset, "shrinking");
}

bool Hdf5File::has_checksums(const std::string& dataset) const {
  if (impl_->child) return hdf5::ask<&Hdf5File::has_checksums>(*impl_->child, dataset);
  const Handle id = impl_->open_dataset(dataset);
  const Handle properties(
      impl_->check(H5Dget_create_plist(id), dataset, "reading how it is stored"), H5Pclose);
  for (int i = 0; i < H5Pget_nfilters(properties); ++i) {
    unsigned flags = 0, config = 0;
    std::size_t values = 0;
    const auto filter = H5Pget_filter2(properties, static_cast<unsigned>(i), &flags, &values,
                                       nullptr, 0, nullptr, &config);
    if (filter == H5Z_FILTER_FLETCHER32) return true;
  }
  return false;
}

#define ASDIC_HDF5_ELEMENT(T)                                                                     \
  template void Hdf5File::create_growing<T>(const std::string&, const Shape&, std::size_t, int);  \
  template void Hdf5File::create_growing<T>(const std::string&, const Shape&, const Shape&, int); \
  template void Hdf5File::append<T>(const std::string&, std::span<const T>);                      \
  template void Hdf5File::append_padded<T>(const std::string&, std::span<const T>, std::size_t);
ASDIC_HDF5_ELEMENTS(ASDIC_HDF5_ELEMENT)
#undef ASDIC_HDF5_ELEMENT

}  // namespace asdic::detail
