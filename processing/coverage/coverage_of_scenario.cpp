#include "processing/coverage/coverage_of_scenario.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/text.h"
#include "sonar/scenario/sampling.h"

namespace asdic::detail {
namespace {

/// A name among things that have some.
template <class Things>
int numbered(const Things& things, const std::string& name, const char* option) {
  std::string all;
  for (std::size_t i = 0; i < things.size(); ++i) {
    if (things[i].name == name) return static_cast<int>(i);
    all += (i > 0 ? ", " : "") + in_quotes(things[i].name);
  }
  throw InputError({.where = option, .got = in_quotes(name), .expected = "one of " + all});
}

/// Of a target, or the mean of its power over all aspects.
double strength_of(const Target& target) {
  if (!target.aspect && target.highlights.empty()) return target.strength_db;
  constexpr int aspects = 72;
  double sum = 0.0;
  for (int i = 0; i < aspects; ++i)
    sum += power_from_db(strength_db(target, 2.0 * pi * i / aspects));
  return db_from_power(sum / aspects);
}

}  // namespace

CoverageSettings coverage_settings(const Scenario& scenario, const AreaWishes& wishes) {
  CoverageSettings settings{
      .bearings = wishes.bearings,
      .ranges = wishes.ranges,
      .depths = wishes.depths,
      .false_alarm_probability = wishes.false_alarm_probability,
      .reference_cells = wishes.reference_cells > 0.0 ? wishes.reference_cells : infinity};
  const auto sent = transmissions(scenario);
  settings.ping = wishes.ping.value_or(1);
  if (wishes.transmitter) {
    const int number = numbered(scenario.transmitters, *wishes.transmitter, "--transmitter");
    if (wishes.ping && *wishes.ping <= static_cast<int>(sent.size()) &&
        sent[static_cast<std::size_t>(*wishes.ping - 1)].transmitter != number)
      throw InputError({.where = "--ping",
                        .got = to_text(*wishes.ping) + ", a ping of another transmitter",
                        .expected = "one of " + in_quotes(*wishes.transmitter) +
                                    ", or no --transmitter beside it"});
    const auto first = std::find_if(sent.begin(), sent.end(), [&](const Transmission& one) {
      return one.transmitter == number;
    });
    if (!wishes.ping) settings.ping = static_cast<int>(first - sent.begin()) + 1;
  }
  if (wishes.array) settings.array = numbered(scenario.arrays, *wishes.array, "--array");
  const Target* const target = scenario.targets.empty() ? nullptr : &scenario.targets.front();
  if (settings.depths.empty()) {
    if (target == nullptr)
      throw InputError({.where = "--depth",
                        .got = "no depth, of a scenario without a target",
                        .expected = "depths of the target in metres: --depth 100"});
    settings.depths = {target->track.at(0.0).position.z()};
  }
  settings.strength_db =
      wishes.strength_db.value_or(target != nullptr ? strength_of(*target) : 10.0);
  if (wishes.fluctuation) {
    const auto* const word =
        std::find(std::begin(fluctuation_words), std::end(fluctuation_words), *wishes.fluctuation);
    if (word == std::end(fluctuation_words))
      throw InputError({.where = "--fluctuation",
                        .got = in_quotes(*wishes.fluctuation),
                        .expected = "none, swerling-1, swerling-2, swerling-3 or swerling-4"});
    settings.fluctuation = static_cast<Fluctuation>(word - std::begin(fluctuation_words));
  } else if (target != nullptr) {
    settings.fluctuation = target->fluctuation;
  }
  constexpr double speed = 1500.0;
  settings.reach = wishes.reach.value_or(0.5 * speed * end_of_record(scenario));
  return settings;
}

}  // namespace asdic::detail
