#include "study/measures/measures.h"

#include <algorithm>
#include <limits>

#include "core/random.h"
#include "study/measures/cell_counts.h"
#include "study/measures/echo_filter.h"

namespace asdic::detail::study {

void Collector::add(std::string_view name, std::string_view unit, std::string_view meaning,
                    double value, Column::Role role) {
  if (columns_ != nullptr)
    columns_->push_back({.name = std::string(name) + suffix_,
                         .unit = std::string(unit),
                         .meaning = std::string(meaning),
                         .role = role});
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

/// A ping's processor time by its stages, which the ping itself tells in wall time.
void add_parts(const Timings& wall, double processor, RowCost& cost) {
  const double rays = wall.rays + wall.patches;
  const double all = wall.eigenrays + rays + wall.synthesis + wall.noise;
  if (!(all > 0.0)) {
    cost[Stage::target_paths] += processor;
    return;
  }
  cost[Stage::target_paths] += processor * wall.eigenrays / all;
  cost[Stage::sea_paths] += processor * rays / all;
  cost[Stage::sound] += processor * wall.synthesis / all;
  cost[Stage::noise] += processor * wall.noise / all;
}

/// What the simulation expects beside echoes, by draws or by a sum; none where the plan's
/// background is another.
std::vector<ExpectedAnswer> background_of(const PingSimulator& simulator, const PingRecord& record,
                                          const MeasurePlan& plan,
                                          const std::shared_ptr<SharedPropagation>& shared) {
  using Background = MatchedFilterPlan::Background;
  if (!plan.uses_matched_filter()) return {};
  if (plan.matched_filter.background == Background::expected)
    return expected_of(simulator, record, plan, shared);
  if (plan.matched_filter.background == Background::summed)
    return summed_answers(simulator, record, plan.matched_filter, plan.array, bool(plan.cells));
  return {};
}

/// What another ping than the plan's own is asked: whether its targets are detected.
MeasurePlan detection_alone(const MeasurePlan& plan, int ping) {
  MeasurePlan asked;
  asked.ping = ping;
  asked.array = plan.array;
  asked.matched_filter = plan.matched_filter;
  asked.detection = plan.detection;
  asked.receiver = plan.receiver;
  return asked;
}

/// \param record, expected  of the plan's own ping, and what draws expect there
/// \param receiver  of that ping   \throws InputError
PingRun run_of(const PingSimulator& simulator, const MeasurePlan& plan, const PingRecord& record,
               const std::vector<ExpectedAnswer>& expected, const ReceiverAnswers& receiver,
               const std::shared_ptr<SharedPropagation>& shared) {
  const PingRunPlan& run = *plan.run;
  if (simulator.pings() < run.first + run.count - 1)
    throw InputError(
        {.where = "pings.count",
         .got = std::to_string(simulator.pings()) + " pings",
         .expected = std::to_string(run.first + run.count - 1) + " or more: measure.pings"});
  PingRun made;
  std::vector<TrackedPing> tracked;
  const double start = simulator.transmission(run.first).time;
  for (int ping = run.first; ping < run.first + run.count; ++ping) {
    const bool own = ping == plan.ping;
    const MeasurePlan asked = detection_alone(plan, ping);
    PingRecord other;
    if (!own) other = received(simulator, asked);
    const PingRecord& heard = own ? record : other;
    RunPing one{.ping = ping, .time = heard.start_time - start};
    for (const Kinematics& target : heard.targets)
      one.range.push_back((target.position - heard.platform.position).template head<2>().norm());
    if (plan.detection->by == DetectionPlan::By::receiver) {
      const ReceiverAnswers answers =
          own ? receiver : receiver_answers(simulator, heard, plan.receiver, plan.array);
      for (const ReceiverAnswer& answer : answers.targets)
        one.detected.push_back(answer.hit ? 1.0 : 0.0);
      if (run.tracker) tracked.push_back(answers.places);
    } else {
      const std::vector<ExpectedAnswer> drawn =
          own ? expected : background_of(simulator, heard, asked, shared);
      for (std::size_t t = 0; t < heard.targets.size(); ++t)
        one.detected.push_back(over_threshold(filter_answer(
            simulator, heard, plan.matched_filter, plan.array, static_cast<int>(t),
            plan.false_alarm_probability(), drawn.empty() ? ExpectedAnswer{} : drawn[t])));
    }
    made.pings.push_back(std::move(one));
  }
  if (run.tracker) made.tracks = tracked_run(tracked, simulator.scenario(), *run.tracker);
  return made;
}

/// One pass over the measures that are wanted.
void walk(std::span<const AnyMeasure> measures, MeasuredPing ping, Collector& to) {
  const std::vector<Target>& targets = ping.scenario.targets;
  ping.receiver.targets.resize(targets.size());
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
                 const std::shared_ptr<SharedPropagation>& shared, RowCost* cost, bool detections) {
  const MeasurePlan& plan = study.measure;
  CostClock clock(cost);
  Measured made{.record = received(simulator, plan)};
  if (cost != nullptr) add_parts(made.record.timings, clock.lap(), *cost);
  std::vector<ExpectedAnswer> expected = background_of(simulator, made.record, plan, shared);
  clock.lap(Stage::draws);
  if (plan.cells) made.cells = counted_cells(simulator, made.record, plan, expected);
  clock.lap(Stage::cells);
  if (plan.uses_receiver() || detections)
    made.receiver = receiver_answers(simulator, made.record, plan.receiver, plan.array);
  PingRun run;
  if (plan.run) run = run_of(simulator, plan, made.record, expected, made.receiver, shared);
  Collector collector(made.values);
  walk(measures,
       {.plan = study.measure,
        .scenario = simulator.scenario(),
        .simulator = &simulator,
        .record = &made.record,
        .receiver = made.receiver,
        .expected = std::move(expected),
        .run = std::move(run)},
       collector);
  made.unknown = collector.unknown();
  clock.lap(Stage::measures);
  return made;
}

}  // namespace asdic::detail::study
