#pragma once
#include <string>
#include <vector>

namespace asdic::detail {

/// A setting as a reader understood it.
struct NotedSetting {
  std::string key;     ///< "target[0].strength_db"
  std::string value;   ///< 12.5, "hann", [0, 100, … 5000] (51 values); or in words what holds
  std::string unit;    ///< "" without one
  bool given = false;  ///< the file says it; else it is the default

  [[nodiscard]] bool operator==(const NotedSetting&) const = default;
};

/// In the order in which they were read; none twice.
using NotedSettings = std::vector<NotedSetting>;

}  // namespace asdic::detail
