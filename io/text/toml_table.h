#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/quantity.h"
#include "core/units.h"
#include "io/text/noted_settings.h"
#include "io/text/toml_value.h"

namespace asdic::detail {

/// A strict, typed reader of one table of a scenario. Every fault is an InputError that says
/// "FILE:LINE: key.path: found X, expected Y". It remembers every key that was asked for; finish()
/// reports those in the file that nobody asked for.
class TomlTable {
 public:
  /// \param table  must outlive this reader   \param path  of the table, "" for the document
  explicit TomlTable(const TomlValue& table, std::string path = "");

  /// What is read of this table and of those within it is noted there. \param noted  outlives them
  void note_in(NotedSettings* noted) { noted_ = noted; }
  [[nodiscard]] bool is_noted() const { return noted_ != nullptr; }
  /// Where it is_noted(): a setting that has been read. \param setting  its key in this table
  void note(NotedSetting setting) const;

  [[nodiscard]] bool has(const std::string& key);
  /// The same of a key that is not among those which messages name, unless it is read.
  [[nodiscard]] bool has_quietly(const std::string& key) const;
  [[nodiscard]] bool is_table(const std::string& key);  ///< there, and a table
  [[nodiscard]] bool is_text(const std::string& key);   ///< there, and a string
  [[nodiscard]] bool is_array(const std::string& key);  ///< there, and an array

  double number(const std::string& key, const Quantity& quantity);
  double number(const std::string& key, const Quantity& quantity, double fallback);
  std::int64_t integer(const std::string& key, std::int64_t low, std::int64_t high);
  std::int64_t integer(const std::string& key, std::int64_t low, std::int64_t high,
                       std::int64_t fallback);
  bool flag(const std::string& key, bool fallback);
  std::string text(const std::string& key);
  std::string text(const std::string& key, const std::string& fallback);
  /// One of a list of names. Without a fallback the key is required.
  std::string choice(const std::string& key, const std::vector<std::string>& names,
                     std::optional<std::string> fallback = std::nullopt);
  /// \return as many numbers as stand there, at least one
  std::vector<double> numbers(const std::string& key, const Quantity& quantity);
  /// Rows of numbers, at least one, each as long as the first. \return [rows][columns]
  std::vector<std::vector<double>> rows(const std::string& key, const Quantity& quantity);
  Vec3 vector(const std::string& key, const Quantity& quantity);
  Vec3 vector(const std::string& key, const Quantity& quantity, const Vec3& fallback);
  std::vector<Vec3> vectors(const std::string& key, const Quantity& quantity);
  /// As many numbers as there are axes. \param axes  "[east, north]"
  void components(const std::string& key, const Quantity& quantity, std::string_view axes,
                  std::span<double> result);

  /// A table inside this one; an absent one reads as empty (its required keys are then missing).
  TomlTable table(const std::string& key);
  /// An array of tables; absent: none.
  std::vector<TomlTable> tables(const std::string& key);
  /// [key], or [[key]] as often as it stands there. \return at least one; an absent one reads as
  /// empty
  std::vector<TomlTable> one_or_more(const std::string& key);

  /// \throws InputError naming the first key that nobody asked for, with the nearest known name
  void finish() const;

  /// A fault at a key (or "key[3]"), for checks that involve more than one value. `got` defaults to
  /// what stands there.
  [[nodiscard]] InputError fault(const std::string& key, const std::string& expected,
                                 std::optional<std::string> got = std::nullopt) const;
  /// "deep_ocean.toml:12: pulse.duration"
  [[nodiscard]] std::string where(const std::string& key) const;

 private:
  const TomlValue* find(const std::string& key);
  const TomlValue& require(const std::string& key, const std::string& expected);
  std::vector<double> checked_numbers(const TomlValue& value, const std::string& key,
                                      const Quantity& quantity, const std::string& expected) const;
  double checked(const TomlValue& value, const std::string& key, const Quantity& quantity) const;
  void checked_components(const TomlValue& value, const std::string& key, const Quantity& quantity,
                          std::string_view axes, std::span<double> result) const;
  [[nodiscard]] InputError fault_at(const TomlValue& value, const std::string& key,
                                    const std::string& expected,
                                    std::optional<std::string> got = std::nullopt) const;
  [[nodiscard]] std::string path_of(const std::string& key) const;

  const TomlValue* table_;
  std::string path_;
  std::string fallback_origin_;  // of an absent table: where it could have stood
  std::vector<std::string> known_;
  NotedSettings* noted_ = nullptr;
};

}  // namespace asdic::detail
