#include "io/settings/reader.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "core/text.h"
#include "io/scenario/columns.h"

namespace asdic {

void TomlReader::fault(std::string_view key, const std::string& expected,
                       std::optional<std::string> got) {
  throw table_->fault(std::string(key), expected, std::move(got));
}

void TomlReader::know(std::string_view setting, double value) {
  known_.numbers.insert_or_assign(std::string(setting), value);
}

double TomlReader::known(std::string_view setting) const {
  const auto found = known_.numbers.find(setting);
  assert(found != known_.numbers.end());  // a struct refers to what is read before it
  return found->second;
}

/// Whether a setting stays as it is, since the file has none and need not. \param given  as
/// number()
bool TomlReader::absent(const SettingKey& key, const std::string& name, bool* given) {
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

void TomlReader::number(const Setting& s, const Quantity& q, double& value, bool* given) {
  const std::string key(s.key.name);
  if (!s.key.inherits.empty()) value = known(s.key.inherits);
  if (!absent(s.key, key, given)) value = table_->number(key, q);
}

void TomlReader::angle(const Setting& s, const AngleQuantity& q, double& value, bool* given) {
  const std::string key = angle_key(s.key.name);
  if (absent(s.key, key, given)) return;
  value = key.ends_with("_rad") ? table_->number(key, q.in_radians())
                                : radians(table_->number(key, q.in_degrees()));
}

void TomlReader::integer(const Setting& s, std::int64_t low, std::int64_t high, std::int64_t& value,
                         bool* given) {
  const std::string key(s.key.name);
  if (!absent(s.key, key, given)) value = table_->integer(key, low, high);
}

void TomlReader::flag(const Setting& s, bool& value) {
  value = table_->flag(std::string(s.key.name), value);
}

void TomlReader::text(const Setting& s, std::string& value) {
  const std::string key(s.key.name);
  if (!absent(s.key, key, nullptr)) value = table_->text(key);
}

void TomlReader::numbers(const Setting& s, const Quantity& q, std::vector<double>& values) {
  const std::string key(s.key.name);
  if (!absent(s.key, key, nullptr)) values = table_->numbers(key, q);
}

void TomlReader::angles(const Setting& s, const AngleQuantity& q, std::vector<double>& values) {
  const std::string key = angle_key(s.key.name);
  if (absent(s.key, key, nullptr)) return;
  const bool ready = key.ends_with("_rad");
  values = table_->numbers(key, ready ? q.in_radians() : q.in_degrees());
  if (!ready) std::transform(values.begin(), values.end(), values.begin(), radians);
}

void TomlReader::vector(const Setting& s, const Quantity& q, std::span<double> value,
                        std::string_view axes) {
  const std::string key(s.key.name);
  if (!absent(s.key, key, nullptr)) table_->components(key, q, axes, value);
}

void TomlReader::vectors(const Setting& s, const Quantity& q, std::vector<Vec3>& values) {
  const std::string key(s.key.name);
  if (!absent(s.key, key, nullptr)) values = table_->vectors(key, q);
}

void TomlReader::choice(const Setting& s, std::span<const std::string_view> words,
                        std::size_t& index) {
  const std::vector<std::string> names(words.begin(), words.end());
  std::optional<std::string> fallback;
  if (!s.key.required) fallback = names[index];
  const std::string chosen = table_->choice(std::string(s.key.name), names, fallback);
  index = static_cast<std::size_t>(std::find(names.begin(), names.end(), chosen) - names.begin());
}

void TomlReader::reference(SettingKey key, int& index, std::string_view list, std::string_view) {
  const std::string name(key.name);
  if (absent(key, name, nullptr)) return;
  const auto found = known_.names.find(list);
  assert(found != known_.names.end());  // a struct refers to what is read before it
  const std::vector<std::string>& names = found->second;
  const std::string chosen = table_->choice(name, names);
  index = static_cast<int>(std::find(names.begin(), names.end(), chosen) - names.begin());
}

void TomlReader::columns(std::initializer_list<Column> all, const ColumnRules& rules,
                         std::string_view) {
  std::vector<std::pair<std::string, Quantity>> wanted;
  for (const Column& column : all)
    wanted.emplace_back(std::string(column.key) + (column.angle ? "_deg" : ""), column.quantity);
  scenario::Columns found = rules.file ? scenario::read_columns(*table_, known_.folder, wanted)
                                       : scenario::read_lists(*table_, wanted);
  if (rules.increasing) scenario::require_increasing(found);
  auto values = found.values.begin();
  for (const Column& column : all) {
    *column.values = std::move(*values++);
    if (column.angle)
      for (double& angle : *column.values) angle = radians(angle);
  }
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

}  // namespace asdic
