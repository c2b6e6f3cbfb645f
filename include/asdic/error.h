#pragma once

/// \file
/// What is thrown. A message says where, what was found, and what was expected.
///
/// ```cpp
/// try {
///   asdic::Scenario::parse("[pulse]\nduraton = 1.0").validate();
/// } catch (const asdic::InputError& error) {
///   std::cout << "line " << error.line() << ", key " << error.key() << ": found " << error.found()
///             << ", expected " << error.expected() << '\n';
/// }
/// ```

#include <stdexcept>
#include <string>

#include "asdic/export.h"

namespace asdic {

/// The caller's input is wrong: a scenario, a file, an argument. Thrown before anything is
/// computed.
class ASDIC_API InputError : public std::runtime_error {
 public:
  /// \param where  "deep_ocean.toml:12: environment.bottom.depth", or an argument's name
  /// \param file   with which `where` begins, if it names no line of it
  InputError(std::string where, std::string found, std::string expected, std::string file = {});
  InputError(const InputError&) = default;
  ~InputError() override;

  [[nodiscard]] const std::string& where() const noexcept { return where_; }
  /// The file that is at fault; "" where it is none: the scenario was built in C++.
  [[nodiscard]] std::string file() const;
  [[nodiscard]] int line() const;  ///< in that file, from 1; 0: not known
  /// "pulse.duration", or the argument; "" where all of the file is at fault.
  [[nodiscard]] std::string key() const;
  [[nodiscard]] const std::string& found() const noexcept { return found_; }
  [[nodiscard]] const std::string& expected() const noexcept { return expected_; }

 private:
  std::string where_, found_, expected_, file_;
};

/// The work was called off (asdic/watch.h).
class ASDIC_API Stopped : public std::runtime_error {
 public:
  Stopped();
  Stopped(const Stopped&) = default;
  ~Stopped() override;
};

/// The world says no: the disk is full, a file is locked.
class ASDIC_API RunError : public std::runtime_error {
 public:
  explicit RunError(const std::string& what);
  RunError(const RunError&) = default;
  ~RunError() override;
};

}  // namespace asdic
