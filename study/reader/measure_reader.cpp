#include "study/reader/measure_reader.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/quantities.h"
#include "io/settings/reader.h"
#include "sonar/scenario/sampling.h"
#include "sonar/scenario/transmission.h"
#include "study/measures/measures.h"

namespace asdic::detail::study {
namespace {

/// `true`, or a table of settings. \return whether it is wanted
bool read_wanted(TomlTable& table, const std::string& key) {
  if (!table.has(key)) return false;
  return table.is_table(key) || table.flag(key, false);
}

void read_matched_filter(TomlTable table, int phones, MatchedFilterPlan& plan) {
  using Background = MatchedFilterPlan::Background;
  // Whoever says which cells wants cells.
  const bool cells = table.has("guard_cells") || table.has("reference_cells");
  const std::string background =
      table.choice("background", {"around", "trend", "expected", "summed", "noise"},
                   cells ? "around" : "expected");
  plan.background = background == "trend"      ? Background::trend
                    : background == "expected" ? Background::expected
                    : background == "summed"   ? Background::summed
                    : background == "noise"    ? Background::noise
                                               : Background::around;
  if (table.has("phone")) plan.phone = static_cast<int>(table.integer("phone", 0, phones - 1));
  plan.guard_cells = static_cast<double>(
      table.integer("guard_cells", 0, 1000, static_cast<std::int64_t>(plan.guard_cells)));
  plan.reference_cells = static_cast<double>(
      table.integer("reference_cells", 1, 1000, static_cast<std::int64_t>(plan.reference_cells)));
  if (table.has("draws")) {
    if (plan.background != Background::expected)
      throw table.fault("draws", "background = \"expected\" with it, whose draws they are");
    plan.draws = static_cast<int>(table.integer("draws", 2, 10000));
  }
  table.finish();
}

DetectionPlan read_detection(TomlTable& measures) {
  DetectionPlan plan;
  if (!measures.is_table("detection")) return plan;
  TomlTable table = measures.table("detection");
  if (table.choice("by", {"matched_filter", "receiver"}, "matched_filter") == "receiver")
    plan.by = DetectionPlan::By::receiver;
  plan.false_alarm_probability =
      table.number("false_alarm_probability", false_alarm_probability_of_cell,
                   plan.by == DetectionPlan::By::receiver ? 1e-6 : 1e-4);
  table.finish();
  return plan;
}

/// `true`, or a table of the tracker's settings.
TrackerSettings read_tracker(TomlTable& run, const DetectionPlan& detection, int pings) {
  TrackerSettings settings;
  if (detection.by != DetectionPlan::By::receiver)
    throw run.fault("tracker",
                    "a detection by = \"receiver\" with it, of whose places tracks are made");
  if (run.is_table("tracker")) {
    KnownSettings known;
    read_settings(run.table("tracker"), settings, known);
  }
  if (settings.start_hits > pings)
    throw run.fault("tracker", "a track_start of no more hits than the run's " +
                                   std::to_string(pings) + " pings: none can begin");
  return settings;
}

/// `true`, all pings of the scenario, or a table. \param pings  that the scenario has
PingRunPlan read_run(TomlTable& measures, const DetectionPlan& detection, int pings) {
  PingRunPlan plan{.count = pings};
  if (pings < 2)
    throw measures.fault("pings",
                         "a scenario with two pings or more: \"pings.count\" = 10 in [set]",
                         "a scenario with one ping");
  if (!measures.is_table("pings")) return plan;
  TomlTable table = measures.table("pings");
  plan.first = static_cast<int>(table.integer("first", 1, pings - 1, 1));
  const int most = pings - plan.first + 1;
  plan.count = static_cast<int>(table.integer("count", 2, most, most));
  if (table.has("initiation")) {
    const std::vector<double> rule =
        table.numbers("initiation", {.noun = "number of pings", .low = 1.0, .high = 1e6});
    const auto whole = [](double x) { return x == std::floor(x); };
    if (rule.size() != 2 || !whole(rule[0]) || !whole(rule[1]) || rule[0] > rule[1] ||
        rule[1] > plan.count)
      throw table.fault("initiation",
                        "[m, n], m hits within n pings in a row: whole numbers, m at most n, and n "
                        "at most the " +
                            std::to_string(plan.count) + " pings");
    plan.hits = static_cast<int>(rule[0]);
    plan.within = static_cast<int>(rule[1]);
  }
  if (read_wanted(table, "tracker")) plan.tracker = read_tracker(table, detection, plan.count);
  table.finish();
  return plan;
}

/// `true`, or a table: bins of time over the record as the scenario has it.
CellPlan read_cells(TomlTable& measures, const Scenario& scenario) {
  CellPlan plan;
  const Recording record = recording_of(scenario);
  int bins = 10;
  if (measures.is_table("cells")) {
    TomlTable table = measures.table("cells");
    if (table.has("edges")) {
      plan.edges = table.numbers("edges", {});
      const bool rising =
          plan.edges.size() > 1 && std::adjacent_find(plan.edges.begin(), plan.edges.end(),
                                                      std::greater_equal<>()) == plan.edges.end();
      if (!rising) throw table.fault("edges", "two times or more that rise [s]");
    }
    if (table.has("bins")) {
      if (!plan.edges.empty()) throw table.fault("bins", "edges or bins, not both");
      bins = static_cast<int>(table.integer("bins", 1, 1000));
    }
    table.finish();
  }
  const double length = static_cast<double>(record.samples) / record.sample_rate;
  if (!plan.edges.empty()) return plan;
  for (int i = 0; i <= bins; ++i) plan.edges.push_back(record.start + length * i / bins);
  return plan;
}

/// The settings of `asdic process`, but for tracks. Of a detection by the receiver the probability
/// of a false alarm is the detection's own.
void read_receiver(TomlTable table, MeasurePlan& plan) {
  const std::string key = "false_alarm_probability";
  const bool by_receiver = plan.detection && plan.detection->by == DetectionPlan::By::receiver;
  if (by_receiver && table.has_quietly(key))
    throw table.fault(key, "no \"" + key + "\" beside a detection by the receiver, which has it");
  KnownSettings known;
  read_settings(std::move(table), plan.receiver, known);
  if (by_receiver)
    plan.receiver.detector.normaliser.false_alarm_probability =
        plan.detection->false_alarm_probability;
}

/// The measures whose keys are true, and what they need.
void read_measures(TomlTable& table, MeasurePlan& plan) {
  for (const AnyMeasure& measure : all_measures) {
    if (measure.name.empty() || !table.flag(std::string(measure.name), false)) continue;
    plan.wanted.emplace_back(measure.name);
    plan.needs.targets |= measure.needs.targets;
    plan.needs.samples |= measure.needs.samples;
    plan.needs.matched_filter |= measure.needs.matched_filter;
    plan.needs.receiver |= measure.needs.receiver;
  }
}

/// "none", "all", or k: of every k-th realisation.
std::uint64_t read_every(TomlTable& table, const std::string& key) {
  if (!table.has(key)) return 0;
  if (table.is_text(key)) return table.choice(key, {"none", "all"}) == "all" ? 1 : 0;
  return static_cast<std::uint64_t>(table.integer(key, 1, 1'000'000'000));
}

/// The same, or a table: how they are made, too.
void read_spectra(TomlTable& measures, MeasurePlan& plan) {
  if (!measures.is_table("spectra")) {
    plan.spectra_every = read_every(measures, "spectra");
    return;
  }
  TomlTable table = measures.table("spectra");
  plan.spectra_every = table.has("every") ? read_every(table, "every") : 1;
  if (table.has("resolution"))
    plan.spectrum.resolution = table.number("resolution", quantity::frequency_step);
  plan.spectrum.each_phone = table.choice("phones", {"mean", "each"}, "mean") == "each";
  table.finish();
}

}  // namespace

MeasurePlan read_measure(TomlTable table, const Scenario& scenario) {
  MeasurePlan plan;
  const auto pings = static_cast<std::int64_t>(transmissions(scenario).size());
  plan.ping = static_cast<int>(table.integer("ping", 1, pings, 1));
  plan.array = static_cast<int>(
      table.integer("array", 0, static_cast<std::int64_t>(scenario.arrays.size()) - 1, 0));
  read_measures(table, plan);
  if (read_wanted(table, "detection")) plan.detection = read_detection(table);
  if (plan.wants(DetectionSignalExcess::name) && !plan.detection)
    throw table.fault(std::string(DetectionSignalExcess::name),
                      "a detection with it, whose receiver and false-alarm probability it is of");
  if (read_wanted(table, "pings")) {
    if (!plan.detection)
      throw table.fault("pings", "a detection with them, which is looked for in each");
    plan.run = read_run(table, *plan.detection, static_cast<int>(pings));
  }
  plan.series_every = read_every(table, "time_series");
  read_spectra(table, plan);
  plan.detections_every = read_every(table, "detections");
  const auto phones =
      static_cast<int>(scenario.arrays[static_cast<std::size_t>(plan.array)].phones.size());
  if (table.has("matched_filter") && !plan.uses_matched_filter())
    throw table.fault("matched_filter", "snr_matched or a detection by the matched filter with it");
  read_matched_filter(table.table("matched_filter"), phones, plan.matched_filter);
  if (read_wanted(table, "cells")) {
    if (!plan.uses_matched_filter())
      throw table.fault("cells", "snr_matched or a detection by the matched filter with it");
    plan.cells = read_cells(table, scenario);
  }
  if (table.has("receiver") && !plan.uses_receiver() && plan.detections_every == 0)
    throw table.fault("receiver",
                      "localisation_error, localisation_ellipse, detections or a detection by the "
                      "receiver with it");
  read_receiver(table.table("receiver"), plan);
  table.finish();
  const bool nothing = plan.wanted.empty() && !plan.needs_samples();
  if (nothing) throw table.fault("echo_level", "at least one measure, echo_level = true say");
  if (scenario.targets.empty() &&
      (plan.needs.targets || plan.uses_matched_filter() || plan.uses_receiver()))
    throw table.fault("echo_level",
                      "series_level, time_series, spectra or detections alone: the scenario has no "
                      "target",
                      "a measure of targets");
  return plan;
}

}  // namespace asdic::detail::study
