#include "io/settings/reader.h"

#include <algorithm>
#include <cassert>
#include <cstdio>
#include <utility>

#include "core/quantities.h"
#include "core/text.h"
#include "core/unit_text.h"
#include "io/settings/axis.h"
#include "io/settings/columns.h"
#include "io/wav/wav.h"

namespace asdic::detail {
namespace {

/// Of 12 digits, so that degrees look as they were written.
std::string shown_number(double value) {
  char text[32] = {};
  std::snprintf(text, sizeof text, "%.12g", value);
  return text;
}

}  // namespace

/// The key of a setting as the file has it: an angle's in degrees or radians. \param key  "a[3]",
/// "heading" or "heading_deg"
std::string TomlReader::written_key(std::string_view key) const {
  const auto bracket = std::min(key.find('['), key.size());
  std::string name(key.substr(0, bracket));
  const std::string place(key.substr(bracket));
  const std::string as_given = name + place;
  if (name.ends_with("_deg")) name.resize(name.size() - 4);
  for (const char* unit : {"", "_deg", "_rad"})
    if (table_->has_quietly(name + unit)) return name + unit + place;
  return as_given;
}

void TomlReader::fault(std::string_view key, const std::string& expected,
                       std::optional<std::string> got) {
  throw table_->fault(written_key(key), expected, std::move(got));
}

bool TomlReader::finds(std::string_view key) const { return table_->has(std::string(key)); }

void TomlReader::know(std::string_view setting, double value) {
  known_.numbers.insert_or_assign(std::string(setting), value);
}

double TomlReader::known(std::string_view setting) const {
  const auto found = known_.numbers.find(setting);
  assert(found != known_.numbers.end());  // a struct refers to what is read before it
  return found->second;
}

/// Whether the word that says "none" of a setting stands there.
bool TomlReader::is_word(const SettingKey& key) {
  const std::string name(key.name);
  if (key.word.empty() || !table_->is_text(name)) return false;
  static_cast<void>(table_->choice(name, {std::string(key.word)}));
  return true;
}

/// Whether a setting stays as it is, since the file has none and need not. \param given  as
/// number()
bool TomlReader::absent(const SettingKey& key, const std::string& name, bool* given) {
  if (!key.word.empty()) {  // what is not there stays as it is
    assert(given != nullptr);
    if (!table_->has(name)) return true;
    *given = !is_word(key);
    return !*given;
  }
  const bool here = (given != nullptr || !key.required) && table_->has(name);
  if (given != nullptr) *given = here;
  return !here && (given != nullptr || !key.required);
}

/// "heading_deg", or "heading_rad" where the file has that.
std::string TomlReader::angle_key(std::string_view name) {
  const std::string degrees = std::string(name) + "_deg", radians = std::string(name) + "_rad";
  if (!table_->has_quietly(radians)) return degrees;
  if (table_->has(degrees))
    throw table_->fault(radians, "no " + in_quotes(radians) + " beside " + degrees);
  return radians;
}

void TomlReader::note_value(const SettingKey& key, const std::string& name,
                            const std::string& value, const Quantity& q) const {
  NotedSetting setting{
      .key = name, .value = value, .unit = unit_of(q), .given = table_->has_quietly(name)};
  if (value.empty()) {
    setting.value = !key.word.empty()        ? in_quotes(key.word)
                    : !key.otherwise.empty() ? std::string(key.otherwise)
                                             : "none";
    setting.unit.clear();
  }
  table_->note(std::move(setting));
}

void TomlReader::note_values(const SettingKey& key, const std::string& name,
                             std::span<const double> values, const Quantity& q) const {
  if (!table_->is_noted()) return;
  constexpr std::size_t most = 8;  // of a longer list the first ones and the last
  const std::size_t shown = values.size() > most ? 3 : values.size();
  std::string text;
  for (std::size_t i = 0; i < shown; ++i) text += (i == 0 ? "[" : ", ") + shown_number(values[i]);
  if (shown < values.size())
    text =
        std::to_string(values.size()) + " values, " + text + ", … " + shown_number(values.back());
  note_value(key, name, text.empty() ? text : text + "]", q);
}

void TomlReader::number(const Setting& s, const Quantity& q, double& value, bool* given) {
  const std::string key(s.key.name);
  if (!s.key.inherits.empty()) value = known(s.key.inherits);
  if (!absent(s.key, key, given)) value = table_->number(key, q);
  if (!table_->is_noted()) return;
  // A value that no file could say stands for what others decide.
  const bool there = (given == nullptr || *given) && (s.key.otherwise.empty() || q.holds(value));
  note_value(s.key, key, there ? shown_number(value) : "", q);
}

void TomlReader::angle(const Setting& s, const AngleQuantity& q, double& value, bool* given) {
  const std::string key = angle_key(s.key.name);
  const bool ready = key.ends_with("_rad");
  if (!absent(s.key, key, given))
    value =
        ready ? table_->number(key, q.in_radians()) : radians(table_->number(key, q.in_degrees()));
  if (table_->is_noted())
    note_value(s.key, key,
               given == nullptr || *given ? shown_number(ready ? value : degrees(value)) : "",
               ready ? q.in_radians() : q.in_degrees());
}

void TomlReader::integer(const Setting& s, std::int64_t low, std::int64_t high, std::int64_t& value,
                         bool* given) {
  const std::string key(s.key.name);
  if (!absent(s.key, key, given)) value = table_->integer(key, low, high);
  if (!table_->is_noted()) return;
  const bool there = (given == nullptr || *given) && (s.key.otherwise.empty() || value != high);
  note_value(s.key, key, there ? std::to_string(value) : "");
}

void TomlReader::flag(const Setting& s, bool& value) {
  const std::string key(s.key.name);
  value = table_->flag(key, value);
  if (table_->is_noted()) note_value(s.key, key, value ? "true" : "false");
}

void TomlReader::text(const Setting& s, std::string& value) {
  const std::string key(s.key.name);
  if (!absent(s.key, key, nullptr)) value = table_->text(key);
  if (table_->is_noted()) note_value(s.key, key, in_quotes(value));
}

void TomlReader::numbers(const Setting& s, const Quantity& q, std::vector<double>& values) {
  const std::string key(s.key.name);
  if (!absent(s.key, key, nullptr)) values = table_->numbers(key, q);
  note_values(s.key, key, values, q);
}

void TomlReader::angles(const Setting& s, const AngleQuantity& q, std::vector<double>& values) {
  const std::string key = angle_key(s.key.name);
  const bool ready = key.ends_with("_rad");
  const Quantity as_written = ready ? q.in_radians() : q.in_degrees();
  if (absent(s.key, key, nullptr)) {
    std::vector<double> shown = values;
    std::transform(shown.begin(), shown.end(), shown.begin(), degrees);
    return note_values(s.key, key, shown, as_written);
  }
  values = table_->numbers(key, as_written);
  note_values(s.key, key, values, as_written);
  if (!ready) std::transform(values.begin(), values.end(), values.begin(), radians);
}

void TomlReader::rows(const Setting& s, const Quantity& q,
                      std::vector<std::vector<double>>& values) {
  const std::string key(s.key.name);
  if (!absent(s.key, key, nullptr)) values = table_->rows(key, q);
  if (table_->is_noted())
    note_value(s.key, key,
               values.empty() ? ""
                              : std::to_string(values.size()) + " rows of " +
                                    std::to_string(values.front().size()),
               q);
}

void TomlReader::axis(SettingKey key, std::vector<double>& values, const Quantity& q,
                      std::string_view) {
  const std::string name(key.name);
  if (absent(key, name, nullptr)) return note_values(key, name, values, q);
  if (table_->is_array(name)) {
    values = table_->numbers(name, q);
  } else if (!table_->is_table(name)) {
    values = {table_->number(name, q)};
  } else {
    TomlTable even = table_->table(name);
    const double first = even.number("first", q), last = even.number("last", q);
    const auto count = even.integer("count", 1, most_on_an_axis);
    even.finish();
    values = evenly_spaced(first, last, static_cast<std::size_t>(count));
  }
  note_values(key, name, values, q);
}

void TomlReader::file(SettingKey key, std::string& path, std::string_view what, std::string_view) {
  const std::string name(key.name);
  if (absent(key, name, nullptr)) return;
  const std::filesystem::path found = known_.folder / table_->text(name);
  if (!std::filesystem::exists(found))
    throw table_->fault(name, std::string(what), "no such file " + in_quotes(found.string()));
  path = found.string();
  if (table_->is_noted()) note_value(key, name, in_quotes(path));
}

void TomlReader::vector(const Setting& s, const Quantity& q, std::span<double> value,
                        std::string_view axes) {
  const std::string key(s.key.name);
  if (!absent(s.key, key, nullptr)) table_->components(key, q, axes, value);
  note_values(s.key, key, value, q);
}

void TomlReader::vectors(const Setting& s, const Quantity& q, std::vector<Vec3>& values) {
  const std::string key(s.key.name);
  if (!absent(s.key, key, nullptr)) values = table_->vectors(key, q);
  if (table_->is_noted())
    note_value(s.key, key, values.empty() ? "" : std::to_string(values.size()) + " rows of 3", q);
}

void TomlReader::choice(const Setting& s, std::span<const std::string_view> words,
                        std::size_t& index) {
  const std::vector<std::string> names(words.begin(), words.end());
  std::optional<std::string> fallback;
  if (!s.key.required) fallback = names[index];
  const std::string key(s.key.name), chosen = table_->choice(key, names, fallback);
  if (table_->is_noted()) note_value(s.key, key, in_quotes(chosen));
  index = static_cast<std::size_t>(std::find(names.begin(), names.end(), chosen) - names.begin());
}

void TomlReader::reference(SettingKey key, int& index, std::string_view list, std::string_view) {
  const std::string name(key.name);
  const auto found = known_.names.find(list);
  assert(found != known_.names.end());  // a struct refers to what is read before it
  const std::vector<std::string>& names = found->second;
  const bool default_one = absent(key, name, nullptr);
  const std::string chosen =
      default_one ? names.at(static_cast<std::size_t>(index)) : table_->choice(name, names);
  if (table_->is_noted()) note_value(key, name, in_quotes(chosen));
  if (default_one) return;
  index = static_cast<int>(std::find(names.begin(), names.end(), chosen) - names.begin());
}

void TomlReader::columns(std::initializer_list<Column> all, const ColumnRules& rules) {
  const bool of_file = rules.file && table_->has("file");
  std::vector<std::pair<std::string, Quantity>> wanted;
  for (const Column& column : all) {
    std::string name(column.key);
    if (column.angle) name = of_file ? name + "_deg" : angle_key(name);
    const bool ready = column.angle && name.ends_with("_rad");
    wanted.emplace_back(name, ready ? column.in_radians() : column.quantity);
  }
  scenario::Columns found = of_file ? scenario::read_columns(*table_, known_.folder, wanted)
                                    : scenario::read_lists(*table_, wanted);
  if (rules.steps)
    scenario::require_not_falling(found);
  else if (rules.increasing)
    scenario::require_increasing(found);
  if (of_file && table_->is_noted()) note_value("file", "file", in_quotes(found.csv_file));
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (!of_file)
      note_values(wanted[i].first.c_str(), wanted[i].first, found.values[i], wanted[i].second);
  auto values = found.values.begin();
  auto name = found.names.begin();
  for (const Column& column : all) {
    *column.values = std::move(*values++);
    const bool degrees = (name++)->ends_with("_deg");
    if (column.angle && degrees)
      for (double& angle : *column.values) angle = radians(angle);
  }
}

void TomlReader::sound(SettingKey key, const Sound& sound, std::string_view what) {
  const std::string name(key.name);
  if (table_->has_quietly("samples")) {  // of a sound that was made and not recorded
    *sound.samples = table_->numbers("samples", quantity::sound_sample);
    *sound.sample_rate = table_->number("sample_rate", quantity::sound_rate);
    note_values("samples", "samples", *sound.samples, {});
    note_values("sample_rate", "sample_rate", {sound.sample_rate, 1}, {.unit = "Hz"});
    sound.file->clear();
    return;
  }
  if (absent(key, name, nullptr)) return;
  const std::filesystem::path path = known_.folder / table_->text(name);
  if (!std::filesystem::exists(path))
    throw table_->fault(name, "a WAV or CSV file of " + std::string(what),
                        "no such file " + in_quotes(path.string()));
  SampledPulse read = read_pulse_file(path);
  *sound.file = path.string();
  *sound.samples = std::move(read.samples);
  *sound.sample_rate = read.sample_rate;
  if (table_->is_noted()) note_value(key, name, in_quotes(*sound.file));
}

void TomlReader::excludes(std::string_view beside, std::initializer_list<std::string_view> keys) {
  for (const std::string_view key : keys)
    if (table_->has(std::string(key)))
      throw table_->fault(std::string(key),
                          "no " + in_quotes(key) + " beside " + std::string(beside));
}

void TomlReader::read(TomlTable& table, const Structure& inner) {
  TomlTable* const outer = std::exchange(table_, &table);
  inner.describe(*this);
  table_->finish();
  table_ = outer;
}

void TomlReader::table(const Setting& s, const Structure& inner) {
  TomlTable there = table_->table(std::string(s.key.name));
  read(there, inner);
}

void TomlReader::perhaps(const Setting& s, const Perhaps& inner) {
  const std::string key(s.key.name);
  if (!table_->has(key)) return inner.clear();
  inner.make();
  TomlTable there = table_->table(key);
  read(there, inner.get());
}

void TomlReader::number_or_table(const Setting& s, const Quantity& q, double& value,
                                 const Perhaps& instead) {
  if (table_->is_table(std::string(s.key.name))) return perhaps(s, instead);
  instead.clear();
  number(s, q, value, nullptr);
}

void TomlReader::tables(const Setting& s, const List& list, const ListRules& rules) {
  const std::string key(s.key.name);
  std::vector<TomlTable> all = rules.one_or_more ? table_->one_or_more(key) : table_->tables(key);
  if (s.key.required && all.empty()) throw table_->fault(key, "[[" + key + "]], one at least");
  list.resize(0);  // none keeps values of another one
  list.resize(all.size());
  std::vector<std::string> taken;
  const Naming outer = naming_;
  for (std::size_t i = 0; i < all.size(); ++i) {
    naming_ = {.noun = rules.named, .usual = std::string(rules.named), .taken = &taken};
    if (all.size() > 1) naming_.usual += " " + std::to_string(i + 1);
    read(all[i], list.at(i));
  }
  naming_ = outer;
  if (!rules.named.empty()) known_.names.insert_or_assign(key, std::move(taken));
}

void TomlReader::name(std::string& value, std::string_view) {
  assert(naming_.taken != nullptr);  // an element of a list that is ListRules::named
  value = table_->text("name", naming_.usual);
  if (table_->is_noted()) note_value("name", "name", in_quotes(value));
  std::vector<std::string>& taken = *naming_.taken;
  if (std::find(taken.begin(), taken.end(), value) != taken.end())
    throw table_->fault("name", "a name that no other " + std::string(naming_.noun) + " has");
  taken.push_back(value);
}

void TomlReader::alternatives(const Setting& s, const OneOf& one) {
  std::size_t index = one.index;
  choice(s, one.names, index);
  if (index != one.index) one.choose(index);
  one.chosen().describe(*this);  // its settings stand in this table
}

/// \throws InputError if a key of another way than the chosen one is there
void TomlReader::refuse_others(const Ways& ways, std::span<const std::string_view> keys) {
  for (const std::string_view key : keys) {
    const std::string other(key);
    if (std::find(ways.chosen.begin(), ways.chosen.end(), key) != ways.chosen.end()) continue;
    if (table_->has(other))
      throw table_->fault(other,
                          "no " + in_quotes(key) + " beside " + std::string(ways.chosen.front()));
  }
}

bool TomlReader::takes(Ways& ways, std::span<const std::string_view> keys, bool, bool last) {
  if (!ways.chosen.empty()) {
    refuse_others(ways, keys);
    return false;
  }
  if (!last && !table_->has(std::string(keys.front()))) {
    ways.passed.insert(ways.passed.end(), keys.begin(), keys.end());
    return false;
  }
  ways.chosen.assign(keys.begin(), keys.end());
  refuse_others(ways, ways.passed);
  return true;
}

}  // namespace asdic::detail
