#pragma once
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/fields.h"
#include "io/settings/known_settings.h"
#include "io/text/toml_value.h"

namespace asdic::detail {

/// Writes described structs as a tree of TOML, key by key in the order in which they are described:
/// TomlReader makes the same struct of it, bit for bit. Every setting is written, one that has its
/// default too; not what is absent, lists and tables without anything in them, and `seldom` keys
/// that are false, 0 or empty. Angles stand in degrees where a decimal number of degrees reads back
/// as the same bits, else in radians. An entry without a value is a comment.
class TreeWriter final : public Fields {
 public:
  /// \param table, known  outlive the writer; the table grows
  TreeWriter(TomlValue::Table& table, KnownSettings& known) : table_(&table), known_(known) {}

  void know(std::string_view setting, double value) override;
  [[nodiscard]] double known(std::string_view setting) const override;
  void remark(std::string_view text) override;

  void axis(SettingKey key, std::vector<double>& values, const Quantity&,
            std::string_view) override;
  void file(SettingKey key, std::string& path, std::string_view, std::string_view) override;
  void sound(SettingKey key, const Sound& sound, std::string_view) override;
  void columns(std::initializer_list<Column> all, const ColumnRules&) override;
  void name(std::string& value, std::string_view) override;
  void reference(SettingKey key, int& index, std::string_view list, std::string_view) override;
  void derived(double&) override {}

 private:
  void number(const Setting&, const Quantity&, double& value, bool* given) override;
  void angle(const Setting&, const AngleQuantity&, double& radians, bool* given) override;
  void integer(const Setting&, std::int64_t, std::int64_t, std::int64_t& value,
               bool* given) override;
  void flag(const Setting&, bool& value) override;
  void text(const Setting&, std::string& value) override;
  void numbers(const Setting&, const Quantity&, std::vector<double>& values) override;
  void angles(const Setting&, const AngleQuantity&, std::vector<double>& radians) override;
  void rows(const Setting&, const Quantity&, std::vector<std::vector<double>>& values) override;
  void vector(const Setting&, const Quantity&, std::span<double> value, std::string_view) override;
  void vectors(const Setting&, const Quantity&, std::vector<Vec3>& values) override;
  void choice(const Setting&, std::span<const std::string_view> words, std::size_t& index) override;
  void table(const Setting&, const Structure& inner) override;
  void perhaps(const Setting&, const Perhaps& inner) override;
  void number_or_table(const Setting&, const Quantity&, double& value,
                       const Perhaps& instead) override;
  void tables(const Setting&, const List& list, const ListRules& rules) override;
  void alternatives(const Setting&, const OneOf& one) override;

  void add(std::string_view key, decltype(TomlValue::data) value);
  void add_list(std::string_view key, std::span<const double> values);
  void add_angles(std::string_view name, std::span<const double> radians);
  [[nodiscard]] bool absent(const SettingKey& key, const bool* given);
  [[nodiscard]] TomlValue written(const Structure& inner);

  TomlValue::Table* table_;
  KnownSettings& known_;
  std::string usual_name_;  // of the element that is written, without one of its own
  std::vector<std::string>* names_ = nullptr;  // of the list's elements before it
};

/// A struct as a tree. \param known  what it refers to and does not hold itself
template <Described T>
[[nodiscard]] TomlValue settings_tree(const T& settings, KnownSettings known = {}) {
  TomlValue::Table table;
  TreeWriter writer(table, known);
  look(settings, writer);
  return {.data = std::move(table), .origin = ""};
}

/// A tree as the text of a file: of every table first the values, then the tables below it.
[[nodiscard]] std::string print_toml(const TomlValue& tree);

}  // namespace asdic::detail
