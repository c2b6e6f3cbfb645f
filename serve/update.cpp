#include "serve/update.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <optional>

#include "core/quantities.h"
#include "core/text.h"
#include "io/scenario/catalogue.h"
#include "io/text/toml_table.h"
#include "io/text/toml_value.h"
#include "serve/client_names.h"
#include "serve/client_value.h"
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

/// An update under way.
struct Update {
  TomlTable reader;  ///< of the command
  const TomlValue& fields;
  const UpdateContext& context;
  double time;  ///< of positions and velocities [s]
  TomlValue& document;
  std::vector<std::string> changed = {};  ///< sections
};

/// Whether two values are equal, where 1 equals 1.0 and the order of a table's keys does not count.
bool same_value(const TomlValue& a, const TomlValue& b) {
  const auto number = [](const TomlValue& one) -> std::optional<double> {
    if (const auto* real = std::get_if<double>(&one.data)) return *real;
    if (const auto* whole = std::get_if<std::int64_t>(&one.data)) return double(*whole);
    return std::nullopt;
  };
  if (const auto x = number(a), y = number(b); x || y) return x == y;
  if (a.data.index() != b.data.index()) return false;
  if (const auto* items = std::get_if<TomlValue::Array>(&a.data))
    return std::ranges::equal(*items, std::get<TomlValue::Array>(b.data), same_value);
  if (const auto* entries = a.table())
    return entries->size() == std::get<TomlValue::Table>(b.data).size() &&
           std::ranges::all_of(*entries, [&](const TomlEntry& entry) {
             const TomlValue* other = b.find(entry.key);
             return other != nullptr && same_value(entry.value, *other);
           });
  if (const auto* text = std::get_if<std::string>(&a.data))
    return *text == std::get<std::string>(b.data);
  if (const auto* flag = std::get_if<bool>(&a.data)) return *flag == std::get<bool>(b.data);
  return true;
}

/// Whether a section is unchanged. One that names a file is not, as its contents may have changed.
bool is_as_before(const TomlValue& document, const TomlValue& before, const std::string& section) {
  const TomlValue *now = find_at(document, section), *then = find_at(before, section);
  return now != nullptr && then != nullptr && now->find("file") == nullptr &&
         same_value(*now, *then);
}

/// Writes the targets as a list of tables, each with its name.
void name_targets(const Scenario& scenario, TomlValue& document) {
  TomlValue::Array targets;
  for (TomlValue* table : tables_of(document, "target")) {
    set_key(*table, "name", {.data = scenario.targets[targets.size()].name, .origin = ""});
    targets.push_back(*table);
  }
  if (!targets.empty()) set_key(document, "target", {.data = std::move(targets), .origin = ""});
}

/// Places that were given from the platform's start stay where they are when that moves.
void fix_targets(Update& to) {
  const std::vector<TomlValue*> tables = tables_of(to.document, "target");
  for (std::size_t i = 0; i < tables.size(); ++i) {
    if (tables[i]->find("range") == nullptr) continue;
    const Kinematics& start = to.context.scenario.targets[i].track.start;
    for (const char* key : {"range", "bearing_deg", "depth"}) erase_key(*tables[i], key);
    set_key(*tables[i], "position", toml_vector(start.position));
    set_key(*tables[i], "velocity", toml_vector(start.velocity));
    to.changed.emplace_back("target");
  }
}

void update_platforms(Update& to) {
  bool moved = false;
  const std::vector<TomlValue*> tables = tables_of(to.document, "platform");
  const auto& platforms = to.context.scenario.platforms;
  for (TomlTable& wanted : to.reader.one_or_more("platform")) {
    const std::size_t i = index_of(wanted, platforms, "platforms");
    if (!has_motion(wanted)) {
      wanted.finish();  // a key that is misspelt is told as that
      throw wanted.fault("position", "a position, velocity, heading_deg, speed or waypoints");
    }
    moved |= set_motion(wanted, platforms[i].track, {.time = to.time, .since = to.context.since},
                        *tables[i]);
    wanted.finish();
  }
  if (moved) fix_targets(to);
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

void update_arrays(Update& to) {
  const std::vector<TomlValue*> tables = tables_of(to.document, "array");
  const std::vector<const TomlValue*> given = tables_of(to.fields, "array");
  std::size_t place = 0;
  for (TomlTable& wanted : to.reader.one_or_more("array")) {
    const TomlValue& values = *given[place++];
    TomlValue& table = *tables[index_of(wanted, to.context.scenario.arrays, "arrays")];
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
void update_target(TomlTable& wanted, const TomlValue& values, const Update& to,
                   TomlValue::Array& targets) {
  const std::vector<Target>& known = to.context.scenario.targets;
  const std::string name = wanted.text("name", targets.size() == 1 ? known[0].name : std::string());
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
  bool known_before = false;
  for (const Target& target : known)
    if (target.name == name) {
      track = target.track;
      known_before = true;
    }
  const bool moves = has_motion(wanted);
  for (const std::string& key : settings)
    if (wanted.has(key)) set_key(*found, key, *values.find(key));
  if (moves)
    set_motion(wanted, track,
               {.time = to.time, .since = known_before ? to.context.since : std::nullopt}, *found);
  if (moves && wanted.has("heading_deg") && found->find("position") != nullptr)
    set_key(*found, "heading_deg", *values.find("heading_deg"));  // it lies there
  wanted.finish();
}

void update_targets(Update& to) {
  TomlValue::Array targets;
  for (const TomlValue* table : tables_of(to.document, "target")) targets.push_back(*table);
  const std::vector<const TomlValue*> given = tables_of(to.fields, "targets");
  std::size_t place = 0;
  for (TomlTable& wanted : to.reader.one_or_more("targets"))
    update_target(wanted, *given[place++], to, targets);
  const std::size_t most = to.context.limits.targets;
  if (targets.size() > most)
    throw Refusal("limit", refusal_text("targets", std::to_string(targets.size()),
                                        "at most " + std::to_string(most)));
  set_key(to.document, "target", {.data = std::move(targets), .origin = ""});
}

/// Lists of things: each kind moves, comes and goes by rules of its own.
struct ListUpdate {
  std::string_view section;
  void (*update)(Update& to);
};
constexpr ListUpdate list_updates[] = {
    {"platform", update_platforms}, {"array", update_arrays}, {"target", update_targets}};

void update_list(const ClientName& list, Update& to) {
  if (!to.reader.has(list.name)) return;
  const auto found = std::find_if(std::begin(list_updates), std::end(list_updates),
                                  [&](const auto& one) { return one.section == list.section; });
  assert(found != std::end(list_updates));
  found->update(to);
  to.changed.push_back(list.section);
}

/// A table that chooses a kind and does not say which is of the first.
void choose_kind(const std::string& section, TomlValue& value) {
  const auto kind = scenario::settings_at(section + ".kind");
  if (!kind.empty() && kind.front()->required && value.find("kind") == nullptr)
    set_key(value, "kind", {.data = kind.front()->words.front(), .origin = ""});
}

/// What stands once in the scenario. \param parts  tables of the command, by their names
void update_value(const ClientName& one, Update& to, std::map<std::string, TomlTable>& parts) {
  const std::size_t dot = one.name.find('.');
  const bool alone = dot == std::string::npos;
  TomlTable* const reader =
      alone ? &to.reader
            : &parts.try_emplace(one.head(), to.reader.table(one.head())).first->second;
  const UpdateContext& context = to.context;
  std::optional<TomlValue> value =
      client_value(*reader, to.fields, alone ? one.name : one.name.substr(dot + 1), one,
                   context.data, context.limits);
  if (!value) return;
  if (one.is_table) choose_kind(one.section, *value);
  value_at(to.document, one.section, "") = std::move(*value);
  to.changed.push_back(one.section);
}

std::vector<std::string> update_all(const TomlValue& fields, const UpdateContext& context,
                                    TomlValue& document) {
  TomlTable reader(fields);
  const double time = reader.number("time", quantity::time, context.now);
  name_targets(context.scenario, document);
  const TomlValue before = document;
  Update to{std::move(reader), fields, context, time, document};
  std::map<std::string, TomlTable> parts;
  for (const ClientName& one : client_names()) {
    if (one.of_a_ping) continue;
    if (one.is_list)
      update_list(one, to);
    else
      update_value(one, to, parts);
  }
  for (const auto& [name, part] : parts) part.finish();
  to.reader.finish();
  if (to.changed.empty()) throw Refusal("value", refusal_text("update", "nothing", update_keys()));
  std::erase_if(to.changed, [&](const std::string& section) {
    return is_as_before(document, before, section);
  });
  return std::move(to.changed);
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

std::vector<std::string> apply_ping_changes(const PingChanges& wanted, TomlValue& document) {
  const std::string section = "transmitter", below = section + ".";
  const auto index = static_cast<std::size_t>(wanted.transmitter);
  TomlValue& table = *tables_of(document, section)[index];
  std::vector<std::string> changed;
  for (const auto& [name, value] : wanted.values) {
    const ClientName *own = nullptr, *common = nullptr;  // of one transmitter, and of all
    for (const ClientName& one : client_names())
      if (one.of_a_ping && one.name == name) (one.section.starts_with(below) ? own : common) = &one;
    const std::string key = own == nullptr ? "" : own->section.substr(below.size());
    if (common == nullptr || (own != nullptr && find_at(table, key) != nullptr)) {
      value_at(table, key, "") = value;
      changed.insert(changed.begin(), section);
    } else {
      value_at(document, common->section, "") = value;
      changed.push_back(common->section);
    }
  }
  return changed;
}

Refusal refusal_of_value(const InputError& error) {
  const InputFault& fault = error.fault();
  const auto colon = fault.where.rfind(": ");
  const std::string key = colon == std::string::npos ? fault.where : fault.where.substr(colon + 2);
  return {"value", refusal_text(key, fault.got, fault.expected)};
}

}  // namespace asdic::detail::serve
