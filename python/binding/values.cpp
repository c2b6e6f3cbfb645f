#include "values.h"

namespace asdic::python {
namespace {

bool is_array(const py::handle& object) { return py::isinstance<py::array>(object); }

Value list_of(const py::handle& object) {
  std::vector<Value> items;
  for (const py::handle item : object) items.push_back(value_of(item));
  return Value(items);
}

}  // namespace

Value value_of(const py::handle& object) {
  if (object.is_none()) return {};
  if (py::isinstance<py::bool_>(object)) return Value(object.cast<bool>());
  if (py::isinstance<py::int_>(object)) return Value(object.cast<std::int64_t>());
  if (py::isinstance<py::float_>(object)) return Value(object.cast<double>());
  if (py::isinstance<py::str>(object)) return Value(object.cast<std::string>());
  if (py::isinstance<py::dict>(object)) {
    Value table = Value::table();
    for (const auto& [key, value] : py::reinterpret_borrow<py::dict>(object))
      if (!value.is_none()) table.set(py::str(key).cast<std::string>(), value_of(value));
    return table;
  }
  if (is_array(object)) return value_of(object.attr("tolist")());
  if (py::isinstance<py::list>(object) || py::isinstance<py::tuple>(object)) return list_of(object);
  // numbers and truths of NumPy's
  if (py::hasattr(object, "item") && py::hasattr(object, "dtype"))
    return value_of(object.attr("item")());
  if (py::hasattr(object, "__fspath__")) return Value(py::str(object).cast<std::string>());
  if (py::hasattr(object, "__index__"))
    return Value(object.attr("__index__")().cast<std::int64_t>());
  if (py::hasattr(object, "__float__")) return Value(object.attr("__float__")().cast<double>());
  throw InputError("value", "a " + py::str(py::type::of(object)).cast<std::string>(),
                   "a number, a text, True or False, a list or a dictionary");
}

py::object object_of(const Value& value) {
  switch (value.kind()) {
    case Value::Kind::nothing:
      return py::none();
    case Value::Kind::flag:
      return py::bool_(value.flag());
    case Value::Kind::whole:
      return py::int_(value.whole());
    case Value::Kind::number:
      return py::float_(value.number());
    case Value::Kind::text:
      return py::str(value.text());
    case Value::Kind::list: {
      py::list made;
      for (std::size_t i = 0; i < value.size(); ++i) made.append(object_of(value.at(i)));
      return made;
    }
    case Value::Kind::table: {
      py::dict made;
      for (const std::string& key : value.keys()) made[py::str(key)] = object_of(value.at(key));
      return made;
    }
  }
  return py::none();
}

}  // namespace asdic::python
