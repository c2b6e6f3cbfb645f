#pragma once
#include <string>
#include <vector>

// What a program's commands and options are, out of the one place that defines them (command.h).
// Help, manual pages and completions are made of it.
namespace asdic::detail::app {

/// An option of a command, or a word by its place.
struct OptionDescription {
  std::vector<std::string> names;  ///< "-o", "--output"; none: a word by its place
  std::string value;               ///< what its word is called: "FILE.h5"; "": a flag
  std::string limits;              ///< "above 0 to 0.5"
  std::vector<std::string> words;  ///< it is one of these
  std::vector<std::string> not_with;
  std::string fallback;  ///< its value where none is given, if that is a number or a word
  std::string help, group;
  bool required = false, repeatable = false;
};

struct CommandDescription {
  std::string name, help, footer;
  std::vector<OptionDescription> options;
};

/// Commands that belong together.
struct CommandGroup {
  struct Line {
    std::string command, brief;  ///< "ping", "what every phone receives"
  };
  std::string heading;
  std::vector<Line> lines;
};

struct ProgramDescription {
  std::string name, help, version, footer;
  std::vector<OptionDescription> options;  ///< without a command
  std::vector<CommandGroup> groups;        ///< none: the commands are listed with their help
  std::vector<CommandDescription> commands;
};

/// What `asdic COMMAND --help` prints. \param width  columns to wrap at
[[nodiscard]] std::string help_text(const ProgramDescription& program,
                                    const CommandDescription& command, std::size_t width);
/// What `asdic --help` prints, and bare `asdic`.
[[nodiscard]] std::string help_text(const ProgramDescription& program, std::size_t width);

/// A manual page (man 7 man), of the program or of a command.
[[nodiscard]] std::string manual_page(const ProgramDescription& program);
[[nodiscard]] std::string manual_page(const ProgramDescription& program,
                                      const CommandDescription& command);

/// What a shell needs to complete commands, options and their words: "bash", "zsh" or "fish".
[[nodiscard]] std::string completion(const ProgramDescription& program, const std::string& shell);

// Pieces of the above.
[[nodiscard]] std::string usage(const ProgramDescription& program,
                                const CommandDescription& command);
/// A command in a few words: its line of a group, or how its help begins.
[[nodiscard]] std::string brief_of(const ProgramDescription& program,
                                   const CommandDescription& command);
/// An option's help, with limits, words and default. Its limits are not told twice.
[[nodiscard]] std::string whole_help(const OptionDescription& option);
/// A footer's lines that say something, and those that show something to type.
struct Footer {
  std::vector<std::string> paragraphs, examples;
};
[[nodiscard]] Footer parts_of_footer(const std::string& text);

}  // namespace asdic::detail::app
