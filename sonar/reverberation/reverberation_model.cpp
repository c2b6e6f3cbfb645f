#include "sonar/reverberation/reverberation_model.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "reverb/power/reverberation_streams.h"
#include "sonar/reverberation/reverberation_covariance.h"
#include "sonar/scenario/ping_bounds.h"
#include "sonar/scenario/sampling.h"
#include "sonar/signal/pulse_coherence.h"

namespace asdic::detail {

ReverberationModel::ReverberationModel(const Scenario& scenario, const PropagationPaths& paths,
                                       const Pulse& widest)
    : scenario_(scenario), paths_(paths), fields_(scenario, paths, widest) {}

int ReverberationModel::planes() const {
  return paths_.layered()
             ? 1
             : fields_.planes(0.5 * fastest_water(scenario_) * end_of_record(scenario_));
}

std::vector<ScatteringSheet::Law> ReverberationModel::laws() const {
  std::vector<ScatteringSheet::Law> found;
  for (const ScatteringPart& part : fields_.parts()) found.push_back(part.law.usual);
  return found;
}

/// Out of the paths' memory if everything that it depends on is as it was once.
std::shared_ptr<const ExpectedReverberation> ReverberationModel::expected(
    std::span<const ScatteringField> fields, const ReverberationContext& context) const {
  const double duration = context.pulse.duration();
  const auto key = ExpectedReverberation::key(fields, duration);
  const auto make = [&] {
    if (context.reuse != nullptr) context.reuse->expected_level = false;
    if (context.budget != nullptr)
      context.budget->take(ExpectedReverberation::need(fields, duration));
    return std::make_shared<ExpectedReverberation>(fields, duration);
  };
  return key ? paths_.memory().remember(*key, make) : make();
}

namespace {

constexpr double many = 20'000.0;  // returns: fewer are gridded as soon

/// Whether a ping may be received as streams where they serve.
bool may_stream(const Scenario& scenario, const ReverberationContext& context) noexcept {
  const ScattererSynthesis how = scenario.reverberation.synthesis;
  return how != ScattererSynthesis::scatterers && how != ScattererSynthesis::covariance &&
         !context.phones.empty() && scenario.arrays.size() == 1;
}

/// Where phones are, of all shapes that an array has: some of them, evenly.
std::vector<Vec3> places_of(std::span<const std::vector<Vec3>> shapes,
                            std::span<const Vec3> phones) {
  if (shapes.empty()) return {phones.begin(), phones.end()};
  constexpr std::size_t most = 64;
  std::vector<Vec3> all, some;
  for (const std::vector<Vec3>& shape : shapes) all.insert(all.end(), shape.begin(), shape.end());
  const std::size_t count = std::min(all.size(), std::max(most, shapes.front().size()));
  for (std::size_t i = 0; i < count; ++i) some.push_back(all[i * all.size() / count]);
  return some;
}

/// A shape that stands for whatever an array becomes while a stream of pings goes on: as long as it
/// is, in any heading, and as high. Then it receives the same streams after it has turned.
std::vector<std::vector<Vec3>> any_heading(std::span<const Vec3> phones, double frequency) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& x : phones) middle += x / static_cast<double>(phones.size());
  double wide = 0.0, high = 0.0;  // from the middle [m]
  for (const Vec3& x : phones) {
    wide = std::max(wide, (x - middle).norm());
    high = std::max(high, std::abs(x.z() - middle.z()));
  }
  const auto next = [&](double length) {  // of a row: one that bends a little is the same
    constexpr double finest = 4.0;        // lengths to an octave
    const double waves = length * frequency / 1500.0;
    if (waves < 0.01) return 0.0;
    return length / waves * std::exp2(std::ceil(finest * std::log2(waves) - 1e-9) / finest);
  };
  wide = next(wide);
  high = next(high);
  std::vector<Vec3> cross;
  const auto count = static_cast<int>(std::clamp<std::size_t>(phones.size(), 1, 16));
  for (int i = 0; i < count; ++i) {
    const double at = count == 1 ? 0.0 : 2.0 * i / (count - 1) - 1.0;
    for (const Vec3& way : {Vec3(wide, 0.0, 0.0), Vec3(0.0, wide, 0.0), Vec3(0.0, 0.0, high)})
      cross.emplace_back(at * way);
  }
  return {cross};
}

/// Width of Doppler shifts within which a sweep is itself, but for a delay [Hz]. A hundredth of its
/// band to either side, it correlates with itself by 0.99. A linear sweep's rate changes as well,
/// by 2ν/f, which turns its ends against its middle by (π/2)·BT·ν/f: 0.99 again at 0.47 rad, so
/// that ν is at most 0.3·f/(BT) to either side. Nothing of other pulses.
double doppler_tolerance(const Pulse& pulse) noexcept {
  const AnyWaveform& waveform = pulse.settings().waveform;
  const double band = pulse.bandwidth_99();
  if (std::holds_alternative<Hfm>(waveform)) return 0.02 * band;
  if (!std::holds_alternative<Lfm>(waveform)) return 0.0;
  return std::min(0.02 * band, 0.6 * pulse.centre_frequency() / (band * pulse.duration()));
}

/// Who receives them.
ReverberationStreams::Listener stream_listener(const Scenario& scenario,
                                               const ReverberationContext& context) {
  // What an array of many shapes receives is sorted for all of them once.
  const std::vector<std::vector<Vec3>> now{{context.phones.begin(), context.phones.end()}};
  const auto& several = context.geometry.array(context.array).shapes;
  const double highest = context.pulse.centre_frequency() + 0.5 * context.pulse.bandwidth_99();
  const bool changes = scenario.pings.continuous;
  const std::vector<std::vector<Vec3>> shapes = changes ? any_heading(now.front(), highest)
                                                : several.empty() ? now
                                                                  : several;
  return {.extents = ReverberationStreams::extents_of(shapes, highest),
          .phones = context.phones.size(),
          .frequency = highest,
          .bandwidth = context.pulse.bandwidth_99(),
          .pulse_duration = context.pulse.duration(),
          .doppler_tolerance = doppler_tolerance(context.pulse),
          .coherence = pulse_coherence(context.pulse),
          .places = changes ? shapes.front() : places_of(several, context.phones),
          .latest = context.latest};
}

}  // namespace

/// Marks the fields that are received by their covariance: those that it serves, if they have many
/// returns. Two arrays that receive the same scatterers would have one covariance: not if there are
/// several. Out of the paths' memory if it is there.
std::shared_ptr<const ReverberationCovariance> ReverberationModel::covariance(
    std::span<ScatteringField> fields, const ExpectedReverberation& expected,
    const ReverberationContext& context) const {
  // Its work grows with their square, a second at so many.
  constexpr std::size_t most_components = 128;
  const ScattererSynthesis how = scenario_.reverberation.synthesis;
  if (how == ScattererSynthesis::scatterers || how == ScattererSynthesis::streams ||
      context.phones.empty() || scenario_.arrays.size() > 1)
    return nullptr;
  const BandNodes band = ReverberationCovariance::frequencies_for(
      context.phones, context.pulse.centre_frequency(), context.pulse.bandwidth_99());
  if (how == ScattererSynthesis::automatic &&
      (!context.plane_waves || band.frequencies.size() * context.phones.size() > most_components))
    return nullptr;
  std::vector<const ScatteringField*> served;
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (ReverberationCovariance::serves(fields[i]) &&
        (how == ScattererSynthesis::covariance || expected.returns_of(i) > many)) {
      fields[i].received_by = ReceivedBy::covariance;
      served.push_back(&fields[i]);
    }
  if (served.empty()) return nullptr;
  const ReverberationCovariance::Listener listener = {.phones = context.phones,
                                                      .band = band,
                                                      .pulse_duration = context.pulse.duration(),
                                                      .coherence = pulse_coherence(context.pulse),
                                                      .latest = context.latest};
  auto key =
      ExpectedReverberation::key(fields, listener.pulse_duration, Kept::reverberation_covariance);
  const auto make = [&] {
    return std::make_shared<ReverberationCovariance>(served, expected.limits, listener);
  };
  if (!key) return make();
  key->add(listener.band.frequencies);
  key->add(listener.coherence->fingerprint());
  for (const ScatteringField& field : fields)
    key->add_all(static_cast<int>(field.received_by), field.thickness);
  for (const Vec3& phone : context.phones) key->add(phone);
  return paths_.memory().remember(*key, make);
}

/// Marks the fields that are received as streams: those that they serve, if they have many returns
/// and no covariance.
std::shared_ptr<const ReverberationStreams> ReverberationModel::streams(
    std::span<ScatteringField> fields, const ExpectedReverberation& expected,
    const ReverberationContext& context) const {
  if (!may_stream(scenario_, context)) return nullptr;
  const bool wherever = scenario_.reverberation.synthesis == ScattererSynthesis::streams;
  const ReverberationStreams::Listener listener = stream_listener(scenario_, context);
  bool any = false;
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (fields[i].received_by == ReceivedBy::scatterers &&
        ReverberationStreams::serves(fields[i]) &&
        (wherever || expected.returns_of(i) >
                         std::max(many, ReverberationStreams::worth(listener, fields[i])))) {
      fields[i].received_by = ReceivedBy::streams;
      any = true;
    }
  return any ? streams_of(fields, expected, context) : nullptr;
}

std::shared_ptr<const ReverberationStreams> ReverberationModel::streams_of(
    std::span<const ScatteringField> fields, const ExpectedReverberation& expected,
    const ReverberationContext& context) const {
  const ReverberationStreams::Listener listener = stream_listener(scenario_, context);
  std::vector<const ScatteringField*> served;
  for (const ScatteringField& field : fields)
    if (field.received_by == ReceivedBy::streams) served.push_back(&field);
  auto key =
      ExpectedReverberation::key(fields, listener.pulse_duration, Kept::reverberation_streams);
  const auto make = [&] {
    if (context.budget != nullptr)
      context.budget->take(ReverberationStreams::need(served, listener));
    return std::make_shared<ReverberationStreams>(served, expected.limits, listener);
  };
  if (!key) return make();
  key->add_all(listener.frequency, listener.doppler_tolerance);
  key->add(listener.coherence->fingerprint());
  for (const ScatteringField& field : fields) {
    const ScattererMotion& motion = field.field.motion;
    key->add_all(static_cast<int>(field.received_by), field.thickness, field.boundary, field.stays,
                 static_cast<int>(motion.kind), motion.receding_share, motion.current);
  }
  for (const Vec3& axis : listener.extents) key->add(axis);
  for (const Vec3& place : listener.places) key->add(place);
  return paths_.memory().remember(*key, make);
}

std::shared_ptr<const ReverberationStreams> ReverberationModel::as_streams(
    const ReverberationContext& context) const {
  std::vector<ScatteringField> received = fields_.of(context, ReverberationFields::Ground::means);
  if (received.empty()) return std::make_shared<const ReverberationStreams>();
  const auto known = expected(received, context);
  for (ScatteringField& field : received) {
    if (!ReverberationStreams::serves(field)) return nullptr;
    field.received_by = ReceivedBy::streams;
  }
  return streams_of(received, *known, context);
}

Bounces ReverberationModel::bounces(const ReverberationContext& context) const {
  Bounces all;
  for (const ScatteringField& field : fields_.of(context, ReverberationFields::Ground::means))
    all.include(field.bounces);
  return all;
}

void ReverberationModel::take_memory(const ReverberationContext& context) const {
  const std::vector<ScatteringField> received =
      fields_.of(context, ReverberationFields::Ground::means);
  if (received.empty()) return;
  context.budget->take(ExpectedReverberation::need(received, context.pulse.duration()));
  const bool forgets =
      std::all_of(received.begin(), received.end(),
                  [](const ScatteringField& field) { return ReverberationStreams::serves(field); });
  if (!forgets) static_cast<void>(fields_.in_detail(received, context));
  // How many returns there are, and so whether they are received as streams, is not known yet;
  // those that a covariance serves seldom are.
  if (!may_stream(scenario_, context)) return;
  const bool wherever = scenario_.reverberation.synthesis == ScattererSynthesis::streams;
  std::vector<const ScatteringField*> served;
  for (const ScatteringField& field : received)
    if (ReverberationStreams::serves(field) &&
        (wherever || !ReverberationCovariance::serves(field)))
      served.push_back(&field);
  if (!served.empty())
    context.budget->take(ReverberationStreams::need(served, stream_listener(scenario_, context)));
}

PingReverberation ReverberationModel::ping(const ReverberationContext& context) const {
  std::vector<ScatteringField> received = fields_.of(context, ReverberationFields::Ground::means);
  auto known = expected(received, context);
  auto by_covariance = covariance(received, *known, context);
  auto as_streams = streams(received, *known, context);
  return {scenario_,
          context,
          fields_.in_detail(std::move(received), context),
          std::move(known),
          std::move(by_covariance),
          std::move(as_streams)};
}

}  // namespace asdic::detail
