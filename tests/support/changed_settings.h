#pragma once
// Copies of a described struct, each with one of its settings changed.
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/fields.h"

namespace asdic::detail::support {

/// Changes one of the numbers and choices that a struct describes: in the order of the walk.
class ChangeOne final : public Fields {
 public:
  explicit ChangeOne(std::size_t which) : which_(which) {}
  [[nodiscard]] bool found() const noexcept { return next_ > which_; }
  /// Numbers of which a struct shows a copy go back into it when they are the ones.
  [[nodiscard]] bool reads() const override { return copy_changed_; }

  void axis(SettingKey, std::vector<double>& values, const Quantity&, std::string_view) override {
    change(values);
  }
  void file(SettingKey, std::string&, std::string_view, std::string_view) override {}
  void columns(std::initializer_list<Column> all, const ColumnRules&) override {
    for (const Column& column : all) change(*column.values);
  }
  void sound(SettingKey, const Sound& sound, std::string_view) override {
    change(*sound.sample_rate);
    change(*sound.samples);
  }
  void name(std::string&, std::string_view) override {}
  void reference(SettingKey, int& index, std::string_view, std::string_view) override {
    if (is_next()) ++index;
  }
  void derived(double& value) override { change(value); }

 private:
  void number(const Setting&, const Quantity&, double& value, bool* given) override {
    change_copy(value, given);
  }
  void angle(const Setting&, const AngleQuantity&, double& radians, bool* given) override {
    change_copy(radians, given);
  }
  void integer(const Setting&, std::int64_t, std::int64_t, std::int64_t& value,
               bool* given) override {
    if (!is_next()) return;
    ++value;
    if (given != nullptr) *given = true;
    copy_changed_ = true;
  }
  void flag(const Setting&, bool& value) override {
    if (is_next()) value = !value;
  }
  void text(const Setting&, std::string&) override {}
  void numbers(const Setting&, const Quantity&, std::vector<double>& values) override {
    change(values);
  }
  void angles(const Setting&, const AngleQuantity&, std::vector<double>& radians) override {
    change(radians);
  }
  void rows(const Setting&, const Quantity&, std::vector<std::vector<double>>& values) override {
    bool changed = false;
    for (std::vector<double>& row : values)
      for (double& value : row) changed = change(value) || changed;
    copy_changed_ = changed;
  }
  void vector(const Setting&, const Quantity&, std::span<double> value, std::string_view) override {
    for (double& coordinate : value) change(coordinate);
  }
  void vectors(const Setting&, const Quantity&, std::vector<Vec3>& values) override {
    for (Vec3& value : values)
      for (double& coordinate : value) change(coordinate);
  }
  void choice(const Setting&, std::span<const std::string_view> words,
              std::size_t& index) override {
    if (!is_next()) return;
    index = (index + 1) % words.size();
    copy_changed_ = true;
  }
  void table(const Setting&, const Structure& inner) override { inner.describe(*this); }
  void perhaps(const Setting&, const Perhaps& inner) override {
    if (inner.present) inner.get().describe(*this);
  }
  void number_or_table(const Setting&, const Quantity&, double& value,
                       const Perhaps& instead) override {
    if (instead.present)
      instead.get().describe(*this);
    else
      change(value);
  }
  void tables(const Setting&, const List& list, const ListRules&) override {
    for (std::size_t i = 0; i < list.size(); ++i) list.at(i).describe(*this);
  }
  void alternatives(const Setting&, const OneOf& one) override { one.chosen().describe(*this); }

  bool is_next() {
    copy_changed_ = false;
    return next_++ == which_;
  }
  bool change(double& value) {
    if (!is_next()) return false;
    value += 0.125;
    return true;
  }
  void change(std::vector<double>& values) {
    for (double& value : values) change(value);
  }
  void change_copy(double& value, bool* given) {
    if (!change(value)) return;
    if (given != nullptr) *given = true;
    copy_changed_ = true;
  }

  std::size_t which_, next_ = 0;
  bool copy_changed_ = false;
};

/// Of every number and choice one copy in which it alone is another.
template <Described T>
[[nodiscard]] std::vector<T> changed_in_one(const T& settings) {
  std::vector<T> all;
  for (std::size_t which = 0;; ++which) {
    T copy = settings;
    ChangeOne walk(which);
    copy.describe(walk);
    if (!walk.found()) return all;
    all.push_back(std::move(copy));
  }
}

}  // namespace asdic::detail::support
