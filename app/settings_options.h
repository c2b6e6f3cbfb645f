#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "app/command.h"
#include "core/fields.h"

namespace asdic::detail::app {

/// What the command line calls a setting, where that is not its key with dashes.
struct OptionWords {
  std::string name = {};  ///< "!--time-only", which sets it false
  std::string type = {};  ///< of its word in help: "LOW:HIGH"
  std::string help = {};  ///< of a flag that says the opposite
};

/// The options of a command that stand for described settings: names, help, ranges and defaults are
/// those of the description.
class SettingsOptions {
 public:
  /// \param words  by key, of those whose options have words of their own
  explicit SettingsOptions(std::map<std::string, OptionWords, std::less<>> words = {})
      : words_(std::move(words)) {}

  /// Gives the command an option for every setting. This object outlives the parsing.
  template <Described T>
  void add(const Command& command, T& defaults) {
    add(command, Fields::structure(defaults));
  }

  /// Sets what was typed. \throws InputError naming the option
  template <Described T>
  void read(T& settings) const {
    read(Fields::structure(settings));
  }

 private:
  friend class OptionAdder;
  friend class OptionReader;
  using Typed = std::variant<double, std::optional<double>, int, bool, std::string>;

  void add(const Command& command, const Fields::Structure& defaults);
  void read(const Fields::Structure& settings) const;
  [[nodiscard]] std::string name_of(std::string_view key) const;

  std::map<std::string, OptionWords, std::less<>> words_;
  std::map<std::string, Typed, std::less<>> typed_;  // by key
};

/// What is in use of a struct's settings: "max_speed=15", in the order of their description.
class SettingsInUse {
 public:
  template <Described T>
  void add(T& settings) {
    add(Fields::structure(settings));
  }
  [[nodiscard]] const std::vector<std::string>& list() const noexcept { return list_; }

 private:
  void add(const Fields::Structure& settings);
  std::vector<std::string> list_;
};

}  // namespace asdic::detail::app
