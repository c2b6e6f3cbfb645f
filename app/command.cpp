#include "app/command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <span>

#include "app/console.h"
#include "core/error.h"
#include "core/text.h"

namespace asdic::detail::app {
namespace {

Check check_of(CLI::Validator rule) {
  return std::make_shared<const CLI::Validator>(std::move(rule));
}

/// What a mistyped word looks most like, as a question; "" when nothing is near.
std::string did_you_mean(const std::string& typed, const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(typed, names);
  return nearest.empty() ? "" : " (did you mean \"" + nearest + "\"?)";
}

/// A number out of all of a text.
template <class T>
std::optional<T> whole_text(const std::string& text) {
  T value{};
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  return error == std::errc{} && end == last ? std::optional(value) : std::nullopt;
}

/// "above 0 to 0.5".
std::string limits_of(const Quantity& q) {
  std::string text = (q.above ? "above " : q.or_zero ? "0, or " : "") + to_text(q.low);
  if (q.high < infinity) text += " to " + to_text(q.high);
  return text;
}

/// Of CLI11's own rule, whose words are those of a programmer.
template <class T>
Check range_check(T low, T high) {
  CLI::Range range(low, high);
  range.description(to_text(low) + " to " + to_text(high));
  return check_of(std::move(range));
}

}  // namespace

InputError told_of_option(const InputError& error) {
  InputFault fault = error.fault();
  const bool is_argument = std::all_of(fault.where.begin(), fault.where.end(),
                                       [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; });
  if (!is_argument) return error;
  std::replace(fault.where.begin(), fault.where.end(), '_', '-');
  fault.where = "--" + fault.where;
  return InputError(std::move(fault));
}

Check above_zero() {
  return check_of({[](const std::string& text) {
                     const double value = std::strtod(text.c_str(), nullptr);
                     return value > 0.0 && std::isfinite(value)
                                ? std::string()
                                : "found " + text + ", expected a number above 0";
                   },
                   "above 0"});
}

Check not_negative() {
  return check_of({[](const std::string& text) {
                     const auto value = whole_text<double>(text);
                     return value && *value >= 0.0 && std::isfinite(*value)
                                ? std::string()
                                : "found " + text + ", expected a number of at least 0";
                   },
                   "at least 0"});
}

Check between(double low, double high) { return range_check(low, high); }
Check between(int low, int high) { return range_check(low, high); }

Check whole_number(std::int64_t low, std::int64_t high, const std::string& noun) {
  return check_of({[low, high, noun](const std::string& text) {
                     const auto value = whole_text<std::int64_t>(text);
                     return value && *value >= low && *value <= high
                                ? std::string()
                                : "found " + text + ", expected " + noun + " from " +
                                      std::to_string(low) + " to " + std::to_string(high);
                   },
                   high == std::numeric_limits<std::int64_t>::max()
                       ? "at least " + std::to_string(low)
                       : std::to_string(low) + " to " + std::to_string(high)});
}

Check number_of(const Quantity& quantity) {
  return check_of({[quantity](const std::string& text) {
                     const auto value = whole_text<double>(text);
                     return value && quantity.holds(*value)
                                ? std::string()
                                : "found " + text + ", expected " + quantity.expected();
                   },
                   limits_of(quantity)});
}

Option Option::required() const { return Option(option_->required()); }
Option Option::type_name(const std::string& name) const { return Option(option_->type_name(name)); }
Option Option::check(const Check& rule) const { return Option(option_->check(*rule)); }
Option Option::one_of(const std::vector<std::string>& words) const {
  return Option(option_->transform(CLI::IsMember(words, CLI::ignore_case)));
}
Option Option::show_default() const { return Option(option_->capture_default_str()); }
Option Option::delimiter(char mark) const { return Option(option_->delimiter(mark)); }
Option Option::one_at_a_time() const { return Option(option_->allow_extra_args(false)); }
Option Option::excludes(Option other) const { return Option(option_->excludes(other.option_)); }
Option Option::group(const std::string& heading) const { return Option(option_->group(heading)); }

template <class T>
Option Command::add_option(const std::string& name, T& store, const std::string& help) const {
  return Option(command_->add_option(name, store, help));
}

template Option Command::add_option(const std::string&, std::string&, const std::string&) const;
template Option Command::add_option(const std::string&, int&, const std::string&) const;
template Option Command::add_option(const std::string&, double&, const std::string&) const;
template Option Command::add_option(const std::string&, std::optional<int>&,
                                    const std::string&) const;
template Option Command::add_option(const std::string&, std::optional<double>&,
                                    const std::string&) const;
template Option Command::add_option(const std::string&, std::optional<std::int64_t>&,
                                    const std::string&) const;
template Option Command::add_option(const std::string&, std::optional<std::uint16_t>&,
                                    const std::string&) const;
template Option Command::add_option(const std::string&, std::vector<std::string>&,
                                    const std::string&) const;
template Option Command::add_option(const std::string&, std::vector<double>&,
                                    const std::string&) const;

namespace {

Option add_length_option(CLI::App& command, const std::string& name,
                         std::function<void(double)> store, const std::string& help) {
  const std::string long_name = name.substr(name.find("--"));
  return Option(command
                    .add_option_function<std::string>(
                        name,
                        [store = std::move(store), long_name](const std::string& text) {
                          store(parse_length(long_name, text));
                        },
                        help)
                    ->type_name("LENGTH"));
}

}  // namespace

Option Command::add_length(const std::string& name, double& store, const std::string& help) const {
  return add_length_option(
      *command_, name, [&store](double length) { store = length; }, help);
}

Option Command::add_length(const std::string& name, std::optional<double>& store,
                           const std::string& help) const {
  return add_length_option(
      *command_, name, [&store](double length) { store = length; }, help);
}

Option Command::add_flag(const std::string& name, bool& store, const std::string& help) const {
  return Option(command_->add_flag(name, store, help));
}

Option Command::add_flag(const std::string& name, std::optional<bool>& store, bool value,
                         const std::string& help) const {
  return Option(command_->add_flag_callback(
      name, [&store, value] { store = value; }, help));
}

void Command::footer(const std::string& text) const { command_->footer(text); }

void Command::runs(Action action) const {
  command_->callback([chosen = chosen_, action = std::move(action)] { *chosen = action; });
}

namespace {

constexpr const char* help_of_help = "print this text";
constexpr const char* help_of_version = "print the version, and how the program was built";

/// "a,b" into its parts.
std::vector<std::string> split(const std::string& text, char mark) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(mark, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

OptionDescription described(const CLI::Option& option) {
  OptionDescription told;
  for (const std::string& name : option.get_snames()) told.names.push_back('-' + name);
  for (const std::string& name : option.get_lnames()) told.names.push_back("--" + name);
  // CLI11 says of a word "N:1 to 1024" and "LEG:{target,array}": what it is called, then its rules
  const std::string type = option.get_type_name();
  const std::size_t mark = std::min(type.find(':'), type.size());
  if (option.get_positional())
    told.value = option.get_name(true);
  else if (option.get_items_expected_max() > 0)
    told.value = type.substr(0, mark);
  std::string rules = type.substr(std::min(mark + 1, type.size()));
  if (rules.starts_with('{') && rules.ends_with('}'))
    told.words = split(rules.substr(1, rules.size() - 2), ',');
  else
    told.limits = std::move(rules);
  for (const CLI::Option* other : option.get_excludes())
    told.not_with.push_back("--" + other->get_lnames().front());
  told.fallback = option.get_default_str();
  told.help = option.get_description();
  told.group = option.get_group();
  told.required = option.get_required();
  told.repeatable = option.get_items_expected_max() > 1;
  return told;
}

std::vector<OptionDescription> described_options(const CLI::App& app) {
  std::vector<OptionDescription> all;
  for (const CLI::Option* option : app.get_options())
    if (!option->get_group().empty()) all.push_back(described(*option));
  // what every command has comes last
  std::stable_partition(all.begin(), all.end(), [](const OptionDescription& option) {
    return option.help != help_of_help && option.help != help_of_version;
  });
  return all;
}

void set_common_flags(CLI::App& app, const std::string& version) {
  app.set_help_flag("-h,--help", help_of_help);
  app.set_version_flag("--version", version, help_of_version);
}

}  // namespace

Program::Program(const std::string& name, const std::string& description,
                 const std::string& version)
    : name_(name), version_(version), app_(std::make_unique<CLI::App>(description, name)) {
  set_common_flags(*app_, version_);
  app_->require_subcommand(0, 1);
}

Program::~Program() = default;

void Program::add_command(const std::string& name, const std::string& help,
                          std::function<void(const Command&)> define) {
  commands_.push_back({name, help, std::move(define)});
}

/// Tells the parser of a command.
void Program::add(const Known& known) {
  CLI::App* const command = app_->add_subcommand(known.name, known.help);
  // called when its name has been read, before its words are
  command->preparse_callback([this, command, &known](std::size_t) {
    set_common_flags(*command, version_);
    known.define({command, &chosen_});
  });
}

void Program::footer(const std::string& text) { app_->footer(text); }

CommandDescription Program::described(const Known& known) const {
  CLI::App app(known.help, known.name);
  set_common_flags(app, version_);
  Action nothing;
  known.define({&app, &nothing});
  return {known.name, known.help, app.get_footer(), described_options(app)};
}

ProgramDescription Program::without_commands() const {
  return {.name = name_,
          .help = app_->get_description(),
          .version = version_,
          .footer = app_->get_footer(),
          .options = described_options(*app_),
          .groups = groups_,
          .commands = {}};
}

ProgramDescription Program::description() const {
  ProgramDescription all = without_commands();
  for (const Known& known : commands_) all.commands.push_back(described(known));
  return all;
}

/// The help of the command that was being parsed: that one helps.
std::string Program::see_help() const {
  const auto chosen = app_->get_subcommands();
  return "; see " + name_ + (chosen.empty() ? "" : ' ' + chosen.front()->get_name()) + " --help";
}

/// Words that no command or option takes, in the order in which they were typed.
std::string Program::complaint_about_extras(int argc, char** argv) const {
  const std::span<char* const> words(argv + 1, static_cast<std::size_t>(argc - 1));
  const auto chosen = app_->get_subcommands();
  std::vector<std::string> names;
  if (chosen.empty()) {
    for (const CLI::App* command : app_->get_subcommands({})) names.push_back(command->get_name());
    for (const std::string word : words)
      if (!word.starts_with('-'))
        return word + ": found no such command" + did_you_mean(word, names) + ", expected one of " +
               CLI::detail::join(names, ", ");
  } else {
    for (const CLI::Option* option : chosen.front()->get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  std::vector<std::string> left = app_->remaining(true);
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

Action Program::parse(int argc, char** argv) {
  // The parser is told of one command if that is what comes first, of all for help and complaints.
  const auto typed = std::find_if(commands_.begin(), commands_.end(), [&](const Known& command) {
    return argc > 1 && command.name == argv[1];
  });
  for (const Known& command : commands_)
    if (typed == commands_.end() || &command == &*typed) add(command);
  const Action tell_all = [this] {
    print(help_text(description(), help_width()));
    return 0;
  };
  try {
    app_->parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    const auto chosen = app_->get_subcommands();
    if (chosen.empty()) return tell_all;
    return [this, name = chosen.front()->get_name()] {
      const auto known = std::find_if(commands_.begin(), commands_.end(),
                                      [&](const Known& one) { return one.name == name; });
      print(help_text(without_commands(), described(*known), help_width()));
      return 0;
    };
  } catch (const CLI::Success&) {  // --version
    return [this] {
      print(version_ + '\n');
      return 0;
    };
  } catch (const CLI::ExtrasError&) {
    throw UsageError(complaint_about_extras(argc, argv) + see_help());
  } catch (const CLI::ParseError& error) {
    throw UsageError(error.what() + see_help());
  }
  if (!chosen_ && !groups_.empty()) return tell_all;
  if (!chosen_) throw UsageError("no command was given" + see_help());
  return chosen_;
}

void add_scenario_options(const Command& command, ScenarioChoice& choice) {
  command.add_option("SCENARIO", choice.path, "scenario file (TOML)").required();
  add_set_option(command, choice);
}

void add_set_option(const Command& command, ScenarioChoice& choice) {
  command
      .add_option(
          "--set", choice.overrides,
          "replace one value of the scenario by its path, in SI units as in the file or with its "
          "unit; may be repeated: --set target.0.range=25km --set target.0.strength_db=20")
      .type_name("KEY=VALUE")
      .one_at_a_time();
}

void add_threads_option(const Command& command, std::optional<int>& threads) {
  command
      .add_option("--threads", threads,
                  "that compute; default: one a core. The results do not depend on it")
      .type_name("N")
      .check(whole_number(1, 1024, "a number"));
}

void add_force_option(const Command& command, bool& force) {
  command.add_flag("--force", force, "write over a file even if asdic did not write it");
}

double parse_length(const std::string& name, const std::string& text) {
  const auto wrong = [&] {
    return InputError(
        {.where = name, .got = '"' + text + '"', .expected = "a length such as 60km, 500m or 500"});
  };
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || !std::isfinite(value) || value < 0.0) throw wrong();
  std::string unit(rest, end);
  if (unit.starts_with(' ')) unit.erase(0, 1);
  if (unit == "km") return 1000.0 * value;
  if (unit.empty() || unit == "m") return value;
  throw wrong();
}

}  // namespace asdic::detail::app
