#include "study/measures/measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "study/measures/echo_filter.h"
#include "study/measures/receiver_measure.h"
#include "study/measures/signal_excess.h"
#include "study/plan/no_value.h"

namespace asdic::study {
namespace {

constexpr const char* level_unit = "dB re 1 µPa";

constexpr std::array<LevelMeasure, 7> by_level{{
    {"echo_level", "echo_level_db", "dB re 1 µPa",
     "all paths together, the peak of their envelope/√2; −∞: none",
     [](const TargetSummary& t) { return t.echo_peak_db; }},
    {"reverberation_level", "reverberation_level_db", "dB re 1 µPa",
     "expected at the time of the strongest path; −∞: none",
     [](const TargetSummary& t) { return t.reverberation_db; }},
    {"noise_level", "noise_level_db", "dB re 1 µPa", "of the noise in the pulse's band",
     [](const TargetSummary& t) { return t.noise_db; }},
    {"echo_to_background", "echo_to_background_db", "dB",
     "echo over reverberation and noise in the band, before any processing; −∞: no path",
     [](const TargetSummary& t) { return t.signal_excess_db; }},
    {"signal_excess", "signal_excess_db", "dB", "old name of echo_to_background_db; will go",
     [](const TargetSummary& t) { return t.signal_excess_db; }},
    {"paths", "paths", "1", "pairs of paths there and back",
     [](const TargetSummary& t) { return static_cast<double>(t.paths); }},
    {"echo_time", "echo_time", "s", "delay of the strongest pair of paths",
     [](const TargetSummary& t) { return t.echo_time; }},
}};

/// Letters, digits and _ of a target's name.
std::string slug(std::string_view name) {
  std::string made;
  for (const char c : name) {
    const bool capital = c >= 'A' && c <= 'Z';
    const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (capital || plain)
      made += capital ? static_cast<char>(c - 'A' + 'a') : c;
    else if (!made.empty() && made.back() != '_')
      made += '_';
  }
  return made;
}

/// Collects the columns, or the values, of one pass over the measures: both in one order.
struct Collector {
  std::vector<Column>* columns = nullptr;
  std::vector<double>* values = nullptr;
  std::string suffix;

  void add(std::string_view name, std::string_view unit, std::string_view meaning, double value) {
    if (columns != nullptr)
      columns->push_back({.name = std::string(name) + suffix,
                          .unit = std::string(unit),
                          .meaning = std::string(meaning),
                          .role = Column::Role::measure});
    if (values != nullptr) values->push_back(value);
  }
};

void strongest_path(const PingRecord* record, int array, int target, Collector& to) {
  const EchoPath* best = nullptr;
  if (record != nullptr)
    for (const EchoPath& echo : record->echoes)
      if (echo.array == array && echo.target == target &&
          (best == nullptr || echo.level_db > best->level_db))
        best = &echo;
  const auto value = [&](auto of) { return best == nullptr ? no_value : of(*best); };
  to.add("path_delay", "s", "strongest pair of paths: delay of its leading edge",
         value([](const EchoPath& e) { return e.heard.delay; }));
  to.add("path_level_db", level_unit, "strongest pair of paths: peak envelope/√2, not windowed",
         value([](const EchoPath& e) { return e.level_db; }));
  to.add("path_doppler", "1", "strongest pair of paths: Doppler factor",
         value([](const EchoPath& e) { return e.heard.doppler; }));
  to.add("path_arrival_elevation_deg", "degrees",
         "strongest pair of paths: direction of travel at the array, positive up",
         value([](const EchoPath& e) {
           const Vec3& s = e.heard.slowness;
           return degrees(std::atan2(-s.z(), std::hypot(s.x(), s.y())));
         }));
}

/// What the phones of the array record as a whole.
void series_level(const PingRecord* record, const Scenario& scenario, int array, Collector& to) {
  double sum = 0.0, peak = 0.0;
  std::size_t count = 0;
  if (record != nullptr) {
    const Recording& r = record->recording;
    count = scenario.arrays[static_cast<std::size_t>(array)].phones.size() * r.samples;
    const float* p =
        record->pressure.data() + first_channel(scenario, array) * r.samples * r.components();
    for (std::size_t i = 0; i < count; ++i) {
      const double power =
          r.is_complex() ? static_cast<double>(p[2 * i] * p[2 * i] + p[2 * i + 1] * p[2 * i + 1])
                         : 2.0 * static_cast<double>(p[i] * p[i]);
      sum += power;
      peak = std::max(peak, power);
    }
  }
  const auto level = [](double envelope_squared) {
    return db_from_power(0.5 * envelope_squared / (micropascal * micropascal));
  };
  to.add("series_rms_db", level_unit, "rms of all samples of the array",
         count == 0 ? no_value : level(sum / static_cast<double>(count)));
  to.add("series_peak_db", level_unit, "greatest of all samples: envelope/√2, of pressure |p|",
         level(peak));
}

void matched_filter(const MeasurePlan& plan, const PingSimulator* simulator,
                    const PingRecord* record, int target, Collector& to) {
  FilterAnswer answer;
  if (record != nullptr)
    answer = filter_answer(*simulator, *record, plan.matched_filter, plan.array, target,
                           plan.detection ? plan.detection->false_alarm_probability : 1e-4);
  if (plan.detection && plan.detection->by == DetectionPlan::By::matched_filter) {
    const auto over = [](double statistic, double threshold) {
      if (std::isnan(statistic)) return no_value;  // not known, which is not the same as missed
      return statistic > threshold ? 1.0 : 0.0;
    };
    to.add("detected", "1", "matched filter over its threshold at the echo's time; NaN: not known",
           over(answer.present, answer.threshold));
    to.add("false_alarm", "1", "matched filter over its threshold where there is no echo",
           over(answer.absent, answer.absent_threshold));
  }
  to.add("snr_matched_db", "dB", "matched filter over its background at the echo's time",
         db_from_power(answer.present));
  to.add("snr_absent_db", "dB", "matched filter over its background where there is no echo",
         db_from_power(answer.absent));
}

void receiver(const MeasurePlan& plan, const ReceiverAnswer& answer, Collector& to) {
  if (plan.detection && plan.detection->by == DetectionPlan::By::receiver) {
    to.add("detected", "1", "a detection of the receiver is the target's", answer.hit ? 1.0 : 0.0);
    to.add("detection_snr_db", "dB", "of the loudest detection that is the target's",
           answer.snr_db);
  }
  if (plan.localisation) {
    to.add("position_error", "m", "horizontal, of the better of two sides", answer.position_error);
    to.add("range_error", "m", "found less true, from the array", answer.range_error);
    to.add("bearing_error_deg", "degrees", "found less true", degrees(answer.bearing_error));
  }
}

/// The receiver whose threshold [measure.detection] sets. \param plan  with a detection
ListeningReceiver receiver_of(const MeasurePlan& plan) {
  ListeningReceiver receiver{.array = plan.array,
                             .false_alarm_probability = plan.detection->false_alarm_probability};
  if (plan.detection->by == DetectionPlan::By::receiver) {
    receiver.cells = 2.0 * plan.receiver.detector.normaliser.reference_cells;
    return receiver;
  }
  receiver.phone = plan.matched_filter.phone;
  const bool known = plan.matched_filter.background == MatchedFilterPlan::Background::noise;
  receiver.cells = known ? infinity : 2.0 * plan.matched_filter.reference_cells;
  return receiver;
}

/// The ping with its samples, or with those alone that a matched filter looks at, or without where
/// nothing needs them.
PingRecord heard(const PingSimulator& simulator, const MeasurePlan& plan) {
  if (!plan.needs_samples()) return simulator.levels(plan.ping);
  if (!plan.filter_alone()) return simulator.simulate(plan.ping);
  return simulator.simulate(plan.ping, [&](const PingRecord& record) {
    return samples_for_filter(simulator, record, plan.matched_filter, plan.array);
  });
}

/// One pass over the measures. \param simulator, record  null where columns alone are wanted
void walk(const MeasurePlan& plan, const Scenario& scenario, const PingSimulator* simulator,
          const PingRecord* record, Collector& to) {
  const bool several = scenario.targets.size() > 1;
  ReceiverAnswers heard;
  heard.targets.resize(scenario.targets.size());
  if (record != nullptr && plan.uses_receiver())
    heard = receiver_answers(*simulator, *record, plan.receiver, plan.array);
  for (std::size_t t = 0; t < scenario.targets.size(); ++t) {
    to.suffix = several ? '_' + slug(scenario.targets[t].name) : "";
    const int target = static_cast<int>(t);
    for (const std::size_t i : plan.levels)
      to.add(by_level[i].column, by_level[i].unit, by_level[i].meaning,
             record == nullptr ? no_value : by_level[i].of(record->summary[t]));
    if (plan.detection_signal_excess)
      to.add("detection_signal_excess_db", "dB",
             "echo over what the receiver detects half of the time; −∞: no path",
             record == nullptr
                 ? no_value
                 : detection_signal_excess_db(*simulator, *record, receiver_of(plan), target));
    if (plan.strongest_path) strongest_path(record, plan.array, target, to);
    if (plan.uses_matched_filter()) matched_filter(plan, simulator, record, target, to);
    if (plan.uses_receiver()) receiver(plan, heard.targets[t], to);
  }
  to.suffix.clear();
  if (plan.uses_receiver())
    to.add("false_alarms", "1", "detections that are no target's", heard.false_alarms);
  if (plan.series_level) series_level(record, scenario, plan.array, to);
}

}  // namespace

std::span<const LevelMeasure> level_measures() { return by_level; }

std::vector<Column> measure_columns(const Study& study, const Scenario& scenario) {
  std::vector<Column> columns;
  Collector collector{.columns = &columns};
  walk(study.measure, scenario, nullptr, nullptr, collector);
  return columns;
}

Measured measure(const Study& study, const PingSimulator& simulator) {
  Measured made{.record = heard(simulator, study.measure)};
  Collector collector{.values = &made.values};
  walk(study.measure, simulator.scenario(), &simulator, &made.record, collector);
  return made;
}

}  // namespace asdic::study
