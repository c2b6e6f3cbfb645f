#include "core/check_settings.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/quantities.h"
#include "core/text.h"

namespace asdic::detail {

void SettingsCheck::fault(std::string_view key, const std::string& expected,
                          std::optional<std::string> got) {
  const auto number = std::find_if(numbers_.begin(), numbers_.end(),
                                   [&](const auto& one) { return one.first == key; });
  if (!got) got = number == numbers_.end() ? "another" : to_text(number->second);
  throw InputError({.where = path_ + std::string(key), .got = *got, .expected = expected});
}

void SettingsCheck::know(std::string_view setting, double value) {
  known_.insert_or_assign(std::string(setting), value);
}
double SettingsCheck::known(std::string_view setting) const {
  const auto found = known_.find(setting);
  return found == known_.end() ? 0.0 : found->second;
}

void SettingsCheck::hold(std::string_view key, const Quantity& q, double value) {
  if (q.holds(value)) return;
  std::string got = std::isfinite(value) ? to_text(value) : "nan or infinity";
  if (std::isfinite(value) && !q.unit.empty()) got.append(" ").append(q.unit);
  fault(key, q.expected(), got);
}

void SettingsCheck::hold_all(std::string_view key, const Quantity& q,
                             std::span<const double> values) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!q.holds(values[i])) hold(std::string(key) + "[" + std::to_string(i) + "]", q, values[i]);
}

void SettingsCheck::number(const Setting& s, const Quantity& q, double& value, bool* given) {
  if (given != nullptr && !*given) return;
  numbers_.emplace_back(s.key.name, value);
  hold(s.key.name, q, value);
}
void SettingsCheck::angle(const Setting& s, const AngleQuantity& q, double& radians, bool* given) {
  number(s, q.in_radians(), radians, given);
}
void SettingsCheck::integer(const Setting& s, std::int64_t low, std::int64_t high,
                            std::int64_t& value, bool* given) {
  if (given != nullptr && !*given) return;
  if (value < low || value > high)
    fault(s.key.name, "a whole number from " + std::to_string(low) + " to " + std::to_string(high),
          std::to_string(value));
}
void SettingsCheck::numbers(const Setting& s, const Quantity& q, std::vector<double>& values) {
  hold_all(s.key.name, q, values);
}
void SettingsCheck::angles(const Setting& s, const AngleQuantity& q, std::vector<double>& radians) {
  hold_all(s.key.name, q.in_radians(), radians);
}
void SettingsCheck::vector(const Setting& s, const Quantity& q, std::span<double> value,
                           std::string_view) {
  hold_all(s.key.name, q, value);
}
void SettingsCheck::vectors(const Setting& s, const Quantity& q, std::vector<Vec3>& values) {
  for (const Vec3& value : values) hold_all(s.key.name, q, {value.data(), 3});
}

void SettingsCheck::columns(std::initializer_list<Column> all, const ColumnRules&) {
  for (const Column& column : all) {
    if (column.values->size() != all.begin()->values->size())
      fault(column.key, "as many numbers as of " + std::string(all.begin()->key),
            std::to_string(column.values->size()));
    for (const double value : *column.values)
      hold(column.key, column.quantity, column.angle ? degrees(value) : value);
  }
}

void SettingsCheck::sound(SettingKey, const Sound& sound, std::string_view) {
  hold("sample_rate", quantity::sound_rate, *sound.sample_rate);
  if (sound.samples->size() < 2)
    fault("samples", "at least 2", std::to_string(sound.samples->size()) + " samples");
  hold_all("samples", quantity::sound_sample, *sound.samples);
}

void SettingsCheck::rows(const Setting& s, const Quantity& q,
                         std::vector<std::vector<double>>& values) {
  for (const std::vector<double>& row : values) hold_all(s.key.name, q, row);
}

/// A table of its own.
void SettingsCheck::inside(const std::string& name, const Structure& inner) {
  const std::size_t length = path_.size();
  const auto before = std::move(numbers_);
  numbers_.clear();
  path_.append(name).append(".");
  inner.describe(*this);
  path_.resize(length);
  numbers_ = before;
}
void SettingsCheck::table(const Setting& s, const Structure& inner) {
  inside(std::string(s.key.name), inner);
}
void SettingsCheck::perhaps(const Setting& s, const Perhaps& inner) {
  if (inner.present) inside(std::string(s.key.name), inner.get());
}
void SettingsCheck::tables(const Setting& s, const List& list, const ListRules&) {
  for (std::size_t i = 0; i < list.size(); ++i)
    inside(std::string(s.key.name) + "[" + std::to_string(i) + "]", list.at(i));
}

}  // namespace asdic::detail
