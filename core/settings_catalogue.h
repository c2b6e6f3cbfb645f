#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/fields_viewer.h"

namespace asdic::detail {

/// What a file may say at one place, as the description of its struct has it.
struct SettingRecord {
  enum class Type {
    number,
    whole_number,
    flag,
    text,
    word,
    numbers,
    rows,
    axis,
    vector,
    vectors,
    reference
  };

  std::string path;  ///< within its section: "duration", "layer[].depth", "start.speed"
  Type type = Type::number;
  Quantity quantity = {};               ///< of numbers, as files have them: angles in degrees
  std::size_t length = 0;               ///< of a vector
  std::vector<std::string> words = {};  ///< that there are; of a number, in its place: "auto"
  /// As a file would have it: 0.5, "hann", true. "": none, or of the other settings
  std::string standard = {};
  std::string inherits = {};   ///< the setting that is its default: "environment.wind_speed"
  std::string help = {};       ///< without the unit
  std::string condition = {};  ///< under which there is one: window = "tukey"
  bool required = false;       ///< it has no default
  bool live = false;           ///< a running server takes changes of it
};

/// Lists every setting that there may be: of all choices, of tables that need not be there, of one
/// element of every list. Defaults are what it is shown. It is shown a struct of its own, which it
/// changes and puts back. NaN stands for a default that others decide.
class SettingsCatalogue final : public FieldsViewer {
 public:
  [[nodiscard]] bool exhaustive() const override { return true; }
  [[nodiscard]] const std::vector<SettingRecord>& records() const noexcept { return records_; }

  void axis(SettingKey key, std::vector<double>& values, const Quantity& q,
            std::string_view help) override;
  void file(SettingKey key, std::string& path, std::string_view what,
            std::string_view help) override;
  void columns(std::initializer_list<Column> all, const ColumnRules& rules,
               std::string_view help) override;
  void sound(SettingKey key, const Sound& sound, std::string_view what) override;
  void name(std::string& value, std::string_view help) override;
  void reference(SettingKey key, int& index, std::string_view list, std::string_view help) override;

 private:
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
  void begin(std::string_view key, std::string_view word) override;
  void end() override;

  SettingRecord& add(const SettingKey& key, std::string_view help, SettingRecord::Type type,
                     std::string standard);
  void within(const std::string& place, const Structure& inner);

  std::vector<SettingRecord> records_;
  std::string place_;                    // before keys: "layer[]."
  std::vector<std::string> conditions_;  // that hold
};

/// Of one section. \param defaults  as an empty file leaves them
template <Described T>
[[nodiscard]] std::vector<SettingRecord> catalogue_of(T defaults = {}) {
  SettingsCatalogue walker;
  defaults.describe(walker);
  return walker.records();
}

/// What a record takes: "0 to 600 m/s", "above 0 Hz", "`none`, `hann`", "three numbers [m]".
[[nodiscard]] std::string domain_of(const SettingRecord& record);

}  // namespace asdic::detail
