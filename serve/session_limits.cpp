#include "serve/session_limits.h"

#include <charconv>
#include <limits>

#include "core/error.h"
#include "core/fields_viewer.h"
#include "core/text.h"

namespace asdic::detail::serve {
namespace {

/// Lists the limits, or sets one.
class LimitWalk final : public FieldsViewer {
 public:
  LimitWalk() = default;
  LimitWalk(std::string_view name, std::size_t value) : name_(name), value_(value) {}
  [[nodiscard]] bool reads() const override { return !name_.empty(); }

  std::vector<NamedLimit> all;

 private:
  void integer(const Setting& s, std::int64_t, std::int64_t, std::int64_t& value, bool*) override {
    all.push_back({.name = s.key.name, .value = static_cast<std::size_t>(value)});
    if (s.key.name == name_) value = static_cast<std::int64_t>(value_);
  }
  std::string_view name_;
  std::size_t value_ = 0;
};

}  // namespace

void SessionLimits::describe(Fields& field) {
  constexpr auto most = std::numeric_limits<std::int64_t>::max();
  field("line_bytes", line_bytes, 1, most, "of a line; a longer one is refused and skipped");
  field("nesting", nesting, 1, most, "levels of its JSON, counted while it is read");
  field("samples", samples, 1, most, "of a phone");
  field("channels", channels, 1, most, "of all arrays");
  field("targets", targets, 1, most, "of the scenario");
  field("patches", patches, 1, most, "`reverberation.most_returns` of the scenario");
  field("rays", rays, 1, most, "of a fan (`rays`)");
  field("receivers", receivers, 1, most, "of a field, of all its sources");
  field("memory_bytes", memory_bytes, 1, most,
        "that a ping may need, estimated before it is begun; no more than "
        "[run.memory](scenario.md#memory)");
  field("file_bytes", file_bytes, 1, most, "of a file that a command names");
  field("kept_bytes", kept_bytes, 1, most, "of sound paths that a session keeps for later pings");
  field("queued_pings", queued_pings, 1, most, "commands of a connection that wait");
  field("command_seconds", command_seconds, 1, most,
        "that a command may compute, from its turn on; then it is called off");
  field("client_seconds", client_seconds, 1, most, "of computing of a connection in all");
  field("connections", connections, 1, most,
        "with a handshake, at a time, of the Unix socket and of TCP each");
  field("answer_bytes", answer_bytes, 1, most,
        "of an answer, and of answers that a slow reader has not taken: past it its commands wait, "
        "and no more is read from it");
  field("total_answer_bytes", total_answer_bytes, 1, most,
        "of answers that readers have not taken, of all connections: past it pings with samples "
        "are answered `busy`, or wait");
  field("output_bytes", output_bytes, 1, most, "of files, over the server's life");
  field("handshake_seconds", handshake_seconds, 1, most, "for the first line of a socket's client");
  field("idle_seconds", idle_seconds, 1, most, "after which a silent socket is closed");
}

std::vector<NamedLimit> limits_by_name(const SessionLimits& limits) {
  LimitWalk walk;
  look(limits, walk);
  return std::move(walk.all);
}

void set_limit(SessionLimits& limits, const std::string& assignment) {
  const auto equals = assignment.find('=');
  const std::string name = assignment.substr(0, equals);
  std::string known;
  for (const NamedLimit& one : limits_by_name(limits)) {
    known += (known.empty() ? "" : ", ") + std::string(one.name);
    if (one.name != name || equals == std::string::npos) continue;
    const char *first = assignment.data() + equals + 1,
               *last = assignment.data() + assignment.size();
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(first, last, value);
    if (error != std::errc{} || end != last || value == 0)
      throw InputError({.where = "--limit " + name,
                        .got = in_quotes(std::string(first, last)),
                        .expected = "a whole number of at least 1"});
    LimitWalk setter(name, value);
    limits.describe(setter);
    return;
  }
  throw InputError({.where = "--limit",
                    .got = in_quotes(assignment),
                    .expected = "NAME=VALUE, with a name of " + known});
}

}  // namespace asdic::detail::serve
