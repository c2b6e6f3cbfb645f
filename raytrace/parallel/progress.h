#pragma once
#include <functional>
#include <stdexcept>

namespace asdic::detail {

/// A run was stopped by its Progress.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Called now and then with the share that is done (0..1) from any thread; returning false stops
/// the run (Interrupted is thrown).
using Progress = std::function<bool(double)>;

}  // namespace asdic::detail
