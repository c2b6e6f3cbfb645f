#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/fields_viewer.h"

namespace asdic::detail {

/// Under which a setting is there: what another key of a table is, or which keys it has.
struct SettingCondition {
  std::string place;                     ///< of that table: "", "beam.", "layer[]."
  std::string key;                       ///< "window"
  std::vector<std::string> words = {};   ///< it is one of them …
  bool other = false;                    ///< … or none of them
  bool there = false;                    ///< `key` is there: of several ways this one is chosen
  std::vector<std::string> absent = {};  ///< and none of these, by which other ways are

  [[nodiscard]] bool operator==(const SettingCondition&) const = default;
};

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
  bool angle = false;                   ///< NAME_deg, for which files may write NAME_rad
  std::size_t length = 0;               ///< of a vector
  std::vector<std::string> words = {};  ///< that there are; of a number, in its place: "auto"
  /// As a file would have it: 0.5, "hann", true. "": none, or of the other settings
  std::string standard = {};
  std::string inherits = {};   ///< the setting that is its default: "environment.wind_speed"
  std::string otherwise = {};  ///< what holds without it, in words: "of the wind"
  std::string help = {};       ///< without the unit
  std::string condition = {};  ///< under which there is one: window = "tukey"
  std::vector<SettingCondition> conditions = {};  ///< the same; all of them
  bool required = false;                          ///< it has no default
  bool live = false;                              ///< a running server takes changes of it
};

/// A table of a file, which holds settings.
struct TableRecord {
  std::string path;  ///< "beam", "layer[]", "layer[].top"
  std::string help;
  bool may_be_absent = false;  ///< it says something by being there
  bool list = false;           ///< [[path]]
  bool one_or_more = false;    ///< [path], or [[path]] as often as it stands there
  bool in_place = false;       ///< of a number of the same path
  bool live = false;           ///< a running server takes another one in its place
  std::vector<SettingCondition> conditions = {};
};

/// Keys of a table that no file has under a condition.
struct KeysExcluded {
  std::string place;
  std::vector<std::string> keys = {};
  std::vector<SettingCondition> conditions = {};
};

/// What a section of a file may have.
struct SettingsList {
  std::vector<SettingRecord> settings = {};
  std::vector<TableRecord> tables = {};
  std::vector<KeysExcluded> excluded = {};
};
/// Of one of its tables, "array", with paths within that: those of [array] and of [[array]].
[[nodiscard]] SettingsList below(const SettingsList& list, std::string_view path);

/// Lists every setting that there may be: of all choices, of tables that need not be there, of one
/// element of every list. Defaults are what it is shown. It is shown a struct of its own, which it
/// changes and puts back.
class SettingsCatalogue final : public FieldsViewer {
 public:
  [[nodiscard]] bool exhaustive() const override { return true; }
  [[nodiscard]] const SettingsList& list() const noexcept { return list_; }

  void excludes(std::string_view beside, std::initializer_list<std::string_view> keys) override;
  void axis(SettingKey key, std::vector<double>& values, const Quantity& q,
            std::string_view help) override;
  void file(SettingKey key, std::string& path, std::string_view what,
            std::string_view help) override;
  void columns(std::initializer_list<Column> all, const ColumnRules& rules) override;
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
  bool takes(Ways& ways, std::span<const std::string_view> keys, bool is, bool last) override;
  void begin(const Condition& condition) override;
  void end() override;

  /// A condition, and how it is told; "" if it is not.
  struct Told {
    SettingCondition condition;
    std::string text;
  };
  SettingRecord& add(const SettingKey& key, std::string_view help, SettingRecord::Type type,
                     std::string standard);
  void within(const Setting& s, TableRecord made, const Structure& inner);
  [[nodiscard]] std::vector<SettingCondition> conditions() const;

  SettingsList list_;
  std::string place_;                // before keys: "layer[]."
  std::vector<Told> conditions_;     // that hold
  std::vector<std::string> absent_;  // of the way that begins: the keys of those before it
  bool last_way_ = false;
};

/// Of one section. \param defaults  as an empty file leaves them
template <Described T>
[[nodiscard]] SettingsList catalogue_of(T defaults = {}) {
  SettingsCatalogue walker;
  defaults.describe(walker);
  return walker.list();
}

/// What a record takes: "0 to 600 m/s", "above 0 Hz", "`none`, `hann`", "three numbers [m]".
[[nodiscard]] std::string domain_of(const SettingRecord& record);

}  // namespace asdic::detail
