#pragma once
#include <hdf5.h>

#include <cstdint>
#include <type_traits>
#include <vector>

#include "io/hdf5/handles.h"

// What the .cpp files of Hdf5File that write datasets share.
namespace asdic::hdf5 {

/// HDF5's name for an element in this machine's memory.
template <class T>
[[nodiscard]] hid_t native_type() {
  if constexpr (std::is_same_v<T, std::int8_t>)
    return H5T_NATIVE_INT8;
  else if constexpr (std::is_same_v<T, std::int32_t>)
    return H5T_NATIVE_INT32;
  else if constexpr (std::is_same_v<T, std::int64_t>)
    return H5T_NATIVE_INT64;
  else if constexpr (std::is_same_v<T, float>)
    return H5T_NATIVE_FLOAT;
  else {
    static_assert(std::is_same_v<T, double>);
    return H5T_NATIVE_DOUBLE;
  }
}

[[nodiscard]] inline std::vector<hsize_t> dims(const Shape& shape) {
  return {shape.begin(), shape.end()};
}

/// Link creation that makes the groups on the way.
[[nodiscard]] inline Handle make_parents() {
  Handle list(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(list, 1);
  H5Pset_char_encoding(list, H5T_CSET_UTF8);
  return list;
}

}  // namespace asdic::hdf5
