// What a file may say, as JSON Schema: the keys of every table and nothing else, their types and
// bounds, which of them are required, and which there are under a condition alone.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "app/settings_sections.h"
#include "core/unit_text.h"
#include "core/units.h"
#include "io/scenario/catalogue.h"
#include "io/settings/axis.h"

namespace asdic::detail::app {
namespace {

using Json = nlohmann::ordered_json;
using Type = SettingRecord::Type;

Json numeric(const char* type, const Quantity& q) {
  Json made{{"type", type}};
  if (q.low > -infinity) made[q.above ? "exclusiveMinimum" : "minimum"] = q.low;
  if (q.high < infinity) made["maximum"] = q.high;
  if (!q.or_zero) return made;
  const Json zero{{"enum", Json::array({0})}};
  return {{"anyOf", Json::array({zero, made})}};
}

/// \param length  0: one item at least
Json array_of(Json items, std::size_t length = 0) {
  Json made{{"type", "array"},
            {"items", std::move(items)},
            {"minItems", std::max<std::size_t>(length, 1)}};
  if (length > 0) made["maxItems"] = length;
  return made;
}

Json any_of(Json::array_t choices) {
  return choices.size() == 1 ? std::move(choices.front()) : Json{{"anyOf", std::move(choices)}};
}

/// A number, or one of the words that stand in its place.
Json number_of(const char* type, const SettingRecord& r) {
  Json::array_t choices{numeric(type, r.quantity)};
  if (r.quantity.unit == "bytes")
    choices.push_back({{"type", "string"}, {"pattern", "^[0-9.]+ ?[MGT]i?B$"}});
  if (!r.words.empty()) choices.push_back({{"enum", r.words}});
  return any_of(std::move(choices));
}

/// What a value must be.
Json value_schema(const SettingRecord& r) {
  const auto number = [&] { return numeric("number", r.quantity); };
  switch (r.type) {
    case Type::number:
      return number_of("number", r);
    case Type::whole_number:
      return number_of("integer", r);
    case Type::flag:
      return {{"type", "boolean"}};
    case Type::text:
    case Type::reference:
      return {{"type", "string"}};
    case Type::word:
      return {{"enum", r.words}};
    case Type::numbers:
      return array_of(number());
    case Type::rows:
      return array_of(array_of(number()));
    case Type::axis: {
      Json even{{"type", "object"},
                {"properties",
                 {{"first", number()},
                  {"last", number()},
                  {"count", {{"type", "integer"}, {"minimum", 1}, {"maximum", most_on_an_axis}}}}},
                {"required", {"first", "last", "count"}},
                {"additionalProperties", false}};
      return any_of({number(), array_of(number()), std::move(even)});
    }
    case Type::vector:
      return array_of(number(), r.length);
    case Type::vectors:
      return array_of(array_of(number(), r.length));
  }
  return Json::object();
}

/// With words for an editor.
Json described(const SettingRecord& record) {
  Json made = value_schema(record);
  const std::string unit = unit_of(record.quantity);
  made["description"] = meaning_of(record, "") + (unit.empty() ? "" : fmt::format(" [{}]", unit));
  if (const Json parsed = Json::parse(record.standard, nullptr, false); !parsed.is_discarded())
    made["default"] = parsed;
  return made;
}

/// The same angle in radians, which files may write as well.
SettingRecord in_radians(SettingRecord record) {
  const Quantity& q = record.quantity;
  record.path.replace(record.path.size() - 4, 4, "_rad");
  record.quantity =
      AngleQuantity{.noun = q.noun, .low_deg = q.low, .high_deg = q.high, .above = q.above}
          .in_radians();
  record.standard.clear();
  return record;
}

/// One thing that a table may say.
struct Entry {
  std::string key;
  Json schema;
  std::vector<SettingCondition> conditions;  ///< on keys of this table
  std::vector<std::string> one_of;           ///< keys of which one is required; an angle has two
};

/// Makes the schema of a table and of those within it.
class TableSchema {
 public:
  /// \param complete  else nothing is required: another file says the rest
  TableSchema(const SettingsList& list, std::string place, bool complete)
      : list_(list), place_(std::move(place)), complete_(complete) {
    for (const SettingRecord& record : list.settings)
      if (is_here(record.path)) add(record);
    for (const TableRecord& table : list.tables)
      if (is_here(table.path.substr(0, table.path.size() - (table.list ? 2 : 0)))) add(table);
  }

  [[nodiscard]] Json made() const {
    Json properties = Json::object(), required = Json::array(), rules = Json::array();
    Json dependent = Json::object();
    std::map<std::string, std::vector<const Entry*>> by_key;
    std::vector<std::string> order;
    for (const Entry& entry : entries_) {
      if (by_key[entry.key].empty()) order.push_back(entry.key);
      by_key[entry.key].push_back(&entry);
      if (entry.one_of.size() == 1 && entry.conditions.empty())
        required.push_back(entry.key);
      else if (!entry.one_of.empty())
        rules.push_back(rule(entry.conditions, has_one(entry.one_of)));
    }
    for (const std::string& key : order) {
      const auto& all = by_key[key];
      properties[key] = schema_of(all);
      if (std::all_of(all.begin(), all.end(),
                      [](const Entry* one) { return !one->conditions.empty(); }))
        if (Json where = holds_for(all, key); !where.is_null()) dependent[key] = std::move(where);
    }
    for (const KeysExcluded& one : list_.excluded)
      if (one.place == place_)
        for (const std::string& key : one.keys)
          if (properties.contains(key))
            rules.push_back(rule(local(one.conditions), {{"properties", {{key, false}}}}));
    Json made{{"type", "object"}, {"properties", std::move(properties)}};
    if (!required.empty()) made["required"] = std::move(required);
    if (!dependent.empty()) made["dependentSchemas"] = std::move(dependent);
    if (!rules.empty()) made["allOf"] = std::move(rules);
    made["additionalProperties"] = false;
    return made;
  }

  /// Keys without which there is no such table.
  [[nodiscard]] std::vector<std::string> required_keys() const {
    std::vector<std::string> keys;
    for (const Entry& entry : entries_)
      if (!entry.one_of.empty() && entry.conditions.empty()) keys.push_back(entry.key);
    return keys;
  }

 private:
  [[nodiscard]] bool is_here(const std::string& path) const {
    return path.starts_with(place_) && path.find('.', place_.size()) == std::string::npos;
  }

  [[nodiscard]] std::vector<SettingCondition> local(
      const std::vector<SettingCondition>& all) const {
    std::vector<SettingCondition> here;
    for (const SettingCondition& one : all)
      if (one.place == place_) here.push_back(one);
    return here;
  }

  void add(const SettingRecord& record) {
    std::vector<std::string> keys{record.path.substr(place_.size())};
    const std::vector<SettingCondition> conditions = local(record.conditions);
    entries_.push_back({keys.front(), described(record), conditions, {}});
    const std::size_t made = entries_.size() - 1;
    if (record.angle) {
      const SettingRecord other = in_radians(record);
      keys.push_back(other.path.substr(place_.size()));
      entries_.push_back({keys.back(), described(other), conditions, {}});
    }
    if (complete_ && record.required) entries_[made].one_of = std::move(keys);
  }

  void add(const TableRecord& table) {
    const TableSchema inner(list_, table.path + '.', complete_);
    Json schema = inner.made();
    schema["description"] = table.help;
    if (table.one_or_more)
      schema = any_of({schema, array_of(schema)});
    else if (table.list)
      schema = {{"type", "array"}, {"items", std::move(schema)}};
    const std::string key =
        table.path.substr(place_.size(), table.path.size() - place_.size() - (table.list ? 2 : 0));
    const bool required = complete_ && !table.may_be_absent && !inner.required_keys().empty();
    entries_.push_back({key, std::move(schema), local(table.conditions), {}});
    if (required) entries_.back().one_of = {key};
  }

  /// What a key must be: of each choice that has it.
  [[nodiscard]] Json schema_of(const std::vector<const Entry*>& all) const {
    Json::array_t choices;
    for (const Entry* one : all)
      if (std::find(choices.begin(), choices.end(), one->schema) == choices.end())
        choices.push_back(one->schema);
    return any_of(std::move(choices));
  }

  /// A key is there, of an angle in either unit.
  [[nodiscard]] static Json has_one(const std::vector<std::string>& keys) {
    Json::array_t choices;
    for (const std::string& key : keys) choices.push_back({{"required", {key}}});
    return any_of(std::move(choices));
  }

  [[nodiscard]] Json holds(const SettingCondition& condition) const {
    Json::array_t parts;
    if (condition.there) parts.push_back({{"required", {condition.key}}});
    for (const std::string& key : condition.absent)
      parts.push_back({{"not", {{"required", {key}}}}});
    if (!condition.words.empty()) {
      Json is{{"properties", {{condition.key, {{"enum", condition.words}}}}}};
      if (!is_standard(condition)) is["required"] = {condition.key};
      parts.push_back(condition.other ? Json{{"not", std::move(is)}} : std::move(is));
    }
    return parts.size() == 1 ? std::move(parts.front()) : Json{{"allOf", std::move(parts)}};
  }

  /// Whether a key has one of a condition's words without being there.
  [[nodiscard]] bool is_standard(const SettingCondition& condition) const {
    for (const SettingRecord& record : list_.settings)
      if (record.path == place_ + condition.key)
        for (const std::string& word : condition.words)
          if (record.standard == '"' + word + '"') return true;
    return false;
  }

  [[nodiscard]] Json holds(const std::vector<SettingCondition>& all) const {
    Json::array_t parts;
    for (const SettingCondition& one : all) parts.push_back(holds(one));
    return parts.size() == 1 ? std::move(parts.front()) : Json{{"allOf", std::move(parts)}};
  }

  /// Under which a key may be there; null where that is how a way is told.
  [[nodiscard]] Json holds_for(const std::vector<const Entry*>& all, const std::string& key) const {
    Json::array_t choices;
    for (const Entry* one : all) {
      std::vector<SettingCondition> conditions = one->conditions;
      std::erase_if(conditions, [&](const SettingCondition& c) {
        return c.there && c.key == key && c.absent.empty();
      });
      if (conditions.empty()) return nullptr;
      if (Json where = holds(conditions);
          std::find(choices.begin(), choices.end(), where) == choices.end())
        choices.push_back(std::move(where));
    }
    return any_of(std::move(choices));
  }

  [[nodiscard]] Json rule(const std::vector<SettingCondition>& conditions, Json then) const {
    if (conditions.empty()) return then;
    return {{"if", holds(conditions)}, {"then", std::move(then)}};
  }

  const SettingsList& list_;
  std::string place_;
  bool complete_;
  std::vector<Entry> entries_;
};

constexpr const char* draft = "https://json-schema.org/draft/2020-12/schema";

}  // namespace

std::string scenario_schema() {
  const SettingsList& list = scenario::catalogue();
  Json made{{"$schema", draft}, {"title", "a scenario of asdic"}};
  made.update(TableSchema(list, "", true).made());
  // Whole tables are required of a whole file: of a sonar, or of a run of the propagation model. A
  // file for `include` has its environment alone, and may say what the including one does not.
  Json ocean = std::move(made["properties"]["environment"]);
  made["properties"]["environment"] = TableSchema(list, "environment.", false).made();
  made.erase("required");
  Json::array_t pulses{{{"required", {"pulse"}}}};
  const Json own{{"type", "object"}, {"required", {"pulse"}}};
  pulses.push_back({{"properties", {{"transmitter", any_of({own, array_of(own)})}}}});
  made["allOf"] = Json::array(
      {Json{{"if", {{"required", {"include"}}}},
            {"else",
             {{"required", {"environment"}}, {"properties", {{"environment", std::move(ocean)}}}}}},
       Json{{"if", {{"required", {"platform"}}}},
            {"then", {{"required", {"transmitter", "array"}}, {"anyOf", std::move(pulses)}}},
            {"else", any_of({Json{{"required", {"run"}}}, Json{{"maxProperties", 1}}})}}});
  return made.dump(2) + '\n';
}

std::string settings_schema(const SettingsSection& section) {
  const SettingsList list = section.list();
  Json table = TableSchema(list, "", true).made();
  table["description"] = section.title;
  const auto& tables = scenario::catalogue().tables;
  if (std::any_of(tables.begin(), tables.end(), [&](const TableRecord& one) {
        return section.document == "scenario" && one.path == section.path + "[]";
      }))
    table = any_of({table, array_of(table)});
  // As it stands in its file.
  for (std::string path = '.' + section.path; !path.empty() && section.path != top_level;) {
    const std::size_t dot = path.rfind('.');
    table = {{"type", "object"}, {"properties", {{path.substr(dot + 1), std::move(table)}}}};
    path.resize(dot);
  }
  Json made{{"$schema", draft}};
  made.update(table);
  return made.dump(2) + '\n';
}
}  // namespace asdic::detail::app
