#include "serve/live_scenario.h"

#include <algorithm>

#include "io/scenario/document.h"
#include "io/scenario/scenario_reader.h"
#include "io/text/toml_writer.h"
#include "serve/caps.h"
#include "serve/client_key.h"
#include "serve/client_names.h"
#include "serve/command.h"
#include "serve/motion.h"
#include "serve/update.h"
#include "sonar/scenario/sampling.h"

namespace asdic::detail::serve {
namespace {

constexpr const char* other_contents = "other contents";
constexpr const char* what_files_hold = "a file that holds what docs/formats/scenario.md says";

}  // namespace

LiveScenario::LiveScenario(ScenarioSource source, DataFolder data, const SessionLimits& limits)
    : source_(std::move(source)),
      data_(std::move(data)),
      limits_(limits),
      document_(scenario::read_document(source_.text, source_.path, source_.overrides)),
      pings_(parse_scenario(source_.text, source_.path, source_.overrides).pings.count) {
  try {
    state_ = read({});
  } catch (const Refusal& refusal) {  // of a limit: here it is the user's
    throw InputError({.where = source_.path.string(),
                      .got = "a scenario past a limit",
                      .expected = std::string(refusal.what()) + " (--limit NAME=VALUE)"});
  }
}

LiveScenario::State LiveScenario::read(const Changes& changes) const {
  std::vector<std::string> overrides = source_.overrides;
  State state;
  for (const auto& [section, value] : changes) {
    overrides.push_back(section);
    overrides.back().append("=").append(value);
    state.key += overrides.back() + '\n';
  }
  // What is checked over the file's schedule is so over one ping: served ones go on for ever, and
  // places are looked at when each is sent (serve/places.h).
  overrides.emplace_back("pings.count=1");
  state.scenario = parse_scenario(source_.text, source_.path, overrides);
  state.scenario.overrides.pop_back();
  state.scenario.pings.count = pings_;
  check_caps(state.scenario, limits_);
  state.changes = changes;
  return state;
}

LiveScenario::State LiveScenario::read_for_client(const Changes& changes, const TomlValue& fields,
                                                  const TomlValue& document) const {
  try {
    return read(changes);
  } catch (const InputError& error) {
    throw refusal(error, changes, fields, document);
  }
}

Refusal LiveScenario::refusal(const InputError& error, const Changes& changes,
                              const TomlValue& fields, const TomlValue& document) const {
  for (const auto& [section, value] : changes) {  // "--set SECTION: SECTION.key"
    const bool here = error.fault().where.starts_with("--set " + section);
    if (here && value.find("\"file\" = ") != std::string::npos)
      return {"scenario", refusal_text(client_key(section, fields, document).name + ".file",
                                       other_contents, what_files_hold)};
  }
  return refusal_of(error, source_.path.string(), fields, document);
}

namespace {

void set_change(std::vector<std::pair<std::string, std::string>>& changes,
                const std::string& section, const std::string& value) {
  const auto found = std::find_if(changes.begin(), changes.end(),
                                  [&](const auto& change) { return change.first == section; });
  if (found != changes.end())
    found->second = value;
  else
    changes.emplace_back(section, value);
}

}  // namespace

void LiveScenario::listen(double since) {
  const Scenario& scenario = state_.scenario;
  if (scenario.pings.recording_start > 0.0)
    throw Refusal("scenario", refusal_text("recording.start", "a record that begins later",
                                           "0 for a stream, which has no gaps"));
  Changes changes = changes_;
  set_change(changes, "pings.continuous", "true");
  if (scenario.pings.samples == Samples::baseband) {
    set_change(changes, "pings.baseband_rate", toml_number(recorded_rate(scenario)));
    set_change(changes, "pings.carrier", toml_number(recorded_carrier(scenario)));
  }
  state_ = read(changes);
  changes_ = std::move(changes);
  since_ = since;
}

void LiveScenario::forget_before(double time) noexcept {
  if (since_) since_ = std::max(*since_, time);
}

bool LiveScenario::update(const TomlValue& fields, double now) {
  TomlValue document = document_;
  Changes changes = changes_;
  const auto changed = apply_update(
      fields,
      {.scenario = state_.scenario, .data = data_, .limits = limits_, .now = now, .since = since_},
      document);
  if (changed.empty()) return false;
  for (const std::string& section : changed)
    set_change(changes, section, inline_toml(*find_at(document, section)));
  state_ = read_for_client(changes, fields, document);
  document_ = std::move(document);
  changes_ = std::move(changes);
  changed_ = std::max(changed_, number_said(fields, "time").value_or(now));
  return true;
}

std::string LiveScenario::elevation_override(int transmitter, double elevation) const {
  const TomlValue& all = *document_.find("transmitter");
  const auto* several = std::get_if<TomlValue::Array>(&all.data);
  const std::string path =
      several == nullptr ? "transmitter" : "transmitter." + std::to_string(transmitter);
  const TomlValue& table =
      several == nullptr ? all : (*several)[static_cast<std::size_t>(transmitter)];
  const std::string angle = toml_number(degrees(elevation));
  if (table.find("elevations_deg") != nullptr) return path + ".elevations_deg=[" + angle + "]";
  const TomlValue* pings = document_.find("pings");
  if (pings != nullptr && pings->find("elevations_deg") != nullptr)
    return "pings.elevations_deg=[" + angle + "]";
  return path + ".elevation_deg=" + angle;
}

LiveScenario::State LiveScenario::with(const PingChanges& wanted, const TomlValue& fields) const {
  if (wanted.values.empty()) return state_;
  TomlValue document = document_;
  Changes changes = changes_;
  for (const std::string& section : apply_ping_changes(wanted, document))
    set_change(changes, section, inline_toml(*find_at(document, section)));
  return read_for_client(changes, fields, document);
}

namespace {

/// Which of the command's files an error is of: "sound_speed.file"; "a file" if it is none of them.
std::string file_key(const TomlValue& fields, const std::string& where) {
  for (const ClientName& one : client_names()) {
    const std::string& key = one.name;
    const TomlValue* file = one.is_table ? find_at(fields, key + ".file") : nullptr;
    const auto* name = file == nullptr ? nullptr : std::get_if<std::string>(&file->data);
    if (name == nullptr || name->empty()) continue;
    const std::string last = std::filesystem::path(*name).filename().string();
    if (where.find(last) != std::string::npos) return key + ".file";
  }
  return "a file";
}

constexpr std::string_view a_depth_between = "a depth between the surface";

/// By which key a command moves a platform: "platform.position"; "" if it moves none.
std::string platform_motion(const TomlValue& fields) {
  const TomlValue* platform = fields.find("platform");
  if (platform == nullptr) return "";
  if (const auto* several = std::get_if<TomlValue::Array>(&platform->data)) {
    if (several->empty()) return "";
    platform = &several->front();
  }
  for (const std::string_view key : motion_keys)
    if (platform->find(key) != nullptr) return "platform." + std::string(key);
  return "";
}

}  // namespace

Refusal refusal_of(const InputError& error, const std::string& scenario, const TomlValue& fields,
                   const TomlValue& document) {
  const InputFault& fault = error.fault();
  // "deep.toml:12: target.0.position", "--set platform: platform.velocity", "pings.sample_rate",
  // "cast.csv:3: speed", "cast.csv": the key is what comes last.
  const auto colon = fault.where.rfind(": ");
  std::string key = colon == std::string::npos ? fault.where : fault.where.substr(colon + 2);
  const bool by_client = fault.where.starts_with("--set ");
  if (by_client && colon == std::string::npos) key = key.substr(6);
  const bool is_key = !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '.' || c == '[' || c == ']';
  });
  const bool ours = by_client || fault.where.starts_with(scenario + ":") ||
                    (colon == std::string::npos && is_key && !fault.where.ends_with(".csv"));
  if (!ours)
    return {"scenario",
            refusal_text(file_key(fields, fault.where), other_contents, what_files_hold)};
  const std::string own = "what the scenario has";  // which nobody is told
  if (!is_key) return {"scenario", refusal_text("the scenario", own, fault.expected)};
  const ClientKey there = client_key(key, fields, document);
  // A client that moves a platform moves what that carries.
  const bool carried = key.starts_with("transmitter") || key.starts_with("array");
  if (!there.given && carried && fault.expected.starts_with(a_depth_between))
    if (const std::string moved = platform_motion(fields); !moved.empty())
      return {"scenario", refusal_text(moved, "a place that puts " + key + " outside the water",
                                       fault.expected + " for that")};
  const bool told = there.given || (there.under && fault.got == "nothing");
  return {"scenario", refusal_text(there.name, told ? fault.got : own, fault.expected)};
}

}  // namespace asdic::detail::serve
