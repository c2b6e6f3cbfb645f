#include "app/settings_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include "core/error.h"
#include "core/fields_viewer.h"
#include "core/text.h"

namespace asdic::detail::app {
namespace {

/// The rule of a number's option.
Check rule_of(const Quantity& q) {
  const bool open = q.high == infinity;
  if (open && q.low == 0.0) return q.above ? above_zero() : not_negative();
  return number_of(q);
}

/// What help calls the word of a number: "MPS", "N" of "number of cells".
std::string type_of(const Quantity& q) {
  if (q.unit == "dB") return "DB";
  if (q.unit == "m/s") return "MPS";
  if (q.unit == "s") return "S";
  return {static_cast<char>(std::toupper(static_cast<unsigned char>(q.noun.front())))};
}

/// Settings of this kind have no option, nor a place in the list of those in use: whoever describes
/// one gives it both.
[[noreturn]] void no_option(std::string_view key) {
  throw std::logic_error("no option is known for settings like " + std::string(key));
}

/// A walk over settings that stand in one flat list: numbers, whole numbers, words, texts, flags.
class FlatSettings : public FieldsViewer {
  void angle(const Setting& s, const AngleQuantity&, double&, bool*) override {
    no_option(s.key.name);
  }
  void numbers(const Setting& s, const Quantity&, std::vector<double>&) override {
    no_option(s.key.name);
  }
  void angles(const Setting& s, const AngleQuantity&, std::vector<double>&) override {
    no_option(s.key.name);
  }
  void vector(const Setting& s, const Quantity&, std::span<double>, std::string_view) override {
    no_option(s.key.name);
  }
  void vectors(const Setting& s, const Quantity&, std::vector<Vec3>&) override {
    no_option(s.key.name);
  }
  void table(const Setting& s, const Structure&) override { no_option(s.key.name); }
  void perhaps(const Setting& s, const Perhaps&) override { no_option(s.key.name); }
  void tables(const Setting& s, const List&, const ListRules&) override { no_option(s.key.name); }
  void alternatives(const Setting& s, const OneOf&) override { no_option(s.key.name); }
};

/// Tells what is in use.
class InUse final : public FlatSettings {
 public:
  explicit InUse(std::vector<std::string>& list) : list_(list) {}

 private:
  void number(const Setting& s, const Quantity&, double& value, bool* given) override {
    if (given == nullptr || *given) list_.push_back(fmt::format("{}={}", s.key.name, value));
  }
  void integer(const Setting& s, std::int64_t, std::int64_t, std::int64_t& value,
               bool* given) override {
    if (given == nullptr || *given) list_.push_back(fmt::format("{}={}", s.key.name, value));
  }
  void flag(const Setting& s, bool& value) override {
    list_.push_back(fmt::format("{}={}", s.key.name, value));
  }
  void text(const Setting& s, std::string& value) override {
    if (!value.empty()) list_.push_back(fmt::format("{}={}", s.key.name, value));
  }
  void choice(const Setting& s, std::span<const std::string_view> words,
              std::size_t& index) override {
    list_.push_back(fmt::format("{}={}", s.key.name, words[index]));
  }

  std::vector<std::string>& list_;
};

}  // namespace

/// Gives a command the options.
class OptionAdder final : public FlatSettings {
 public:
  OptionAdder(const Command& command, SettingsOptions& options)
      : command_(command), options_(options) {}
  [[nodiscard]] bool exhaustive() const override { return true; }

 private:
  template <class T>
  T& store(const Setting& s, T value) {
    const auto [at, is_new] =
        options_.typed_.insert_or_assign(std::string(s.key.name), std::move(value));
    return std::get<T>(at->second);
  }
  [[nodiscard]] std::string option(const Setting& s) const { return options_.name_of(s.key.name); }

  void number(const Setting& s, const Quantity& q, double& value, bool* given) override {
    std::string help(s.help);
    if (q.unit == "m" && given != nullptr) {
      command_.add_length(option(s), store(s, std::optional<double>()), help);
      return;
    }
    if (!q.unit.empty() && !s.key.name.ends_with("_db")) help += fmt::format(" [{}]", q.unit);
    if (given != nullptr) {
      auto& typed = store(s, *given ? std::optional(value) : std::nullopt);
      command_.add_option(option(s), typed, help).type_name(type_of(q)).check(rule_of(q));
      return;
    }
    command_.add_option(option(s), store(s, value), help)
        .show_default()
        .type_name(type_of(q))
        .check(rule_of(q));
  }
  void integer(const Setting& s, std::int64_t low, std::int64_t high, std::int64_t& value,
               bool* given) override {
    if (given != nullptr) no_option(s.key.name);
    command_.add_option(option(s), store(s, static_cast<int>(value)), std::string(s.help))
        .show_default()
        .type_name("N")
        .check(between(static_cast<int>(low), static_cast<int>(high)));
  }
  void flag(const Setting& s, bool& value) override {
    const auto found = options_.words_.find(s.key.name);
    const bool opposite = found != options_.words_.end() && !found->second.help.empty();
    command_.add_flag(option(s), store(s, value),
                      opposite ? found->second.help : std::string(s.help));
  }
  void text(const Setting& s, std::string& value) override {
    const Option made = command_.add_option(option(s), store(s, value), std::string(s.help));
    if (!value.empty()) made.show_default();
    if (const auto found = options_.words_.find(s.key.name); found != options_.words_.end())
      made.type_name(found->second.type);
  }
  void choice(const Setting& s, std::span<const std::string_view> words,
              std::size_t& index) override {
    command_.add_option(option(s), store(s, std::string(words[index])), std::string(s.help))
        .show_default()
        .one_of({words.begin(), words.end()});
  }

  const Command& command_;
  SettingsOptions& options_;
};

/// Sets what was typed.
class OptionReader final : public FlatSettings {
 public:
  explicit OptionReader(const SettingsOptions& options) : options_(options) {}
  [[nodiscard]] bool reads() const override { return true; }
  [[nodiscard]] bool checks() const override { return true; }
  void fault(std::string_view key, const std::string& expected,
             std::optional<std::string> got) override {
    if (!got) got = in_quotes(typed<std::string>(key));
    throw InputError({.where = options_.name_of(key), .got = *got, .expected = expected});
  }

 private:
  template <class T>
  [[nodiscard]] const T& typed(std::string_view key) const {
    return std::get<T>(options_.typed_.find(key)->second);
  }

  void number(const Setting& s, const Quantity&, double& value, bool* given) override {
    if (given == nullptr) {
      value = typed<double>(s.key.name);
      return;
    }
    const auto& number = typed<std::optional<double>>(s.key.name);
    *given = number.has_value();
    value = number.value_or(0.0);
  }
  void integer(const Setting& s, std::int64_t, std::int64_t, std::int64_t& value, bool*) override {
    value = typed<int>(s.key.name);
  }
  void flag(const Setting& s, bool& value) override { value = typed<bool>(s.key.name); }
  void text(const Setting& s, std::string& value) override {
    value = typed<std::string>(s.key.name);
  }
  void choice(const Setting& s, std::span<const std::string_view> words,
              std::size_t& index) override {
    index = static_cast<std::size_t>(
        std::find(words.begin(), words.end(), typed<std::string>(s.key.name)) - words.begin());
  }

  const SettingsOptions& options_;
};

void SettingsOptions::add(const Command& command, const Fields::Structure& defaults) {
  OptionAdder walker(command, *this);
  defaults.describe(walker);
}

void SettingsOptions::read(const Fields::Structure& settings) const {
  OptionReader walker(*this);
  settings.describe(walker);
}

/// "--max-speed" of "max_speed".
std::string SettingsOptions::name_of(std::string_view key) const {
  const auto found = words_.find(key);
  if (found != words_.end() && !found->second.name.empty()) return found->second.name;
  std::string name = "--" + std::string(key);
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

void SettingsInUse::add(const Fields::Structure& settings) {
  InUse walker(list_);
  settings.describe(walker);
}

}  // namespace asdic::detail::app
