#include "serve/client_key.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <vector>

#include "serve/client_names.h"
#include "serve/motion.h"

namespace asdic::detail::serve {
namespace {

/// "target[1].strength_db" without its index: "target.strength_db", and 1.
struct Indexed {
  std::string key;
  std::optional<std::size_t> index;
};

Indexed without_index(const std::string& key) {
  const std::size_t open = key.find('['), dot = key.find('.');
  const std::size_t close = key.find(']', std::min(open, key.size()));
  if (close == std::string::npos || dot < open) return {key, std::nullopt};
  std::size_t index = 0;
  std::from_chars(key.data() + open + 1, key.data() + close, index);
  return {key.substr(0, open) + key.substr(close + 1), index};
}

std::string name_in(const TomlValue* table) {
  const TomlValue* name = table == nullptr ? nullptr : table->find("name");
  const auto* text = name == nullptr ? nullptr : std::get_if<std::string>(&name->data);
  return text == nullptr ? "" : *text;
}

const TomlValue* element(const TomlValue* value, std::size_t index) {
  const auto* array = value == nullptr ? nullptr : std::get_if<TomlValue::Array>(&value->data);
  return array == nullptr || index >= array->size() ? nullptr : &(*array)[index];
}

/// Which of a command's array has the name of the scenario's, if any has.
std::optional<std::size_t> same_name(const TomlValue& several, const std::string& name) {
  const auto* array = std::get_if<TomlValue::Array>(&several.data);
  for (std::size_t i = 0; array != nullptr && i < array->size(); ++i)
    if (name_in(&(*array)[i]) == name) return i;
  return std::nullopt;
}

/// What stands at "position.x" or "speed[3]" below a value.
const TomlValue* below(const TomlValue* at, std::string_view path) {
  path = path.substr(0, path.find('['));
  while (at != nullptr && !path.empty()) {
    const std::size_t dot = std::min(path.find('.'), path.size());
    at = at->find(std::string(path.substr(0, dot)));
    path.remove_prefix(std::min(dot + 1, path.size()));
  }
  return at;
}

/// The key by which a command moves what the scenario moves by another: ".waypoints[0].position" of
/// a platform whose "position" it gave. "": neither is of motion.
std::string same_motion(const TomlValue* table, std::string_view rest) {
  std::vector<std::string_view> ways(motion_keys.begin(), motion_keys.end());
  ways.insert(ways.end(), {"range", "depth", "bearing_deg"});  // of files alone
  const std::string_view first = rest.substr(std::min<std::size_t>(1, rest.size()));
  const std::string_view word = first.substr(0, first.find_first_of(".["));
  if (table == nullptr || std::find(ways.begin(), ways.end(), word) == ways.end()) return "";
  for (const std::string_view key : ways)
    if (table->find(key) != nullptr) return std::string(key);
  return "";
}

}  // namespace

ClientKey client_key(const std::string& key, const TomlValue& fields, const TomlValue& document) {
  const Indexed scenario = without_index(key);
  for (const ClientName& one : client_names()) {
    const std::string& section = one.section;
    const std::string_view rest =
        std::string_view(scenario.key).substr(std::min(section.size(), scenario.key.size()));
    if (!scenario.key.starts_with(section) ||
        !(rest.empty() || rest.front() == '.' || rest.front() == '['))
      continue;
    const std::string tail(rest);
    const TomlValue* table = below(&fields, one.name);
    std::string where = one.name;
    if (table != nullptr && std::holds_alternative<TomlValue::Array>(table->data) &&
        scenario.index) {
      const auto i = same_name(*table, name_in(element(document.find(section), *scenario.index)));
      where += i ? "[" + std::to_string(*i) + "]" : "";
      table = i ? element(table, *i) : nullptr;
    }
    const TomlValue* value = below(table, rest.starts_with('.') ? rest.substr(1) : rest);
    if (value == nullptr)  // one way of saying where something is stands for another
      if (const std::string motion = same_motion(table, rest); !motion.empty())
        return {.name = where.append(".").append(motion), .given = true, .under = true};
    return {.name = where + tail, .given = value != nullptr, .under = table != nullptr};
  }
  return {.name = key};
}

}  // namespace asdic::detail::serve
