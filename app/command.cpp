#include "app/command.h"

#include <charconv>
#include <cmath>
#include <cstdlib>

#include "core/error.h"

namespace asdic::app {

void add_scenario_options(CLI::App& command, ScenarioChoice& choice) {
  command.add_option("SCENARIO", choice.path, "scenario file (TOML)")->required();
  command
      .add_option(
          "--set", choice.overrides,
          "replace one value of the scenario by its path, in SI units as in the file; "
          "may be repeated: --set transmitter.elevation_deg=12 --set target.0.strength_db=20")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
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

CLI::Option* add_length_option(CLI::App& command, const std::string& name,
                               std::function<void(double)> store, const std::string& help) {
  const std::string long_name = name.substr(name.find("--"));
  return command
      .add_option_function<std::string>(
          name,
          [store = std::move(store), long_name](const std::string& text) {
            store(parse_length(long_name, text));
          },
          help)
      ->type_name("LENGTH");
}

void add_threads_option(CLI::App& command, std::optional<int>& threads) {
  command
      .add_option("--threads", threads,
                  "that compute; default: one a core. The results do not depend on it")
      ->type_name("N")
      ->check(whole_number(1, 1024, "a number"));
}

CLI::Validator above_zero() {
  return CLI::Validator(
      [](const std::string& text) {
        const double value = std::strtod(text.c_str(), nullptr);
        return value > 0.0 && std::isfinite(value)
                   ? std::string()
                   : "found " + text + ", expected a number above 0";
      },
      "ABOVE 0");
}

CLI::Validator not_negative() {
  return CLI::Validator(
      [](const std::string& text) {
        double value = 0.0;
        const char* const last = text.data() + text.size();
        const auto [end, error] = std::from_chars(text.data(), last, value);
        const bool good =
            error == std::errc{} && end == last && value >= 0.0 && std::isfinite(value);
        return good ? std::string() : "found " + text + ", expected a number of at least 0";
      },
      "AT LEAST 0");
}

CLI::Validator whole_number(std::int64_t low, std::int64_t high, const std::string& noun) {
  return CLI::Validator(
      [low, high, noun](const std::string& text) {
        std::int64_t value = 0;
        const char* const last = text.data() + text.size();
        const auto [end, error] = std::from_chars(text.data(), last, value);
        const bool good = error == std::errc{} && end == last && value >= low && value <= high;
        return good ? std::string()
                    : "found " + text + ", expected " + noun + " from " + std::to_string(low) +
                          " to " + std::to_string(high);
      },
      std::to_string(low) + " TO " + std::to_string(high));
}

}  // namespace asdic::app
