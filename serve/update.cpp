#include "serve/update.h"

#include <algorithm>
#include <limits>

#include "core/quantities.h"
#include "core/text.h"
#include "io/scenario/catalogue.h"
#include "io/text/toml_table.h"
#include "io/text/toml_value.h"
#include "serve/client_names.h"
#include "serve/motion.h"

namespace asdic::detail::serve {
namespace {

/// The tables of a section that stands once, [x], or several times, [[x]].
template <class Value>
std::vector<Value*> tables_of(Value& document, const std::string& section) {
  std::vector<Value*> tables;
  Value* found = document.find(section);
  if (found == nullptr) return tables;
  if (auto* array = std::get_if<TomlValue::Array>(&found->data))
    for (Value& table : *array) tables.push_back(&table);
  else
    tables.push_back(found);
  return tables;
}

/// Which of several a command means: the one with its name, or the only one.
template <class List>
std::size_t index_of(TomlTable& wanted, const List& list, const std::string& kind) {
  if (!wanted.has("name")) {
    if (list.size() == 1) return 0;
    throw wanted.fault("name", "the name of one of " + std::to_string(list.size()) + " " + kind);
  }
  const std::string name = wanted.text("name");
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const auto& one) { return one.name == name; });
  if (found == list.end()) throw wanted.fault("name", "the name of one of the " + kind);
  return static_cast<std::size_t>(found - list.begin());
}

/// A value of the command as it stands; a file in it lies in the data folder.
TomlValue with_file(TomlTable& reader, const std::string& key, const TomlValue& fields,
                    const UpdateContext& context) {
  TomlTable table = reader.table(key);
  TomlValue value = *fields.find(key);
  if (table.has("file")) {
    const auto file =
        context.data.file(table.text("file"), key + ".file", context.limits.file_bytes);
    set_key(value, "file", {.data = file.string(), .origin = ""});
  }
  return value;
}

/// Places that were given from the platform's start stay where they are when that moves.
void fix_targets(const Scenario& scenario, TomlValue& document, std::vector<std::string>& changed) {
  const std::vector<TomlValue*> tables = tables_of(document, "target");
  for (std::size_t i = 0; i < tables.size(); ++i) {
    if (tables[i]->find("range") == nullptr) continue;
    const Kinematics& start = scenario.targets[i].track.start;
    for (const char* key : {"range", "bearing_deg", "depth"}) erase_key(*tables[i], key);
    set_key(*tables[i], "position", toml_vector(start.position));
    set_key(*tables[i], "velocity", toml_vector(start.velocity));
    changed.emplace_back("target");
  }
}

void update_platforms(TomlTable& reader, const UpdateContext& context, double time,
                      TomlValue& document) {
  const std::vector<TomlValue*> tables = tables_of(document, "platform");
  for (TomlTable& wanted : reader.one_or_more("platform")) {
    const std::size_t i = index_of(wanted, context.scenario.platforms, "platforms");
    if (!has_motion(wanted)) {
      wanted.finish();  // a key that is misspelt is told as that
      throw wanted.fault("position", "a position, velocity, heading_deg, speed or waypoints");
    }
    set_motion(wanted, context.scenario.platforms[i].track, time, *tables[i]);
    wanted.finish();
  }
}

/// Keys of a table, and tables within it, that there are with some kinds of it alone.
std::vector<std::string> keys_of_choices(std::string_view section) {
  std::vector<std::string> keys;
  const SettingsList list = below(scenario::catalogue(), section);
  const auto add = [&](const std::string& path, const auto& conditions) {
    if (!conditions.empty() && conditions.front().place.empty())
      keys.push_back(path.substr(0, path.find_first_of(".[")));
  };
  for (const SettingRecord& one : list.settings) {
    add(one.path, one.conditions);
    if (one.angle) add(one.path.substr(0, one.path.size() - 4) + "_rad", one.conditions);
  }
  return keys;
}

void update_arrays(TomlTable& reader, const UpdateContext& context, const TomlValue& fields,
                   TomlValue& document) {
  const std::vector<TomlValue*> tables = tables_of(document, "array");
  const std::vector<const TomlValue*> given = tables_of(fields, "array");
  std::size_t place = 0;
  for (TomlTable& wanted : reader.one_or_more("array")) {
    const TomlValue& values = *given[place++];
    TomlValue& table = *tables[index_of(wanted, context.scenario.arrays, "arrays")];
    if (wanted.has("positions")) {
      static_cast<void>(
          wanted.vectors("positions", scenario::setting_at("array.positions").quantity));
      for (const std::string& key : keys_of_choices("array")) erase_key(table, key);
      set_key(table, "kind", {.data = std::string("positions"), .origin = ""});
    }
    for (const std::string& key : live_keys("array"))
      if (wanted.has(key)) set_key(table, key, *values.find(key));
    wanted.finish();
  }
}

/// One target of the command: changed, taken out, or a new one.
void update_target(TomlTable& wanted, const TomlValue& values, const UpdateContext& context,
                   double time, TomlValue::Array& targets) {
  const std::string name =
      wanted.text("name", targets.size() == 1 ? context.scenario.targets[0].name : std::string());
  if (name.empty()) throw wanted.fault("name", "the name of a target");
  const auto by_name = [&](const TomlValue& table) {
    return std::get<std::string>(table.find("name")->data) == name;
  };
  auto found = std::find_if(targets.begin(), targets.end(), by_name);
  if (wanted.flag("remove", false)) {
    if (found == targets.end()) throw wanted.fault("name", "the name of one of the targets");
    targets.erase(found);
    wanted.finish();
    return;
  }
  std::vector<std::string> settings = live_keys("target");
  std::erase_if(settings, [](const std::string& key) {
    return std::find(motion_keys.begin(), motion_keys.end(), key) != motion_keys.end();
  });
  Track track;
  if (found == targets.end()) {
    if (!wanted.has("position") && !wanted.has("waypoints")) {
      static_cast<void>(has_motion(wanted));
      for (const std::string& key : settings) static_cast<void>(wanted.has(key));
      wanted.finish();  // a key that is misspelt is told as that
      throw wanted.fault("position", "the position of a new target");
    }
    TomlValue table{.data = TomlValue::Table{}, .origin = ""};
    set_key(table, "name", {.data = name, .origin = ""});
    targets.push_back(std::move(table));
    found = targets.end() - 1;
  }
  for (const Target& target : context.scenario.targets)
    if (target.name == name) track = target.track;
  const bool moves = has_motion(wanted);
  for (const std::string& key : settings)
    if (wanted.has(key)) set_key(*found, key, *values.find(key));
  if (moves) set_motion(wanted, track, time, *found);
  if (moves && wanted.has("heading_deg") && found->find("position") != nullptr)
    set_key(*found, "heading_deg", *values.find("heading_deg"));  // it lies there
  wanted.finish();
}

void update_targets(TomlTable& reader, const UpdateContext& context, const TomlValue& fields,
                    double time, TomlValue& document) {
  TomlValue::Array targets;
  for (TomlValue* table : tables_of(document, "target")) {
    set_key(*table, "name", {.data = context.scenario.targets[targets.size()].name, .origin = ""});
    targets.push_back(*table);
  }
  const std::vector<const TomlValue*> given = tables_of(fields, "targets");
  std::size_t place = 0;
  for (TomlTable& wanted : reader.one_or_more("targets"))
    update_target(wanted, *given[place++], context, time, targets);
  if (targets.size() > context.limits.targets)
    throw Refusal("limit", refusal_text("targets", std::to_string(targets.size()),
                                        "at most " + std::to_string(context.limits.targets)));
  set_key(document, "target", {.data = std::move(targets), .origin = ""});
}

TomlValue& table_in(TomlValue& document, const std::string& section) {
  if (document.find(section) == nullptr)
    set_key(document, section, {.data = TomlValue::Table{}, .origin = ""});
  return *document.find(section);
}

void update_recording(TomlTable& reader, const TomlValue& fields, TomlValue& document,
                      std::vector<std::string>& changed) {
  TomlTable wanted = reader.table("recording");
  for (const std::string& name : live_keys("pings")) {  // recording_duration is recording.duration
    const std::string key = name.substr(name.find('_') + 1);
    if (!wanted.has(key)) continue;
    set_key(table_in(document, "pings"), name, *fields.find("recording")->find(key));
    changed.push_back("pings." + name);
  }
  wanted.finish();
}

std::vector<std::string> update_all(const TomlValue& fields, const UpdateContext& context,
                                    TomlValue& document) {
  TomlTable reader(fields);
  std::vector<std::string> changed;
  const double time = reader.number("time", quantity::time, context.now);
  if (reader.has("platform")) {
    fix_targets(context.scenario, document, changed);
    update_platforms(reader, context, time, document);
    changed.emplace_back("platform");
  }
  if (reader.has("array")) {
    update_arrays(reader, context, fields, document);
    changed.emplace_back("array");
  }
  if (reader.has("targets")) {
    update_targets(reader, context, fields, time, document);
    changed.emplace_back("target");
  }
  if (reader.has("wind_speed")) {
    static_cast<void>(
        reader.number("wind_speed", scenario::setting_at("environment.wind_speed").quantity));
    set_key(table_in(document, "environment"), "wind_speed", *fields.find("wind_speed"));
    changed.emplace_back("environment.wind_speed");
  }
  if (reader.has("sound_speed")) {
    TomlValue profile = with_file(reader, "sound_speed", fields, context);
    if (profile.find("kind") == nullptr)
      set_key(profile, "kind", {.data = std::string("table"), .origin = ""});
    set_key(table_in(document, "environment"), "sound_speed", std::move(profile));
    changed.emplace_back("environment.sound_speed");
  }
  if (reader.has("noise")) {
    set_key(document, "noise", with_file(reader, "noise", fields, context));
    changed.emplace_back("noise");
  }
  if (reader.has("seed")) {
    constexpr auto most = std::numeric_limits<std::int64_t>::max() - 1;  // so that it is told
    static_cast<void>(reader.integer("seed", 0, most));
    set_key(document, "seed", *fields.find("seed"));
    changed.emplace_back("seed");
  }
  if (reader.has("recording")) update_recording(reader, fields, document, changed);
  reader.finish();
  if (changed.empty()) throw Refusal("value", refusal_text("update", "nothing", update_keys()));
  return changed;
}

}  // namespace

std::vector<std::string> apply_update(const TomlValue& fields, const UpdateContext& context,
                                      TomlValue& document) {
  try {
    return update_all(fields, context, document);
  } catch (const InputError& error) {
    throw refusal_of_value(error);
  }
}

std::vector<std::string> apply_ping_changes(const PingChanges& wanted, const Scenario& scenario,
                                            TomlValue& document) {
  const auto index = static_cast<std::size_t>(wanted.transmitter);
  TomlValue& table = *tables_of(document, "transmitter")[index];
  std::vector<std::string> changed;
  if (wanted.source_level_db)
    set_key(table, "source_level_db", {.data = *wanted.source_level_db, .origin = ""});
  if (wanted.beamwidth_deg)
    set_key(table, "beamwidth_deg", {.data = *wanted.beamwidth_deg, .origin = ""});
  const bool own = scenario.transmitters[index].pulse.has_value();
  if (wanted.waveform) set_key(own ? table : document, "pulse", *wanted.waveform);
  if (wanted.source_level_db || wanted.beamwidth_deg || (wanted.waveform && own))
    changed.emplace_back("transmitter");
  if (wanted.waveform && !own) changed.emplace_back("pulse");
  return changed;
}

const TomlValue* find_section(const TomlValue& document, const std::string& path) {
  const TomlValue* at = &document;
  for (std::size_t start = 0; at != nullptr && start <= path.size();) {
    const std::size_t dot = std::min(path.find('.', start), path.size());
    at = at->find(path.substr(start, dot - start));
    start = dot + 1;
  }
  return at;
}

Refusal refusal_of_value(const InputError& error) {
  const InputFault& fault = error.fault();
  const auto colon = fault.where.rfind(": ");
  const std::string key = colon == std::string::npos ? fault.where : fault.where.substr(colon + 2);
  return {"value", refusal_text(key, fault.got, fault.expected)};
}

}  // namespace asdic::detail::serve
