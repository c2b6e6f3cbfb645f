#pragma once
#include <cstdint>
#include <vector>

#include "reverb/scattering/sea_draws.h"
#include "sonar/echoes/echo.h"
#include "sonar/paths/moving_paths.h"

namespace asdic::detail {

/// What something that moves receives of something else that moves, along one path: delay since the
/// ping, Doppler factor and slowness of the one leg, amplitude with the ping's pattern (and without
/// it in `frequency response`). \param sender  when what is received leaves
[[nodiscard]] EchoPath received_along(const EchoContext& context, const Kinematics& sender,
                                      const MetPath& met);

/// Adds what rough boundaries scatter about that path. \param sent  when it leaves, since the ping
/// [s]   \param ends  number of the pair of places, the same from ping to ping
/// \param received  of the path's own   \param draws  of the scenario's seed
void scatter_along(const EchoContext& context, const Kinematics& sender, double sent,
                   const MetPath& met, std::uint64_t ends, const EchoPath& received,
                   SeaDraws& draws, std::vector<EchoPath>& found);

/// Where so many paths are told of, no more than so many bounces of each are: their places took a
/// gigabyte. Counts of bounces stay. \param receivers  that are told of alike
void shorten_bounces(Arrivals& paths, std::size_t receivers = 1);

}  // namespace asdic::detail
