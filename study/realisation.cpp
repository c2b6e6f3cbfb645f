#include "study/realisation.h"

#include <atomic>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/random.h"
#include "io/scenario_reader.h"
#include "study/measures.h"
#include "study/sampler.h"

namespace asdic::study {
namespace {

/// The seed of a realisation's own streams: noise, weights, fluctuations.
std::uint64_t seed_of(const Study& study, std::uint64_t index) {
  const auto words = RandomStream(study.seed, Draw::study_noise, 0, index).block(0);
  return (static_cast<std::uint64_t>(words[0]) << 32) | words[1];
}

bool keeps_series(const MeasurePlan& plan, std::uint64_t index) {
  return plan.series_every > 0 && index % plan.series_every == 0;
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
}

}  // namespace

std::vector<Column> columns(const Study& study) {
  std::vector<Column> all = Sampler(study).columns();
  for (Column& column : measure_columns(study, example_of(study))) all.push_back(std::move(column));
  return all;
}

struct Realiser::Impl {
  explicit Impl(Study made)
      : study(std::move(made)), sampler(study), measures(columns(study).size() - inputs()) {}
  [[nodiscard]] std::size_t inputs() const { return sampler.columns().size(); }

  Study study;
  Sampler sampler;
  std::size_t measures;
  /// Bounded, so that memory stays flat: a target that moves never finds its paths again.
  std::shared_ptr<SharedPropagation> shared =
      std::make_shared<SharedPropagation>(std::size_t{64} << 20);

  void count(const Reuse& reuse) noexcept {
    ++pings;
    oceans += reuse.ocean ? 1 : 0;
    searched += static_cast<std::uint64_t>(reuse.legs_searched);
    reused += static_cast<std::uint64_t>(reuse.legs_reused);
    boundaries += reuse.reverberation ? 1 : 0;
  }
  std::atomic<std::uint64_t> pings = 0, oceans = 0, searched = 0, reused = 0, boundaries = 0;
};

Realiser::Realiser(Study study) : impl_(std::make_unique<Impl>(std::move(study))) {}
Realiser::~Realiser() = default;

const Study& Realiser::study() const noexcept { return impl_->study; }

ReuseCounts Realiser::reuse() const noexcept {
  return {.pings = impl_->pings,
          .oceans_known = impl_->oceans,
          .legs_searched = impl_->searched,
          .legs_reused = impl_->reused,
          .boundaries_known = impl_->boundaries};
}

Row Realiser::realise(std::uint64_t index) const {
  const Study& study = impl_->study;
  const Sampler::Drawn draw = impl_->sampler.draw(index);
  Row row{.index = index, .values = draw.values};
  try {
    TomlValue tree = study.scenario;
    impl_->sampler.apply(draw, tree);
    Scenario scenario = scenario_of(tree, study.scenario_path);
    scenario.seed = seed_of(study, index);
    const PingSimulator simulator(std::move(scenario), impl_->shared);
    Measured measured = measure(study, simulator);
    impl_->count(measured.record.reuse);
    row.values.insert(row.values.end(), measured.values.begin(), measured.values.end());
    if (keeps_series(study.measure, index))
      keep_series(measured.record, study, simulator.scenario(), row);
  } catch (const InputError& error) {
    const InputError fault = told(error, study.scenario_path, index, impl_->sampler.describe(draw));
    if (study.on_error == OnError::stop) {
      InputFault stop = fault.fault();
      stop.expected += ", or study.on_error = \"skip\"";
      throw InputError(stop);
    }
    row.valid = false;
    row.fault = fault.what();
    row.values.resize(impl_->inputs() + impl_->measures, std::numeric_limits<double>::quiet_NaN());
  }
  return row;
}

}  // namespace asdic::study
