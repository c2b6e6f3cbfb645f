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
  const PropagationCase::OnArea* on_area = nullptr;  // of an area that was read from files

  void describe(Fields& field) const {
    std::optional<OceanOrigin> shown = origin;
    if (origin) field("origin", shown, "where on the Earth the map's [0, 0] is");
    if (on_area == nullptr)
      scenario::OceanTable{ocean}.describe(field);
    else
      scenario::describe_ocean_on_area(
          field, *on_area->area,
          {.x = on_area->place.x(), .y = on_area->place.y(), .bearing = on_area->bearing});
  }
};

/// A file with an ocean alone, for `include`.
struct OceanDocument {
  const Environment& ocean;
  const std::optional<OceanOrigin> origin = {};
  const PropagationCase::OnArea* on_area = nullptr;

  void describe(Fields& field) const {
    PlacedOcean environment{ocean, origin, on_area};
    field("environment", environment, "the water and its boundaries");
  }
};

/// A file with an ocean and what the propagation model is to do.
struct CaseDocument {
  const PropagationCase& run_case;

  void describe(Fields& field) const {
    PropagationCase shown = run_case;
    field(seldom("title"), shown.title, "of the case");
    const auto& area = run_case.on_area;
    const bool of_files = area && !area->area->settings().bathymetry.file.empty();
    OceanDocument{run_case.environment, run_case.origin, of_files ? &*area : nullptr}.describe(
        field);
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
