#pragma once
#include <string>
#include <vector>

#include "raytrace/warnings/warnings.h"
#include "sonar/scenario/pulse_frequencies.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// Of a sonar's scenario, its ocean included: what a user should know before he trusts a number, in
/// one line each, "KEY: what is the matter". Every check is a function of this file.
[[nodiscard]] std::vector<std::string> warnings(const Scenario& scenario);

namespace checks {

/// A pulse whose band reaches down to 0 Hz: written in kHz, most likely.
[[nodiscard]] std::string pulse_band(const Scenario& scenario);
/// A geometric comb two or more of whose lines an echo's Doppler puts on others.
[[nodiscard]] std::string comb_lines(const Scenario& scenario);
/// Wenz's or Knudsen's noise asked about frequencies that its curves do not have.
[[nodiscard]] std::string noise_law_range(const Scenario& scenario);
/// Measured noise asked about frequencies at which it was not measured: beyond its ends the level
/// stays what it is there.
[[nodiscard]] std::string noise_table_band(const Scenario& scenario);
/// Scattering at the sea surface by a law that was not measured for this frequency or wind.
[[nodiscard]] std::string surface_scattering_range(const Scenario& scenario);
/// Reverberation that may be drawn from its covariance, by plane waves, for an array that is too
/// long for them (sonar/reverberation/phone_groups.h).
[[nodiscard]] std::string reverberation_plane_waves(const Scenario& scenario);
/// Coherent noise of a towed line that turns so fast that coherence changes within a block of it.
[[nodiscard]] std::string noise_of_a_bent_line(const Scenario& scenario);
/// Noise of sources at the surface, over a bottom that reflects it.
[[nodiscard]] std::string noise_from_below(const Scenario& scenario);
/// Rays in three dimensions, and what stays in vertical planes beside them.
[[nodiscard]] std::string planes_beside_volume(const Scenario& scenario);
/// Targets, and an ocean or a range for which sound where no ray goes is not computed.
[[nodiscard]] std::string left_out_diffraction(const Scenario& scenario);
/// Sound that is heard from beyond an area's maps: there their edges go on.
[[nodiscard]] std::string beyond_the_map(const Scenario& scenario);
/// The same of sound that is followed to a distance from the platforms [m].
[[nodiscard]] std::string beyond_the_map(const Scenario& scenario, double distance);
/// Noise of another wind than that over an array.
[[nodiscard]] std::string wind_elsewhere(const Scenario& scenario);
/// Places where an area's map, or the bounds that rays in three dimensions take of it, do not hold.
[[nodiscard]] std::string far_from_the_origin(const Scenario& scenario);
/// A target whose echo along straight lines no array receives completely within its ping's record.
[[nodiscard]] std::string echo_beside_record(const Scenario& scenario);
/// Pings whose records overlap. No record contains what is received of another ping.
[[nodiscard]] std::string overlapping_records(const Scenario& scenario);
/// Rings of reverberation that are further apart than the pulse is long, or much wider than the
/// source is high over them.
[[nodiscard]] std::string coarse_rings(const Scenario& scenario);
/// A line transmitter that is steered so far that its beam is much wider than `beamwidth_deg`.
[[nodiscard]] std::string steered_line(const Scenario& scenario);
/// A scattering law of a rough boundary that hands out more energy than comes in.
[[nodiscard]] std::string scattering_energy(const Scenario& scenario);

}  // namespace checks
}  // namespace asdic::detail
