#include "asdic/value.h"

#include <algorithm>

#include "core/utf8.h"
#include "io/text/toml_writer.h"
#include "library/access.h"

namespace asdic {
namespace {

using detail::TomlValue;

template <class Items>
TomlValue list_of(const Items& items) {
  TomlValue::Array array;
  for (const auto& item : items) array.push_back({.data = item, .origin = set_in_program});
  return {.data = std::move(array), .origin = set_in_program};
}

/// A text, or a key. \throws InputError for what no file can hold
std::string utf8(std::string_view text) {
  if (detail::is_utf8(text)) return std::string(text);
  throw InputError("value", '"' + std::string(text) + '"', "a text in UTF-8");
}

template <class T>
const T& held(const TomlValue& value, const char* expected) {
  if (const T* found = std::get_if<T>(&value.data)) return *found;
  throw InputError(value.origin.empty() ? "value" : value.origin, value.describe(), expected);
}

double number_in(const TomlValue& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value.data))
    return static_cast<double>(*whole);
  return held<double>(value, "a number");
}

}  // namespace

Value Access::made(TomlValue value) {
  Value result;
  result.data_ = std::make_shared<const Value::Data>(Value::Data{std::move(value)});
  return result;
}

const TomlValue& Access::tree(const Value& value) {
  static const TomlValue nothing;
  return value.data_ ? value.data_->value : nothing;
}

const TomlValue& Access::given(const Value& value) {
  if (value.kind() == Value::Kind::nothing)
    throw InputError("value", "nothing", "a value; erase() takes a setting out");
  return tree(value);
}

Value::Value() = default;
Value::Value(bool flag) : Value(Access::made({.data = flag, .origin = set_in_program})) {}
Value::Value(double number) : Value(Access::made({.data = number, .origin = set_in_program})) {}
Value::Value(Whole whole) : Value(Access::made({.data = whole.number, .origin = set_in_program})) {
  if (whole.above_zero && whole.number < 0)  // it was unsigned, and wrapped
    throw InputError("value", std::to_string(static_cast<std::uint64_t>(whole.number)),
                     "a whole number of at most 9223372036854775807");
}
Value::Value(const char* text) {
  if (text == nullptr) throw InputError("value", "a null pointer", "a text");
  *this = std::string(text);
}
Value::Value(std::string text)
    : Value(Access::made({.data = utf8(text), .origin = set_in_program})) {}
Value::Value(const std::vector<double>& numbers) : Value(Access::made(list_of(numbers))) {}
Value::Value(const std::array<double, 3>& vector) : Value(Access::made(list_of(vector))) {}
Value::Value(const std::vector<std::string>& texts)
    : Value(std::vector<Value>(texts.begin(), texts.end())) {}
Value::Value(const std::vector<Value>& items) {
  TomlValue::Array array;
  for (const Value& item : items) array.push_back(Access::given(item));
  *this = Access::made({.data = std::move(array), .origin = set_in_program});
}

Value Value::list(std::initializer_list<Value> items) { return Value(std::vector<Value>(items)); }

Value Value::table(std::initializer_list<std::pair<std::string_view, Value>> entries) {
  Value result = Access::made({.data = TomlValue::Table{}, .origin = set_in_program});
  for (const auto& [key, value] : entries) result.set(key, value);
  return result;
}

Value::Kind Value::kind() const noexcept {
  return static_cast<Kind>(Access::tree(*this).data.index());  // as TomlValue has them
}

bool Value::flag() const { return held<bool>(Access::tree(*this), "true or false"); }
std::int64_t Value::whole() const {
  return held<std::int64_t>(Access::tree(*this), "a whole number");
}
double Value::number() const { return number_in(Access::tree(*this)); }
std::string Value::text() const { return held<std::string>(Access::tree(*this), "a text"); }

std::vector<double> Value::numbers() const {
  std::vector<double> result;
  for (const TomlValue& item : held<TomlValue::Array>(Access::tree(*this), "a list of numbers"))
    result.push_back(number_in(item));
  return result;
}

std::size_t Value::size() const {
  if (const TomlValue::Table* table = Access::tree(*this).table()) return table->size();
  return held<TomlValue::Array>(Access::tree(*this), "a list or a table").size();
}

Value Value::at(std::size_t index) const {
  const auto& items = held<TomlValue::Array>(Access::tree(*this), "a list");
  if (index >= items.size())
    throw InputError("index", std::to_string(index),
                     "one below " + std::to_string(items.size()) + ", the list's size");
  return Access::made(items[index]);
}

Value Value::at(std::string_view key) const {
  static_cast<void>(held<TomlValue::Table>(Access::tree(*this), "a table"));
  const TomlValue* found = Access::tree(*this).find(key);
  if (found == nullptr) throw InputError("key", '"' + std::string(key) + '"', "a key of the table");
  return Access::made(*found);
}

bool Value::has(std::string_view key) const { return Access::tree(*this).find(key) != nullptr; }

std::vector<std::string> Value::keys() const {
  std::vector<std::string> result;
  for (const detail::TomlEntry& entry : held<TomlValue::Table>(Access::tree(*this), "a table"))
    result.push_back(entry.key);
  return result;
}

Value& Value::set(std::string_view key, const Value& value) {
  TomlValue table = Access::tree(*this);
  static_cast<void>(held<TomlValue::Table>(table, "a table"));
  detail::set_key(table, utf8(key), Access::given(value));
  return *this = Access::made(std::move(table));
}

std::string Value::to_toml() const { return detail::inline_toml(Access::tree(*this)); }

}  // namespace asdic
