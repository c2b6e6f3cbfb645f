#include <algorithm>
#include <cmath>
#include <limits>

#include "core/mixed_bits.h"
#include "reverb/power/path_interference.h"
#include "sonar/reverberation/reverberation.h"
#include "sonar/signal/pulse_coherence.h"

namespace asdic::detail {
namespace {

constexpr int elevations = 6;  // ranges of arrival elevation, alike in its sine

/// What a sector's scatterers put into one bin: their power, and the one that stands for all.
struct Bin {
  float power = 0.0F, chosen = 0.0F;  // of all; of that one (both ways of a reciprocal pair)
  std::uint32_t ring = 0, copies = 0, copy = 0;
  std::uint16_t out = 0, back = 0;
};

/// The same pair the other way round, if it is among them and not the pair itself.
const PathPair* reciprocal(std::span<const PathPair> pairs, const PathPair& pair) {
  for (const PathPair& other : pairs)
    if (other.out_index == pair.back_index && other.back_index == pair.out_index && &other != &pair)
      return &other;
  return nullptr;
}

}  // namespace

double PingReverberation::sector_bin(const ScatteringField& field) const {
  const double bins_allowed = static_cast<double>(scenario_.reverberation.most_returns) /
                              (2.0 * field.grid.azimuths * static_cast<double>(fields_.size()));
  return std::max(0.5 / context_.pulse.bandwidth_99(), context_.latest / bins_allowed);
}

void PingReverberation::add_sector(const ScatteringField& field, int sector,
                                   ReturnBlock& into) const {
  const ScattererWeights weights(field.field.statistics, Draw::sector_weight, scenario_.seed,
                                 context_.geometry.time(), context_.ping());
  const double bin = sector_bin(field);
  const auto count = static_cast<std::size_t>(std::ceil(context_.latest / bin)) + 1;
  std::vector<Bin> bins(count * elevations);
  PathPairs pairs;
  PlaceSounds sounds;
  const PathInterference interference(context_.phones, field.sheet.ends().frequency,
                                      *pulse_coherence(context_.pulse), false);
  const double speed = field.sheet.ends().receiver_speed;
  const bool one_fan = field.sheet.one_fan();
  const auto with = [&](const PathPair& pair) {
    return one_fan ? reciprocal(pairs.found, pair) : nullptr;
  };
  const auto put = [&](const ScattererKey& key, std::uint64_t entity, const Met& met) {
    sounds.clear();
    for (const PathPair& pair : pairs.found) {
      const PathPair* other = with(pair);
      const PathPair* part = other && pair.out_index > pair.back_index ? other : &pair;
      sounds.add(field.sheet, pair, {}, field.sheet.doppler(pair, met.velocity, met.bragg),
                 field.sheet.arriving(pair), static_cast<std::size_t>(part - pairs.found.data()));
    }
    const std::span<const double> gains = sounds.gains(interference, {}, pairs.found.size());
    for (const PathPair& pair : pairs.found) {
      const PathPair* other = with(pair);
      if (other && pair.out_index > pair.back_index) continue;  // it goes with the other
      const double alone = std::norm(met.strength) * (std::norm(pair.amplitude) +
                                                      (other ? std::norm(other->amplitude) : 0.0));
      const double power =
          alone * std::pow(gains[static_cast<std::size_t>(&pair - pairs.found.data())], 2);
      const double sine = -field.sheet.arriving(pair).z() * speed;
      const int elevation =
          std::clamp(static_cast<int>(0.5 * (sine + 1.0) * elevations), 0, elevations - 1);
      const auto late = static_cast<std::size_t>(std::max(0.0, pair.delay) / bin);
      Bin& full =
          bins[std::min(late, count - 1) * elevations + static_cast<std::size_t>(elevation)];
      full.power += static_cast<float>(power);
      const std::uint64_t number = std::uint64_t{pair.out_index} << 16 | pair.back_index;
      const double drawn = uniform_of_bits(mixed(mixed(entity, scenario_.seed), number));
      if (drawn * static_cast<double>(full.power) >= power) continue;
      full = {.power = full.power,
              .chosen = static_cast<float>(alone),
              .ring = key.ring,
              .copies = key.copies,
              .copy = key.copy,
              .out = static_cast<std::uint16_t>(pair.out_index),
              .back = static_cast<std::uint16_t>(pair.back_index)};
    }
  };
  for (std::uint32_t ring = 0; ring < field.grid.rings; ++ring)
    for_each_scatterer(field, ring, sector, pairs, put);
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const Bin& full = bins[i];
    if (full.chosen <= 0.0F) continue;
    const ScattererKey key{.ring = full.ring,
                           .sector = static_cast<std::uint32_t>(sector),
                           .copies = full.copies,
                           .copy = full.copy};
    const Met met = meet(field, key, key.entity(field.grid.identity), pairs);
    const std::uint64_t entity = mixed(mixed(field.grid.identity, ~std::uint64_t(sector)), i);
    const std::complex<double> weight =
        std::sqrt(static_cast<double>(full.power) / static_cast<double>(full.chosen)) *
        weights(entity);
    for (const PathPair& pair : pairs.found)
      if (pair.out_index == full.out && pair.back_index == full.back) {
        receive(field, pairs, pair, met, weight, into);
        const PathPair* other = one_fan ? reciprocal(pairs.found, pair) : nullptr;
        if (other) receive(field, pairs, *other, met, weight, into);
        break;
      }
  }
}

std::vector<PingReverberation::Block> PingReverberation::sector_blocks() const {
  std::vector<Block> blocks;
  for (std::size_t field = 0; field < fields_.size(); ++field) {
    const auto sectors = static_cast<std::uint32_t>(fields_[field].grid.azimuths);
    const double bins = context_.latest / sector_bin(fields_[field]);
    for (std::uint32_t sector = 0; sector < sectors; ++sector)
      blocks.push_back({.field = field,
                        .begin = sector,
                        .end = sector + 1,
                        .expected = static_cast<std::size_t>(2.0 * bins) + 1});
  }
  return blocks;
}

}  // namespace asdic::detail
