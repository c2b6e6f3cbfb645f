#pragma once
#include <span>
#include <vector>

#include "reverb/patches.h"
#include "sonar/ping_record.h"
#include "sonar/pulse.h"
#include "sonar/scenario.h"
#include "sonar/transmitter.h"

namespace asdic {

/// Where and how the sonar hears its own reverberation in one ping.
struct ReverberationContext {
  const Scenario& scenario;
  const BeamPattern& pattern;
  Kinematics platform;
  double sound_speed;  ///< at the platform [m/s]
  std::uint32_t ping;
  double first_bearing = 0.0;  ///< where sector 0 begins, clockwise from north [rad]
};

/// The patches of one plane, and the azimuth sectors of every ring that they stand for: all of them
/// in a layered ocean, otherwise the two mirrored about the transect.
struct SectorPatches {
  std::vector<Patch> patches;  ///< of the whole ring, were it all like this plane
  std::vector<int> sectors;    ///< 0 … azimuths − 1; sector k is centred on first_bearing +
                               ///< 2π(k + ½)/azimuths
};

/// The patches as returns: every ring is split into azimuth sectors, each with its own direction,
/// Doppler factor and complex Gaussian weight, E|w|² = 1, keyed by (seed, ping, ground cell,
/// sector) and shared by all path pairs through it. The weakest pairs are left out as long as all
/// that is left out stays 50 dB below what is heard at its time.
[[nodiscard]] Returns reverberation_returns(const ReverberationContext& context,
                                            std::span<const SectorPatches> pieces);
/// The same of patches that stand for all sectors.
[[nodiscard]] Returns reverberation_returns(const ReverberationContext& context,
                                            std::span<const Patch> patches);

/// Expected level of the reverberation at the array at time t [dB re 1 µPa, peak envelope/√2]: SL +
/// 10·log₁₀ Σ_cells |Σ_pairs A·D·s(t − τ)|², the mean over sectors. −∞ where there is none.
[[nodiscard]] double expected_reverberation_db(const ReverberationContext& context,
                                               std::span<const SectorPatches> pieces,
                                               const Pulse& pulse, double t);

/// The patches as rows of the file, at most `most` of them; \return {rows, every}: each every-th
/// cell is kept (of each piece).
struct PatchRows {
  std::vector<PatchRow> rows;
  int every = 1;
};
[[nodiscard]] PatchRows patch_rows(const ReverberationContext& context,
                                   std::span<const SectorPatches> pieces, std::size_t most);

}  // namespace asdic
