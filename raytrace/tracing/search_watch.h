#pragma once
#include <functional>

namespace asdic {

/// How a search fares.
struct SearchWatch {
  /// Told the share that is done, from any thread; false: stop.
  std::function<bool(double)> progress;
  /// It was stopped, and what was found is not all.
  bool stopped = false;
  /// Of the fan's 256 first intervals, those given up after 16 384 rays: where boundaries are so
  /// rough that rays part without end, faint paths are missing.
  int unfinished = 0;
};

}  // namespace asdic
