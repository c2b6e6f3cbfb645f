#include "core/settings_words.h"

#include <bit>

namespace asdic::detail {

void SettingsWords::add(double value) { add(std::bit_cast<std::uint64_t>(value)); }

void SettingsWords::add(std::span<const double> values) {
  add(std::uint64_t{values.size()});
  for (const double value : values) add(value);
}

/// Whether there is a value, which is a word of its own where it may be absent.
bool SettingsWords::adds(const bool* given) {
  if (given != nullptr) add(std::uint64_t{*given});
  return given == nullptr || *given;
}

void SettingsWords::columns(std::initializer_list<Column> all, const ColumnRules&) {
  for (const Column& column : all) add(*column.values);
}
void SettingsWords::sound(SettingKey, const Sound& sound, std::string_view) {
  add(*sound.sample_rate);
  add(*sound.samples);
}
void SettingsWords::reference(SettingKey, int& index, std::string_view, std::string_view) {
  add(static_cast<std::uint64_t>(index));
}
void SettingsWords::derived(double& value) { add(value); }

void SettingsWords::number(const Setting&, const Quantity&, double& value, bool* given) {
  if (adds(given)) add(value);
}
void SettingsWords::angle(const Setting&, const AngleQuantity&, double& radians, bool* given) {
  if (adds(given)) add(radians);
}
void SettingsWords::integer(const Setting&, std::int64_t, std::int64_t, std::int64_t& value,
                            bool* given) {
  if (adds(given)) add(static_cast<std::uint64_t>(value));
}
void SettingsWords::flag(const Setting&, bool& value) { add(std::uint64_t{value}); }
void SettingsWords::numbers(const Setting&, const Quantity&, std::vector<double>& values) {
  add(values);
}
void SettingsWords::angles(const Setting&, const AngleQuantity&, std::vector<double>& radians) {
  add(radians);
}
void SettingsWords::rows(const Setting&, const Quantity&,
                         std::vector<std::vector<double>>& values) {
  add(std::uint64_t{values.size()});
  for (const std::vector<double>& row : values) add(row);
}
void SettingsWords::vector(const Setting&, const Quantity&, std::span<double> value,
                           std::string_view) {
  add(std::span<const double>(value));
}
void SettingsWords::vectors(const Setting&, const Quantity&, std::vector<Vec3>& values) {
  add(std::uint64_t{values.size()});
  for (const Vec3& value : values) add(std::span<const double>(value.data(), 3));
}
void SettingsWords::choice(const Setting&, std::span<const std::string_view>, std::size_t& index) {
  add(std::uint64_t{index});
}
void SettingsWords::table(const Setting&, const Structure& inner) { inner.describe(*this); }
void SettingsWords::perhaps(const Setting&, const Perhaps& inner) {
  if (adds(&inner.present)) inner.get().describe(*this);
}
void SettingsWords::number_or_table(const Setting&, const Quantity&, double& value,
                                    const Perhaps& instead) {
  if (adds(&instead.present))
    instead.get().describe(*this);
  else
    add(value);
}
void SettingsWords::tables(const Setting&, const List& list, const ListRules&) {
  add(std::uint64_t{list.size()});
  for (std::size_t i = 0; i < list.size(); ++i) list.at(i).describe(*this);
}
void SettingsWords::alternatives(const Setting&, const OneOf& one) {
  add(std::uint64_t{one.index});
  one.chosen().describe(*this);
}
bool SettingsWords::takes(Ways& ways, std::span<const std::string_view> keys, bool is, bool last) {
  const bool taken = Fields::takes(ways, keys, is, last);
  add(std::uint64_t{taken});
  return taken;
}

}  // namespace asdic::detail
