#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "app/description.h"
#include "core/quantity.h"

// The command line as asdic's commands describe it. CLI11 stands behind it in command.cpp alone: it
// takes seconds to compile.
namespace CLI {
class App;
class Option;
class Validator;
}  // namespace CLI

namespace asdic::detail {
class InputError;
}

namespace asdic::detail::app {

/// What the command line asked for. \return the exit status
using Action = std::function<int()>;

/// A rule that the words of an option obey.
using Check = std::shared_ptr<const CLI::Validator>;

/// Numbers above zero.
[[nodiscard]] Check above_zero();
/// Numbers of at least zero.
[[nodiscard]] Check not_negative();
/// Numbers from low to high.
[[nodiscard]] Check between(double low, double high);
/// Whole numbers from low to high.
[[nodiscard]] Check between(int low, int high);
/// A whole number from low to high: "found 70000, expected a port from 0 to 65535".
/// \param noun  "a port"
[[nodiscard]] Check whole_number(std::int64_t low, std::int64_t high, const std::string& noun);

/// A number of this kind: "found 0, expected a probability above 0 up to 0.5".
[[nodiscard]] Check number_of(const Quantity& quantity);

/// A fault of an argument, told of the option that says it: "source_depth" is --source-depth. What
/// is a fault of a file or of a setting stays as it is.
[[nodiscard]] InputError told_of_option(const InputError& error);

/// A handle of one option. Its methods say more about it, and return it.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  // NOLINTBEGIN(modernize-use-nodiscard): these change the option
  Option required() const;
  Option type_name(const std::string& name) const;  ///< what help calls its word: "FILE.h5"
  Option check(const Check& rule) const;
  /// One of these words, in capitals or not; what is stored is the word as it stands here.
  Option one_of(const std::vector<std::string>& words) const;
  Option show_default() const;                     ///< in help
  Option delimiter(char mark) const;               ///< between the parts of one word: -5,0,5
  Option one_at_a_time() const;                    ///< may be repeated, takes one word each time
  Option excludes(Option other) const;             ///< not both
  Option group(const std::string& heading) const;  ///< of help
                                                   // NOLINTEND(modernize-use-nodiscard)

 private:
  CLI::Option* option_;
};

/// A handle of one command: what is typed after the program's name. Stores outlive the parsing.
class Command {
 public:
  Command(CLI::App* command, Action* chosen) : command_(command), chosen_(chosen) {}

  /// An option, "-o,--output", or a word by its place, "FILE".
  /// \tparam T  a number, a text, an optional or a vector of them; command.cpp lists all
  template <class T>
  Option add_option(const std::string& name, T& store, const std::string& help) const;

  /// A length: 60km, 500m, or plain metres; "--range" or "-r,--range".
  Option add_length(const std::string& name, double& store, const std::string& help) const;
  Option add_length(const std::string& name, std::optional<double>& store,
                    const std::string& help) const;

  /// Becomes true; "!--name" becomes false.
  Option add_flag(const std::string& name, bool& store, const std::string& help) const;
  /// Becomes `value`.
  Option add_flag(const std::string& name, std::optional<bool>& store, bool value,
                  const std::string& help) const;

  void footer(const std::string& text) const;

  /// What the command does.
  void runs(Action action) const;

 private:
  CLI::App* command_;
  Action* chosen_;
};

/// A command line that makes no sense; what() says what, and where help is.
class UsageError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A program and its commands.
class Program {
 public:
  /// \param version  what --version prints, of the program and of each command
  Program(const std::string& name, const std::string& description, const std::string& version);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// \param define  gives the command its options, once it is the one that was typed: most of what
  /// starting takes would be options of the others
  void add_command(const std::string& name, const std::string& help,
                   std::function<void(const Command&)> define);
  void footer(const std::string& text);
  /// What the program shows when nothing is asked of it: every command in one of these groups.
  /// Without them it complains.
  void overview(std::vector<CommandGroup> groups) { groups_ = std::move(groups); }

  /// Every command with its options: each is defined for it.
  [[nodiscard]] ProgramDescription description() const;

  /// \return what the chosen command does, or what prints the help or the version \throws
  /// UsageError \throws InputError naming an option whose word is wrong
  [[nodiscard]] Action parse(int argc, char** argv);

 private:
  [[nodiscard]] std::string complaint_about_extras(int argc, char** argv) const;
  [[nodiscard]] std::string see_help() const;

  /// A command that may be typed.
  struct Known {
    std::string name, help;
    std::function<void(const Command&)> define;
  };
  void add(const Known& command);
  [[nodiscard]] CommandDescription described(const Known& command) const;
  [[nodiscard]] ProgramDescription without_commands() const;

  std::string name_, version_;
  std::vector<Known> commands_;
  std::vector<CommandGroup> groups_;
  std::unique_ptr<CLI::App> app_;
  Action chosen_;
};

// Each adds its command to the program.
void add_ping_command(Program& program);
void add_rays_command(Program& program);
void add_arrivals_command(Program& program);
void add_validate_command(Program& program);
void add_info_command(Program& program);
void add_plot_command(Program& program);
void add_export_command(Program& program);
void add_compare_command(Program& program);
void add_field_command(Program& program);
void add_explain_command(Program& program);
void add_area_command(Program& program);
void add_place_command(Program& program);
void add_ocean_command(Program& program);
void add_bellhop_command(Program& program);
void add_convert_command(Program& program);
void add_process_command(Program& program);
void add_study_command(Program& program);
void add_merge_command(Program& program);
void add_recover_command(Program& program);
void add_listen_command(Program& program);
void add_serve_command(Program& program);
void add_settings_command(Program& program);
/// Tells of the program itself. It outlives the parsing.
void add_help_command(Program& program);

/// A scenario as the command line names it.
struct ScenarioChoice {
  std::string path;
  std::vector<std::string> overrides;  ///< key.path=value
};

/// SCENARIO and --set, as every command that reads a scenario has them.
void add_scenario_options(const Command& command, ScenarioChoice& choice);
/// --set alone, of a command whose file may be a scenario or something else.
void add_set_option(const Command& command, ScenarioChoice& choice);

/// --threads, as every command that computes has it.
void add_threads_option(const Command& command, std::optional<int>& threads);

/// --force, as every command that writes a file has it.
void add_force_option(const Command& command, bool& force);

/// Metres out of "60km", "500 m", "2.5e3". \throws InputError{where: `name`}
[[nodiscard]] double parse_length(const std::string& name, const std::string& text);

}  // namespace asdic::detail::app
