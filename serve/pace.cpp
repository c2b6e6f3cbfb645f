#include "serve/pace.h"

#include <charconv>
#include <cmath>

#include "core/error.h"
#include "core/text.h"

namespace asdic::detail::serve {

Pace parse_pace(const std::string& text) {
  if (text == "real") return {.factor = 1.0};
  if (text == "fast") return {};
  double factor = 0.0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, factor);
  if (error != std::errc{} || end != last || !(factor > 0.0) || !(factor <= 1e6))
    throw InputError({.where = "--pace",
                      .got = in_quotes(text),
                      .expected = "\"real\", \"fast\" or a factor above 0 and at most 1e6"});
  return {.factor = factor};
}

std::string name_of(const Pace& pace) {
  if (!pace.factor) return "fast";
  return *pace.factor == 1.0 ? "real" : to_text(*pace.factor);
}

}  // namespace asdic::detail::serve
