#pragma once
#include "module.h"

namespace asdic::python {

/// None, bool, int, float, str, lists, tuples, arrays of NumPy's, dictionaries.
/// \throws InputError for anything else
[[nodiscard]] Value value_of(const py::handle& object);
[[nodiscard]] py::object object_of(const Value& value);

}  // namespace asdic::python
