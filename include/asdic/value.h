#pragma once

/// \file
/// A value of a setting: a number, a text, true or false, a list, a table. Settings that are built
/// often have structs of their own (asdic/pulse.h and others), which become values by themselves.
///
/// ```cpp
/// asdic::Value target = asdic::Value::table({{"range", 5000.0}, {"depth", 100.0}});
/// target.set("strength_db", 15.0).set("name", "submarine");
/// std::cout << target.to_toml() << '\n';
/// for (const std::string& key : target.keys()) std::cout << key << '\n';
/// ```

#include <array>
#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "asdic/export.h"

namespace asdic {

/// Cheap to copy: copies share what they hold until one is changed. One that was moved from is
/// nothing. Texts and keys are UTF-8.
class ASDIC_API Value {
 public:
  enum class Kind { nothing, flag, whole, number, text, list, table };

  Value();  ///< nothing
  Value(bool flag);
  Value(double number);
  /// \throws InputError for one of 2⁶³ or more, which no file can hold
  template <std::integral T>
  requires(sizeof(T) <= sizeof(std::int64_t)) Value(T whole)
      : Value(Whole{static_cast<std::int64_t>(whole), whole > T{}}) {}
  Value(const char* text);  ///< \throws InputError for what is no UTF-8
  Value(std::string text);
  Value(const std::vector<double>& numbers);
  Value(const std::array<double, 3>& vector);
  Value(const std::vector<std::string>& texts);
  Value(const std::vector<Value>& items);
  [[nodiscard]] static Value list(std::initializer_list<Value> items);
  [[nodiscard]] static Value table(
      std::initializer_list<std::pair<std::string_view, Value>> entries = {});

  [[nodiscard]] Kind kind() const noexcept;
  /// \throws InputError for the functions below, where the value is of another kind
  [[nodiscard]] bool flag() const;
  [[nodiscard]] std::int64_t whole() const;
  [[nodiscard]] double number() const;  ///< a whole number will do
  [[nodiscard]] std::string text() const;
  [[nodiscard]] std::vector<double> numbers() const;  ///< of a list of them
  [[nodiscard]] std::size_t size() const;             ///< of a list or a table
  [[nodiscard]] Value at(std::size_t index) const;    ///< of a list
  [[nodiscard]] Value at(std::string_view key) const;
  [[nodiscard]] bool has(std::string_view key) const;
  [[nodiscard]] std::vector<std::string> keys() const;

  /// Sets a key of a table. \return this
  Value& set(std::string_view key, const Value& value);

  /// On one line, as TOML; numbers read back as the same bits.
  [[nodiscard]] std::string to_toml() const;

  struct Data;  ///< of the library alone

 private:
  friend struct Access;
  struct Whole {
    std::int64_t number;
    bool above_zero;
  };
  Value(Whole whole);
  std::shared_ptr<const Data> data_;
};

}  // namespace asdic
