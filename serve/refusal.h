#pragma once
#include <stdexcept>
#include <string>

namespace asdic::detail::serve {

/// Why a command was not done, in words that may go to a client: where, found, expected, as every
/// message of ours; never what stands in a file, in the scenario, or where files lie.
class Refusal : public std::runtime_error {
 public:
  /// \param code  for programs: handshake, token, json, command, value, limit, file, scenario,
  /// busy, cancelled, closing, idle, run
  /// Control characters of a client's own words are not passed on.
  Refusal(std::string code, std::string message)
      : std::runtime_error(printable(std::move(message))), code_(std::move(code)) {}

  [[nodiscard]] const std::string& code() const noexcept { return code_; }

 private:
  static std::string printable(std::string text) {
    for (char& c : text)
      if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    return text;
  }

  std::string code_;
};

/// "WHERE: found GOT, expected EXPECTED"; without what was found: "WHERE: expected EXPECTED".
[[nodiscard]] inline std::string refusal_text(const std::string& where, const std::string& got,
                                              const std::string& expected) {
  return where + (where.empty() ? "" : ": ") + (got.empty() ? "" : "found " + got + ", ") +
         "expected " + expected;
}

}  // namespace asdic::detail::serve
