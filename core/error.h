#pragma once
#include <stdexcept>
#include <string>

namespace asdic::detail {

/// What is wrong with an input, in the three parts that every message of ours has.
struct InputFault {
  std::string where;     ///< file, line and key, or the argument: "deep_ocean.toml:12:
                         ///< environment.sound_speed.speed[3]"
  std::string got;       ///< what was found, with its unit: "-1498 m/s"
  std::string expected;  ///< what would have been right: "a speed above 0 m/s"
};

/// The user's input is wrong. Thrown while reading or building, never while computing. The program
/// exits with status 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(InputFault fault);

  [[nodiscard]] const InputFault& fault() const noexcept { return fault_; }

  /// The same fault seen from further out: `outer` comes before where(), joined by a dot ("" leaves
  /// it as it is).
  [[nodiscard]] InputError inside(const std::string& outer) const;

 private:
  InputFault fault_;
};

/// The world says no (disk full, file locked, a tool is missing). The program exits with status 1.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace asdic::detail
