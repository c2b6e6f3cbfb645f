#pragma once
#include <optional>

#include "module.h"

namespace asdic::python {

/// Does work beside the interpreter, which is released meanwhile. In Python's main thread Ctrl-C
/// calls the work off. \param progress  None, or called with (done, total)
/// \throws what the work throws; KeyboardInterrupt, or whatever the signal's handler raised
void run_watched(const std::function<void(const Watch&)>& work, const py::object& progress);

/// The same of work that returns something.
template <class Work>
auto watched(const Work& work, const py::object& progress = py::none()) {
  std::optional<decltype(work(Watch{}))> result;
  run_watched([&](const Watch& watch) { result.emplace(work(watch)); }, progress);
  return std::move(*result);
}

}  // namespace asdic::python
