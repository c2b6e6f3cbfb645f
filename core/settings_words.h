#pragma once
#include <cstdint>
#include <vector>

#include "core/fields.h"

namespace asdic::detail {

/// All that decides what a described struct does, bit for bit: every number and every choice, what
/// is derived too, in the order in which it describes them. Two structs of one type are equal when
/// these are. Names and other texts change no result, and are left out.
class SettingsWords final : public Fields {
 public:
  explicit SettingsWords(std::vector<std::uint64_t>& words) : words_(words) {}

  void axis(SettingKey, std::vector<double>& values, const Quantity&, std::string_view) override {
    add(values);
  }
  void file(SettingKey, std::string&, std::string_view, std::string_view) override {}
  void columns(std::initializer_list<Column> all, const ColumnRules&) override;
  void sound(SettingKey, const Sound& sound, std::string_view) override;
  void name(std::string&, std::string_view) override {}
  void reference(SettingKey, int& index, std::string_view, std::string_view) override;
  void derived(double& value) override;

 private:
  void number(const Setting&, const Quantity&, double& value, bool* given) override;
  void angle(const Setting&, const AngleQuantity&, double& radians, bool* given) override;
  void integer(const Setting&, std::int64_t, std::int64_t, std::int64_t&, bool* given) override;
  void flag(const Setting&, bool& value) override;
  void text(const Setting&, std::string&) override {}
  void numbers(const Setting&, const Quantity&, std::vector<double>& values) override;
  void angles(const Setting&, const AngleQuantity&, std::vector<double>& radians) override;
  void rows(const Setting&, const Quantity&, std::vector<std::vector<double>>& values) override;
  void vector(const Setting&, const Quantity&, std::span<double> value, std::string_view) override;
  void vectors(const Setting&, const Quantity&, std::vector<Vec3>& values) override;
  void choice(const Setting&, std::span<const std::string_view>, std::size_t& index) override;
  void table(const Setting&, const Structure& inner) override;
  void perhaps(const Setting&, const Perhaps& inner) override;
  void number_or_table(const Setting&, const Quantity&, double& value,
                       const Perhaps& instead) override;
  void tables(const Setting&, const List& list, const ListRules&) override;
  void alternatives(const Setting&, const OneOf& one) override;
  bool takes(Ways& ways, std::span<const std::string_view> keys, bool is, bool last) override;

  void add(std::uint64_t word) { words_.push_back(word); }
  void add(double value);
  void add(std::span<const double> values);  // and how many
  [[nodiscard]] bool adds(const bool* given);

  std::vector<std::uint64_t>& words_;
};

template <Described T>
[[nodiscard]] std::vector<std::uint64_t> settings_words(const T& settings) {
  std::vector<std::uint64_t> words;
  SettingsWords walker(words);
  look(settings, walker);
  return words;
}

}  // namespace asdic::detail
