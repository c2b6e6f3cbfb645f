#include "watched.h"

namespace asdic::python {
namespace {

using namespace py::literals;

py::dict shown(StudyResult&& result) {
  py::dict columns;
  for (std::size_t i = 0; i < result.columns.size(); ++i)
    columns[py::str(result.columns[i])] = taken(std::move(result.values[i]));
  return py::dict("columns"_a = columns, "units"_a = result.units, "complete"_a = result.complete,
                  "question"_a = result.question, "value"_a = result.value, "low"_a = result.low,
                  "high"_a = result.high, "warnings"_a = result.warnings);
}

/// A measure that is a function of Python's: it is called with the interpreter held.
StudyMeasure measure_of(const py::dict& told, const std::shared_ptr<py::object>& function) {
  return {.name = told["name"].cast<std::string>(),
          .unit = told["unit"].cast<std::string>(),
          .meaning = told["meaning"].cast<std::string>(),
          .version = told["version"].cast<std::string>(),
          .samples = told["samples"].cast<bool>(),
          .of = [function](const Ping& ping) {
            const py::gil_scoped_acquire held;
            return (*function)(ping).cast<double>();
          }};
}

py::dict run(const std::filesystem::path& file, const std::filesystem::path& output,
             const std::vector<std::string>& changes, const py::list& measures, bool fresh,
             const std::vector<std::string>& until, const py::object& enough,
             const py::object& progress) {
  StudyOptions options{.changes = changes, .fresh = fresh, .until = until};
  std::vector<std::shared_ptr<py::object>> functions;  // outlive the run, and go with the GIL held
  for (const py::handle& one : measures) {
    const py::dict told = py::reinterpret_borrow<py::dict>(one);
    functions.push_back(std::make_shared<py::object>(told["of"]));
    options.measures.push_back(measure_of(told, functions.back()));
  }
  if (!enough.is_none())
    options.enough = [&enough](const StudyResult& rows) {
      const py::gil_scoped_acquire held;
      StudyResult copy = rows;
      return enough(shown(std::move(copy))).cast<bool>();
    };
  StudyResult result = watched(
      [&](const Watch& watch) {
        options.stop = watch.stop;
        if (watch.progress)
          options.progress = [&](std::uint64_t done, std::uint64_t total) {
            watch.progress(static_cast<int>(done), static_cast<int>(total));
          };
        return study(file, output, options);
      },
      progress);
  return shown(std::move(result));
}

}  // namespace

void add_study(py::module_& module) {
  module.def("study", &run);
  module.def(
      "write_placement", [](const std::filesystem::path& output, const std::filesystem::path& plan,
                            const std::vector<std::string>& changes, const py::object& progress) {
        return watched(
            [&](const Watch& watch) { return write_placement(output, plan, changes, watch); },
            progress);
      });
  module.def("read_study",
             [](const std::filesystem::path& file) { return shown(read_study(file)); });
}

}  // namespace asdic::python
