#pragma once
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/fields_viewer.h"

namespace asdic::detail {

/// Holds a struct that a program has built against what it says of itself, as the reader does with
/// one out of a file. \throws InputError that names the setting, "pulse.duration"
class SettingsCheck final : public FieldsViewer {
 public:
  [[nodiscard]] bool checks() const override { return true; }
  void fault(std::string_view key, const std::string& expected,
             std::optional<std::string> got) override;
  void know(std::string_view setting, double value) override;
  [[nodiscard]] double known(std::string_view setting) const override;
  void columns(std::initializer_list<Column> all, const ColumnRules&) override;
  void sound(SettingKey, const Sound& sound, std::string_view) override;

 private:
  void number(const Setting&, const Quantity&, double& value, bool* given) override;
  void angle(const Setting&, const AngleQuantity&, double& radians, bool* given) override;
  void integer(const Setting&, std::int64_t low, std::int64_t high, std::int64_t& value,
               bool* given) override;
  void numbers(const Setting&, const Quantity&, std::vector<double>& values) override;
  void angles(const Setting&, const AngleQuantity&, std::vector<double>& radians) override;
  void rows(const Setting&, const Quantity&, std::vector<std::vector<double>>& values) override;
  void vector(const Setting&, const Quantity&, std::span<double> value, std::string_view) override;
  void vectors(const Setting&, const Quantity&, std::vector<Vec3>& values) override;
  void table(const Setting&, const Structure& inner) override;
  void perhaps(const Setting&, const Perhaps& inner) override;
  void tables(const Setting&, const List& list, const ListRules&) override;

  void hold(std::string_view key, const Quantity& q, double value);
  void hold_all(std::string_view key, const Quantity& q, std::span<const double> values);
  void inside(const std::string& name, const Structure& inner);

  std::map<std::string, double, std::less<>> known_;
  std::string path_;                                          // of the table, with a dot
  std::vector<std::pair<std::string_view, double>> numbers_;  // of it, for the texts of faults
};

template <Described T>
void check_settings(const T& settings) {
  SettingsCheck walker;
  look(settings, walker);
}

}  // namespace asdic::detail
