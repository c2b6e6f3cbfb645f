#pragma once
#include <chrono>
#include <utility>

namespace asdic::detail {

/// Wall time since it was made or last read [s].
class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(start_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace asdic::detail
