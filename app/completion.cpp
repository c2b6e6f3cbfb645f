#include <algorithm>
#include <string_view>

#include "app/description.h"
#include "app/settings_sections.h"
#include "app/topics.h"

// Completion of a program's words in bash, zsh and fish.
namespace asdic::detail::app {
namespace {

/// What the shell offers for a word.
struct Offer {
  enum class Kind { nothing, words, files, folders } kind = Kind::nothing;
  std::vector<std::string> words{};
  std::string ending{};  ///< of the files, ".toml"; "": any
};

Offer offer(const ProgramDescription& program, const OptionDescription& option) {
  using Kind = Offer::Kind;
  if (!option.words.empty()) return {Kind::words, option.words};
  if (option.value == "TOPIC") {
    Offer all{Kind::words};
    for (const CommandDescription& command : program.commands) all.words.push_back(command.name);
    for (const Topic& topic : topics())
      if (std::find(all.words.begin(), all.words.end(), topic.name) == all.words.end())
        all.words.push_back(topic.name);
    return all;
  }
  if (option.value == "SECTION") {
    Offer all{Kind::words};
    for (const SettingsSection& section : settings_sections()) all.words.push_back(section.path);
    return all;
  }
  if (option.value == "DIR") return {Kind::folders};
  if (option.value == "SCENARIO" || option.value == "STUDY" ||
      option.value.find(".toml") != std::string::npos)
    return {Kind::files, {}, ".toml"};
  if (option.names.empty() || option.value.find("FILE") != std::string::npos ||
      option.value == "ROOT" || option.value == "PATH")
    return {Kind::files};
  return {};
}

std::string spaced(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

std::vector<std::string> all_names_of(const std::vector<OptionDescription>& options) {
  std::vector<std::string> names;
  for (const OptionDescription& option : options)
    names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

/// In single quotes, for a shell. \param also  signs that get a backslash
std::string quoted(const std::string& text, std::string_view also, std::string_view quote) {
  std::string safe = "'";
  for (const char c : text) {
    if (c == '\'') {
      safe += quote;
      continue;
    }
    if (also.find(c) != std::string_view::npos) safe += '\\';
    safe += c;
  }
  return safe + '\'';
}

/// A C name for shell functions: asdic_mpi.
std::string identifier(std::string name) {
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

// bash
// ---------------------------------------------------------------------------------------------

std::string bash_words(const std::string& words) {
  return "mapfile -t COMPREPLY < <(compgen -W '" + words + "' -- \"$current\")";
}

std::string bash_offer(const Offer& what) {
  switch (what.kind) {
    case Offer::Kind::words:
      return bash_words(spaced(what.words));
    case Offer::Kind::folders:
      return "compopt -o filenames; mapfile -t COMPREPLY < <(compgen -d -- \"$current\")";
    case Offer::Kind::files:
      if (what.ending.empty())
        return "compopt -o filenames; mapfile -t COMPREPLY < <(compgen -f -- \"$current\")";
      return "compopt -o filenames; mapfile -t COMPREPLY < <(compgen -d -- \"$current\"; compgen "
             "-f "
             "-X '!*" +
             what.ending + "' -- \"$current\")";
    case Offer::Kind::nothing:
      break;
  }
  return ":";
}

std::string bash(const ProgramDescription& program) {
  const std::string function = '_' + identifier(program.name);
  std::vector<std::string> first;
  for (const CommandDescription& command : program.commands) first.push_back(command.name);
  for (const std::string& name : all_names_of(program.options)) first.push_back(name);
  std::string text = function +
                     "() {\n"
                     "  local current=${COMP_WORDS[COMP_CWORD]} "
                     "previous=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]}\n"
                     "  COMPREPLY=()\n"
                     "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n    " +
                     bash_words(spaced(first)) +
                     "\n    return\n  fi\n  case \"$command $previous\" in\n";
  for (const CommandDescription& command : program.commands)
    for (const OptionDescription& option : command.options) {
      if (option.names.empty() || option.value.empty()) continue;
      std::string pattern;
      for (const std::string& name : option.names)
        pattern += (pattern.empty() ? "'" : " | '") + command.name + ' ' + name + '\'';
      text += "    " + pattern + ") " + bash_offer(offer(program, option)) + "; return ;;\n";
    }
  text += "  esac\n  case \"$current\" in -*)\n    case \"$command\" in\n";
  for (const CommandDescription& command : program.commands)
    text += "      " + command.name + ") " + bash_words(spaced(all_names_of(command.options))) +
            " ;;\n";
  text += "    esac\n    return\n  esac\n  case \"$command\" in\n";
  for (const CommandDescription& command : program.commands)
    for (const OptionDescription& option : command.options) {
      if (!option.names.empty()) continue;
      text += "    " + command.name + ") " + bash_offer(offer(program, option)) + " ;;\n";
      break;
    }
  return text + "  esac\n}\ncomplete -F " + function + ' ' + program.name + '\n';
}

// zsh
// ----------------------------------------------------------------------------------------------

std::string zsh_offer(const Offer& what) {
  switch (what.kind) {
    case Offer::Kind::words:
      return '(' + spaced(what.words) + ')';
    case Offer::Kind::folders:
      return "_files -/";
    case Offer::Kind::files:
      return what.ending.empty() ? "_files" : "_files -g \"*" + what.ending + '"';
    case Offer::Kind::nothing:
      break;
  }
  return " ";
}

std::string zsh_line(const std::string& text) { return quoted(text, "", "'\\''"); }

/// Help inside of brackets.
std::string zsh_help(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') safe += '\\';
    safe += c;
  }
  return '[' + safe + ']';
}

std::string zsh(const ProgramDescription& program) {
  const std::string function = '_' + identifier(program.name);
  std::string text =
      "#compdef " + program.name + '\n' + function + "() {\n  local -a commands\n  commands=(\n";
  for (const CommandDescription& command : program.commands)
    text += "    " + zsh_line(command.name + ':' + brief_of(program, command)) + '\n';
  text +=
      "  )\n  if (( CURRENT == 2 )); then _describe command commands; return; fi\n"
      "  local command=$words[2]\n  shift words; (( CURRENT-- ))\n  case $command in\n";
  for (const CommandDescription& command : program.commands) {
    text += "    " + command.name + ") _arguments -s -S";
    for (const OptionDescription& option : command.options) {
      const std::string word = ':' + option.value + ':' + zsh_offer(offer(program, option));
      if (option.names.empty()) {
        text += " \\\n      " + zsh_line((option.repeatable ? "*" : "") + word);
        continue;
      }
      const std::string others = option.repeatable ? "*" : '(' + spaced(option.names) + ')';
      for (const std::string& name : option.names)
        text += " \\\n      " + zsh_line(others + name + zsh_help(option.help) +
                                         (option.value.empty() ? "" : word));
    }
    text += " ;;\n";
  }
  return text + "  esac\n}\nif [ \"$funcstack[1]\" = " + function + " ]; then " + function +
         " \"$@\"; else compdef " + function + ' ' + program.name + "; fi\n";
}

// fish
// ---------------------------------------------------------------------------------------------

std::string fish_line(const std::string& text) { return quoted(text, "\\", "\\'"); }

std::string fish_offer(const Offer& what) {
  switch (what.kind) {
    case Offer::Kind::words:
      return " -x -a " + fish_line(spaced(what.words));
    case Offer::Kind::folders:
      return " -x -a '(__fish_complete_directories)'";
    case Offer::Kind::files:
      return what.ending.empty() ? " -r -F"
                                 : " -x -a '(__fish_complete_suffix " + what.ending + ")'";
    case Offer::Kind::nothing:
      break;
  }
  return " -x";
}

std::string fish(const ProgramDescription& program) {
  const std::string complete = "complete -c " + program.name;
  std::string text;
  for (const CommandDescription& command : program.commands)
    text += complete + " -n __fish_use_subcommand -f -a " + command.name + " -d " +
            fish_line(brief_of(program, command)) + '\n';
  const auto add = [&](const std::string& when, const OptionDescription& option) {
    text += complete + " -n " + when;
    for (const std::string& name : option.names)
      text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (!option.value.empty()) {
      std::string words = fish_offer(offer(program, option));
      if (option.names.empty())  // a word by its place needs no -r
        for (const std::string_view need : {" -r", " -x"})
          if (words.starts_with(need)) words.replace(0, need.size(), need == " -x" ? " -f" : "");
      text += words;
    }
    text += " -d " + fish_line(option.help) + '\n';
  };
  for (const OptionDescription& option : program.options) add("__fish_use_subcommand", option);
  for (const CommandDescription& command : program.commands)
    for (const OptionDescription& option : command.options)
      add("'__fish_seen_subcommand_from " + command.name + "'", option);
  return text;
}

}  // namespace

std::string completion(const ProgramDescription& program, const std::string& shell) {
  const std::string begin = "# Written by " + program.name + " help --completion " + shell + ".\n";
  if (shell == "bash") return begin + bash(program);
  if (shell == "fish") return begin + fish(program);
  std::string text = zsh(program);  // #compdef has to be the first line
  return text.insert(text.find('\n') + 1, begin);
}

}  // namespace asdic::detail::app
