#include "values.h"
#include "watched.h"

namespace asdic::python {
namespace {

py::dict described(const Setting& s) {
  static const char* const kinds[] = {"number", "whole", "flag",   "text",    "word", "numbers",
                                      "rows",   "axis",  "vector", "vectors", "name"};
  using namespace py::literals;
  return py::dict("path"_a = s.path, "kind"_a = kinds[static_cast<int>(s.kind)], "unit"_a = s.unit,
                  "lowest"_a = s.lowest, "highest"_a = s.highest, "or_zero"_a = s.or_zero,
                  "words"_a = s.words, "length"_a = s.length, "standard"_a = s.standard,
                  "otherwise"_a = s.otherwise, "help"_a = s.help, "condition"_a = s.condition,
                  "required"_a = s.required);
}

py::dict described(const SettingTable& table) {
  using namespace py::literals;
  return py::dict("path"_a = table.path, "help"_a = table.help, "list"_a = table.list,
                  "one_or_more"_a = table.one_or_more);
}

}  // namespace

void add_scenario(py::module_& module) {
  py::class_<Scenario>(module, "Scenario")
      .def(py::init<>())
      .def_static("read",
                  [](const std::filesystem::path& file, const std::vector<std::string>& changes) {
                    return Scenario::read(file, changes);
                  })
      .def_static("parse",
                  [](const std::string& text, const std::filesystem::path& name) {
                    return Scenario::parse(text, name);
                  })
      .def("copy", [](const Scenario& s) { return s; })
      .def("set", [](Scenario& s, const std::string& path,
                     const py::object& value) { s.set(path, value_of(value)); })
      .def("add", [](Scenario& s, const std::string& path,
                     const py::object& table) { s.add(path, value_of(table)); })
      .def("erase", [](Scenario& s, const std::string& path) { s.erase(path); })
      .def("has", [](const Scenario& s, const std::string& path) { return s.has(path); })
      .def("get", [](const Scenario& s, const std::string& path) { return object_of(s.get(path)); })
      .def("to_toml", &Scenario::to_toml)
      .def("path", [](const Scenario& s) { return s.path().string(); })
      .def("warnings", &Scenario::warnings)
      .def("validate", [](const Scenario& s, const py::object& progress) {
        return watched([&](const Watch& watch) { return s.validate(watch); }, progress);
      });
  module.def("settings", [] {
    py::list made;
    for (const Setting& setting : settings()) made.append(described(setting));
    return made;
  });
  module.def("setting_tables", [] {
    py::list made;
    for (const SettingTable& table : setting_tables()) made.append(described(table));
    return made;
  });
  module.def("toml", [](const py::object& value) { return value_of(value).to_toml(); });
  module.def("measured", &measured);
  module.def("version", &version);
  module.def("build", &build);
}

}  // namespace asdic::python
