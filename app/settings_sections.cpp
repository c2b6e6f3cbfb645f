#include "app/settings_sections.h"

#include <array>
#include <limits>

#include "io/scenario/propagation.h"
#include "io/scenario/sections.h"
#include "processing/ping_processor.h"
#include "serve/ping_request.h"
#include "serve/session_limits.h"

namespace asdic::detail::app {
namespace {

/// What others decide, where files do not say it.
constexpr double no_default = std::numeric_limits<double>::quiet_NaN();

/// Of a whole scenario file, but for [environment], whose tables say one thing in several ways.
std::vector<SettingRecord> scenario_records() {
  Scenario scenario;
  scenario.platforms.resize(1);  // where targets' ranges begin
  PropagationCase run;  // as files without these keys have it: frequency and place are a sonar's
  run.solver = FieldSolver::automatic;
  run.source_depths.clear();
  run.receivers.ranges = {1.0};  // then there is a box around them
  run.frequency = run.box_range = run.box_depth = no_default;
  scenario::RunTable run_table{run};
  SettingsCatalogue walker;
  scenario::describe_head(walker, scenario);
  walker("pulse", scenario.pulse, "that transmitters send");
  scenario::describe_bodies(walker, scenario);
  scenario::describe_sound(walker, scenario);
  walker("run", run_table, "of the propagation model alone");
  return walker.records();
}

/// Those of one table of it, [path] or [[path]].
std::vector<SettingRecord> table_of_scenario(std::string_view path) {
  std::vector<SettingRecord> found;
  for (SettingRecord& record : scenario_records()) {
    std::string_view rest = record.path;
    if (!rest.starts_with(path)) continue;
    rest.remove_prefix(path.size());
    if (rest.starts_with("[]")) rest.remove_prefix(2);
    if (!rest.starts_with('.')) continue;
    record.path = std::string(rest.substr(1));
    found.push_back(std::move(record));
  }
  return found;
}

template <Described T>
std::vector<SettingRecord> records_of(std::string_view /*path*/) {
  return catalogue_of<T>();
}

}  // namespace

std::span<const SettingsSection> settings_sections() {
  static constexpr auto in_scenario = [](std::string_view path, std::string_view title,
                                         bool several = false) {
    return SettingsSection{"scenario", path, title, table_of_scenario, several};
  };
  static constexpr std::array all{
      in_scenario("pulse", "what is sent"),
      in_scenario("platform", "what carries transmitters and arrays", true),
      in_scenario("transmitter", "what sends the pulses", true),
      in_scenario("array", "of hydrophones", true),
      in_scenario("target", "what sends echoes", true),
      in_scenario("interferer", "ships that make noise", true),
      in_scenario("noise", "of the sea at the phones"),
      in_scenario("reverberation", "of surface, bottom and water"),
      in_scenario("propagation", "the paths that are searched for"),
      in_scenario("pings", "when pings are sent and how they are recorded"),
      in_scenario("run", "of the propagation model alone"),
      SettingsSection{"study", "measure.receiver", "the receiver, and the options of asdic process",
                      records_of<ProcessingSettings>},
      SettingsSection{"process", "tracks", "options of asdic process for tracks",
                      records_of<TrackerSettings>},
      SettingsSection{"serve", "ping", "keys of the command ping", records_of<serve::PingRequest>},
      SettingsSection{"serve", "limits", "what a client may ask for: --limit",
                      records_of<serve::SessionLimits>}};
  return all;
}

}  // namespace asdic::detail::app
