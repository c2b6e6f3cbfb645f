#include "serve/command.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "core/text.h"
#include "serve/refusal.h"

namespace asdic::detail::serve {
namespace {

using Json = nlohmann::json;

constexpr std::size_t longest_id = 128;  // bytes of JSON
constexpr std::size_t longest_name = 64;
constexpr const char* one_object = "one JSON object a line";

bool plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// Watches a text while it is parsed: so nothing deep is ever built.
class Watch {
 public:
  /// \param at  the key that was last read, for messages; outlives this
  Watch(std::size_t nesting, std::string& at) : nesting_(nesting), at_(at) {}

  bool operator()(int, Json::parse_event_t event, Json& parsed) {
    using Event = Json::parse_event_t;
    if (event == Event::object_start || event == Event::array_start) {
      if (open_.size() == nesting_)
        throw Refusal("limit", refusal_text(at_, "deeper nesting",
                                            "at most " + std::to_string(nesting_) + " levels"));
      open_.emplace_back();
    } else if (event == Event::object_end || event == Event::array_end) {
      open_.pop_back();
    } else if (event == Event::key) {
      const auto& name = parsed.get_ref<const std::string&>();
      if (name.empty() || name.size() > longest_name ||
          !std::all_of(name.begin(), name.end(), plain))
        throw Refusal(
            "json", refusal_text(at_, "another key", "keys of 1 to 64 letters, digits and \"_\""));
      if (!open_.back().insert(name).second)
        throw Refusal("json", refusal_text(name, "the key twice", "every key once"));
      at_ = name;
    }
    return true;
  }

 private:
  std::size_t nesting_;
  std::string& at_;
  std::vector<std::set<std::string>> open_;  // the keys of each level that is open
};

Json parse(std::string_view line, const SessionLimits& limits) {
  if (line.size() > limits.line_bytes)
    throw Refusal("limit",
                  refusal_text("line", "a longer one",
                               "at most " + std::to_string(limits.line_bytes) + " bytes a line"));
  std::string at = "line";  // where it goes wrong
  try {
    Json all = Json::parse(line, Watch(limits.nesting, at));
    if (!all.is_object())
      throw Refusal("json", refusal_text("line", std::string(all.type_name()), one_object));
    return all;
  } catch (const Json::out_of_range&) {  // 1e999
    throw Refusal("json", refusal_text(at, "a number that is not finite", "finite numbers"));
  } catch (const Json::exception&) {
    throw Refusal("json", refusal_text("line", "text that is no JSON in UTF-8", one_object));
  }
}

TomlValue to_toml(const Json& json) {
  TomlValue value;
  switch (json.type()) {
    case Json::value_t::boolean:
      value.data = json.get<bool>();
      break;
    case Json::value_t::number_integer:
      value.data = json.get<std::int64_t>();
      break;
    case Json::value_t::number_unsigned:
      if (json.get<std::uint64_t>() <= std::uint64_t{std::numeric_limits<std::int64_t>::max()})
        value.data = json.get<std::int64_t>();
      else
        value.data = json.get<double>();
      break;
    case Json::value_t::number_float:
      value.data = json.get<double>();
      break;
    case Json::value_t::string:
      value.data = json.get<std::string>();
      break;
    case Json::value_t::array: {
      TomlValue::Array items;
      for (const Json& item : json) items.push_back(to_toml(item));
      value.data = std::move(items);
      break;
    }
    case Json::value_t::object: {
      TomlValue::Table entries;
      for (const auto& [key, item] : json.items())
        if (!item.is_null()) entries.push_back({key, to_toml(item)});
      value.data = std::move(entries);
      break;
    }
    default:  // null: like a key that is not there
      break;
  }
  return value;
}

std::string checked_id(const Json& all) {
  const auto found = all.find("id");
  if (found == all.end()) return "null";
  if (!(found->is_number() || found->is_string() || found->is_null()))
    throw Refusal("command",
                  refusal_text("id", std::string(found->type_name()), "a number or a string"));
  std::string id = found->dump();
  if (id.size() > longest_id)
    throw Refusal("command", refusal_text("id", std::to_string(id.size()) + " bytes",
                                          "at most " + std::to_string(longest_id)));
  return id;
}

/// "a", "b" or "c".
std::string one_of(std::span<const std::string_view> names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " or ") + in_quotes(names[i]);
  return text;
}

std::string_view checked_name(const Json& all, std::span<const std::string_view> names) {
  const auto found = all.find("command");
  if (found == all.end() || !found->is_string())
    throw Refusal(
        "command",
        refusal_text("command", found == all.end() ? "nothing" : std::string(found->type_name()),
                     one_of(names)));
  const auto known = std::find(names.begin(), names.end(), found->get_ref<const std::string&>());
  if (known == names.end())
    throw Refusal("command", refusal_text("command", "an unknown one", one_of(names)));
  return *known;
}

}  // namespace

Command read_command(std::string_view line, const SessionLimits& limits,
                     std::span<const std::string_view> names) {
  const Json all = parse(line, limits);
  Command command;
  command.line = line;
  command.id = checked_id(all);
  command.name = checked_name(all, names);
  TomlValue::Table fields;
  for (const auto& [key, value] : all.items())
    if (key != "id" && key != "command" && !value.is_null())
      fields.push_back({key, to_toml(value)});
  command.fields = {.data = std::move(fields), .origin = std::string(command.name)};
  return command;
}

namespace {

/// Listens to a text for the id of its outermost object, whatever else is wrong with it; builds
/// nothing. The names are those of nlohmann::json_sax.
class IdListener {
 public:
  [[nodiscard]] std::string id() const { return times_ == 1 ? id_ : "null"; }

  bool null() { return value("null"); }
  bool boolean(bool) { return value("null"); }
  bool number_integer(std::int64_t x) { return value(Json(x).dump()); }
  bool number_unsigned(std::uint64_t x) { return value(Json(x).dump()); }
  bool number_float(double x, const std::string&) { return value(Json(x).dump()); }
  bool string(std::string& x) { return value(wanted_ ? Json(x).dump() : "null"); }
  bool binary(Json::binary_t&) { return value("null"); }
  bool start_object(std::size_t) { return open(true); }
  bool start_array(std::size_t) { return open(false); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool key(std::string& name) {
    wanted_ = depth_ == 1 && name == "id";
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const Json::exception&) { return false; }

 private:
  bool value(const std::string& json) {
    if (wanted_) {
      ++times_;
      id_ = json.size() <= longest_id ? json : "null";
    }
    wanted_ = false;
    return depth_ > 0;  // a lone value has none
  }
  bool open(bool object) {
    if (wanted_) static_cast<void>(value("null"));
    return ++depth_ > 1 || object;
  }
  bool close() {
    --depth_;
    return true;
  }

  std::string id_ = "null";
  std::size_t depth_ = 0;
  int times_ = 0;
  bool wanted_ = false;  // the next value is the id
};

}  // namespace

std::string id_of(std::string_view line, const SessionLimits& limits) {
  if (line.size() > limits.line_bytes) return "null";
  IdListener listener;
  static_cast<void>(Json::sax_parse(line, &listener));
  return listener.id();
}

std::optional<double> number_said(const TomlValue& fields, std::string_view key) {
  const TomlValue* value = fields.find(key);
  if (value == nullptr) return std::nullopt;
  if (const auto* number = std::get_if<double>(&value->data)) return *number;
  if (const auto* number = std::get_if<std::int64_t>(&value->data))
    return static_cast<double>(*number);
  return std::nullopt;
}

std::optional<std::string> id_text(const TomlValue& value) {
  if (const auto* text = std::get_if<std::string>(&value.data)) return Json(*text).dump();
  if (const auto* number = std::get_if<std::int64_t>(&value.data)) return Json(*number).dump();
  if (const auto* number = std::get_if<double>(&value.data)) return Json(*number).dump();
  return std::nullopt;
}

Handshake read_handshake(std::string_view line) {
  const Refusal wrong("handshake", refusal_text("first line", "another", R"({"asdic": 1})"));
  SessionLimits strict;
  strict.line_bytes = 4096;
  strict.nesting = 2;
  Handshake shake;
  try {
    const Json all = parse(line, strict);
    bool ours = false;
    for (const auto& [key, value] : all.items()) {
      if (key == "asdic")
        ours = value.is_number_integer() && value == 1;
      else if (key == "token" && value.is_string())
        shake.token = value.get<std::string>();
      else if (key == "when_full" && (value == "wait" || value == "busy"))
        shake.waits = value == "wait";
      else
        throw wrong;
    }
    if (!ours) throw wrong;
  } catch (const Refusal&) {
    throw wrong;
  }
  return shake;
}

}  // namespace asdic::detail::serve
