#include "io/scenario/catalogue.h"

#include <algorithm>
#include <cassert>
#include <string>

#include "io/scenario/document.h"
#include "io/scenario/propagation.h"
#include "io/scenario/sections.h"

namespace asdic::detail::scenario {
namespace {

/// [run], with what is of the process.
struct RunSection {
  PropagationCase& run;

  void describe(Fields& field) {
    RunTable{run}.describe(field);
    double memory = 0.0;
    describe_memory(field, memory);
  }
};

SettingsList made() {
  Scenario scenario;
  scenario.platforms.resize(1);  // where targets' ranges begin
  PropagationCase run;
  run.solver = FieldSolver::automatic;  // as files without the key have it
  SettingsCatalogue walker;
  std::string include;
  describe_head(walker, scenario);
  describe_include(walker, include);
  describe_environment(walker, scenario);
  walker(live("pulse"), scenario.pulse, "that transmitters send");
  describe_bodies(walker, scenario);
  describe_sound(walker, scenario);
  RunSection section{run};
  walker("run", section, "of the propagation model alone");
  return walker.list();
}

/// "target.strength_db" of "target[].strength_db" and of "target.0.strength_db".
std::string without_places(std::string_view key) {
  std::string text;
  while (!key.empty()) {
    const std::size_t dot = std::min(key.find('.'), key.size());
    std::string_view name = key.substr(0, dot);
    key.remove_prefix(std::min(dot + 1, key.size()));
    if (name.find_first_not_of("0123456789") == std::string_view::npos) continue;
    if (const auto bracket = name.find('['); bracket != std::string_view::npos)
      name = name.substr(0, bracket);
    text += (text.empty() ? "" : ".") + std::string(name);
  }
  return text;
}

}  // namespace

const SettingsList& catalogue() {
  static const SettingsList all = made();
  return all;
}

std::vector<const SettingRecord*> settings_at(std::string_view key) {
  const std::string wanted = without_places(key);
  std::vector<const SettingRecord*> found;
  for (const SettingRecord& one : catalogue().settings)
    if (without_places(one.path) == wanted) found.push_back(&one);
  return found;
}

const SettingRecord& setting_at(std::string_view key) {
  const auto found = settings_at(key);
  assert(!found.empty());
  return *found.front();
}

}  // namespace asdic::detail::scenario
