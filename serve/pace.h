#pragma once
#include <optional>
#include <string>

namespace asdic::detail::serve {

/// How the scenario's time goes: by the clock, so many times as fast, or not at all.
struct Pace {
  std::optional<double> factor;  ///< seconds of the scenario a second; none: as fast as possible

  [[nodiscard]] bool by_the_clock() const noexcept { return factor.has_value(); }
};

/// "real", "fast", or a factor above 0. \throws InputError{where: "--pace"}
[[nodiscard]] Pace parse_pace(const std::string& text);
[[nodiscard]] std::string name_of(const Pace& pace);

}  // namespace asdic::detail::serve
