#include "app/program.h"

#include <signal.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "app/console.h"
#include "app/provenance.h"
#include "core/error.h"
#include "io/text/toml_value.h"

namespace asdic::app {
namespace {

enum ExitStatus : int { success = 0, failure = 1, bad_input = 2 };

int complain(const std::string& message, int status) {
  std::fflush(stdout);
  std::fputs(("asdic: " + message + '\n').c_str(), stderr);
  return status;
}

/// The command that was being parsed: its help is the one that helps.
std::string help_of(const CLI::App& program) {
  const auto chosen = program.get_subcommands();
  return chosen.empty() ? "asdic --help" : "asdic " + chosen.front()->get_name() + " --help";
}

/// What a mistyped word looks most like, as a question; "" when nothing is near.
std::string did_you_mean(const std::string& typed, const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(typed, names);
  return nearest.empty() ? "" : " (did you mean \"" + nearest + "\"?)";
}

/// Words that no command or option takes, in the order in which they were typed.
std::string extras_text(const CLI::App& program, std::span<char* const> words) {
  const auto chosen = program.get_subcommands();
  std::vector<std::string> names;
  if (chosen.empty()) {
    for (const CLI::App* command : program.get_subcommands({}))
      names.push_back(command->get_name());
    for (const std::string word : words)
      if (!word.starts_with('-'))
        return word + ": found no such command" + did_you_mean(word, names) + ", expected one of " +
               CLI::detail::join(names, ", ");
  } else {
    for (const CLI::Option* option : chosen.front()->get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  std::vector<std::string> left = program.remaining(true);
  std::string text;
  for (const std::string word : words) {
    const auto found = std::find(left.begin(), left.end(), word);
    if (found == left.end()) continue;
    left.erase(found);
    text += (text.empty() ? "" : ", ") + word;
    if (word.starts_with("--")) text += did_you_mean(word, names);
  }
  return "not expected: " + text;
}

int run(int argc, char** argv, std::span<const AddCommand> commands) {
  CLI::App program(
      "asdic simulates an active sonar in a real ocean: a ping goes out, sound\n"
      "refracts, strikes the surface and the targets, and comes back to every phone.",
      "asdic");
  program.set_version_flag("--version", version_text());
  program.require_subcommand(0, 1);
  program.footer(
      "Example:  asdic ping scenarios/deep_ocean.toml -o deep_ocean.h5\n"
      "Exit status: 0 done, 1 it could not be done, 2 the input is wrong.");
  Action action;
  for (const AddCommand add : commands) add(program, action);
  for (CLI::App* command : program.get_subcommands({}))
    command->set_version_flag("--version", version_text());
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help) {  // --help, --version
    const int status = program.exit(help);
    flush_output();
    return status;
  } catch (const CLI::ExtrasError&) {
    const std::span<char* const> words(argv + 1, static_cast<std::size_t>(argc - 1));
    return complain(extras_text(program, words) + "; see " + help_of(program), bad_input);
  } catch (const CLI::ParseError& error) {
    return complain(std::string(error.what()) + "; see " + help_of(program), bad_input);
  }
  if (!action) return complain("no command was given; see asdic --help", bad_input);
  const int status = action();
  flush_output();
  return status;
}

}  // namespace

int run_program(int argc, char** argv, std::span<const AddCommand> commands) {
  signal(SIGXFSZ, SIG_IGN);  // a file over its limit is a failed write, told as any other
  try {
    return run(argc, argv, commands);
  } catch (const InputError& error) {
    return complain(error.what(), bad_input);
  } catch (const std::bad_alloc&) {
    return complain("not enough memory for this run", failure);
  } catch (const std::exception& error) {
    return complain(error.what(), failure);
  }
}

}  // namespace asdic::app
