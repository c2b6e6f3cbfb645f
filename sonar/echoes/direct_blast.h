#pragma once
#include "sonar/echoes/echo.h"
#include "sonar/paths/moving_paths.h"
#include "sonar/paths/returns.h"

namespace asdic::detail {

/// What an array receives of the ping itself, on its way from the transmitter: no target, no
/// scatterer.
struct DirectBlast {
  std::vector<Leg> legs;           ///< transmitter → array (or one to every phone)
  std::vector<EchoPath> received;  ///< one per path, and what rough boundaries scatter about it;
                                   ///< target −1
  Bounces bounces;                 ///< that were followed
};

/// The ways from the transmitter to one phone, each to where the phone is when that path arrives.
struct BlastPaths {
  Leg leg;                   ///< with the paths to where it is when the first of them comes
  std::vector<MetPath> met;  ///< [paths]
  Vec3 end = Vec3::Zero();   ///< place of the phone then [m]
  Carried receiver;          ///< what receives
  Bounces followed;
  PathLimits limits;
};
/// Of an array on the transmitter's own platform without what comes straight.
/// \param channel  of the array; −1: its reference point
[[nodiscard]] BlastPaths blast_paths(const EchoContext& context, int channel);

/// Delays are solved for where the array is when each path arrives; every path has its exact
/// Doppler factor. An array on the transmitter's own platform receives what surface and bottom
/// mirror (the fathometer's returns), not what comes straight: levels refer to 1 m, and a sonar is
/// deaf while it sends. Any other has to be at least 1 m from the transmitter.
[[nodiscard]] DirectBlast direct_blast(const EchoContext& context);

}  // namespace asdic::detail
