#include "sonar/reverberation/sector_returns.h"

#include <algorithm>
#include <cmath>

#include "core/mixed_bits.h"
#include "reverb/power/path_interference.h"
#include "sonar/reverberation/scatterer_returns.h"
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

SectorReturns::SectorReturns(const ScattererMeeting& meeting, const Pulse& pulse, double latest,
                             std::size_t most, std::size_t fields)
    : meeting_(meeting), pulse_(pulse), latest_(latest), most_(most), fields_(fields) {}

double SectorReturns::bin(const ScatteringField& field) const {
  const double bins_allowed =
      static_cast<double>(most_) / (2.0 * field.grid.azimuths * static_cast<double>(fields_));
  return std::max(0.5 / pulse_.bandwidth_99(), latest_ / bins_allowed);
}

void SectorReturns::add(const ScatteringField& field, int sector, ReturnBlock& into) const {
  const ScattererWeights weights(field.field.statistics, Draw::sector_weight, meeting_.seed,
                                 meeting_.time, meeting_.ping);
  const double width = bin(field);
  const auto count = static_cast<std::size_t>(std::ceil(latest_ / width)) + 1;
  std::vector<Bin> bins(count * elevations);
  PathPairs pairs;
  PlaceSounds sounds;
  const PathInterference interference({}, field.sheet.ends().frequency, *pulse_coherence(pulse_),
                                      false);
  const double speed = field.sheet.ends().receiver_speed;
  const bool one_fan = field.sheet.one_fan();
  const auto with = [&](const PathPair& pair) {
    return one_fan ? reciprocal(pairs.found, pair) : nullptr;
  };
  const auto put = [&](const ScattererKey& key, std::uint64_t entity, const MetScatterer& met) {
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
      const double alone =
          met.strength * met.strength *
          (std::norm(pair.amplitude) + (other ? std::norm(other->amplitude) : 0.0));
      const double power =
          alone * std::pow(gains[static_cast<std::size_t>(&pair - pairs.found.data())], 2);
      const double sine = -field.sheet.arriving(pair).z() * speed;
      const int elevation =
          std::clamp(static_cast<int>(0.5 * (sine + 1.0) * elevations), 0, elevations - 1);
      const auto late = static_cast<std::size_t>(std::max(0.0, pair.delay) / width);
      Bin& full =
          bins[std::min(late, count - 1) * elevations + static_cast<std::size_t>(elevation)];
      full.power += static_cast<float>(power);
      const std::uint64_t number = std::uint64_t{pair.out_index} << 16 | pair.back_index;
      const double drawn = uniform_of_bits(mixed(mixed(entity, meeting_.seed), number));
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
    for_each_scatterer(field, ring, sector, meeting_, pairs, put);
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const Bin& full = bins[i];
    if (full.chosen <= 0.0F) continue;
    const ScattererKey key{.ring = full.ring,
                           .sector = static_cast<std::uint32_t>(sector),
                           .copies = full.copies,
                           .copy = full.copy};
    const MetScatterer met = meet(field, key, key.entity(field.grid.identity), meeting_, pairs);
    const std::uint64_t entity = mixed(mixed(field.grid.identity, ~std::uint64_t(sector)), i);
    const std::complex<double> weight =
        std::sqrt(static_cast<double>(full.power) / static_cast<double>(full.chosen)) *
        weights(entity);
    for (const PathPair& pair : pairs.found)
      if (pair.out_index == full.out && pair.back_index == full.back) {
        add_return(field, pairs, pair, met, weight, into);
        const PathPair* other = one_fan ? reciprocal(pairs.found, pair) : nullptr;
        if (other) add_return(field, pairs, *other, met, weight, into);
        break;
      }
  }
}

std::vector<ExpectedReverberation::Block> SectorReturns::blocks(
    std::span<const ScatteringField> fields) const {
  std::vector<ExpectedReverberation::Block> blocks;
  for (std::size_t field = 0; field < fields.size(); ++field) {
    const auto sectors = static_cast<std::uint32_t>(fields[field].grid.azimuths);
    const double bins = latest_ / bin(fields[field]);
    for (std::uint32_t sector = 0; sector < sectors; ++sector)
      blocks.push_back({.field = field,
                        .begin = sector,
                        .end = sector + 1,
                        .expected = static_cast<std::size_t>(2.0 * bins) + 1});
  }
  return blocks;
}

}  // namespace asdic::detail
