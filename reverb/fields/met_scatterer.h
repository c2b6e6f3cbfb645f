#pragma once
#include <cstdint>

#include "reverb/fields/scattering_field.h"

namespace asdic::detail {

/// By which draws scatterers are met one by one, when, and what is too faint.
struct ScattererMeeting {
  std::uint64_t seed = 1;
  double time = 0.0;                      ///< of the ping, since the start of the scenario [s]
  std::uint32_t ping = 1;                 ///< key of what every ping draws anew
  const AudibleLimits* limits = nullptr;  ///< pairs that are fainter are left out; null: none
};

/// A scatterer as a ping meets it, with what belongs to it alone.
struct MetScatterer {
  double strength = 0.0;         ///< √(area·texture), its field's share included [m]
  double bragg = 0.0;            ///< as ScatteringSheet::doppler() takes it
  Vec3 velocity = Vec3::Zero();  ///< [m/s]
};

/// \param entity  of the key   \param pairs  of paths through it: none where it is not received
[[nodiscard]] MetScatterer meet(const ScatteringField& field, const ScattererKey& key,
                                std::uint64_t entity, const ScattererMeeting& meeting,
                                PathPairs& pairs);

/// Calls visit(key, entity, met) for every scatterer of a cell that is received; its pairs are in
/// `pairs` then.
template <class Visit>
void for_each_scatterer(const ScatteringField& field, std::uint32_t ring, int sector,
                        const ScattererMeeting& meeting, PathPairs& pairs, Visit&& visit) {
  const std::uint32_t copies = field.copies_of(ring, sector);
  for (std::uint32_t copy = 0; copy < copies; ++copy) {
    const ScattererKey key{
        .ring = ring, .sector = static_cast<std::uint32_t>(sector), .copies = copies, .copy = copy};
    const std::uint64_t entity = key.entity(field.grid.identity);
    const MetScatterer met = meet(field, key, entity, meeting, pairs);
    if (!pairs.found.empty()) visit(key, entity, met);
  }
}

}  // namespace asdic::detail
