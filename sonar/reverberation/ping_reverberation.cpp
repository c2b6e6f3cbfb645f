#include "sonar/reverberation/ping_reverberation.h"

#include <algorithm>
#include <utility>

#include "raytrace/parallel/parallel.h"
#include "sonar/reverberation/scatterer_returns.h"
#include "sonar/signal/pulse_coherence.h"

namespace asdic::detail {

PingReverberation::PingReverberation(const Scenario& scenario, const ReverberationContext& context,
                                     std::vector<ScatteringField> fields,
                                     std::shared_ptr<const ExpectedReverberation> expected,
                                     std::shared_ptr<const ReverberationCovariance> covariance,
                                     std::shared_ptr<const ReverberationStreams> streams)
    : scenario_(scenario),
      context_(context),
      fields_(std::move(fields)),
      expected_(std::move(expected)),
      covariance_(std::move(covariance)),
      streams_(std::move(streams)) {
  context_.phones = {};  // of the caller's, who needs not keep them
  context_.budget = nullptr;
  for (std::size_t i = 0; i < fields_.size(); ++i)
    if (fields_[i].received_by == ReceivedBy::scatterers) one_by_one_ += expected_->returns_of(i);
  // A part of the array receives the scatterers that its neighbours receive, one by one.
  by_sectors_ =
      !context_.point && one_by_one_ > static_cast<double>(scenario_.reverberation.most_returns);
  blocks_ = by_sectors_ ? sectors().blocks(fields_) : expected_->blocks;
  std::erase_if(blocks_, [&](const Block& b) {
    return fields_[b.field].received_by != ReceivedBy::scatterers;
  });
}

ScattererMeeting PingReverberation::meeting() const {
  return {.seed = scenario_.seed,
          .time = context_.geometry.time(),
          .ping = context_.ping(),
          .limits = &expected_->limits};
}

SectorReturns PingReverberation::sectors() const {
  return {meeting(), context_.pulse, context_.latest, scenario_.reverberation.most_returns,
          fields_.size()};
}

void PingReverberation::add(const Block& block, bool by_sectors, ReturnBlock& into) const {
  const ScatteringField& field = fields_[block.field];
  if (!by_sectors) return add_scatterers(field, meeting(), block.begin, block.end, into);
  for (std::uint32_t sector = block.begin; sector < block.end; ++sector)
    sectors().add(field, static_cast<int>(sector), into);
}

void PingReverberation::make(std::size_t block, ReturnBlock& into) const {
  add(blocks_[block], by_sectors_, into);
}

Bounces PingReverberation::bounces() const {
  Bounces all;
  for (const ScatteringField& field : fields_) all.include(field.bounces);
  return all;
}

bool PingReverberation::drawn_anew() const noexcept {
  return std::any_of(fields_.begin(), fields_.end(),
                     [](const ScatteringField& field) { return field.drawn_anew; });
}

std::vector<DopplerSpan> PingReverberation::dopplers() const {
  std::vector<DopplerSpan> spans;
  for (const ScatteringField& field : fields_)
    for (const DopplerSpan& span : field.sheet.dopplers(field.field.motion)) spans.push_back(span);
  return spans;
}

Returns PingReverberation::collect(const std::vector<Block>& blocks, bool by_sectors) const {
  std::vector<ReturnBlock> parts(blocks.size());
  in_parallel(blocks.size(), [&](std::size_t i) { add(blocks[i], by_sectors, parts[i]); });
  Returns all;
  for (const ReturnBlock& part : parts)
    all.insert(all.end(), part.returns.begin(), part.returns.end());
  return all;
}

Returns PingReverberation::plain_returns() const { return collect(expected_->blocks, false); }
Returns PingReverberation::sector_returns() const {
  return collect(sectors().blocks(fields_), true);
}
Returns PingReverberation::returns() const { return collect(blocks_, by_sectors_); }

double PingReverberation::expected_db(double t) const {
  return context_.geometry.transmitter().source_level_db +
         db_from_power(
             expected_->power([&](double since) { return context_.pulse.analytic(since); },
                              context_.pulse.duration(), t));
}

std::vector<double> PingReverberation::mean_power(double first, double step, std::size_t count,
                                                  PropagationMemory& memory) const {
  if (fields_.empty()) return std::vector<double>(count, 0.0);
  const Pulse& pulse = context_.pulse;
  const auto coherence = pulse_coherence(pulse);
  const auto find = [&] {
    return std::make_shared<std::vector<double>>(
        expected_->mean_power({.coherence = *coherence,
                               .duration = pulse.duration(),
                               .energy = pulse.energy(),
                               .frequency = pulse.centre_frequency()},
                              first, step, count));
  };
  auto key = ExpectedReverberation::key(fields_, pulse.duration(), Kept::mean_reverberation);
  if (!key) return *find();
  key->add_all(coherence->fingerprint(), pulse.energy(), first, step, count);
  return *memory.remember(
      *key, find, [](const std::vector<double>& power) { return power.size() * sizeof(double); });
}

PatchRows PingReverberation::rows(std::size_t most, PropagationMemory* memory) const {
  if (fields_.empty()) return {};
  const double source_level = context_.geometry.transmitter().source_level_db;
  const auto find = [&] { return patch_rows(fields_, expected_->limits, source_level, most); };
  auto key = memory == nullptr
                 ? std::nullopt
                 : ExpectedReverberation::key(fields_, context_.pulse.duration(), Kept::patch_rows);
  if (!key) return find();
  key->add(most).add(source_level);
  for (const ScatteringField& field : fields_) key->add_all(field.boundary, field.thickness);
  return *memory->remember(
      *key, [&] { return std::make_shared<PatchRows>(find()); },
      [](const PatchRows& found) { return found.rows.size() * sizeof(PatchRow); });
}

}  // namespace asdic::detail
