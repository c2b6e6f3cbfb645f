#pragma once
#include <cstdint>
#include <vector>

#include "io/hdf5/handles.h"

// What the .cpp files of Hdf5File that write datasets share (hdf5_file.cpp).
namespace asdic::hdf5 {

/// HDF5's name for an element of Hdf5File in this machine's memory.
template <class T>
[[nodiscard]] std::int64_t native_type();

/// As HDF5 wants a shape.
[[nodiscard]] inline std::vector<unsigned long long> dims(const Shape& shape) {
  return {shape.begin(), shape.end()};
}

/// Link creation that makes the groups on the way.
[[nodiscard]] Handle make_parents();

}  // namespace asdic::hdf5
