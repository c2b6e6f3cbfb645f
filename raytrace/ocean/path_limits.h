#pragma once
#include <limits>

namespace asdic::detail {

/// What is searched for, between one source and one receiver depth. A path is kept when it is
/// within all the limits.
struct PathLimits {
  int max_surface_bounces = 3;
  int max_bottom_bounces = 3;
  double max_launch_angle = 1.5707963267948966;  ///< from the horizontal [rad]
  int max_vertices = 256;    ///< turning points and bounces together: at a kink of the profile ever
                             ///< smaller cycles have no end
  int min_vertices = 0;      ///< fewest of them, of a search for some histories alone
  bool diffraction = false;  ///< and what waves do at caustics and where no ray comes (sonar's)
  double faintest = 0.0;     ///< product of reflection magnitudes below which a path is dropped
  /// Of a path to the ground: delay + home_slowness·range above which it is dropped, for with the
  /// quickest way home it comes too late [s]. A search for receivers uses it to stop, and may keep
  /// some later ones.
  double max_delay = std::numeric_limits<double>::infinity();
  double home_slowness = 0.0;  ///< [s/m]
};

}  // namespace asdic::detail
