#include <cmath>

#include "fuzz/fuzz_target.h"
#include "io/text/toml_writer.h"
#include "serve/command.h"
#include "serve/commands/cancel.h"
#include "serve/line_splitter.h"
#include "serve/live_scenario.h"
#include "serve/sound_request.h"
#include "serve/update.h"

// Lines of a client of `asdic serve`: a handshake, then commands. What is taken is within the
// limits and finite, whatever pieces it came in; what an update writes into a scenario is TOML that
// holds the same values; what is refused is told in one line.

namespace {

using namespace asdic::detail;
using namespace asdic::detail::serve;

constexpr SessionLimits limits{.line_bytes = 4096, .nesting = 8};

void check(const TomlValue& value, std::size_t level) {
  fuzz::insist(level <= limits.nesting, "nothing is nested deeper than the limit");
  if (const auto* number = std::get_if<double>(&value.data))
    fuzz::insist(std::isfinite(*number), "numbers are finite");
  if (const auto* items = std::get_if<TomlValue::Array>(&value.data))
    for (const TomlValue& item : *items) check(item, level + 1);
  if (const auto* entries = value.table())
    for (const TomlEntry& entry : *entries) check(entry.value, level + 1);
}

void read_back(const TomlValue& value) {
  const std::string text = inline_toml(value);
  fuzz::insist(text.find('\n') == std::string::npos, "a value is one line");
  TomlValue root = parse_toml("", "empty");
  fuzz::insist(!fuzz::refuses([&] { apply_override(root, "x=" + text); }), "a value is TOML");
  fuzz::insist(inline_toml(*root.find("x")) == text, "and reads back as it was");
}

const LiveScenario& sea() {
  static const LiveScenario live(
      {.text =
           R"(environment = { sound_speed = { kind = "isovelocity", speed = 1500.0 }, bottom = { depth = 1000.0, kind = "rigid" } }
platform = { position = [0.0, 0.0, 200.0] }
transmitter = { source_level_db = 200.0, taper = "omnidirectional" }
pulse = { kind = "cw", frequency = 1000.0, duration = 0.1, window = "hann" }
array = { kind = "horizontal", phones = 2, spacing = 0.75 }
target = [{ name = "rock", position = [3000.0, 0.0, 500.0], strength_db = 10.0 }]
pings = { samples = "baseband", recording_duration = 5.0 }
)",
       .path = "sea.toml",
       .overrides = {}},
      DataFolder(), limits);
  return live;
}

/// Refusals are one line each that says what was expected.
template <class Work>
bool refused(Work work) {
  try {
    work();
    return false;
  } catch (const Refusal& refusal) {
    const std::string said = refusal.what();
    fuzz::insist(said.find(": found ") != std::string::npos,
                 "a refusal says where, and what it found");
    fuzz::insist(said.find(", expected ") != std::string::npos, "and what was expected");
    return true;
  }
}

void carry_out(const Command& command) {
  check(command.fields, 1);
  read_back(command.fields);
  if (command.name == "arrivals")
    static_cast<void>(
        refused([&] { static_cast<void>(read_request<ArrivalsRequest>(command.fields)); }));
  if (command.name == "rays")
    static_cast<void>(refused([&] {
      const auto asked = read_request<RaysRequest>(command.fields);
      fuzz::insist(!asked.elevations().empty(), "there are rays");
      for (const double elevation : asked.elevations())
        fuzz::insist(std::abs(elevation) <= 1.5708, "which go somewhere");
    }));
  if (command.name == "cancel")
    static_cast<void>(refused([&] { static_cast<void>(CancelCommand::meant(command)); }));
  if (command.name != "update") return;
  LiveScenario live = sea();
  static_cast<void>(refused([&] { live.update(command.fields, 0.0); }));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  LineSplitter splitter(limits.line_bytes);
  std::string_view bytes = fuzz::text(data, size);
  bool first = true;
  while (!bytes.empty()) {
    const auto line = splitter.take(bytes);
    if (!line) break;
    fuzz::insist(line->text.size() <= limits.line_bytes, "a line is within its limit");
    if (first) {
      first = false;
      static_cast<void>(refused([&] { static_cast<void>(read_handshake(line->text)); }));
      continue;
    }
    Command command;
    if (!refused([&] { command = read_command(line->text, limits); })) carry_out(command);
  }
  return 0;
}
