#pragma once
#include <asdic/asdic.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

// asdic._core: the public C++ library (include/asdic) for Python, one part a file. It says what the
// library says, in NumPy's arrays; what people meet is made of it in python/asdic/.
namespace asdic::python {

namespace py = pybind11;

void add_errors(py::module_& module);
void add_scenario(py::module_& module);
void add_arrivals(py::module_& module);
void add_field(py::module_& module);
void add_ping(py::module_& module);
void add_process(py::module_& module);
void add_channel(py::module_& module);
void add_study(py::module_& module);
void add_files(py::module_& module);

/// An array that looks into a vector which lives as long as `owner`. It may not be written to.
template <class T>
py::array view(const T* data, std::vector<py::ssize_t> shape, py::handle owner) {
  py::array made(py::dtype::of<T>(), std::move(shape), data, owner);
  made.attr("flags").attr("writeable") = false;
  return made;
}

/// An array that has taken over a vector.
template <class T>
py::array taken(std::vector<T>&& values, std::vector<py::ssize_t> shape = {}) {
  auto* kept = new std::vector<T>(std::move(values));
  py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<T>*>(p); });
  if (shape.empty()) shape = {static_cast<py::ssize_t>(kept->size())};
  return py::array(py::dtype::of<T>(), std::move(shape), kept->data(), owner);
}

/// One field of many structs as an array.
template <class T, class Item, class Get>
py::array column(const std::vector<Item>& items, const Get& get) {
  py::array_t<T> made(static_cast<py::ssize_t>(items.size()));
  T* to = made.mutable_data();
  for (const Item& item : items) *to++ = static_cast<T>(get(item));
  return made;
}

/// A true bearing as files tell it: 0 to 360°. NaN stays.
inline double bearing_deg(double bearing) {
  const double turned = std::fmod(degrees(bearing), 360.0);
  return turned < 0.0 ? turned + 360.0 : turned;
}

}  // namespace asdic::python
