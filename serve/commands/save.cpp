#include "serve/commands/save.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/text.h"
#include "io/files/output_file.h"
#include "io/scenario/document.h"
#include "io/scenario/scenario_reader.h"
#include "io/text/toml_document.h"
#include "serve/answers.h"
#include "serve/refusal.h"
#include "sonar/scenario/transmission.h"
#include "sonar/signal/pulse.h"

namespace asdic::detail::serve {
namespace {

TomlValue number(double value) { return {.data = value, .origin = ""}; }
TomlValue number(int value) { return {.data = std::int64_t{value}, .origin = ""}; }

bool is_next(const Scenario& scenario, int ping, const Transmission& next) {
  const auto sent = transmissions(scenario);
  if (ping > static_cast<int>(sent.size())) return false;
  const Transmission& one = sent[static_cast<std::size_t>(ping - 1)];
  return one.transmitter == next.transmitter && one.own_ping == next.own_ping &&
         one.time == next.time && one.elevation == next.elevation;
}

/// Sees to it that ping `ping` of all is one of a transmitter at a time, by so many before it, one
/// pulse after the other. With a power of 2 between them their times are exact.
void place(TomlValue& document, int ping, const Transmission& next, const Scenario& scenario) {
  const double pulse = Pulse(pulse_of(scenario, next.transmitter)).duration();
  const double apart = std::exp2(std::ceil(std::log2(pulse)));
  const double first = next.time - double(ping - 1) * apart;
  if (first < 0.0)
    throw Refusal("scenario", refusal_text("save",
                                           std::to_string(ping - 1) + " pings before " +
                                               to_text(next.time) + " s",
                                           "no more than have time there"));
  TomlValue& all = value_at(document, "transmitter", "");
  auto* several = std::get_if<TomlValue::Array>(&all.data);
  const std::size_t count = several == nullptr ? 1 : several->size();
  for (std::size_t t = 0; t < count; ++t) {
    TomlValue& one = several == nullptr ? all : (*several)[t];
    const bool this_one = static_cast<int>(t) == next.transmitter;
    if (this_one) set_key(one, "interval", number(apart));
    set_key(one, "first_ping_time", number(this_one ? first : next.time + 1.0));
  }
  set_key(value_at(document, "pings", ""), "count", number(ping));
}

}  // namespace

Answer SaveCommand::run(SessionState& session, const Command& command) {
  bool as_text = session.settings.output.empty();
  for (const auto& [key, value] : std::get<TomlValue::Table>(command.fields.data)) {
    const auto* word = std::get_if<std::string>(&value.data);
    if (key != "deliver" || word == nullptr || (*word != "file" && *word != "text"))
      throw Refusal("value",
                    refusal_text(key, "something else", "\"deliver\": \"file\" or \"text\" alone"));
    as_text = *word == "text";
  }
  if (!as_text && session.settings.output.empty())
    throw Refusal("value",
                  refusal_text("deliver", "\"file\"", "\"text\": the server has no --output-dir"));
  if (as_text && !session.settings.tells_scenario)
    throw Refusal("value", refusal_text("deliver", "\"text\"",
                                        "\"file\": the server was started without "
                                        "--tell-scenario or --output-dir"));
  const Scenario& scenario = session.live.state().scenario;
  const int ping = session.pings + 1;
  Transmission next = session.schedule.next(scenario);
  if (session.settings.pace.by_the_clock()) next.time = session.now();
  if (session.heard)
    next.time = session.listening->whole_samples(std::max(next.time, session.heard->time));
  TomlValue document = session.live.document();
  const std::filesystem::path& path = session.settings.scenario.path;
  scenario::make_files_absolute(document, path.parent_path());
  erase_key(document, "include");
  Scenario longer = scenario;
  longer.pings.count = std::max(longer.pings.count, ping);
  if (is_next(longer, ping, next))
    set_key(value_at(document, "pings", ""), "count", number(longer.pings.count));
  else
    place(document, ping, next, scenario);
  const std::string text = toml_text(document);
  if (!is_next(parse_scenario(text, path, {}), ping, next))
    throw Refusal("scenario", refusal_text("save", "a next ping that no schedule has",
                                           "one of a single transmitter, after time 0"));
  if (as_text) return {.line = save_line(command.id, ping, next.time, "", text)};
  const std::string file = session.next_save().string();
  CountedFile counted(*session.settings.written, session.settings.limits.output_bytes, file,
                      text.size());
  OutputFile(file).write(text);
  counted.keep();
  return {.line = save_line(command.id, ping, next.time, file, "")};
}

}  // namespace asdic::detail::serve
