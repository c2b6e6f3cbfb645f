#include "study/measures/realisation.h"

#include <tbb/task_arena.h>

#include <limits>
#include <new>

#include "core/error.h"
#include "core/memory_budget.h"
#include "core/random.h"
#include "io/scenario/propagation.h"
#include "io/scenario/scenario_reader.h"
#include "study/measures/measures.h"
#include "study/measures/row_memory.h"
#include "study/measures/sampler.h"

namespace asdic::detail::study {
namespace {

/// The seed of a realisation's own streams: noise, weights, fluctuations.
/// \param chance  Sampler::chance_of its index
std::uint64_t seed_of(const Study& study, std::uint64_t chance) {
  const auto words = RandomStream(study.seed, Draw::study_noise, 0, chance).block(0);
  return (static_cast<std::uint64_t>(words[0]) << 32) | words[1];
}

/// \return [reuse_columns()]
std::vector<double> reuse_of(const Reuse& reuse) {
  return {reuse.ocean ? 1.0 : 0.0, static_cast<double>(reuse.legs_searched),
          static_cast<double>(reuse.legs_reused), reuse.reverberation ? 1.0 : 0.0,
          reuse.expected_level ? 1.0 : 0.0};
}

/// The channels of the measured array.
void keep_series(const PingRecord& record, const Study& study, const Scenario& scenario, Row& row) {
  const Recording& r = record.recording;
  const std::size_t channels =
      scenario.arrays[static_cast<std::size_t>(study.measure.array)].phones.size();
  const std::size_t of_channel = r.samples * r.components();
  const auto begin =
      record.pressure.begin() +
      static_cast<std::ptrdiff_t>(first_channel(scenario, study.measure.array) * of_channel);
  row.pressure.assign(begin, begin + static_cast<std::ptrdiff_t>(channels * of_channel));
  row.pressure_shape = {channels, r.samples};
  if (r.is_complex()) row.pressure_shape.push_back(2);
  row.timing = {
      .sample_rate = r.sample_rate, .start = r.start, .carrier = r.carrier, .epoch = r.epoch};
}

/// What else the plan keeps of this index.
void keep_arrays(const Measured& measured, const Study& study, const Scenario& scenario, Row& row) {
  const MeasurePlan& plan = study.measure;
  if (keeps(plan.spectra_every, row.index))
    row.kept.push_back(
        kept_spectrum(array_recording(scenario, measured.record, plan.array), plan.spectrum));
  if (keeps(plan.detections_every, row.index))
    row.kept.push_back(kept_detections(measured.receiver));
}

}  // namespace

const std::vector<Column>& reuse_columns() {
  const auto column = [](const char* name, const char* meaning) {
    return Column{.name = name, .unit = "1", .meaning = meaning, .role = Column::Role::reuse};
  };
  static const std::vector<Column> all{
      column("ocean", "1: an earlier realisation had used an equal ocean"),
      column("legs_searched", "sets of eigenrays of echoes and direct blasts that were searched"),
      column("legs_reused", "the same, that were known"),
      column("reverberation", "1: all paths to scattering boundaries and layers were known"),
      column("expected_level", "1: so was the expected level of the reverberation")};
  return all;
}

std::vector<Column> columns(const Study& study) {
  std::vector<Column> all = Sampler(study).columns();
  for (Column& column : measure_columns(study, example_of(study))) all.push_back(std::move(column));
  for (const OwnMeasure& own : study.measure.own)
    all.push_back({.name = own.name, .unit = own.unit, .meaning = own.meaning});
  if (study.rare.event)
    all.push_back(
        {.name = rare_event_column, .unit = "1", .meaning = "1: " + study.rare.event->text});
  return all;
}

CellShape cell_shape(const Study& study) {
  if (!study.measure.cells) return {};
  return {.targets = example_of(study).targets.size(),
          .edges = study.measure.cells->edges,
          .levels = cell_levels(study.measure.false_alarm_probability())};
}

struct Realiser::Impl {
  Impl(Study made, int processes)
      : study(std::move(made)),
        sampler(study),
        measures(columns(study).size() - inputs()),
        budget(budget_of(study.scenario, MemoryBudget(processes))),
        memory(budget.bytes(), static_cast<std::size_t>(tbb::this_task_arena::max_concurrency())) {}
  [[nodiscard]] std::size_t inputs() const { return sampler.columns().size(); }
  [[nodiscard]] Row make(std::uint64_t index, double bytes, RowCost* cost);
  /// What it drew, and why it has no measures.
  [[nodiscard]] Row skipped(std::uint64_t index, const Sampler::Drawn& draw,
                            const std::string& fault) const {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    Row row{.index = index, .valid = false, .fault = fault, .values = draw.values};
    row.values.resize(inputs() + measures, none);
    row.reuse.assign(reuse_columns().size(), none);
    return row;
  }

  Study study;
  Sampler sampler;
  std::size_t measures;
  MemoryBudget budget;  // of all rows in hand
  RowMemory memory;
  /// Bounded, so that memory stays flat: a target that moves never finds its paths again.
  std::shared_ptr<SharedPropagation> shared = std::make_shared<SharedPropagation>(shared_bytes);
};

Realiser::Realiser(Study study, int processes)
    : impl_(std::make_unique<Impl>(std::move(study), processes)) {}
Realiser::~Realiser() = default;

const Study& Realiser::study() const noexcept { return impl_->study; }

Row Realiser::realise(std::uint64_t index, RowCost* cost) const {
  Row row;
  CostClock clock(cost);
  impl_->memory.within([&](double bytes) { row = impl_->make(index, bytes, cost); });
  if (cost != nullptr) cost->total = clock.lap();
  return row;
}

Row Realiser::skipped(std::uint64_t index, const std::string& fault) const {
  return impl_->skipped(index, impl_->sampler.draw(index), fault);
}

/// \param bytes  that it may take
Row Realiser::Impl::make(std::uint64_t index, double bytes, RowCost* cost) {
  CostClock clock(cost);
  const Sampler::Drawn draw = sampler.draw(index);
  Row row{.index = index, .values = draw.values};
  const auto fails = [&](const InputError& error) {
    const InputError fault = told(error, study.scenario_path, index, sampler.describe(draw));
    if (study.on_error == OnError::stop) {
      InputFault stop = fault.fault();
      stop.expected += ", or study.on_error = \"skip\"";
      throw InputError(stop);
    }
    row = skipped(index, draw, fault.what());
  };
  try {
    TomlValue tree = study.scenario;
    sampler.apply(draw, tree);
    Scenario scenario = scenario_of(tree, study.scenario_path);
    scenario.seed = seed_of(study, sampler.chance_of(index));
    clock.lap(Stage::scenario);
    PingSimulator simulator(std::move(scenario), shared, budget.share(bytes, "a row's share"));
    if (!study.measure.run) simulator.receives_one_ping();
    clock.lap(Stage::ocean);
    Measured measured = measure(study, simulator, all_measures, shared, cost,
                                keeps(study.measure.detections_every, index));
    static_cast<void>(clock.lap());
    row.reuse = reuse_of(measured.record.reuse);
    row.values.insert(row.values.end(), measured.values.begin(), measured.values.end());
    row.cells = std::move(measured.cells);
    row.unknown = std::move(measured.unknown);
    for (const OwnMeasure& own : study.measure.own)
      row.values.push_back(own.of(tree, simulator, measured.record));
    if (study.rare.event)
      row.values.push_back(study.rare.event->of(study.rare.event->excess_of(row.values)));
    clock.lap(Stage::measures);
    if (keeps(study.measure.series_every, index))
      keep_series(measured.record, study, simulator.scenario(), row);
    keep_arrays(measured, study, simulator.scenario(), row);
  } catch (const MemoryError& error) {
    if (bytes < memory.total()) throw;
    fails(error);
  } catch (const InputError& error) {
    fails(error);
  } catch (const std::bad_alloc&) {  // the system has less than run.memory allows
    fails(InputError({.where = "run.memory",
                      .got = "no more memory to be had",
                      .expected = "as much as it allows, " + budget.text()}));
  }
  return row;
}

}  // namespace asdic::detail::study
