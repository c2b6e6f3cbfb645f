#include "serve/inline_toml.h"

#include <algorithm>

#include "io/text/toml_writer.h"

namespace asdic::serve {
namespace {

/// A basic string: quotes, backslashes and control characters are written as TOML asks.
std::string quoted(const std::string& text) {
  constexpr std::string_view hex = "0123456789abcdef";
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      result += {'\\', c};
    else if (byte < 0x20 || byte == 0x7f)
      result += {'\\', 'u', '0', '0', hex[byte >> 4], hex[byte & 15]};
    else
      result += c;
  }
  return result + '"';
}

struct Writer {
  std::string operator()(std::monostate) const { return "\"\""; }
  std::string operator()(bool flag) const { return flag ? "true" : "false"; }
  std::string operator()(std::int64_t number) const { return std::to_string(number); }
  std::string operator()(double number) const { return toml_number(number); }
  std::string operator()(const std::string& text) const { return quoted(text); }
  std::string operator()(const TomlValue::Array& items) const {
    std::string result;
    for (const TomlValue& item : items) result += (result.empty() ? "" : ", ") + inline_toml(item);
    return "[" + result + "]";
  }
  std::string operator()(const TomlValue::Table& entries) const {
    std::string result;
    for (const TomlEntry& entry : entries)
      result += (result.empty() ? "" : ", ") + quoted(entry.key) + " = " + inline_toml(entry.value);
    return "{" + result + "}";
  }
};

}  // namespace

std::string inline_toml(const TomlValue& value) { return std::visit(Writer{}, value.data); }

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

}  // namespace asdic::serve
