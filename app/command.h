#pragma once
#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace asdic::app {

/// What the command line asked for. \return the exit status
using Action = std::function<int()>;

// Each adds its command to the program; when the command is chosen, `action` becomes what it does.
void add_ping_command(CLI::App& program, Action& action);
void add_rays_command(CLI::App& program, Action& action);
void add_arrivals_command(CLI::App& program, Action& action);
void add_validate_command(CLI::App& program, Action& action);
void add_info_command(CLI::App& program, Action& action);
void add_plot_command(CLI::App& program, Action& action);
void add_export_command(CLI::App& program, Action& action);
void add_compare_command(CLI::App& program, Action& action);
void add_field_command(CLI::App& program, Action& action);
void add_explain_command(CLI::App& program, Action& action);
void add_ocean_command(CLI::App& program, Action& action);
void add_bellhop_command(CLI::App& program, Action& action);
void add_convert_command(CLI::App& program, Action& action);
void add_process_command(CLI::App& program, Action& action);
void add_study_command(CLI::App& program, Action& action);
void add_merge_command(CLI::App& program, Action& action);
void add_serve_command(CLI::App& program, Action& action);

/// A scenario as the command line names it.
struct ScenarioChoice {
  std::string path;
  std::vector<std::string> overrides;  ///< key.path=value
};

/// SCENARIO and --set, as every command that reads a scenario has them.
void add_scenario_options(CLI::App& command, ScenarioChoice& choice);

/// --threads, as every command that computes has it.
void add_threads_option(CLI::App& command, std::optional<int>& threads);

/// A check for numbers above zero that says just that.
[[nodiscard]] CLI::Validator above_zero();
/// The same of at least zero.
[[nodiscard]] CLI::Validator not_negative();
/// Checks that an option is a whole number from low to high: "found 70000, expected a port from 0
/// to 65535". \param noun  "a port"
[[nodiscard]] CLI::Validator whole_number(std::int64_t low, std::int64_t high,
                                          const std::string& noun);

/// An option that takes a length: 60km, 500m, or plain metres. Negative ones are refused.
/// \throws InputError naming the option, while the command line is parsed
CLI::Option* add_length_option(CLI::App& command, const std::string& name,
                               std::function<void(double)> store, const std::string& help);

/// The same for words outside of CLI11: metres out of "60km", "500 m", "2.5e3".
/// \throws InputError{where: `name`}
[[nodiscard]] double parse_length(const std::string& name, const std::string& text);

}  // namespace asdic::app
