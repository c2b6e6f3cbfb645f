#include "core/settings_catalogue.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "core/text.h"

namespace asdic::detail {
namespace {

using Type = SettingRecord::Type;

/// Of 12 digits, as someone would write it: 28.6478897565.
std::string rounded(double value) {
  char text[32] = {};
  std::snprintf(text, sizeof text, "%.12g", value);
  return to_text(std::strtod(text, nullptr));
}

std::string list_of(std::span<const double> values) {
  std::string text = "[";
  for (const double value : values) text += (text.size() > 1 ? ", " : "") + to_text(value);
  return text + "]";
}

/// "0 to 600 m/s"; "" where anything goes and there is no unit.
std::string range_of(const Quantity& q) {
  const bool low = std::isfinite(q.low), high = std::isfinite(q.high);
  std::string text;
  if (low && high && q.above)
    text = "above " + to_text(q.low) + ", to " + to_text(q.high);
  else if (low && high)
    text = to_text(q.low) + " to " + to_text(q.high);
  else if (low)
    text = (q.above ? "above " : "at least ") + to_text(q.low);
  else if (high)
    text = "at most " + to_text(q.high);
  if (!q.unit.empty()) text += (text.empty() ? "" : " ") + std::string(q.unit);
  return text;
}

std::string with_range(const std::string& what, const Quantity& q) {
  const std::string range = range_of(q);
  return range.empty() ? what : what + ", " + range;
}

}  // namespace

SettingRecord& SettingsCatalogue::add(const SettingKey& key, std::string_view help, Type type,
                                      std::string standard) {
  std::string condition;
  for (const std::string& one : conditions_) condition += (condition.empty() ? "" : ", ") + one;
  records_.push_back({.path = place_ + std::string(key.name),
                      .type = type,
                      .standard = key.required || !key.inherits.empty() ? "" : std::move(standard),
                      .inherits = std::string(key.inherits),
                      .help = std::string(help),
                      .condition = std::move(condition),
                      .required = key.required,
                      .live = key.live});
  SettingRecord& made = records_.back();
  if (!key.word.empty()) made.words = {std::string(key.word)};
  if (!key.word.empty() && made.standard.empty()) made.standard = in_quotes(key.word);
  return made;
}

void SettingsCatalogue::number(const Setting& s, const Quantity& q, double& value, bool* given) {
  const bool there = (given == nullptr || *given) && !std::isnan(value);
  add(s.key, s.help, Type::number, there ? to_text(value) : "").quantity = q;
}

void SettingsCatalogue::angle(const Setting& s, const AngleQuantity& q, double& radians,
                              bool* given) {
  const bool there = given == nullptr || *given;
  SettingRecord& made = add(s.key, s.help, Type::number, there ? rounded(degrees(radians)) : "");
  made.path += "_deg";
  made.quantity = q.in_degrees();
}

void SettingsCatalogue::integer(const Setting& s, std::int64_t low, std::int64_t high,
                                std::int64_t& value, bool* given) {
  const bool there = given == nullptr || *given;
  const double most =
      high == std::numeric_limits<std::int64_t>::max() ? infinity : static_cast<double>(high);
  add(s.key, s.help, Type::whole_number, there ? std::to_string(value) : "").quantity = {
      .noun = "number", .low = static_cast<double>(low), .high = most};
}

void SettingsCatalogue::flag(const Setting& s, bool& value) {
  add(s.key, s.help, Type::flag, value ? "true" : "false");
}

void SettingsCatalogue::text(const Setting& s, std::string& value) {
  add(s.key, s.help, Type::text, value.empty() ? "" : in_quotes(value));
}

void SettingsCatalogue::name(std::string& value, std::string_view help) {
  add("name", help, Type::text, value.empty() ? "" : in_quotes(value));
}

void SettingsCatalogue::reference(SettingKey key, int&, std::string_view list,
                                  std::string_view help) {
  add(key, help, Type::reference, "the first").words = {std::string(list)};
}

void SettingsCatalogue::numbers(const Setting& s, const Quantity& q, std::vector<double>& values) {
  add(s.key, s.help, Type::numbers, values.empty() ? "" : list_of(values)).quantity = q;
}

void SettingsCatalogue::angles(const Setting& s, const AngleQuantity& q,
                               std::vector<double>& radians) {
  std::string standard;
  for (const double angle : radians)
    standard += (standard.empty() ? "[" : ", ") + rounded(degrees(angle));
  SettingRecord& made =
      add(s.key, s.help, Type::numbers, standard.empty() ? standard : standard + "]");
  made.path += "_deg";
  made.quantity = q.in_degrees();
}

void SettingsCatalogue::vector(const Setting& s, const Quantity& q, std::span<double> value,
                               std::string_view) {
  SettingRecord& made = add(s.key, s.help, Type::vector, list_of(value));
  made.quantity = q;
  made.length = value.size();
}

void SettingsCatalogue::vectors(const Setting& s, const Quantity& q, std::vector<Vec3>&) {
  SettingRecord& made = add(s.key, s.help, Type::vectors, "");
  made.quantity = q;
  made.length = 3;
}

void SettingsCatalogue::choice(const Setting& s, std::span<const std::string_view> words,
                               std::size_t& index) {
  add(s.key, s.help, Type::word, in_quotes(words[index])).words.assign(words.begin(), words.end());
}

void SettingsCatalogue::axis(SettingKey key, std::vector<double>& values, const Quantity& q,
                             std::string_view help) {
  add(key, help, Type::axis, values.empty() ? "" : list_of(values)).quantity = q;
}

void SettingsCatalogue::file(SettingKey key, std::string&, std::string_view what,
                             std::string_view help) {
  add(key, std::string(help) + (help.empty() ? "" : ": ") + std::string(what), Type::text, "");
}

void SettingsCatalogue::sound(SettingKey key, const Sound&, std::string_view what) {
  add(key, "a WAV or CSV file of " + std::string(what), Type::text, "");
}

void SettingsCatalogue::rows(const Setting& s, const Quantity& q,
                             std::vector<std::vector<double>>&) {
  add(s.key, s.help, Type::rows, "").quantity = q;
}

void SettingsCatalogue::columns(std::initializer_list<Column> all, const ColumnRules& rules,
                                std::string_view help) {
  for (const Column& column : all) {
    SettingRecord& made = add(required(column.key), help, Type::numbers, "");
    if (column.angle) made.path += "_deg";
    made.quantity = column.quantity;
  }
  if (rules.file) add("file", "instead: a CSV of these columns", Type::text, "");
}

void SettingsCatalogue::within(const std::string& place, const Structure& inner) {
  const std::string outer = place_;
  place_ += place + '.';
  inner.describe(*this);
  place_ = outer;
}

void SettingsCatalogue::table(const Setting& s, const Structure& inner) {
  within(std::string(s.key.name), inner);
}

void SettingsCatalogue::perhaps(const Setting& s, const Perhaps& inner) {
  if (!inner.present) inner.make();
  within(std::string(s.key.name), inner.get());
  if (!inner.present) inner.clear();
}

void SettingsCatalogue::number_or_table(const Setting& s, const Quantity& q, double& value,
                                        const Perhaps& instead) {
  number(s, q, value, nullptr);
  perhaps(s, instead);
}

void SettingsCatalogue::tables(const Setting& s, const List& list, const ListRules&) {
  const std::size_t size = list.size();
  if (size == 0) list.resize(1);
  within(std::string(s.key.name) + "[]", list.at(0));
  list.resize(size);
}

void SettingsCatalogue::alternatives(const Setting& s, const OneOf& one) {
  std::size_t chosen = one.index;
  choice(s, one.names, chosen);
  for (std::size_t i = 0; i < one.names.size(); ++i) {
    if (chosen != i) one.choose(i);
    chosen = i;
    begin(s.key.name, one.names[i]);
    one.chosen().describe(*this);
    end();
  }
  if (chosen != one.index) one.choose(one.index);
}

void SettingsCatalogue::begin(std::string_view key, std::string_view word) {
  conditions_.push_back(word.empty() ? "with " + std::string(key)
                                     : std::string(key) + " = " + in_quotes(word));
}

void SettingsCatalogue::end() { conditions_.pop_back(); }

std::string domain_of(const SettingRecord& record) {
  const std::string other = record.words.empty() ? "" : " or `" + record.words.front() + "`";
  switch (record.type) {
    case Type::number:
      return range_of(record.quantity) + other;
    case Type::whole_number:
      return with_range("whole", record.quantity) + other;
    case Type::flag:
      return "`true`, `false`";
    case Type::text:
      return "text";
    case Type::word: {
      std::string text;
      for (const std::string& word : record.words)
        text += (text.empty() ? "`" : ", `") + word + '`';
      return text;
    }
    case Type::numbers:
      return with_range("numbers", record.quantity);
    case Type::rows:
      return with_range("rows of numbers", record.quantity);
    case Type::axis:
      return with_range("a number, numbers, or { first, last, count }", record.quantity);
    case Type::vector:
      return with_range(std::to_string(record.length) + " numbers", record.quantity);
    case Type::vectors:
      return with_range("rows of " + std::to_string(record.length) + " numbers", record.quantity);
    case Type::reference:
      return "name of a " + record.words.front();
  }
  return "";
}

}  // namespace asdic::detail
