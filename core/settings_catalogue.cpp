#include "core/settings_catalogue.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "core/quantities.h"
#include "core/text.h"
#include "core/unit_text.h"

namespace asdic::detail {
namespace {

using Type = SettingRecord::Type;

/// Of 12 digits, as someone would write it: 28.6478897565.
std::string rounded(double value) {
  char text[32] = {};
  std::snprintf(text, sizeof text, "%.12g", value);
  return to_text(std::strtod(text, nullptr));
}

/// The same as a file would have it; "" where others decide.
std::string list_of(std::span<const double> values) {
  for (const double value : values)
    if (!std::isfinite(value)) return "";
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
    text = (q.or_zero ? "0, or " : "") + to_text(q.low) + " to " + to_text(q.high);
  else if (low)
    text = (q.above ? "above " : "at least ") + to_text(q.low);
  else if (high)
    text = "at most " + to_text(q.high);
  if (!q.unit.empty()) text += (text.empty() ? "" : " ") + unit_of(q);
  return text;
}

constexpr std::string_view file_key = "file";
std::string with_range(const std::string& what, const Quantity& q) {
  const std::string range = range_of(q);
  return range.empty() ? what : what + ", " + range;
}

}  // namespace

std::vector<SettingCondition> SettingsCatalogue::conditions() const {
  std::vector<SettingCondition> all;
  for (const Told& one : conditions_) all.push_back(one.condition);
  return all;
}

SettingRecord& SettingsCatalogue::add(const SettingKey& key, std::string_view help, Type type,
                                      std::string standard) {
  const bool decided = !key.inherits.empty() || !key.otherwise.empty();
  const bool required = key.required && !decided;
  list_.settings.push_back({.path = place_ + std::string(key.name),
                            .type = type,
                            .standard = required || decided ? "" : std::move(standard),
                            .inherits = std::string(key.inherits),
                            .otherwise = std::string(key.otherwise),
                            .help = std::string(help),
                            .conditions = conditions(),
                            .required = required,
                            .live = key.live});
  SettingRecord& made = list_.settings.back();
  for (const Told& one : conditions_) {
    const bool itself = one.condition.there && one.condition.place + one.condition.key == made.path;
    if (itself) made.required = false;  // nothing else tells that it is there
    if (!itself && !one.text.empty())
      made.condition += (made.condition.empty() ? "" : ", ") + one.text;
  }
  if (!key.word.empty()) made.words = {std::string(key.word)};
  if (!key.word.empty() && made.standard.empty() && !decided) made.standard = in_quotes(key.word);
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
  made.angle = true;
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
  made.angle = true;
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
  const std::string of = "of " + std::string(what);
  Ways ways;
  if (const auto way = this->way(ways, {"samples", "sample_rate"}, false)) {
    add(required("samples"), of + " as a program made it, in place of a file", Type::numbers, "")
        .quantity = quantity::sound_sample;
    add(required("sample_rate"), of, Type::number, "").quantity = quantity::sound_rate;
  }
  if (const auto way = otherwise(ways, {key.name}))
    add(key, "a WAV or CSV file " + of, Type::text, "");
}

void SettingsCatalogue::rows(const Setting& s, const Quantity& q,
                             std::vector<std::vector<double>>&) {
  add(s.key, s.help, Type::rows, "").quantity = q;
}

void SettingsCatalogue::columns(std::initializer_list<Column> all, const ColumnRules& rules) {
  const bool by_file = rules.file && !conditions_.empty() && conditions_.back().condition.there &&
                       conditions_.back().condition.key == file_key;
  if (by_file) {  // a way of its own
    add(required(file_key), "a CSV of these columns", Type::text, "");
    return;
  }
  if (rules.file)
    conditions_.push_back({{.place = place_, .key = "", .absent = {std::string(file_key)}}, ""});
  for (const Column& column : all) {
    SettingRecord& made = add(required(column.key), column.help, Type::numbers, "");
    if (column.angle) made.path += "_deg";
    made.angle = column.angle;
    made.quantity = column.quantity;
  }
  if (!rules.file) return;
  conditions_.pop_back();
  add(file_key, "in place of these columns: a CSV that has them", Type::text, "");
}

/// \param made  but for its path and what holds of every table
void SettingsCatalogue::within(const Setting& s, TableRecord made, const Structure& inner) {
  const std::string outer = place_;
  made.path = place_ + std::string(s.key.name) + (made.list ? "[]" : "");
  made.help = s.help;
  made.live = s.key.live;
  made.conditions = conditions();
  place_ = made.path + '.';
  list_.tables.push_back(std::move(made));
  inner.describe(*this);
  place_ = outer;
}

void SettingsCatalogue::table(const Setting& s, const Structure& inner) { within(s, {}, inner); }

void SettingsCatalogue::perhaps(const Setting& s, const Perhaps& inner) {
  if (!inner.present) inner.make();
  within(s, {.may_be_absent = true}, inner.get());
  if (!inner.present) inner.clear();
}

void SettingsCatalogue::number_or_table(const Setting& s, const Quantity& q, double& value,
                                        const Perhaps& instead) {
  number(s, q, value, nullptr);
  if (!instead.present) instead.make();
  within(s, {.may_be_absent = true, .in_place = true}, instead.get());
  if (!instead.present) instead.clear();
}

void SettingsCatalogue::tables(const Setting& s, const List& list, const ListRules& rules) {
  const std::size_t size = list.size();
  if (size == 0) list.resize(1);
  within(s,
         {.may_be_absent = !rules.one_or_more && !s.key.required,
          .list = true,
          .one_or_more = rules.one_or_more},
         list.at(0));
  list.resize(size);
}

void SettingsCatalogue::alternatives(const Setting& s, const OneOf& one) {
  std::size_t chosen = one.index;
  choice(s, one.names, chosen);
  for (std::size_t i = 0; i < one.names.size(); ++i) {
    if (chosen != i) one.choose(i);
    chosen = i;
    begin({.key = s.key.name, .words = one.names.subspan(i, 1)});
    one.chosen().describe(*this);
    end();
  }
  if (chosen != one.index) one.choose(one.index);
}

void SettingsCatalogue::excludes(std::string_view, std::initializer_list<std::string_view> keys) {
  list_.excluded.push_back(
      {.place = place_, .keys = {keys.begin(), keys.end()}, .conditions = conditions()});
}

bool SettingsCatalogue::takes(Ways& ways, std::span<const std::string_view> keys, bool, bool last) {
  absent_.assign(ways.passed.begin(), ways.passed.end());
  last_way_ = last;
  ways.passed.push_back(keys.front());
  return true;
}

void SettingsCatalogue::begin(const Condition& condition) {
  Told told{{.place = place_,
             .key = std::string(condition.key),
             .words = {condition.words.begin(), condition.words.end()},
             .other = condition.other},
            ""};
  if (condition.words.empty()) {
    told.condition.there = !last_way_;
    told.condition.absent = absent_;
    std::string others;
    for (const std::string& one : absent_) others += (others.empty() ? "" : " and ") + one;
    told.text = last_way_ ? "without " + others : "with " + told.condition.key;
  } else {
    std::string words;
    for (const std::string& one : told.condition.words)
      words += (words.empty() ? "" : " or ") + in_quotes(one);
    told.text = told.condition.key + (condition.other ? " other than " : " = ") + words;
  }
  absent_.clear();  // of a way alone, which begins as soon as it is taken
  last_way_ = false;
  conditions_.push_back(std::move(told));
}

void SettingsCatalogue::end() { conditions_.pop_back(); }

SettingsList below(const SettingsList& list, std::string_view path) {
  // "array.kind" and "array[].kind" are "kind" of "array".
  const auto rest = [&](std::string_view whole) -> std::optional<std::string> {
    if (!whole.starts_with(path)) return std::nullopt;
    whole.remove_prefix(path.size());
    if (whole.starts_with("[]")) whole.remove_prefix(2);
    if (!whole.starts_with('.')) return std::nullopt;
    return std::string(whole.substr(1));
  };
  const auto within = [&](const std::vector<SettingCondition>& all) {
    std::vector<SettingCondition> kept;
    for (const SettingCondition& one : all)
      if (const auto place = rest(one.place)) {
        kept.push_back(one);
        kept.back().place = *place;
      }
    return kept;
  };
  SettingsList found;
  const auto add = [&](const auto& from, auto& to, auto member) {
    for (const auto& one : from)
      if (const auto inner = rest(one.*member)) {
        to.push_back(one);
        to.back().*member = *inner;
        to.back().conditions = within(one.conditions);
      }
  };
  add(list.settings, found.settings, &SettingRecord::path);
  add(list.tables, found.tables, &TableRecord::path);
  add(list.excluded, found.excluded, &KeysExcluded::place);
  return found;
}

std::string domain_of(const SettingRecord& record) {
  const std::string other = record.words.empty() ? "" : " or `" + record.words.front() + "`";
  switch (record.type) {
    case Type::number:
      return range_of(record.quantity) +
             (record.quantity.unit == "bytes" ? R"(, or a text: "4 GB")" : "") + other;
    case Type::whole_number: {
      Quantity q = record.quantity;
      if (q.high >= std::numeric_limits<std::int32_t>::max()) q.high = infinity;  // of the type
      return with_range("whole", q) + other;
    }
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
