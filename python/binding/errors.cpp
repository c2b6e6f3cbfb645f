#include "module.h"

namespace asdic::python {
namespace {

PyObject *input_error = nullptr, *run_error = nullptr, *stopped = nullptr;

PyObject* made(py::module_& module, const char* name, PyObject* base, const char* doc) {
  const std::string full = std::string("asdic.") + name;
  PyObject* type = PyErr_NewExceptionWithDoc(full.c_str(), doc, base, nullptr);
  module.attr(name) = py::reinterpret_borrow<py::object>(type);
  return type;
}

void raise(const InputError& error) {
  py::object raised = py::reinterpret_borrow<py::object>(input_error)(error.what());
  raised.attr("where") = error.where();
  raised.attr("file") = error.file();
  raised.attr("line") = error.line();
  raised.attr("key") = error.key();
  raised.attr("found") = error.found();
  raised.attr("expected") = error.expected();
  PyErr_SetObject(input_error, raised.ptr());
}

}  // namespace

void add_errors(py::module_& module) {
  input_error = made(module, "InputError", PyExc_ValueError,
                     "The input is wrong: a scenario, a file, an argument.\n\n"
                     "Attributes: where, file (\"\": none), line (from 1; 0: not known), key, "
                     "found, expected.");
  run_error = made(module, "RunError", PyExc_RuntimeError,
                   "The world says no: the disk is full, a file is locked.");
  stopped = made(module, "Stopped", PyExc_RuntimeError, "The work was called off.");
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const InputError& error) {
      raise(error);
    } catch (const RunError& error) {
      PyErr_SetString(run_error, error.what());
    } catch (const Stopped& error) {
      PyErr_SetString(stopped, error.what());
    }
  });
}

}  // namespace asdic::python
