#include "io/text/toml_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/text.h"
#include "io/text/measured.h"

namespace asdic::detail {
namespace {

/// What an absent table reads as.
const TomlValue& empty_table() {
  static const TomlValue empty{.data = TomlValue::Table{}, .origin = ""};
  return empty;
}

std::string join(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + in_quotes(names[i]);
  return text;
}

/// "target.0.depth" of "target[0].depth": as --set has it.
std::string dotted(const std::string& path) {
  std::string text;
  for (const char c : path)
    if (c != ']') text += c == '[' ? '.' : c;
  return text;
}

std::string element(const std::string& key, std::size_t index) {
  return key + "[" + std::to_string(index) + "]";
}

bool is_override(const TomlValue& value) { return value.origin.starts_with("--set "); }

/// Files write bytes with a unit as well: "4 GB".
constexpr std::string_view bytes = "bytes";

/// A number with its unit, which --set takes where that unit is meant; a file has bare numbers.
std::optional<double> measured(const TomlValue& value, std::string_view unit) {
  const auto* text = std::get_if<std::string>(&value.data);
  if (text == nullptr || !(is_override(value) || unit == bytes)) return std::nullopt;
  const std::optional<Measured> number = parse_measured(*text);
  if (!number || !unit_fits(number->unit, unit)) return std::nullopt;
  return number->value;
}

std::string expected_of(const Quantity& quantity) {
  return quantity.expected() +
         (quantity.unit == bytes ? R"(, or a text such as "4 GB" or "512 MiB")" : "");
}

/// A string such as "12 m/s" or "12".
bool holds_number(const TomlValue& value) {
  const auto* text = std::get_if<std::string>(&value.data);
  if (text == nullptr) return false;
  double number = 0.0;
  return std::from_chars(text->data(), text->data() + text->size(), number).ec == std::errc{};
}
constexpr std::string_view place = "[east, north, depth]";

/// "[east, north, depth] in m"
std::string in_unit(std::string_view axes, const Quantity& quantity) {
  return std::string(axes) + " in " + std::string(quantity.unit);
}

constexpr const char* bare_number = ", as a number without quotes and unit";

}  // namespace

TomlTable::TomlTable(const TomlValue& table, std::string path)
    : table_(&table), path_(std::move(path)) {
  if (table.table() == nullptr)
    throw InputError(
        {.where = table.origin + ": " + path_, .got = table.describe(), .expected = "a table"});
}

std::string TomlTable::path_of(const std::string& key) const {
  return path_.empty() ? key : path_ + "." + key;
}

InputError TomlTable::fault_at(const TomlValue& value, const std::string& key,
                               const std::string& expected, std::optional<std::string> got) const {
  const std::string path = path_of(key);
  const std::string& origin = value.origin.empty() ? fallback_origin_ : value.origin;
  // "--set pulse.duration", or "--set target.0.depth" of target[0].depth, already names the key.
  const std::string where = origin == "--set " + dotted(path) ? origin : origin + ": " + path;
  return InputError(
      {.where = where, .got = got ? std::move(*got) : value.describe(), .expected = expected});
}

InputError TomlTable::fault(const std::string& key, const std::string& expected,
                            std::optional<std::string> got) const {
  const auto bracket = key.find('[');
  const TomlValue* value = table_->find(key.substr(0, bracket));
  if (value != nullptr && bracket != std::string::npos)
    if (const auto* array = std::get_if<TomlValue::Array>(&value->data)) {
      const auto index = std::stoul(key.substr(bracket + 1));
      if (index < array->size()) value = &(*array)[index];
    }
  if (value != nullptr) return fault_at(*value, key, expected, std::move(got));
  return fault_at(*table_, key, expected, got.value_or("nothing"));
}

std::string TomlTable::where(const std::string& key) const { return fault(key, "").fault().where; }

const TomlValue* TomlTable::find(const std::string& key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
  return table_->find(key);
}

void TomlTable::note(NotedSetting setting) const {
  setting.key = path_of(setting.key);
  const bool again = std::any_of(noted_->begin(), noted_->end(),
                                 [&](const auto& one) { return one.key == setting.key; });
  if (!again) noted_->push_back(std::move(setting));
}

bool TomlTable::has(const std::string& key) { return find(key) != nullptr; }

bool TomlTable::has_quietly(const std::string& key) const { return table_->find(key) != nullptr; }

bool TomlTable::is_table(const std::string& key) {
  const TomlValue* value = find(key);
  return value != nullptr && value->table() != nullptr;
}

bool TomlTable::is_text(const std::string& key) {
  const TomlValue* value = find(key);
  return value != nullptr && std::holds_alternative<std::string>(value->data);
}

bool TomlTable::is_array(const std::string& key) {
  const TomlValue* value = find(key);
  return value != nullptr && std::holds_alternative<TomlValue::Array>(value->data);
}

const TomlValue& TomlTable::require(const std::string& key, const std::string& expected) {
  const TomlValue* value = find(key);
  if (value != nullptr) return *value;
  // A key that nobody asked for and that looks like this one is this one, misspelt.
  std::vector<std::string> strange;
  for (const TomlEntry& entry : std::get<TomlValue::Table>(table_->data))
    if (std::find(known_.begin(), known_.end(), entry.key) == known_.end())
      strange.push_back(entry.key);
  const std::string nearest = nearest_name(key, strange);
  if (!nearest.empty())
    throw fault_at(*table_->find(nearest), nearest, "a known key (did you mean \"" + key + "\"?)",
                   "an unknown key");
  throw fault(key, expected);
}

double TomlTable::checked(const TomlValue& value, const std::string& key,
                          const Quantity& quantity) const {
  double number = 0.0;
  if (const auto* integer = std::get_if<std::int64_t>(&value.data))
    number = static_cast<double>(*integer);
  else if (const auto* real = std::get_if<double>(&value.data))
    number = *real;
  else if (const std::optional<double> with_unit = measured(value, quantity.unit))
    number = *with_unit;
  else
    throw fault_at(
        value, key,
        expected_of(quantity) +
            (holds_number(value) && !is_override(value) && quantity.unit != bytes ? bare_number
                                                                                  : ""));
  if (quantity.holds(number)) return number;
  const bool bare = !std::holds_alternative<std::string>(value.data);
  const bool show_unit = bare && std::isfinite(number) && !quantity.unit.empty();
  throw fault_at(value, key, expected_of(quantity),
                 value.describe() + (show_unit ? " " + std::string(quantity.unit) : ""));
}

double TomlTable::number(const std::string& key, const Quantity& quantity) {
  return checked(require(key, quantity.expected()), key, quantity);
}

double TomlTable::number(const std::string& key, const Quantity& quantity, double fallback) {
  return has(key) ? number(key, quantity) : fallback;
}

std::int64_t TomlTable::integer(const std::string& key, std::int64_t low, std::int64_t high) {
  const std::string expected =
      high == std::numeric_limits<std::int64_t>::max()
          ? "a whole number of at least " + std::to_string(low)
          : "a whole number from " + std::to_string(low) + " to " + std::to_string(high);
  const TomlValue& value = require(key, expected);
  const auto* integer = std::get_if<std::int64_t>(&value.data);
  if (integer == nullptr || *integer < low || *integer > high) throw fault_at(value, key, expected);
  return *integer;
}

std::int64_t TomlTable::integer(const std::string& key, std::int64_t low, std::int64_t high,
                                std::int64_t fallback) {
  return has(key) ? integer(key, low, high) : fallback;
}

bool TomlTable::flag(const std::string& key, bool fallback) {
  const TomlValue* value = find(key);
  if (value == nullptr) return fallback;
  if (const auto* flag = std::get_if<bool>(&value->data)) return *flag;
  throw fault_at(*value, key, "true or false");
}

std::string TomlTable::text(const std::string& key) {
  const TomlValue& value = require(key, "a string");
  if (const auto* text = std::get_if<std::string>(&value.data)) return *text;
  throw fault_at(value, key, "a string");
}

std::string TomlTable::text(const std::string& key, const std::string& fallback) {
  return has(key) ? text(key) : fallback;
}

std::string TomlTable::choice(const std::string& key, const std::vector<std::string>& names,
                              std::optional<std::string> fallback) {
  const TomlValue* value = find(key);
  if (value == nullptr && fallback.has_value()) return *fallback;
  const auto* text = value == nullptr ? nullptr : std::get_if<std::string>(&value->data);
  if (text != nullptr && std::find(names.begin(), names.end(), *text) != names.end()) return *text;
  const std::string nearest = text == nullptr ? "" : nearest_name(*text, names);
  throw fault(key, join(names) + (nearest.empty() ? "" : " (did you mean \"" + nearest + "\"?)"));
}

std::vector<double> TomlTable::checked_numbers(const TomlValue& value, const std::string& key,
                                               const Quantity& quantity,
                                               const std::string& expected) const {
  const auto* array = std::get_if<TomlValue::Array>(&value.data);
  if (array == nullptr) throw fault_at(value, key, expected);
  if (array->empty()) throw fault_at(value, key, expected + ", one at least");
  std::vector<double> result;
  for (std::size_t i = 0; i < array->size(); ++i)
    result.push_back(checked((*array)[i], element(key, i), quantity));
  return result;
}

std::vector<double> TomlTable::numbers(const std::string& key, const Quantity& quantity) {
  const std::string expected = "an array of numbers, each " + quantity.expected();
  return checked_numbers(require(key, expected), key, quantity, expected);
}

std::vector<std::vector<double>> TomlTable::rows(const std::string& key, const Quantity& quantity) {
  const std::string expected = "rows of numbers, each " + quantity.expected();
  const TomlValue& value = require(key, expected);
  const auto* array = std::get_if<TomlValue::Array>(&value.data);
  if (array == nullptr || array->empty()) throw fault_at(value, key, expected);
  std::vector<std::vector<double>> result;
  for (std::size_t i = 0; i < array->size(); ++i) {
    const std::string row = element(key, i);
    result.push_back(checked_numbers((*array)[i], row, quantity, "a row of numbers"));
    if (result.back().size() != result.front().size())
      throw fault_at(
          (*array)[i], row,
          "as many numbers as in the first row, " + std::to_string(result.front().size()));
  }
  return result;
}

void TomlTable::checked_components(const TomlValue& value, const std::string& key,
                                   const Quantity& quantity, std::string_view axes,
                                   std::span<double> result) const {
  const auto* array = std::get_if<TomlValue::Array>(&value.data);
  if (array == nullptr || array->size() != result.size())
    throw fault_at(value, key, in_unit(axes, quantity));
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = checked((*array)[i], element(key, i), quantity);
}

void TomlTable::components(const std::string& key, const Quantity& quantity, std::string_view axes,
                           std::span<double> result) {
  checked_components(require(key, in_unit(axes, quantity)), key, quantity, axes, result);
}

Vec3 TomlTable::vector(const std::string& key, const Quantity& quantity) {
  Vec3 result;
  components(key, quantity, place, {result.data(), 3});
  return result;
}

Vec3 TomlTable::vector(const std::string& key, const Quantity& quantity, const Vec3& fallback) {
  return has(key) ? vector(key, quantity) : fallback;
}

std::vector<Vec3> TomlTable::vectors(const std::string& key, const Quantity& quantity) {
  const std::string expected = "an array of " + in_unit(place, quantity);
  const TomlValue& value = require(key, expected);
  const auto* array = std::get_if<TomlValue::Array>(&value.data);
  if (array == nullptr || array->empty()) throw fault_at(value, key, expected);
  std::vector<Vec3> result(array->size());
  for (std::size_t i = 0; i < array->size(); ++i)
    checked_components((*array)[i], element(key, i), quantity, place, {result[i].data(), 3});
  return result;
}

TomlTable TomlTable::table(const std::string& key) {
  const TomlValue* value = find(key);
  TomlTable inner(value == nullptr ? empty_table() : *value, path_of(key));
  inner.noted_ = noted_;
  // Missing keys of an absent table are reported at the line of the table around it.
  if (value == nullptr)
    inner.fallback_origin_ = table_->origin.empty() ? fallback_origin_ : table_->origin;
  return inner;
}

std::vector<TomlTable> TomlTable::tables(const std::string& key) {
  const TomlValue* value = find(key);
  if (value == nullptr) return {};
  const auto* array = std::get_if<TomlValue::Array>(&value->data);
  if (array == nullptr) throw fault_at(*value, key, "an array of tables, [[" + path_of(key) + "]]");
  std::vector<TomlTable> result;
  for (std::size_t i = 0; i < array->size(); ++i)
    result.emplace_back((*array)[i], path_of(element(key, i))).noted_ = noted_;
  return result;
}

std::vector<TomlTable> TomlTable::one_or_more(const std::string& key) {
  std::vector<TomlTable> result;
  if (is_array(key)) result = tables(key);
  if (result.empty()) result.push_back(table(key));
  return result;
}

void TomlTable::finish() const {
  for (const TomlEntry& entry : std::get<TomlValue::Table>(table_->data)) {
    if (std::find(known_.begin(), known_.end(), entry.key) != known_.end()) continue;
    const std::string nearest = nearest_name(entry.key, known_);
    std::vector<std::string> names = known_;
    std::sort(names.begin(), names.end());
    throw fault_at(entry.value, entry.key,
                   nearest.empty() ? "one of " + join(names)
                                   : "a known key (did you mean \"" + nearest + "\"?)",
                   "an unknown key");
  }
}

}  // namespace asdic::detail
