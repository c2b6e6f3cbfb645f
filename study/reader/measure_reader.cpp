#include "study/reader/measure_reader.h"

#include <cmath>

#include "sonar/scenario/transmission.h"
#include "study/measures/measures.h"

namespace asdic::study {
namespace {

constexpr Quantity probability{.noun = "probability", .low = 0.0, .high = 0.5, .above = true};

/// `true`, or a table of settings. \return whether it is wanted
bool read_wanted(TomlTable& table, const std::string& key) {
  if (!table.has(key)) return false;
  return table.is_table(key) || table.flag(key, false);
}

void read_matched_filter(TomlTable table, int phones, MatchedFilterPlan& plan) {
  if (table.choice("background", {"around", "noise"}, "around") == "noise")
    plan.background = MatchedFilterPlan::Background::noise;
  if (table.has("phone")) plan.phone = static_cast<int>(table.integer("phone", 0, phones - 1));
  plan.guard_cells = static_cast<double>(
      table.integer("guard_cells", 0, 1000, static_cast<std::int64_t>(plan.guard_cells)));
  plan.reference_cells = static_cast<double>(
      table.integer("reference_cells", 1, 1000, static_cast<std::int64_t>(plan.reference_cells)));
  table.finish();
}

DetectionPlan read_detection(TomlTable& measures) {
  DetectionPlan plan;
  if (!measures.is_table("detection")) return plan;
  TomlTable table = measures.table("detection");
  if (table.choice("by", {"matched_filter", "receiver"}, "matched_filter") == "receiver")
    plan.by = DetectionPlan::By::receiver;
  plan.false_alarm_probability = table.number("false_alarm_probability", probability,
                                              plan.by == DetectionPlan::By::receiver ? 1e-6 : 1e-4);
  table.finish();
  return plan;
}

/// The settings of `asdic process`.
void read_receiver(TomlTable table, ProcessingSettings& s) {
  NormaliserSettings& normaliser = s.detector.normaliser;
  if (table.choice("beamformer", {"conventional", "mvdr"}, "conventional") == "mvdr")
    s.detector.beamformer = Beamformer::mvdr;
  s.detector.hann_shading = table.choice("shading", {"none", "hann"}, "none") == "hann";
  if (table.choice("normaliser", {"split-window", "cell-averaging"}, "split-window") ==
      "cell-averaging")
    normaliser.method = Normaliser::cell_averaging;
  const Quantity cells{.noun = "number of cells", .low = 0.0, .high = 1e4};
  normaliser.guard_cells = table.number("guard_cells", cells, normaliser.guard_cells);
  normaliser.reference_cells =
      table.number("reference_cells", {.noun = "number of cells", .low = 1.0, .high = 1e4},
                   normaliser.reference_cells);
  const Quantity speed{.noun = "speed", .unit = "m/s", .low = 0.0, .high = 600.0};
  s.max_speed = table.number("max_speed", speed, s.max_speed);
  const Quantity time{.noun = "time", .unit = "s", .low = 0.0, .high = 1e6};
  s.detector.first_time = table.number("from", time, 0.0);
  if (table.has("until")) s.detector.last_time = table.number("until", time);
  if (table.has("target_depth"))
    s.target_depth = table.number("target_depth", {.noun = "depth", .unit = "m", .low = 0.0});
  if (table.has("range_speed"))
    s.range_speed = table.number("range_speed",
                                 {.noun = "speed", .unit = "m/s", .low = 1000.0, .high = 2000.0});
  table.finish();
}

/// "none", "all", or k: of every k-th realisation.
std::uint64_t read_series(TomlTable& table) {
  if (!table.has("time_series")) return 0;
  if (table.is_text("time_series"))
    return table.choice("time_series", {"none", "all"}) == "all" ? 1 : 0;
  return static_cast<std::uint64_t>(table.integer("time_series", 1, 1'000'000'000));
}

}  // namespace

MeasurePlan read_measure(TomlTable table, const Scenario& scenario) {
  MeasurePlan plan;
  const auto pings = static_cast<std::int64_t>(transmissions(scenario).size());
  plan.ping = static_cast<int>(table.integer("ping", 1, pings, 1));
  plan.array = static_cast<int>(
      table.integer("array", 0, static_cast<std::int64_t>(scenario.arrays.size()) - 1, 0));
  for (std::size_t i = 0; i < level_measures().size(); ++i)
    if (table.flag(std::string(level_measures()[i].key), false)) plan.levels.push_back(i);
  plan.strongest_path = table.flag("strongest_path", false);
  plan.series_level = table.flag("series_level", false);
  plan.matched = table.flag("snr_matched", false);
  if (read_wanted(table, "detection")) plan.detection = read_detection(table);
  plan.detection_signal_excess = table.flag("detection_signal_excess", false);
  if (plan.detection_signal_excess && !plan.detection)
    throw table.fault("detection_signal_excess",
                      "a detection with it, whose receiver and false-alarm probability it is of");
  plan.localisation = table.flag("localisation_error", false);
  plan.series_every = read_series(table);
  const auto phones =
      static_cast<int>(scenario.arrays[static_cast<std::size_t>(plan.array)].phones.size());
  if (table.has("matched_filter") && !plan.uses_matched_filter())
    throw table.fault("matched_filter", "snr_matched or a detection by the matched filter with it");
  read_matched_filter(table.table("matched_filter"), phones, plan.matched_filter);
  if (table.has("receiver") && !plan.uses_receiver())
    throw table.fault("receiver", "localisation_error or a detection by the receiver with it");
  read_receiver(table.table("receiver"), plan.receiver);
  if (plan.detection)
    plan.receiver.detector.normaliser.false_alarm_probability =
        plan.detection->by == DetectionPlan::By::receiver
            ? plan.detection->false_alarm_probability
            : plan.receiver.detector.normaliser.false_alarm_probability;
  table.finish();
  const bool nothing = plan.levels.empty() && !plan.strongest_path && !plan.needs_samples();
  if (nothing) throw table.fault("echo_level", "at least one measure, echo_level = true say");
  if (scenario.targets.empty() && (!plan.levels.empty() || plan.strongest_path ||
                                   plan.uses_matched_filter() || plan.uses_receiver()))
    throw table.fault("echo_level", "series_level or time_series alone: the scenario has no target",
                      "a measure of targets");
  return plan;
}

}  // namespace asdic::study
