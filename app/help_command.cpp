#include <algorithm>
#include <memory>

#include "app/command.h"
#include "app/console.h"
#include "app/settings_sections.h"
#include "app/topics.h"
#include "core/error.h"
#include "core/text.h"

namespace asdic::detail::app {
namespace {

struct HelpOptions {
  std::string topic, shell;
  bool man = false;
};

const CommandDescription* command_of(const ProgramDescription& program, const std::string& name) {
  const auto found = std::find_if(program.commands.begin(), program.commands.end(),
                                  [&](const auto& command) { return command.name == name; });
  return found == program.commands.end() ? nullptr : &*found;
}

std::string joined_commands(const ProgramDescription& program) {
  std::string names;
  for (const auto& command : program.commands) names += (names.empty() ? "" : ", ") + command.name;
  return names;
}

/// A word that is neither a command nor a subject; a table of settings has its own command.
InputError no_such_topic(const ProgramDescription& program, const std::string& name) {
  std::vector<std::string> names;
  for (const auto& command : program.commands) names.push_back(command.name);
  for (const Topic& topic : topics()) names.push_back(topic.name);
  std::string got = "no such command or subject";
  const std::string nearest = nearest_name(name, names);
  const auto sections = settings_sections();
  if (std::any_of(sections.begin(), sections.end(),
                  [&](const SettingsSection& section) { return section.path == name; }))
    got += ", but a table of scenarios: see asdic settings " + name;
  else if (!nearest.empty())
    got += " (did you mean \"" + nearest + "\"?)";
  return InputError({.where = name,
                     .got = got,
                     .expected = "one of the subjects " + joined_topics() +
                                 ", or a command: " + joined_commands(program)});
}

std::string list_of_topics(std::size_t width) {
  std::string text = '\n' + emphasised("Subjects (asdic help TOPIC):") + '\n';
  std::size_t left = 0;
  for (const Topic& topic : topics()) left = std::max(left, topic.name.size());
  for (const Topic& topic : topics())
    text +=
        wrapped("  " + topic.name + std::string(left + 2 - topic.name.size(), ' ') + topic.brief,
                width, left + 4);
  return text;
}

void tell_topic(const ProgramDescription& program, const std::string& name) {
  const auto topic = std::find_if(topics().begin(), topics().end(), [&](const Topic& one) {
    return one.name == name || one.name + 's' == name;
  });
  const CommandDescription* const command = command_of(program, name);
  if (topic == topics().end() && command == nullptr) throw no_such_topic(program, name);
  if (topic != topics().end()) print(topic_text(*topic, help_width()));
  if (topic != topics().end() && command != nullptr)
    print('\n' + emphasised(program.name + ' ' + name + ':') + '\n');
  if (command != nullptr) print(help_text(program, *command, help_width()));
}

int help(const ProgramDescription& program, const HelpOptions& options) {
  if (!options.shell.empty()) {
    print(completion(program, options.shell));
  } else if (options.man) {
    if (options.topic.empty() || options.topic == program.name) {
      print(manual_page(program));
    } else {
      const CommandDescription* const command = command_of(program, options.topic);
      if (command == nullptr)
        throw InputError({.where = options.topic,
                          .got = "no such command",
                          .expected = "nothing, or one of " + joined_commands(program)});
      print(manual_page(program, *command));
    }
  } else if (options.topic.empty()) {
    print(help_text(program, help_width()) + list_of_topics(help_width()));
  } else {
    tell_topic(program, options.topic);
  }
  return 0;
}

}  // namespace

void add_help_command(Program& program) {
  program.add_command(
      "help",
      "Tell of a command or a subject; without a word, what there is. Manual pages and completions "
      "of shells are written here, too.",
      [&program](const Command& command) {
        auto options = std::make_shared<HelpOptions>();
        command.add_option("TOPIC", options->topic, "a command, or a subject");
        const Option man = command.add_flag(
            "--man", options->man,
            "write the manual page, of the program or of the command TOPIC, for man -l");
        command
            .add_option("--completion", options->shell,
                        "write what a shell needs to complete the program's words")
            .type_name("SHELL")
            .one_of({"bash", "zsh", "fish"})
            .excludes(man);
        command.footer(
            "Example:  asdic help units\n"
            "          asdic help --man ping | man -l -");
        command.runs([options, &program] { return help(program.description(), *options); });
      });
}

}  // namespace asdic::detail::app
