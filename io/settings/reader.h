#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/fields.h"
#include "io/settings/known_settings.h"
#include "io/text/toml_table.h"

namespace asdic::detail {

/// Reads described structs out of TOML: every setting has the type and the range that its struct
/// says, angles stand in degrees (or as NAME_rad in radians), and no key is there that is not read.
/// Faults are those of TomlTable. What is not in the file keeps the value that the struct has.
class TomlReader final : public Fields {
 public:
  /// \param table, known  outlive the reader. The caller finishes the table
  TomlReader(TomlTable& table, KnownSettings& known) : table_(&table), known_(known) {}

  [[nodiscard]] bool reads() const override { return true; }
  [[nodiscard]] bool checks() const override { return true; }
  void fault(std::string_view key, const std::string& expected,
             std::optional<std::string> got) override;
  [[nodiscard]] bool finds(std::string_view key) const override;
  void note(const std::string& text) override { known_.notes.push_back(text); }
  void know(std::string_view setting, double value) override;
  [[nodiscard]] double known(std::string_view setting) const override;

  void axis(SettingKey key, std::vector<double>& values, const Quantity& q,
            std::string_view help) override;
  void file(SettingKey key, std::string& path, std::string_view what,
            std::string_view help) override;
  void columns(std::initializer_list<Column> all, const ColumnRules& rules) override;
  void sound(SettingKey key, const Sound& sound, std::string_view what) override;
  void excludes(std::string_view beside, std::initializer_list<std::string_view> keys) override;
  void name(std::string& value, std::string_view help) override;
  void reference(SettingKey key, int& index, std::string_view list, std::string_view help) override;
  void derived(double&) override {}

 private:
  /// Of the list whose element is read: what it is called without a name of its own, and the others
  struct Naming {
    std::string_view noun;
    std::string usual;
    std::vector<std::string>* taken = nullptr;
  };

  void number(const Setting&, const Quantity&, double& value, bool* given) override;
  void angle(const Setting&, const AngleQuantity&, double& radians, bool* given) override;
  void integer(const Setting&, std::int64_t low, std::int64_t high, std::int64_t& value,
               bool* given) override;
  void flag(const Setting&, bool& value) override;
  void text(const Setting&, std::string& value) override;
  void numbers(const Setting&, const Quantity&, std::vector<double>& values) override;
  void angles(const Setting&, const AngleQuantity&, std::vector<double>& radians) override;
  void rows(const Setting&, const Quantity&, std::vector<std::vector<double>>& values) override;
  void vector(const Setting&, const Quantity&, std::span<double> value,
              std::string_view axes) override;
  void vectors(const Setting&, const Quantity&, std::vector<Vec3>& values) override;
  void choice(const Setting&, std::span<const std::string_view> words, std::size_t& index) override;
  void table(const Setting&, const Structure& inner) override;
  void perhaps(const Setting&, const Perhaps& inner) override;
  void number_or_table(const Setting&, const Quantity&, double& value,
                       const Perhaps& instead) override;
  void tables(const Setting&, const List& list, const ListRules& rules) override;
  void alternatives(const Setting&, const OneOf& one) override;
  bool takes(Ways& ways, std::span<const std::string_view> keys, bool is, bool last) override;

  /// Tells the table's notes of a setting that was read. \param value  as a file would have it; "":
  /// nothing holds, or what the key's words say
  void note_value(const SettingKey& key, const std::string& name, const std::string& value,
                  const Quantity& q = {}) const;
  void note_values(const SettingKey& key, const std::string& name, std::span<const double> values,
                   const Quantity& q) const;
  [[nodiscard]] bool is_word(const SettingKey& key);
  [[nodiscard]] bool absent(const SettingKey& key, const std::string& name, bool* given);
  [[nodiscard]] std::string angle_key(std::string_view name);
  [[nodiscard]] std::string written_key(std::string_view key) const;
  void read(TomlTable& table, const Structure& inner);
  void refuse_others(const Ways& ways, std::span<const std::string_view> keys);

  TomlTable* table_;
  KnownSettings& known_;
  Naming naming_;
};

/// A struct out of a table of its own, which is finished.
template <Described T>
void read_settings(TomlTable table, T& settings, KnownSettings& known) {
  TomlReader reader(table, known);
  settings.describe(reader);
  table.finish();
}

/// A word of an enumeration, for tables that are read by hand. \param value  without a word
template <Worded E>
[[nodiscard]] E read_word(TomlTable& table, SettingKey key, E value) {
  KnownSettings nothing;
  TomlReader(table, nothing)(key, value, "");
  return value;
}

}  // namespace asdic::detail
