#include "module.h"

PYBIND11_MODULE(_core, module) {
  using namespace asdic::python;
  module.doc() = "The C++ library of asdic; use the package asdic.";
  add_errors(module);
  add_scenario(module);
  add_arrivals(module);
  add_field(module);
  add_ping(module);
  add_process(module);
  add_channel(module);
  add_study(module);
  add_files(module);
}
