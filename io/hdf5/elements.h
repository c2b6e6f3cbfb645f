#pragma once
#include <cstdint>
#include <functional>
#include <numeric>
#include <vector>

#include "io/hdf5/handles.h"

// What the .cpp files of Hdf5File that write datasets share (hdf5_file.cpp).
namespace asdic::detail::hdf5 {

/// HDF5's name for an element of Hdf5File in this machine's memory.
template <class T>
[[nodiscard]] std::int64_t native_type();
template <>
std::int64_t native_type<std::int8_t>();
template <>
std::int64_t native_type<std::int32_t>();
template <>
std::int64_t native_type<std::int64_t>();
template <>
std::int64_t native_type<float>();
template <>
std::int64_t native_type<double>();

/// UTF-8 of a fixed length, filled with zeros at the end; at least one byte. Text of variable
/// length lies apart from its owner, in heaps of the file that damage makes HDF5 crash on.
[[nodiscard]] Handle text_type(std::size_t bytes);

/// As HDF5 wants a shape.
[[nodiscard]] inline std::vector<unsigned long long> dims(const Shape& shape) {
  return {shape.begin(), shape.end()};
}

/// Elements of a shape.
[[nodiscard]] inline std::size_t product(const Shape& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
}

/// Link creation that makes the groups on the way.
[[nodiscard]] Handle make_parents();

}  // namespace asdic::detail::hdf5

/// Instantiates a template for every type of element: INSTANTIATE(type) for each.
#define ASDIC_HDF5_ELEMENTS(INSTANTIATE) \
  INSTANTIATE(std::int8_t)               \
  INSTANTIATE(std::int32_t)              \
  INSTANTIATE(std::int64_t)              \
  INSTANTIATE(float)                     \
  INSTANTIATE(double)
