#include "io/text/toml_document.h"

#include <algorithm>

#include "io/text/toml_writer.h"

namespace asdic::detail {
namespace {

bool is_list_of_tables(const TomlValue& value) {
  const auto* items = std::get_if<TomlValue::Array>(&value.data);
  return items != nullptr && !items->empty() &&
         std::all_of(items->begin(), items->end(),
                     [](const TomlValue& item) { return item.table() != nullptr; });
}

/// What a table holds: first its values, then its tables, which TOML would else put them into.
void add_table(const TomlValue::Table& table, const std::string& path, std::string& text) {
  const auto below = [&](const std::string& key) {
    return path.empty() ? toml_key(key) : path + "." + toml_key(key);
  };
  for (const TomlEntry& entry : table)
    if (entry.value.table() == nullptr && !is_list_of_tables(entry.value))
      text += toml_key(entry.key) + " = " + inline_toml(entry.value) + "\n";
  for (const TomlEntry& entry : table) {
    if (const TomlValue::Table* inner = entry.value.table()) {
      text += (text.empty() ? "[" : "\n[") + below(entry.key) + "]\n";
      add_table(*inner, below(entry.key), text);
    } else if (is_list_of_tables(entry.value)) {
      for (const TomlValue& item : std::get<TomlValue::Array>(entry.value.data)) {
        text += (text.empty() ? "[[" : "\n[[") + below(entry.key) + "]]\n";
        add_table(std::get<TomlValue::Table>(item.data), below(entry.key), text);
      }
    }
  }
}

}  // namespace

std::string toml_text(const TomlValue& document) {
  std::string text;
  add_table(std::get<TomlValue::Table>(document.data), "", text);
  return text;
}

}  // namespace asdic::detail
