#pragma once
#include <stdexcept>
#include <string>

namespace asdic::serve {

/// Why a command was not done, in words that may go to a client: where, found, expected, as every
/// message of ours; never what stands in a file, in the scenario, or where files lie.
class Refusal : public std::runtime_error {
 public:
  /// \param code  for programs: handshake, token, json, command, value, limit, file, scenario,
  /// busy, closing, idle, run
  Refusal(std::string code, const std::string& message)
      : std::runtime_error(message), code_(std::move(code)) {}

  [[nodiscard]] const std::string& code() const noexcept { return code_; }

 private:
  std::string code_;
};

/// "WHERE: found GOT, expected EXPECTED"; without what was found: "WHERE: expected EXPECTED".
[[nodiscard]] inline std::string refusal_text(const std::string& where, const std::string& got,
                                              const std::string& expected) {
  return where + (where.empty() ? "" : ": ") + (got.empty() ? "" : "found " + got + ", ") +
         "expected " + expected;
}

}  // namespace asdic::serve
