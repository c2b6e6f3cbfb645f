#include <fmt/format.h>

#include <algorithm>

#include "app/console.h"
#include "app/description.h"
#include "app/shared_files.h"

// What --help prints.
namespace asdic::detail::app {
namespace {

constexpr std::size_t most_in_left_column = 26;

std::string joined(const std::vector<std::string>& parts, const std::string& between) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : between) + part;
  return text;
}

/// "-o, --output FILE.h5"
std::string names_of(const OptionDescription& option) {
  if (option.names.empty()) return option.value + (option.repeatable ? "..." : "");
  return joined(option.names, ", ") + (option.value.empty() ? "" : ' ' + option.value);
}

/// Names to the left, what they mean to the right; a long name has a line of its own.
struct Columns {
  std::vector<std::pair<std::string, std::string>> rows;

  [[nodiscard]] std::size_t left() const {
    std::size_t widest = 0;
    for (const auto& row : rows)
      if (columns_of(row.first) <= most_in_left_column)
        widest = std::max(widest, columns_of(row.first));
    return widest + 4;
  }
  [[nodiscard]] std::string text(std::size_t left, std::size_t width) const {
    std::string all;
    for (const auto& [name, meaning] : rows) {
      std::string begin = "  " + name;
      if (columns_of(begin) + 2 > left) {
        all += begin + '\n';
        begin.clear();
      }
      begin.resize(begin.size() + left - columns_of(begin), ' ');
      all += wrapped(begin + meaning, width, left);
    }
    return all;
  }
};

void add_options(const std::vector<OptionDescription>& options, std::size_t width,
                 std::string& text) {
  std::vector<std::pair<std::string, Columns>> groups;
  std::size_t left = 0;
  for (const OptionDescription& option : options) {
    const std::string heading = option.names.empty() ? "Words" : option.group;
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const auto& known) { return known.first == heading; });
    if (group == groups.end()) group = groups.insert(groups.end(), {heading, {}});
    group->second.rows.emplace_back(names_of(option), whole_help(option));
  }
  // what stands by its place comes first
  std::stable_partition(groups.begin(), groups.end(),
                        [](const auto& group) { return group.first == "Words"; });
  for (const auto& group : groups) left = std::max(left, group.second.left());
  for (const auto& [heading, columns] : groups)
    text += '\n' + emphasised(heading + ":") + '\n' + columns.text(left, width);
}

void add_footer(const std::string& footer, std::size_t width, std::string& text) {
  const Footer parts = parts_of_footer(footer);
  if (!footer.empty()) text += '\n';
  for (const std::string& paragraph : parts.paragraphs) text += wrapped(paragraph, width, 0);
  std::string begin = parts.examples.size() > 1 ? "Examples: " : "Example:  ";
  for (const std::string& example : parts.examples) {
    text += wrapped(begin + example, width, 12, " \\");
    begin = std::string(begin.size(), ' ');
  }
}

/// An example that works as it stands: with the scenarios where they are.
std::string with_places(std::string example) {
  const std::string_view relative = " scenarios/";
  const std::string place = ' ' + told_place("scenarios") + '/';
  for (std::size_t at = 0; (at = example.find(relative, at)) != std::string::npos;
       at += place.size())
    example.replace(at, relative.size(), place);
  return example;
}

}  // namespace

Footer parts_of_footer(const std::string& text) {
  Footer parts;
  bool examples = false;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    constexpr std::string_view mark = "Example:";
    if (line.starts_with(mark)) {
      examples = true;
      line.erase(0, mark.size());
    } else if (!line.starts_with(' ')) {
      examples = false;
    }
    line.erase(0, line.find_first_not_of(' '));
    if (examples) line = with_places(line);
    if (!line.empty()) (examples ? parts.examples : parts.paragraphs).push_back(line);
  }
  return parts;
}

std::string whole_help(const OptionDescription& option) {
  std::vector<std::string> more;
  if (option.required && !option.names.empty()) more.emplace_back("required");
  const auto tells = [&](const std::string& what) {
    return option.help.find(what) != std::string::npos;
  };
  if (!option.words.empty() && !std::all_of(option.words.begin(), option.words.end(), tells))
    more.push_back(joined(option.words, ", "));
  if (!option.limits.empty() && !tells(option.limits)) more.push_back(option.limits);
  if (!option.not_with.empty()) more.push_back("not with " + joined(option.not_with, ", "));
  if (!option.fallback.empty()) more.push_back("default: " + option.fallback);
  return option.help + (more.empty() ? "" : " (" + joined(more, "; ") + ')');
}

std::string brief_of(const ProgramDescription& program, const CommandDescription& command) {
  for (const CommandGroup& group : program.groups)
    for (const auto& one : group.lines)
      if (one.command == command.name) return one.brief;
  return command.help.substr(0, command.help.find_first_of(".;:"));
}

std::string usage(const ProgramDescription& program, const CommandDescription& command) {
  std::string text = program.name + ' ' + command.name;
  for (const OptionDescription& option : command.options)
    if (option.required && !option.names.empty())
      text += ' ' + option.names.back() + ' ' + option.value;
  for (const OptionDescription& option : command.options)
    if (option.names.empty())
      text += ' ' + (option.required ? names_of(option) : '[' + names_of(option) + ']');
  return text + " [OPTIONS]";
}

std::string help_text(const ProgramDescription& program, const CommandDescription& command,
                      std::size_t width) {
  std::string text = wrapped(command.help, width, 0);
  text += '\n' + wrapped("Usage: " + usage(program, command), width, 7);
  add_options(command.options, width, text);
  add_footer(command.footer, width, text);
  return text;
}

std::string help_text(const ProgramDescription& program, std::size_t width) {
  std::string text = wrapped(program.help, width, 0);
  text += "\nUsage: " + program.name + " COMMAND [WORDS] [OPTIONS]\n";
  std::vector<std::pair<std::string, Columns>> groups;
  if (program.groups.empty()) {
    Columns columns;
    for (const CommandDescription& command : program.commands)
      columns.rows.emplace_back(command.name, command.help);
    groups.emplace_back("Commands", std::move(columns));
  }
  for (const CommandGroup& group : program.groups) {
    Columns columns;
    for (const auto& [command, brief] : group.lines) columns.rows.emplace_back(command, brief);
    groups.emplace_back(group.heading, std::move(columns));
  }
  std::size_t left = 0;
  for (const auto& group : groups) left = std::max(left, group.second.left());
  for (const auto& [heading, columns] : groups)
    text += '\n' + emphasised(heading + ":") + '\n' + columns.text(left, width);
  add_footer(program.footer, width, text);
  return text;
}

}  // namespace asdic::detail::app
