#include "serve/session_limits.h"

#include <array>
#include <charconv>

#include "core/error.h"
#include "core/text.h"

namespace asdic::serve {

std::span<const LimitName> limit_names() {
  using L = SessionLimits;
  static const std::array names{
      LimitName{"line_bytes", &L::line_bytes},
      LimitName{"nesting", &L::nesting},
      LimitName{"samples", &L::samples},
      LimitName{"channels", &L::channels},
      LimitName{"targets", &L::targets},
      LimitName{"patches", &L::patches},
      LimitName{"memory_bytes", &L::memory_bytes},
      LimitName{"file_bytes", &L::file_bytes},
      LimitName{"kept_bytes", &L::kept_bytes},
      LimitName{"queued_pings", &L::queued_pings},
      LimitName{"connections", &L::connections},
      LimitName{"answer_bytes", &L::answer_bytes},
      LimitName{"handshake_seconds", &L::handshake_seconds},
      LimitName{"idle_seconds", &L::idle_seconds},
  };
  return names;
}

void set_limit(SessionLimits& limits, const std::string& assignment) {
  const auto equals = assignment.find('=');
  const std::string name = assignment.substr(0, equals);
  std::string known;
  for (const LimitName& one : limit_names()) {
    known += (known.empty() ? "" : ", ") + one.name;
    if (one.name != name || equals == std::string::npos) continue;
    const char *first = assignment.data() + equals + 1,
               *last = assignment.data() + assignment.size();
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(first, last, value);
    if (error != std::errc{} || end != last || value == 0)
      throw InputError({.where = "--limit " + name,
                        .got = in_quotes(std::string(first, last)),
                        .expected = "a whole number of at least 1"});
    limits.*one.value = value;
    return;
  }
  throw InputError({.where = "--limit",
                    .got = in_quotes(assignment),
                    .expected = "NAME=VALUE, with a name of " + known});
}

}  // namespace asdic::serve
