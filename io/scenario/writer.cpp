#include "io/scenario/writer.h"

#include "io/scenario/ocean.h"
#include "io/scenario/propagation.h"
#include "io/scenario/sections.h"
#include "io/settings/writer.h"

namespace asdic::detail {
namespace {

/// [environment] of an ocean without a sonar.
struct PlacedOcean {
  const Environment& ocean;
  const std::optional<OceanOrigin>& origin;

  void describe(Fields& field) const {
    std::optional<OceanOrigin> shown = origin;
    if (origin) field("origin", shown, "where on the Earth the map's [0, 0] is");
    scenario::OceanTable{ocean}.describe(field);
  }
};

/// A file with an ocean alone, for `include`.
struct OceanDocument {
  const Environment& ocean;
  const std::optional<OceanOrigin> origin = {};

  void describe(Fields& field) const {
    PlacedOcean environment{ocean, origin};
    field("environment", environment, "the water and its boundaries");
  }
};

/// A file with an ocean and what the propagation model is to do.
struct CaseDocument {
  const PropagationCase& run_case;

  void describe(Fields& field) const {
    PropagationCase shown = run_case;
    field(seldom("title"), shown.title, "of the case");
    OceanDocument{run_case.environment, run_case.origin}.describe(field);
    scenario::RunTable run{shown};
    field("run", run, "what the propagation model is to do");
  }
};

/// A file of a sonar.
struct ScenarioDocument {
  const Scenario& scenario;

  void describe(Fields& field) const {
    Scenario shown = scenario;
    scenario::describe_head(field, shown);
    field("pulse", shown.pulse, "of the transmitters without one of their own");
    scenario::describe_environment(field, shown);
    field.know("pings.elevations", static_cast<double>(shown.pings.elevations.size()));
    scenario::describe_bodies(field, shown);
    scenario::describe_sound(field, shown);
  }
};

}  // namespace

std::string to_toml(const Environment& environment) {
  return print_toml(settings_tree(OceanDocument{environment}));
}

std::string to_toml(const PropagationCase& run) {
  return print_toml(settings_tree(CaseDocument{run}));
}

std::string to_toml(const Scenario& scenario) {
  return print_toml(settings_tree(ScenarioDocument{scenario}));
}

}  // namespace asdic::detail
