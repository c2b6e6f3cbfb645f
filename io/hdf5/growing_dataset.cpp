// Datasets of Hdf5File whose first dimension grows.
#include <hdf5.h>

#include <algorithm>
#include <stdexcept>

#include "io/hdf5/elements.h"

namespace asdic {
namespace {

using hdf5::dims;
using hdf5::Handle;
using hdf5::make_parents;
using hdf5::native_type;
using hdf5::product;

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

#define ASDIC_HDF5_ELEMENT(T)                                                                     \
  template void Hdf5File::create_growing<T>(const std::string&, const Shape&, std::size_t, int);  \
  template void Hdf5File::create_growing<T>(const std::string&, const Shape&, const Shape&, int); \
  template void Hdf5File::append<T>(const std::string&, std::span<const T>);                      \
  template void Hdf5File::append_padded<T>(const std::string&, std::span<const T>, std::size_t);
ASDIC_HDF5_ELEMENTS(ASDIC_HDF5_ELEMENT)
#undef ASDIC_HDF5_ELEMENT

}  // namespace asdic
