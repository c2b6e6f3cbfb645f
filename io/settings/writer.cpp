#include "io/settings/writer.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <filesystem>

#include "core/error.h"
#include "io/settings/axis.h"
#include "io/text/toml_writer.h"

namespace asdic::detail {
namespace {

bool is_zero(double value) { return value == 0.0 && !std::signbit(value); }

TomlValue::Array array_of(std::span<const double> values) {
  TomlValue::Array items(values.size());
  for (std::size_t i = 0; i < items.size(); ++i) items[i].data = values[i];
  return items;
}

/// The number that exact_degrees() writes. \return false if there is none
bool in_exact_degrees(double radians, double& degrees) {
  const std::string text = exact_degrees(radians);
  if (!text.empty()) degrees = std::stod(text);
  return !text.empty();
}

}  // namespace

void TreeWriter::know(std::string_view setting, double value) {
  known_.numbers.insert_or_assign(std::string(setting), value);
}

double TreeWriter::known(std::string_view setting) const {
  const auto found = known_.numbers.find(setting);
  return found == known_.numbers.end() ? 0.0 : found->second;
}

void TreeWriter::add(std::string_view key, decltype(TomlValue::data) value) {
  table_->push_back({std::string(key), {.data = std::move(value), .origin = ""}});
}

void TreeWriter::add_list(std::string_view key, std::span<const double> values) {
  if (!values.empty()) add(key, array_of(values));
}

void TreeWriter::add_angles(std::string_view name, std::span<const double> radians) {
  std::vector<double> degrees(radians.size());
  bool exact = true;
  for (std::size_t i = 0; i < degrees.size() && exact; ++i)
    exact = in_exact_degrees(radians[i], degrees[i]);
  const std::string key(name);
  exact ? add_list(key + "_deg", degrees) : add_list(key + "_rad", radians);
}

/// Whether there is no value to write: the word that says so is written here.
bool TreeWriter::absent(const SettingKey& key, const bool* given) {
  if (given == nullptr || *given) return false;
  if (!key.word.empty() && !key.seldom) add(key.name, std::string(key.word));
  return true;
}

void TreeWriter::remark(std::string_view text) { add(text, std::monostate{}); }

void TreeWriter::number(const Setting& s, const Quantity&, double& value, bool* given) {
  if (!absent(s.key, given) && !(s.key.seldom && is_zero(value))) add(s.key.name, value);
}

void TreeWriter::angle(const Setting& s, const AngleQuantity&, double& radians, bool* given) {
  if (absent(s.key, given) || (s.key.seldom && is_zero(radians))) return;
  const std::string name(s.key.name);
  double degrees = 0.0;
  in_exact_degrees(radians, degrees) ? add(name + "_deg", degrees) : add(name + "_rad", radians);
}

void TreeWriter::integer(const Setting& s, std::int64_t, std::int64_t, std::int64_t& value,
                         bool* given) {
  if (!absent(s.key, given) && !(s.key.seldom && value == 0)) add(s.key.name, value);
}

void TreeWriter::flag(const Setting& s, bool& value) {
  if (value || !s.key.seldom) add(s.key.name, value);
}

void TreeWriter::text(const Setting& s, std::string& value) {
  if (!value.empty() || !s.key.seldom) add(s.key.name, value);
}

void TreeWriter::numbers(const Setting& s, const Quantity&, std::vector<double>& values) {
  add_list(s.key.name, values);
}

void TreeWriter::angles(const Setting& s, const AngleQuantity&, std::vector<double>& radians) {
  add_angles(s.key.name, radians);
}

void TreeWriter::rows(const Setting& s, const Quantity&, std::vector<std::vector<double>>& values) {
  TomlValue::Array all;
  for (const std::vector<double>& row : values)
    all.push_back({.data = array_of(row), .origin = ""});
  if (!all.empty()) add(s.key.name, std::move(all));
}

void TreeWriter::axis(SettingKey key, std::vector<double>& values, const Quantity&,
                      std::string_view) {
  if (!are_evenly_spaced(values)) return add_list(key.name, values);
  const auto entry = [](const char* name, decltype(TomlValue::data) value) {
    return TomlEntry{name, {.data = std::move(value), .origin = ""}};
  };
  add(key.name, TomlValue::Table{entry("first", values.front()), entry("last", values.back()),
                                 entry("count", static_cast<std::int64_t>(values.size()))});
  table_->back().value.in_line = true;
}

void TreeWriter::file(SettingKey key, std::string& path, std::string_view, std::string_view) {
  if (!path.empty()) add(key.name, std::filesystem::absolute(path).string());
}

void TreeWriter::sound(SettingKey key, const Sound& sound, std::string_view what) {
  if (!sound.file->empty()) return file(key, *sound.file, what, "");
  constexpr std::size_t most = 1 << 20;
  if (sound.samples->size() > most)
    throw InputError({.where = std::string(key.name),
                      .got = std::to_string(sound.samples->size()) + " samples",
                      .expected = "at most " + std::to_string(most) + " samples of " +
                                  std::string(what) + ", or a file that has them"});
  add_list("samples", *sound.samples);
  add("sample_rate", *sound.sample_rate);
}

void TreeWriter::vector(const Setting& s, const Quantity&, std::span<double> value,
                        std::string_view) {
  add_list(s.key.name, value);
}

void TreeWriter::vectors(const Setting& s, const Quantity&, std::vector<Vec3>& values) {
  TomlValue::Array all;
  for (const Vec3& value : values)
    all.push_back({.data = array_of({value.data(), 3}), .origin = ""});
  if (!all.empty()) add(s.key.name, std::move(all));
}

void TreeWriter::choice(const Setting& s, std::span<const std::string_view> words,
                        std::size_t& index) {
  if (index != 0 || !s.key.seldom) add(s.key.name, std::string(words[index]));
}

void TreeWriter::columns(std::initializer_list<Column> all, const ColumnRules&) {
  for (const Column& column : all)
    column.angle ? add_angles(column.key, *column.values) : add_list(column.key, *column.values);
}

/// Of several elements with one name all but the first get a number: files tell them apart.
void TreeWriter::name(std::string& value, std::string_view) {
  assert(names_ != nullptr);  // an element of a list that is ListRules::named
  const std::string own = value.empty() ? usual_name_ : value;
  const auto taken = [&](const std::string& one) {
    return std::find(names_->begin(), names_->end(), one) != names_->end();
  };
  std::string given = own;
  for (int number = 2; taken(given); ++number) given = own + " " + std::to_string(number);
  names_->push_back(given);
  add("name", given);
}

void TreeWriter::reference(SettingKey key, int& index, std::string_view list, std::string_view) {
  const auto found = known_.names.find(list);
  assert(found != known_.names.end());  // a struct refers to what is written before it
  const auto i = static_cast<std::size_t>(index);
  if (index >= 0 && i < found->second.size()) add(key.name, found->second[i]);
}

/// A struct in a table of its own.
TomlValue TreeWriter::written(const Structure& inner) {
  TomlValue::Table there;
  TomlValue::Table* const outer = std::exchange(table_, &there);
  inner.describe(*this);
  table_ = outer;
  return {.data = std::move(there), .origin = ""};
}

void TreeWriter::table(const Setting& s, const Structure& inner) {
  TomlValue there = written(inner);
  if (!std::get<TomlValue::Table>(there.data).empty()) add(s.key.name, std::move(there.data));
}

void TreeWriter::perhaps(const Setting& s, const Perhaps& inner) {
  if (inner.present) add(s.key.name, written(inner.get()).data);
}

void TreeWriter::number_or_table(const Setting& s, const Quantity& q, double& value,
                                 const Perhaps& instead) {
  instead.present ? perhaps(s, instead) : number(s, q, value, nullptr);
}

void TreeWriter::tables(const Setting& s, const List& list, const ListRules& rules) {
  TomlValue::Array all;
  std::vector<std::string> names;
  std::vector<std::string>* const outer_names = std::exchange(names_, &names);
  const std::string outer_usual = usual_name_;
  for (std::size_t i = 0; i < list.size(); ++i) {
    usual_name_ = std::string(rules.named);
    if (list.size() > 1) usual_name_ += " " + std::to_string(i + 1);
    all.push_back(written(list.at(i)));
  }
  names_ = outer_names;
  usual_name_ = outer_usual;
  if (!all.empty()) add(s.key.name, std::move(all));
  if (!rules.named.empty())
    known_.names.insert_or_assign(std::string(s.key.name), std::move(names));
}

void TreeWriter::alternatives(const Setting& s, const OneOf& one) {
  add(s.key.name, std::string(one.names[one.index]));
  one.chosen().describe(*this);  // its settings stand in this table
}

namespace {

bool is_table_of_its_own(const TomlValue& value) {
  return value.table() != nullptr && !value.in_line;
}

bool are_tables(const TomlValue& value) {
  const auto* items = std::get_if<TomlValue::Array>(&value.data);
  return items != nullptr && !items->empty() &&
         std::all_of(items->begin(), items->end(), is_table_of_its_own);
}

bool is_array(const TomlValue& value) {
  return std::holds_alternative<TomlValue::Array>(value.data);
}

/// Numbers as many as fit on a line; of rows, one a line.
std::string array_text(const TomlValue::Array& items) {
  const std::size_t most = std::any_of(items.begin(), items.end(), is_array) ? 1 : most_in_a_line;
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i)
    text += (i == 0 ? "" : i % most == 0 ? ",\n  " : ", ") + inline_toml(items[i]);
  return "[" + text + "]";
}

std::string in_line_text(const TomlValue::Table& entries) {
  std::string text;
  for (const TomlEntry& entry : entries)
    text += (text.empty() ? "" : ", ") + toml_key(entry.key) + " = " + inline_toml(entry.value);
  return "{ " + text + " }";
}

void print_values(TomlWriter& out, const TomlValue::Table& table) {
  for (const auto& [key, value] : table) {
    if (is_table_of_its_own(value) || are_tables(value)) continue;
    if (std::holds_alternative<std::monostate>(value.data))
      out.comment(key);
    else if (const auto* items = std::get_if<TomlValue::Array>(&value.data))
      out.line(toml_key(key), array_text(*items));
    else if (const auto* entries = value.table())
      out.line(toml_key(key), in_line_text(*entries));
    else
      out.line(toml_key(key), inline_toml(value));
  }
}

/// \param path  of the table, with a point at its end; "" for the document
void print_table(TomlWriter& out, const TomlValue::Table& table, const std::string& path) {
  print_values(out, table);
  for (const auto& [key, value] : table) {
    const std::string name = path + toml_key(key);
    if (is_table_of_its_own(value)) {
      out.table(name);
      print_table(out, *value.table(), name + ".");
    } else if (are_tables(value)) {
      for (const TomlValue& item : std::get<TomlValue::Array>(value.data)) {
        out.array_table(name);
        print_table(out, *item.table(), name + ".");
      }
    }
  }
}

}  // namespace

std::string print_toml(const TomlValue& tree) {
  assert(tree.table() != nullptr);
  TomlWriter out;
  print_table(out, *tree.table(), "");
  return out.str();
}

}  // namespace asdic::detail
