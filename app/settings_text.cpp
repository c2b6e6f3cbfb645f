#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/settings_sections.h"

namespace asdic::detail::app {
namespace {

using Json = nlohmann::ordered_json;
using Type = SettingRecord::Type;

std::string default_of(const SettingRecord& record) {
  if (record.required) return "required";
  return record.inherits.empty() ? record.standard : record.inherits;
}

/// What it means, and when there is one.
std::string meaning_of(const SettingRecord& record, std::string_view quote) {
  std::string text = record.help;
  if (!record.condition.empty()) text += fmt::format(" ({}{}{})", quote, record.condition, quote);
  if (record.live) text += "; a running server takes changes";
  return text;
}

std::string in_code(const std::string& text) { return text.empty() ? "" : '`' + text + '`'; }

/// A table's cell: a bar in it would end it.
std::string cell(const std::string& text) {
  std::string made;
  for (const char c : text) made += c == '|' ? std::string("\\|") : std::string(1, c);
  return made;
}

Json numeric(const char* type, const Quantity& q) {
  Json made{{"type", type}};
  if (q.low > -infinity) made[q.above ? "exclusiveMinimum" : "minimum"] = q.low;
  if (q.high < infinity) made["maximum"] = q.high;
  return made;
}

Json array_of(Json items, std::size_t length) {
  Json made{{"type", "array"}, {"items", std::move(items)}};
  if (length > 0) made["minItems"] = made["maxItems"] = length;
  return made;
}

/// A word in place of a number.
Json or_words(Json number, const std::vector<std::string>& words) {
  if (words.empty()) return number;
  return {{"anyOf", Json::array({std::move(number), Json{{"enum", words}}})}};
}

/// What a value must be.
Json value_schema(const SettingRecord& r) {
  switch (r.type) {
    case Type::number:
      return or_words(numeric("number", r.quantity), r.words);
    case Type::whole_number:
      return or_words(numeric("integer", r.quantity), r.words);
    case Type::flag:
      return {{"type", "boolean"}};
    case Type::text:
    case Type::reference:
      return {{"type", "string"}};
    case Type::word:
      return {{"enum", r.words}};
    case Type::numbers:
      return array_of(numeric("number", r.quantity), 0);
    case Type::rows:
      return array_of(array_of(numeric("number", r.quantity), 0), 0);
    case Type::axis: {
      const Json number = numeric("number", r.quantity);
      const Json even{{"type", "object"}, {"required", {"first", "last", "count"}}};
      return {{"anyOf", Json::array({number, array_of(number, 0), even})}};
    }
    case Type::vector:
      return array_of(numeric("number", r.quantity), r.length);
    case Type::vectors:
      return array_of(array_of(numeric("number", r.quantity), r.length), 0);
  }
  return Json::object();
}

/// The schema of a setting with its words for an editor. Of a key that two choices have, what one
/// of them takes.
void add_value(Json& properties, const std::string& key, const SettingRecord& record) {
  Json made = value_schema(record);
  made["description"] =
      meaning_of(record, "") +
      (record.quantity.unit.empty() ? "" : fmt::format(" [{}]", record.quantity.unit));
  if (const std::string standard = default_of(record); !standard.empty() && !record.required) {
    const Json parsed = Json::parse(standard, nullptr, false);
    if (!parsed.is_discarded()) made["default"] = parsed;
  }
  if (!properties.contains(key))
    properties[key] = std::move(made);
  else if (properties[key] != made)
    properties[key] = {{"anyOf", Json::array({properties[key], made})}};
}

/// The properties of the table at a path: "a.b[].c". A table may stand once or several times.
Json& properties_at(Json& root, std::string_view path) {
  Json* at = &root;
  while (!path.empty()) {
    const std::size_t dot = std::min(path.find('.'), path.size());
    std::string key(path.substr(0, dot));
    path.remove_prefix(std::min(dot + 1, path.size()));
    const bool several = key.ends_with("[]");
    if (several) key.resize(key.size() - 2);
    Json& table = (*at)["properties"][key];
    if (table.is_null() && several)
      table = {{"type", {"array", "object"}}, {"items", {{"type", "object"}}}};
    else if (table.is_null())
      table = {{"type", "object"}};
    at = several ? &table["items"] : &table;
  }
  return (*at)["properties"];
}

}  // namespace

std::string settings_markdown(std::span<const SettingRecord> records) {
  std::string text = "| key | | default | |\n|---|---|---|---|\n";
  for (const SettingRecord& r : records) {
    const std::string standard = r.required ? "required" : in_code(default_of(r));
    text += fmt::format("| `{}` | {} | {} | {} |\n", r.path, cell(domain_of(r)), cell(standard),
                        cell(meaning_of(r, "`")));
  }
  return text;
}

std::string settings_text(const SettingsSection& section) {
  std::string text = fmt::format("[{}] of {}: {}\n", section.path, section.document, section.title);
  for (const SettingRecord& r : section.records()) {
    const std::string standard = default_of(r);
    text += fmt::format("  {}: {}{}\n      {}\n", r.path, domain_of(r),
                        standard.empty() ? "" : fmt::format(" [{}]", standard), meaning_of(r, ""));
  }
  return text;
}

std::string settings_schema(std::span<const SettingsSection> sections) {
  Json root{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"type", "object"}};
  for (const SettingsSection& section : sections)
    for (const SettingRecord& record : section.records()) {
      const std::size_t dot = record.path.rfind('.');
      const std::string inner = dot == std::string::npos ? "" : '.' + record.path.substr(0, dot);
      const std::string key = dot == std::string::npos ? record.path : record.path.substr(dot + 1);
      Json& properties =
          properties_at(root, std::string(section.path) + (section.several ? "[]" : "") + inner);
      add_value(properties, key, record);
    }
  return root.dump(2) + '\n';
}

}  // namespace asdic::detail::app
