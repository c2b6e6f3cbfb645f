#pragma once
#include <cstddef>
#include <functional>

namespace asdic::detail {

/// What a search takes: rays traced, for the fan and for roots, and the segments of them.
struct SearchCost {
  std::size_t rays = 0, segments = 0;

  void add(std::size_t segments_of_ray) noexcept {
    ++rays;
    segments += segments_of_ray;
  }
  SearchCost& operator+=(const SearchCost& other) noexcept {
    rays += other.rays;
    segments += other.segments;
    return *this;
  }
};

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
  SearchCost cost;    ///< the same for any number of threads
};

}  // namespace asdic::detail
