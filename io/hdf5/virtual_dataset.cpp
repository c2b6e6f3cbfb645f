// Virtual datasets of Hdf5File.
#include <hdf5.h>

#include <stdexcept>

#include "io/hdf5/elements.h"
#include "io/hdf5/gate.h"
#include "io/hdf5/remote.h"

namespace asdic::detail {
namespace {

using hdf5::dims;
using hdf5::Handle;
using hdf5::native_type;

/// A space with `rows` rows from `first` on selected, each as large as `row` says.
Handle rows_of(const Shape& shape, std::size_t first, std::size_t rows, const Shape& row) {
  Handle space(H5Screate_simple(static_cast<int>(shape.size()), dims(shape).data(), nullptr),
               H5Sclose);
  std::vector<hsize_t> start(shape.size(), 0), count = dims(row);
  start[0] = first;
  count[0] = rows;
  H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  return space;
}

}  // namespace

template <class T>
void Hdf5File::write_virtual(const std::string& dataset, const Shape& shape,
                             std::span<const VirtualRows> parts, T fill) {
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_fill_value(properties, native_type<T>(), &fill);
  std::size_t at = 0;
  for (const VirtualRows& part : parts) {
    if (part.shape.size() != shape.size())
      throw std::logic_error(dataset + ": a part of another rank");
    if (part.rows == 0) continue;
    const Handle target = rows_of(shape, at, part.rows, part.shape);
    const Handle source = rows_of(part.shape, part.first, part.rows, part.shape);
    impl_->check(
        H5Pset_virtual(properties, target, part.file.c_str(), part.dataset.c_str(), source),
        dataset, "referring to " + part.file.string());
    at += part.rows;
  }
  if (at != shape.front()) throw std::logic_error(dataset + ": parts do not fill the shape");
  const Handle space(H5Screate_simple(static_cast<int>(shape.size()), dims(shape).data(), nullptr),
                     H5Sclose);
  const Handle links = hdf5::make_parents();
  const Handle id(impl_->check(H5Dcreate2(impl_->file, dataset.c_str(), native_type<T>(), space,
                                          links, properties, H5P_DEFAULT),
                               dataset, "creating the dataset"),
                  H5Dclose);
}

std::vector<std::filesystem::path> Hdf5File::virtual_files(const std::string& dataset) const {
  if (impl_->child) return hdf5::ask<&Hdf5File::virtual_files>(*impl_->child, dataset);
  const Handle id = impl_->open_dataset(dataset);
  return hdf5::virtual_sources(Handle(H5Dget_create_plist(id), H5Pclose), impl_->path);
}

#define ASDIC_HDF5_ELEMENT(T)                                                \
  template void Hdf5File::write_virtual<T>(const std::string&, const Shape&, \
                                           std::span<const VirtualRows>, T);
ASDIC_HDF5_ELEMENTS(ASDIC_HDF5_ELEMENT)
#undef ASDIC_HDF5_ELEMENT

}  // namespace asdic::detail
