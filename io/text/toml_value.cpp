#include "io/text/toml_value.h"

#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "core/error.h"
#include "core/text.h"

namespace asdic::detail {
namespace {

TomlValue convert(const toml::node& node, const std::string& origin, const std::string& file) {
  // Implicit tables have no line of their own: they keep that of what encloses them.
  const auto line = node.source().begin.line;
  TomlValue value;
  value.origin = line == 0 || file.empty() ? origin : file + ":" + std::to_string(line);
  if (const auto* table = node.as_table()) {
    TomlValue::Table entries;
    for (const auto& [key, child] : *table)
      entries.push_back({std::string(key.str()), convert(child, value.origin, file)});
    value.data = std::move(entries);
  } else if (const auto* array = node.as_array()) {
    TomlValue::Array items;
    for (const auto& child : *array) items.push_back(convert(child, value.origin, file));
    value.data = std::move(items);
  } else if (const auto* flag = node.as_boolean()) {
    value.data = flag->get();
  } else if (const auto* integer = node.as_integer()) {
    value.data = integer->get();
  } else if (const auto* real = node.as_floating_point()) {
    value.data = real->get();
  } else if (const auto* text = node.as_string()) {
    value.data = text->get();
  } else {
    throw InputError({.where = value.origin,
                      .got = "a date or time",
                      .expected = "a number, a string, true or false, an array or a table"});
  }
  return value;
}

/// The names of a dotted path; one in quotes may have dots in it: vary."target.0.range".high
std::vector<std::string> split(std::string_view path) {
  std::vector<std::string> parts;
  for (std::size_t start = 0; start <= path.size();) {
    const auto quote =
        path.substr(start).starts_with('"') ? path.find('"', start + 1) : std::string_view::npos;
    if (quote != std::string_view::npos && (quote + 1 == path.size() || path[quote + 1] == '.')) {
      parts.emplace_back(path.substr(start + 1, quote - start - 1));
      start = quote + 2;
      continue;
    }
    const auto dot = std::min(path.find('.', start), path.size());
    parts.emplace_back(path.substr(start, dot - start));
    start = dot + 1;
  }
  return parts;
}

/// The value of an override: TOML if it parses as one value, else the words themselves.
TomlValue override_value(std::string_view text, const std::string& origin) {
  try {
    const toml::table table = toml::parse("value = " + std::string(text));
    if (table.size() == 1) return convert(*table.get("value"), origin, "");
  } catch (const toml::parse_error& error) {
    const auto first = text.find_first_not_of(" \t");
    if (first != std::string_view::npos &&
        std::string_view("[{\"'").find(text[first]) != std::string_view::npos)
      throw InputError({.where = origin,
                        .got = "a fault (" + std::string(error.description()) + ")",
                        .expected = "a TOML value"});
  }
  return {.data = std::string(text), .origin = origin};
}

}  // namespace

const TomlValue* TomlValue::find(std::string_view key) const {
  const Table* entries = table();
  if (entries == nullptr) return nullptr;
  const auto it = std::find_if(entries->begin(), entries->end(),
                               [&](const TomlEntry& entry) { return entry.key == key; });
  return it == entries->end() ? nullptr : &it->value;
}

TomlValue* TomlValue::find(std::string_view key) {
  return const_cast<TomlValue*>(std::as_const(*this).find(key));
}

std::string TomlValue::describe() const {
  if (const auto* flag = std::get_if<bool>(&data)) return *flag ? "true" : "false";
  if (const auto* integer = std::get_if<std::int64_t>(&data)) return std::to_string(*integer);
  if (const auto* real = std::get_if<double>(&data)) return to_text(*real);
  if (const auto* text = std::get_if<std::string>(&data)) return '"' + *text + '"';
  if (const auto* array = std::get_if<Array>(&data))
    return "an array of " + std::to_string(array->size());
  return table() != nullptr ? "a table" : "nothing";
}

/// toml++ walks a dotted key by recursion, without a limit: a key of ten thousand parts would end
/// the program.
void refuse_endless_keys(std::string_view text, const std::string& file) {
  constexpr int most_parts = 64;
  int line = 1, dots = 0;
  char quote = 0;
  for (const char c : text) {
    if (c == '\n') ++line;
    if (quote != 0) {
      if (c == quote || c == '\n') quote = 0;
      continue;
    }
    if (c == '"' || c == '\'') quote = c;
    if (c == '.') ++dots;
    if (std::string_view(",[]{}=#\n").find(c) != std::string_view::npos) dots = 0;
    if (dots > most_parts)
      throw InputError({.where = file + ":" + std::to_string(line),
                        .got = "a key of more than 64 parts",
                        .expected = "TOML 1.0 with short keys"});
  }
}

TomlValue parse_toml(std::string_view text, const std::string& file) {
  refuse_endless_keys(text, file);
  try {
    TomlValue root = convert(toml::parse(text, file), file + ":1", file);
    root.origin = file + ":1";
    return root;
  } catch (const toml::parse_error& error) {
    const auto at = error.source().begin;
    throw InputError(
        {.where = file + ":" + std::to_string(at.line) + ":" + std::to_string(at.column),
         .got = "a fault (" + std::string(error.description()) + ")",
         .expected = "TOML 1.0"});
  }
}

void merge_defaults(TomlValue& base, const TomlValue& fragment) {
  auto* mine = std::get_if<TomlValue::Table>(&base.data);
  const auto* theirs = std::get_if<TomlValue::Table>(&fragment.data);
  if (mine == nullptr || theirs == nullptr) return;
  for (const TomlEntry& entry : *theirs) {
    TomlValue* have = base.find(entry.key);
    if (have == nullptr)
      mine->push_back(entry);
    else if (have->find("kind") == nullptr)
      merge_defaults(*have, entry.value);
  }
}

namespace {

InputError no_such_index(const std::string& origin, const std::string& index,
                         const std::string& array, std::size_t size) {
  return InputError({.where = origin,
                     .got = "index \"" + index + "\" of " + array,
                     .expected = size == 0 ? "no index, the array is empty"
                                           : "an index from 0 to " + std::to_string(size - 1)});
}

/// The index that a part of a path is; none: it is no number, or past the end.
std::optional<std::size_t> index_of(const std::string& part, const TomlValue::Array& array) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  const bool whole = error == std::errc{} && end == part.data() + part.size();
  return whole && index < array.size() ? std::optional(index) : std::nullopt;
}

InputError nothing_below(const std::string& origin, const std::string& part,
                         const std::string& path, const TomlValue& there) {
  return InputError({.where = origin,
                     .got = '"' + part + "\" below " + path + ", which is " + there.describe(),
                     .expected = "a path through tables and arrays"});
}

}  // namespace

TomlValue& value_at(TomlValue& root, std::string_view path, const std::string& origin) {
  TomlValue* at = &root;
  std::string walked;
  for (const std::string& part : split(path)) {
    if (auto* array = std::get_if<TomlValue::Array>(&at->data)) {
      const std::optional<std::size_t> index = index_of(part, *array);
      if (!index) throw no_such_index(origin, part, walked, array->size());
      at = &(*array)[*index];
    } else if (auto* table = std::get_if<TomlValue::Table>(&at->data)) {
      if (part.empty())
        throw InputError({.where = origin, .got = "an empty name", .expected = "a key path"});
      TomlValue* next = at->find(part);
      if (next == nullptr) {  // the reader finds out whether such a key exists
        table->push_back({part, {.data = TomlValue::Table{}, .origin = origin}});
        next = &table->back().value;
      }
      at = next;
    } else {
      throw nothing_below(origin, part, walked, *at);
    }
    walked += (walked.empty() ? "" : ".") + part;
  }
  return *at;
}

const TomlValue* find_at(const TomlValue& root, std::string_view path) {
  const TomlValue* at = &root;
  for (const std::string& part : split(path)) {
    if (const auto* array = std::get_if<TomlValue::Array>(&at->data)) {
      const std::optional<std::size_t> index = index_of(part, *array);
      at = index ? &(*array)[*index] : nullptr;
    } else {
      at = at->find(part);
    }
    if (at == nullptr) return nullptr;
  }
  return at;
}

void erase_at(TomlValue& root, std::string_view path) {
  if (find_at(root, path) == nullptr) return;
  const std::string last = split(path).back();
  const auto length = std::min(path.size(), last.size() + (path.ends_with('"') ? 3 : 1));
  const std::string_view parent = path.substr(0, path.size() - length);
  TomlValue& home = parent.empty() ? root : value_at(root, parent, "");
  if (auto* array = std::get_if<TomlValue::Array>(&home.data))
    array->erase(array->begin() + static_cast<std::ptrdiff_t>(*index_of(last, *array)));
  else
    erase_key(home, last);
}

void apply_override(TomlValue& root, const std::string& assignment) {
  const auto equals = assignment.find('=');
  const std::string key = assignment.substr(0, equals);
  const std::string origin = "--set " + key;
  if (equals == std::string::npos || key.empty())
    throw InputError({.where = "--set", .got = '"' + assignment + '"', .expected = "key=value"});
  value_at(root, key, origin) =
      override_value(std::string_view(assignment).substr(equals + 1), origin);
}

void set_key(TomlValue& table, const std::string& key, TomlValue value) {
  if (TomlValue* found = table.find(key))
    *found = std::move(value);
  else
    std::get<TomlValue::Table>(table.data).push_back({key, std::move(value)});
}

void erase_key(TomlValue& table, const std::string& key) {
  std::erase_if(std::get<TomlValue::Table>(table.data),
                [&](const TomlEntry& entry) { return entry.key == key; });
}

}  // namespace asdic::detail
