#include "sonar/reverberation/reverberation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/doppler.h"
#include "core/mixed_bits.h"
#include "raytrace/parallel/parallel.h"

namespace asdic::detail {
namespace {

/// Three normals that belong to a scatterer, held at four standard deviations.
Vec3 own_velocity(double rms, std::uint64_t entity, std::uint64_t seed) {
  if (rms <= 0.0) return Vec3::Zero();
  RandomStream draw(seed, Draw::scatterer_velocity, 0, entity);
  Vec3 velocity;
  for (int i = 0; i < 3; ++i) velocity[i] = rms * std::clamp(draw.normal(), -4.0, 4.0);
  return velocity;
}

}  // namespace

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
  blocks_ = by_sectors_ ? sector_blocks() : expected_->blocks;
  std::erase_if(blocks_, [&](const Block& b) {
    return fields_[b.field].received_by != ReceivedBy::scatterers;
  });
}

PingReverberation::Met PingReverberation::meet(const ScatteringField& field,
                                               const ScattererKey& key, std::uint64_t entity,
                                               PathPairs& pairs) const {
  const ScattererMotion& motion = field.field.motion;
  const Scatterer scatterer = place_scatterer(field.grid, key, entity, scenario_.seed);
  field.sheet.pairs_at(
      scatterer.place, pairs, &expected_->limits, field.received_area(key.ring),
      (scatterer.depth_share - 0.5) * field.thickness,
      mixed(entity, field.field.statistics.coherence_time > 0.0 ? 0 : context_.ping()));
  Met met;
  if (pairs.found.empty()) return met;
  const Vec2 in_water = scatterer.place - motion.current * context_.geometry.time();
  met.strength =
      field.share * std::sqrt(scatterer.area * pairs.found.front().area) *
      texture_amplitude(field.field.statistics, in_water, field.boundary, scenario_.seed);
  met.velocity = {motion.current.x(), motion.current.y(), 0.0};
  if (motion.kind == ScattererMotion::Kind::bragg)
    met.bragg = scatterer.fate < motion.receding_share ? -1.0 : 1.0;
  else if (motion.kind == ScattererMotion::Kind::spread)
    met.velocity += own_velocity(motion.speed_rms, entity, scenario_.seed);
  return met;
}

void PingReverberation::receive(const ScatteringField& field, const PathPairs& pairs,
                                const PathPair& pair, const Met& met, std::complex<double> weight,
                                ReturnBlock& into) const {
  const std::complex<double> strength = met.strength * weight;
  into.returns.push_back({.delay = pair.delay,
                          .amplitude = pair.amplitude * strength,
                          .doppler = field.sheet.doppler(pair, met.velocity, met.bragg),
                          .slowness = met_by(pair.receiver->velocity, field.sheet.arriving(pair))});
  const std::size_t points = context_.band.size();
  const auto first = static_cast<std::size_t>(&pair - pairs.found.data()) * points;
  for (std::size_t k = 0; k < points; ++k)
    into.responses.emplace_back(pairs.responses[first + k] * strength);
}

void PingReverberation::add_rings(const ScatteringField& field, std::uint32_t begin,
                                  std::uint32_t end, ReturnBlock& into) const {
  const ScattererWeights weights(field.field.statistics, field.weights, scenario_.seed,
                                 context_.geometry.time(), context_.ping());
  PathPairs pairs;
  for (std::uint32_t ring = begin; ring < end; ++ring)
    for (int sector = 0; sector < field.grid.azimuths; ++sector)
      for_each_scatterer(field, ring, sector, pairs,
                         [&](const ScattererKey& /*key*/, std::uint64_t entity, const Met& met) {
                           const std::complex<double> weight = weights(entity);
                           for (const PathPair& pair : pairs.found)
                             receive(field, pairs, pair, met, weight, into);
                         });
}

void PingReverberation::make(std::size_t block, ReturnBlock& into) const {
  const Block& b = blocks_[block];
  const ScatteringField& field = fields_[b.field];
  if (!by_sectors_) return add_rings(field, b.begin, b.end, into);
  for (std::uint32_t sector = b.begin; sector < b.end; ++sector)
    add_sector(field, static_cast<int>(sector), into);
}

Bounces PingReverberation::bounces() const {
  Bounces all;
  for (const ScatteringField& field : fields_) all.include(field.bounces);
  return all;
}

std::vector<DopplerSpan> PingReverberation::dopplers() const {
  std::vector<DopplerSpan> spans;
  for (const ScatteringField& field : fields_)
    for (const DopplerSpan& span : field.sheet.dopplers(field.field.motion)) spans.push_back(span);
  return spans;
}

Returns PingReverberation::collect(const std::vector<Block>& blocks, bool sectors) const {
  std::vector<ReturnBlock> parts(blocks.size());
  in_parallel(blocks.size(), [&](std::size_t i) {
    const Block& b = blocks[i];
    if (!sectors) return add_rings(fields_[b.field], b.begin, b.end, parts[i]);
    for (std::uint32_t sector = b.begin; sector < b.end; ++sector)
      add_sector(fields_[b.field], static_cast<int>(sector), parts[i]);
  });
  Returns all;
  for (const ReturnBlock& part : parts)
    all.insert(all.end(), part.returns.begin(), part.returns.end());
  return all;
}

Returns PingReverberation::plain_returns() const { return collect(expected_->blocks, false); }
Returns PingReverberation::sector_returns() const { return collect(sector_blocks(), true); }
Returns PingReverberation::returns() const { return collect(blocks_, by_sectors_); }

double PingReverberation::expected_db(double t) const {
  return context_.geometry.transmitter().source_level_db +
         db_from_power(
             expected_->power([&](double since) { return context_.pulse.analytic(since); },
                              context_.pulse.duration(), t));
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
