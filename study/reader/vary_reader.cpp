#include "study/reader/vary_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "core/text.h"
#include "core/unit_text.h"
#include "io/scenario/catalogue.h"
#include "io/text/toml_writer.h"
#include "study/expression/names.h"
#include "study/reader/vary_laws.h"
#include "study/reader/vary_profiles.h"

namespace asdic::detail::study {
namespace {

/// The line of "study.toml:12"; overrides come last.
int line_of(const std::string& origin) {
  int line = 0;
  const char* end = origin.data() + origin.size();
  const char* begin = origin.data() + origin.rfind(':') + 1;
  return std::from_chars(begin, end, line).ptr == end && begin != end ? line : 1 << 30;
}

/// Lower case, and _ for whatever is no letter or digit.
std::string column_name(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const bool capital = c >= 'A' && c <= 'Z';
    const bool plain = capital || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (plain)
      result += capital ? static_cast<char>(c - 'A' + 'a') : c;
    else if (!result.empty() && result.back() != '_')
      result += '_';
  }
  return result;
}

/// "range" of target.0.range, "target_0" of target.0.
std::string short_name(std::string_view key) {
  const auto dot = key.rfind('.');
  const std::string_view last = dot == std::string_view::npos ? key : key.substr(dot + 1);
  const bool index = !last.empty() && std::all_of(last.begin(), last.end(),
                                                  [](char c) { return c >= '0' && c <= '9'; });
  if (!index || dot == std::string_view::npos) return column_name(last);
  return column_name(key.substr(key.rfind('.', dot - 1) + 1));
}

/// As the description of the setting has it: "target.0.depth: depth below the mean surface" [m]. Of
/// choices with a key of their own each the first, where they differ.
NumberAtKey number_at(const std::string& key) {
  const bool radians = key.ends_with("_rad");
  const auto found = scenario::settings_at(radians ? key.substr(0, key.size() - 4) + "_deg" : key);
  if (found.empty()) return {"1", key};
  const SettingRecord& setting = *found.front();
  const std::string unit = radians ? "radians" : unit_of(setting.quantity);
  const std::string noun =
      setting.type == SettingRecord::Type::number || setting.type == SettingRecord::Type::numbers
          ? std::string(setting.quantity.noun) + " "
          : "";
  return {.unit = unit.empty() ? "1" : unit,
          .meaning = key + ": " + noun + setting.help.substr(0, setting.help.find(';')),
          .whole = setting.type == SettingRecord::Type::whole_number};
}

/// These laws know the key that they write: profile = { law = "profile_eof", … }
bool is_profile_law(const TomlValue& entry) {
  if (const TomlValue* laws = entry.find("laws"); laws != nullptr && entry.find("given")) {
    if (const auto* array = std::get_if<TomlValue::Array>(&laws->data))
      return std::any_of(array->begin(), array->end(), is_profile_law);
    return laws->table() != nullptr &&
           std::any_of(laws->table()->begin(), laws->table()->end(),
                       [](const TomlEntry& branch) { return is_profile_law(branch.value); });
  }
  const TomlValue* law = entry.find("law");
  const auto* name = law == nullptr ? nullptr : std::get_if<std::string>(&law->data);
  return name != nullptr &&
         (*name == "profile_eof" || *name == "profile_casts" || *name == "climatology");
}

std::vector<std::string> read_keys(const TomlEntry& entry, TomlTable& table) {
  const TomlValue* keys = table.has("keys") ? entry.value.find("keys") : nullptr;
  if (keys == nullptr && entry.key.find('.') == std::string::npos && is_profile_law(entry.value))
    return {profile_key};
  if (keys == nullptr) return {entry.key};
  std::vector<std::string> result;
  if (const auto* array = std::get_if<TomlValue::Array>(&keys->data))
    for (const TomlValue& item : *array) {
      const auto* key = std::get_if<std::string>(&item.data);
      if (key == nullptr || key->empty())
        throw table.fault("keys", "an array of keys, each in quotes");
      result.push_back(*key);
    }
  if (!std::holds_alternative<TomlValue::Array>(keys->data))
    throw table.fault("keys", "an array of keys, each in quotes");
  return result;
}

/// An entry of [vary] on its way to a variable.
struct Pending {
  const TomlEntry* entry;
  TomlTable table;
  Variable variable{};
  bool done = false;
};

/// All but its law.
Pending begin_variable(const TomlEntry& entry) {
  const bool quoted = entry.key.find('.') != std::string::npos;
  Pending pending{
      .entry = &entry,
      .table = TomlTable(entry.value, "vary." + (quoted ? '"' + entry.key + '"' : entry.key))};
  TomlTable& table = pending.table;
  Variable& variable = pending.variable;
  variable = {.keys = read_keys(entry, table), .origin = entry.value.origin};
  const bool group = variable.keys.empty() || variable.keys.front() != entry.key;
  variable.name = column_name(table.text("name", group ? entry.key : short_name(entry.key)));
  if (variable.name.empty()) throw table.fault("name", "a name with letters or digits");
  for (const std::string& key : variable.keys) variable.numbers.push_back(number_at(key));
  if (variable.keys.empty())  // drawn for others alone
    variable.numbers.push_back({.meaning = entry.key + ": writes no key, others look at it"});
  for (NumberAtKey& number : variable.numbers) number.unit = table.text("unit", number.unit);
  return pending;
}

/// Two variables of one name take the whole of their keys as names.
void distinguish(std::vector<Variable*>& variables) {
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const std::string name = variables[i]->name;
    const auto alike = [&](const Variable* v) { return v->name == name; };
    if (std::count_if(variables.begin(), variables.end(), alike) < 2) continue;
    for (Variable* variable : variables)
      if (alike(variable) && !variable->keys.empty())
        variable->name = column_name(variable->keys.front());
  }
}

void check_columns(const std::vector<Variable>& variables) {
  std::vector<std::string> names, keys;
  const auto add = [](std::vector<std::string>& list, const std::string& word,
                      const Variable& variable, const std::string& what) {
    if (std::find(list.begin(), list.end(), word) != list.end())
      throw InputError(
          {.where = variable.origin + ": vary", .got = "\"" + word + "\" twice", .expected = what});
    list.push_back(word);
  };
  for (const Variable& variable : variables) {
    for (const InputColumn& column : input_columns(variable))
      add(names, column.name, variable, "columns of different names (give one a name = \"…\")");
    for (const std::string& key : variable.keys) add(keys, key, variable, "each key once");
  }
}

std::vector<std::string> column_names(const Others& others) {
  std::vector<std::string> names;
  for (const Variable* other : others)
    for (const InputColumn& column : input_columns(*other)) names.push_back(column.name);
  return names;
}

/// Whether a column will be one of an input that is not read yet: its name, or one that begins so.
bool may_make(const Variable& variable, const std::string& column) {
  return column == variable.name || column.starts_with(variable.name + '_');
}

/// Why none of those that are left can be drawn: a name that nobody has, or a circle.
InputError stuck(const std::vector<Pending>& pending, const Others& others) {
  std::vector<std::string> names = column_names(others);
  for (const Pending& one : pending)
    if (!one.done) names.push_back(one.variable.name);
  const auto missing = [&](const Pending& one) {
    const std::vector<std::string> there = column_names(others);
    for (const std::string& name : looked_at(one.entry->value))
      if (std::find(there.begin(), there.end(), name) == there.end()) return name;
    return std::string();
  };
  const auto maker = [&](const std::string& name) {
    return std::find_if(pending.begin(), pending.end(), [&](const Pending& one) {
      return !one.done && may_make(one.variable, name);
    });
  };
  for (const Pending& one : pending) {
    if (one.done) continue;
    const std::string name = missing(one);
    if (maker(name) != pending.end()) continue;
    std::erase(names, one.variable.name);
    const std::string nearest = nearest_name(name, names);
    return InputError(
        {.where = one.variable.origin + ": vary." + one.variable.name,
         .got = "the name " + in_quotes(name),
         .expected =
             names.empty()
                 ? "the column of another input; there is none"
                 : "the column of another input, " + list_of(names) +
                       (nearest.empty() ? "" : " (did you mean " + in_quotes(nearest) + "?)")});
  }
  // Each waits for another: whoever is met twice stands in a circle.
  std::vector<const Pending*> way;
  const Pending* at =
      &*std::find_if(pending.begin(), pending.end(), [](const Pending& one) { return !one.done; });
  while (std::find(way.begin(), way.end(), at) == way.end()) {
    way.push_back(at);
    at = &*maker(missing(*at));
  }
  std::string circle;
  for (auto it = std::find(way.begin(), way.end(), at); it != way.end(); ++it)
    circle += in_quotes((*it)->variable.name) + " looks at ";
  return InputError({.where = at->variable.origin + ": vary." + at->variable.name,
                     .got = "a circle: " + circle + in_quotes(at->variable.name),
                     .expected = "inputs that look at others in one direction only"});
}

}  // namespace

std::vector<Variable> read_vary(const TomlValue& document, const Study& study) {
  const TomlValue* vary = document.find("vary");
  if (vary == nullptr) return {};
  static_cast<void>(TomlTable(*vary, "vary"));  // must be a table
  std::vector<const TomlEntry*> entries;
  for (const TomlEntry& entry : std::get<TomlValue::Table>(vary->data)) entries.push_back(&entry);
  std::stable_sort(entries.begin(), entries.end(), [](const TomlEntry* a, const TomlEntry* b) {
    return line_of(a->value.origin) < line_of(b->value.origin);
  });
  std::vector<Pending> pending;
  std::vector<Variable*> heads;
  for (const TomlEntry* entry : entries) pending.push_back(begin_variable(*entry));
  for (Pending& one : pending) heads.push_back(&one.variable);
  distinguish(heads);
  // A law can be read once those are that it looks at; else in the order of the file.
  Others others;
  for (bool more = true; std::exchange(more, false);)
    for (Pending& one : pending) {
      const std::vector<std::string> there = column_names(others);
      const std::vector<std::string> names = looked_at(one.entry->value);
      const auto known = [&](const std::string& name) {
        return std::find(there.begin(), there.end(), name) != there.end();
      };
      if (one.done || !std::all_of(names.begin(), names.end(), known)) continue;
      one.variable.law = read_law(one.table, one.entry->value, one.variable, study, others);
      if (one.table.has("proposal"))
        one.variable.proposal = read_proposal(one.table, one.variable.law);
      one.table.finish();
      one.variable.text = inline_toml(one.entry->value);
      others.push_back(&one.variable);
      one.done = more = true;
    }
  if (others.size() < pending.size()) throw InputError(stuck(pending, others));
  std::vector<Variable> variables;
  for (Pending& one : pending) variables.push_back(std::move(one.variable));
  check_columns(variables);
  return variables;
}

}  // namespace asdic::detail::study
