#pragma once
#include <span>
#include <utility>
#include <vector>

#include "processing/blast_canceller.h"
#include "raytrace/places/propagation_paths.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// Whether a transmitter's own platform carries an array.
[[nodiscard]] bool is_own(const Scenario& scenario, int transmitter, int array) noexcept;

/// Whether an array is blanked while a transmitter sends: the own ship's alone.
[[nodiscard]] bool is_blanked(const Scenario& scenario, int transmitter, int array) noexcept;

/// Whether echoes of a transmitter are to be found while it sends: pings of a continuous record
/// whose pulse lasts longer than a tenth of the time that a ping is received, at an array that is
/// not blanked meanwhile.
[[nodiscard]] bool sends_on(const Scenario& scenario, int transmitter, int array,
                            double duration) noexcept;

/// What is listened to: one array, from a ping's start on.
struct BlastSearch {
  const Scenario& scenario;
  const PropagationPaths& paths;
  int ping = 1, transmitter = 0, array = 0;
  double ping_time = 0.0;         ///< since the start of the scenario [s]
  double start = 0.0, end = 0.0;  ///< of the record, after the ping's start [s]
  std::vector<Vec3> phones;       ///< from the array's reference point [m]
};

/// Transmissions whose straight ways reach the array in the record. Without a continuous record
/// that is the ping's own alone.
/// \param pulses  [transmitters], or one for all   \param all  not only those that send on
[[nodiscard]] std::vector<KnownBlast> known_blasts(const BlastSearch& search,
                                                   std::span<const Replica> pulses, bool all);

/// When the array is blanked, after the ping's start [s].
[[nodiscard]] std::vector<std::pair<double, double>> blanked_times(const BlastSearch& search,
                                                                   std::span<const Replica> pulses);

/// When the ping's own sound comes first, after its start; the array's own ship's: 0 [s]
[[nodiscard]] double first_sound(const BlastSearch& search, const Replica& pulse);

}  // namespace asdic::detail
