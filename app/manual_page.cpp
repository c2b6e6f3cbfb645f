#include <algorithm>
#include <cctype>

#include "app/description.h"

// Manual pages in the language of man(7).
namespace asdic::detail::app {
namespace {

/// Text as it is: no sign of it is roff's.
std::string roff_text(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '\\')
      safe += "\\e";
    else if (c == '-')
      safe += "\\-";
    else if (c == '\'')
      safe += "\\(aq";
    else if (c == '`')
      safe += "\\(ga";
    else if (c == '^')
      safe += "\\(ha";
    else if (c == '~')
      safe += "\\(ti";
    else
      safe += c;
  }
  return safe;
}

/// A line of text; one that begins with a dot is none of roff's.
std::string roff_line(const std::string& text) {
  return (text.starts_with('.') ? "\\&" : "") + roff_text(text) + '\n';
}

std::string roff_bold(const std::string& text) { return "\\fB" + roff_text(text) + "\\fR"; }
std::string roff_italic(const std::string& text) { return "\\fI" + roff_text(text) + "\\fR"; }

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string title(const ProgramDescription& program, const std::string& page) {
  const std::string version = program.version.substr(0, program.version.find('\n'));
  return ".\\\" Written by " + program.name + " help --man.\n.TH " + roff_text(upper(page)) +
         " 1 \"\" \"" + roff_text(version) + "\" \"asdic manual\"\n.nh\n";
}

std::string section(const std::string& name) { return ".SH " + name + '\n'; }

void add_options(const std::vector<OptionDescription>& options, std::string& text) {
  std::string heading;
  for (const OptionDescription& option : options) {
    if (!option.names.empty() && option.group != "Options" && option.group != heading) {
      heading = option.group;
      text += ".SS " + roff_text(heading) + '\n';
    }
    std::string names;
    for (const std::string& name : option.names)
      names += (names.empty() ? "" : ", ") + roff_bold(name);
    if (!option.value.empty()) names += (names.empty() ? "" : " ") + roff_italic(option.value);
    text += ".TP\n" + names + '\n' + roff_line(whole_help(option));
  }
}

void add_footer(const std::string& footer, std::string& text) {
  const Footer parts = parts_of_footer(footer);
  if (!parts.paragraphs.empty()) text += section("NOTES");
  for (std::size_t i = 0; i < parts.paragraphs.size(); ++i)
    text += (i > 0 ? ".PP\n" : "") + roff_line(parts.paragraphs[i]);
  if (!parts.examples.empty()) text += section("EXAMPLES") + ".nf\n";
  for (const std::string& example : parts.examples) text += roff_line(example);
  if (!parts.examples.empty()) text += ".fi\n";
}

std::string status(const CommandDescription* command) {
  std::string text = section("EXIT STATUS");
  if (command != nullptr && command->footer.find("Exit status") != std::string::npos)
    return text + "See NOTES.\n";
  return text +
         ".TP\n0\ndone\n.TP\n1\nit could not be done, or was interrupted\n"
         ".TP\n2\nthe input is wrong\n";
}

std::string environment() {
  return section("ENVIRONMENT") +
         ".TP\n\\fBASDIC_PYTHON\\fR\nthe Python that draws pictures, in place of "
         "/usr/bin/python3\n"
         ".TP\n\\fBASDIC_LEVEL\\fR\nx86\\-64\\-v2, \\-v3 or \\-v4: the instructions to use, at "
         "most those of the processor\n"
         ".TP\n\\fBCOLUMNS\\fR\nhow wide help is; without it, as wide as the terminal\n"
         ".TP\n\\fBNO_COLOR\\fR\nif set, no bold letters\n";
}

}  // namespace

std::string manual_page(const ProgramDescription& program, const CommandDescription& command) {
  const std::string page = program.name + '-' + command.name;
  std::string text = title(program, page) + section("NAME") + roff_text(page) + " \\- " +
                     roff_text(brief_of(program, command)) + '\n' + section("SYNOPSIS") +
                     roff_text(usage(program, command)) + '\n' + section("DESCRIPTION") +
                     roff_line(command.help) + section("OPTIONS");
  std::vector<OptionDescription> options = command.options;
  std::stable_partition(options.begin(), options.end(),
                        [](const OptionDescription& option) { return option.names.empty(); });
  // of groups with a heading of their own, each as a whole, at the end
  std::stable_partition(options.begin(), options.end(), [](const OptionDescription& option) {
    return option.names.empty() || option.group == "Options";
  });
  add_options(options, text);
  add_footer(command.footer, text);
  return text + status(&command) + environment() + section("SEE ALSO") + ".BR " +
         roff_text(program.name) + " (1)\n";
}

std::string manual_page(const ProgramDescription& program) {
  const std::string brief = program.help.substr(0, program.help.find_first_of(":."));
  std::string text =
      title(program, program.name) + section("NAME") + roff_text(program.name) + " \\- " +
      roff_text(brief.starts_with(program.name + ' ') ? brief.substr(program.name.size() + 1)
                                                      : brief) +
      '\n' + section("SYNOPSIS") + roff_text(program.name) + " COMMAND [WORDS] [OPTIONS]\n" +
      section("DESCRIPTION") + roff_line(program.help) + section("COMMANDS");
  for (const CommandGroup& group : program.groups) {
    text += ".SS " + roff_text(group.heading) + '\n';
    for (const auto& one : group.lines)
      text += ".TP\n.BR " + roff_text(program.name + '-' + one.command) + " (1)\n" +
              roff_line(one.brief);
  }
  if (program.groups.empty())
    for (const CommandDescription& command : program.commands)
      text += ".TP\n.BR " + roff_text(program.name + '-' + command.name) + " (1)\n" +
              roff_line(command.help);
  text += section("OPTIONS");
  add_options(program.options, text);
  add_footer(program.footer, text);
  text += status(nullptr) + environment() + section("SEE ALSO");
  for (const CommandDescription& command : program.commands)
    text += ".BR " + roff_text(program.name + '-' + command.name) +
            (&command == &program.commands.back() ? " (1)\n" : " (1),\n");
  return text;
}

}  // namespace asdic::detail::app
