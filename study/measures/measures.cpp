#include "study/measures/measures.h"

#include <algorithm>
#include <limits>

#include "core/random.h"
#include "study/measures/cell_counts.h"
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

/// The same sea and noise, drawn anew and without targets, as often as the plan says.
std::vector<ExpectedAnswer> expected_of(const PingSimulator& simulator, const PingRecord& record,
                                        const MeasurePlan& plan,
                                        const std::shared_ptr<SharedPropagation>& shared) {
  const auto draw = [&](int k, const SampleRange& part) {
    Scenario scenario = simulator.scenario();
    const auto words =
        RandomStream(scenario.seed, Draw::study_noise, 1, static_cast<std::uint64_t>(k)).block(0);
    scenario.seed = (static_cast<std::uint64_t>(words[0]) << 32) | words[1];
    for (Target& target : scenario.targets) target.first_ping = std::numeric_limits<int>::max();
    PingSimulator drawn(std::move(scenario), shared);
    drawn.receives_one_ping();
    return drawn.simulate(plan.ping, [&](const PingRecord&) { return part; });
  };
  return expected_answers(simulator, record, plan.matched_filter, plan.array,
                          plan.cells.has_value(), draw);
}

/// All cells without an echo, by target, time and level.
std::vector<std::uint8_t> counted_cells(const PingSimulator& simulator, const PingRecord& record,
                                        const MeasurePlan& plan,
                                        const std::vector<ExpectedAnswer>& expected) {
  const std::vector<double>& edges = plan.cells->edges;
  const std::vector<double> levels = cell_levels(plan.false_alarm_probability());
  const std::size_t times = edges.size() - 1;
  std::vector<std::uint32_t> counts(record.targets.size() * times * levels.size(), 0);
  for (std::size_t target = 0; target < record.targets.size(); ++target)
    for (const FreeCell& cell :
         free_cells(simulator, record, plan.matched_filter, plan.array, static_cast<int>(target),
                    expected.empty() ? ExpectedAnswer{} : expected[target])) {
      if (cell.time < edges.front() || cell.time >= edges.back() || !(cell.level >= 0.0)) continue;
      const auto place = [](const std::vector<double>& of, double x) {
        return static_cast<std::size_t>(std::upper_bound(of.begin(), of.end(), x) - of.begin()) - 1;
      };
      ++counts[(target * times + place(edges, cell.time)) * levels.size() +
               place(levels, cell.level)];
    }
  return packed_counts(counts);
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
                 std::span<const AnyMeasure> measures,
                 const std::shared_ptr<SharedPropagation>& shared) {
  const MeasurePlan& plan = study.measure;
  Measured made{.record = received(simulator, plan)};
  std::vector<ExpectedAnswer> expected;
  if (plan.uses_matched_filter() &&
      plan.matched_filter.background == MatchedFilterPlan::Background::expected)
    expected = expected_of(simulator, made.record, plan, shared);
  if (plan.uses_matched_filter() &&
      plan.matched_filter.background == MatchedFilterPlan::Background::summed)
    expected =
        summed_answers(simulator, made.record, plan.matched_filter, plan.array, bool(plan.cells));
  if (plan.cells) made.cells = counted_cells(simulator, made.record, plan, expected);
  Collector collector(made.values);
  walk(measures,
       {.plan = study.measure,
        .scenario = simulator.scenario(),
        .simulator = &simulator,
        .record = &made.record,
        .expected = std::move(expected)},
       collector);
  return made;
}

}  // namespace asdic::detail::study
