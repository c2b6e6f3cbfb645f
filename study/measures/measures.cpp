#include "study/measures/measures.h"

#include "study/measures/echo_filter.h"

namespace asdic::detail::study {

void Collector::add(std::string_view name, std::string_view unit, std::string_view meaning,
                    double value) {
  if (columns_ != nullptr)
    columns_->push_back({.name = std::string(name) + suffix_,
                         .unit = std::string(unit),
                         .meaning = std::string(meaning),
                         .role = Column::Role::measure});
  if (values_ != nullptr) values_->push_back(value);
}

namespace {

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

/// The ping with its samples, or with those alone that a matched filter looks at, or without where
/// nothing needs them.
PingRecord received(const PingSimulator& simulator, const MeasurePlan& plan) {
  if (!plan.needs_samples()) return simulator.levels(plan.ping);
  if (!plan.filter_alone()) return simulator.simulate(plan.ping);
  return simulator.simulate(plan.ping, [&](const PingRecord& record) {
    return samples_for_filter(simulator, record, plan.matched_filter, plan.array);
  });
}

/// One pass over the measures that are wanted.
void walk(std::span<const AnyMeasure> measures, MeasuredPing ping, Collector& to) {
  const std::vector<Target>& targets = ping.scenario.targets;
  ping.receiver.targets.resize(targets.size());
  if (ping && ping.plan.uses_receiver())
    ping.receiver =
        receiver_answers(*ping.simulator, *ping.record, ping.plan.receiver, ping.plan.array);
  for (std::size_t t = 0; t < targets.size(); ++t) {
    to.of(targets.size() > 1 ? '_' + slug(targets[t].name) : "");
    for (const AnyMeasure& measure : measures)
      if (measure.wanted(ping.plan, measure.name)) measure.of_target(ping, t, to);
  }
  to.of("");
  for (const AnyMeasure& measure : measures)
    if (measure.wanted(ping.plan, measure.name)) measure.of_ping(ping, to);
}

}  // namespace

std::vector<Column> measure_columns(const Study& study, const Scenario& scenario,
                                    std::span<const AnyMeasure> measures) {
  std::vector<Column> columns;
  Collector collector(columns);
  walk(measures, {.plan = study.measure, .scenario = scenario}, collector);
  return columns;
}

Measured measure(const Study& study, const PingSimulator& simulator,
                 std::span<const AnyMeasure> measures) {
  Measured made{.record = received(simulator, study.measure)};
  Collector collector(made.values);
  walk(measures,
       {.plan = study.measure,
        .scenario = simulator.scenario(),
        .simulator = &simulator,
        .record = &made.record},
       collector);
  return made;
}

}  // namespace asdic::detail::study
