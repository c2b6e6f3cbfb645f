#pragma once
#include <optional>

#include "reverb/scattering/models.h"

namespace asdic {

/// Surface reverberation as scattering patches on one ground grid.
struct ReverberationSettings {
  bool enabled = true;
  AnySurfaceScattering surface =
      NrlSurface{};   ///< wind and surface sound speed are filled in from the environment
  int azimuths = 36;  ///< sectors of a ring, each with its own bearing and weight
  std::optional<double> ground_spacing;  ///< of the grid [m]; by default from the pulse's bandwidth
};

}  // namespace asdic
