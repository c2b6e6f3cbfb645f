#pragma once

namespace asdic {

/// What is searched for, between one source and one receiver depth. A path is kept when it is
/// within all the limits.
struct PathLimits {
  int max_surface_bounces = 3;
  int max_bottom_bounces = 3;
  double max_launch_angle = 1.5707963267948966;  ///< from the horizontal [rad]
  int max_vertices = 256;    ///< turning points and bounces together: at a kink of the profile ever
                             ///< smaller cycles have no end
  bool diffraction = false;  ///< and the sound that gets where no ray does (sonar's paths only)
  double faintest = 0.0;     ///< product of reflection magnitudes below which a path is dropped
};

}  // namespace asdic
