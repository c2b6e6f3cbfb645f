#pragma once
#include <functional>

namespace asdic {

/// How a search fares.
struct SearchWatch {
  /// Told the share that is done, from any thread; false: stop.
  std::function<bool(double)> progress;
  /// It was stopped, and what was found is not all.
  bool stopped = false;
  /// Of the fan's first intervals, those given up after their part of 4 million rays: where
  /// boundaries are so rough that rays part without end, faint paths are missing.
  int unfinished = 0;
  int intervals = 0;  ///< how many these are
};

}  // namespace asdic
