#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "core/units.h"
#include "processing/array_shape.h"

namespace asdic::detail {

/// Where and how a thing may be that answers like this, by the paths of sound.
struct Location {
  Vec3 position = Vec3::Zero();  ///< when the sound struck it [m]
  double range = 0.0;            ///< horizontal, from the array when it received it [m]
  double bearing = 0.0;     ///< from there, clockwise from north; NaN if the array tells none [rad]
  double elevation = 0.0;   ///< look elevation of the returning path, positive up [rad]
  double range_rate = 0.0;  ///< of half the horizontal way there and back [m/s]; from the Doppler
                            ///< factor and the paths' slowness
  double range_slope = 0.0;    ///< dr/dτ along the bearing: range per delay [m/s]
  double bearing_slope = 0.0;  ///< dr/dβ at one delay, along its ellipse; 0 of one place [m/rad]
  double rate_slope = 0.0;     ///< range rate per Doppler factor, 1/(ξ_out + ξ_home) [m/s]
  double struck = 0.0;         ///< when the sound struck it, since the ping's start [s]
  int surface_bounces = 0, bottom_bounces = 0;  ///< there and back together

  /// Range and range rate per delay and Doppler factor. Along the bearing looked at the way out
  /// grows by cos(turn) of the way home, dT/dr = ξ_out·cos(turn) + ξ_home; a thing that moves
  /// changes both by its own velocity, η − 1 = −(ξ_out + ξ_home)·ṙ, ṙ half the horizontal way's.
  /// Across the bearing the way out grows by r·sin(turn) dβ. From `range`, which must be set.
  /// \param xi_out, xi_home  horizontal slownesses [s/m]  \param turn  between their bearings [rad]
  void set_slopes(double xi_out, double xi_home, double turn, double factor);
};

/// Why a detection has no place.
enum class Unplaced {
  no,          ///< it has one
  no_bearing,  ///< the array tells none and the pair lies apart: anywhere on an ellipse
  no_path,     ///< no pair of paths to the assumed depth has its delay
  ray_ends,    ///< the ray back at the measured elevation ends before
};
[[nodiscard]] std::string_view words_for(Unplaced reason) noexcept;

/// One thing received that is not background.
struct Detection {
  int ping = 1;
  int array = 0;
  double time = 0.0;           ///< of its leading edge after the ping's start [s]
  double doppler = 1.0;        ///< factor η
  double doppler_sigma = 0.0;  ///< its standard deviation; of a sweep, time errs with it along the
                               ///< ridge (DetectorResult::delay_per_doppler)
  Vec3 look = Vec3::UnitY();   ///< unit vector towards it; on a cone around a line, see `cosine`
  double cosine = 0.0;         ///< line, bent or not: of the angle between look and axis; else NaN
  double bearing = 0.0;        ///< of `look`; NaN for an upright line or a point [rad]
  double elevation =
      0.0;  ///< of `look`; NaN for a line that is not upright, bent or not, or a point [rad]
  double snr_db = 0.0;     ///< |peak|² over the mean square of the envelope around it [dB]
  double excess_db = 0.0;  ///< peak over threshold [dB]
  double level_db = 0.0;   ///< of an echo from `look`, peak envelope/√2 [dB re 1 µPa]
  /// One; two where left and right cannot be resolved (right of the line's axis first, or the two
  /// mirror images of a plane); none where no path fits.
  std::vector<Location> locations;
  Unplaced unplaced = Unplaced::no;  ///< why, if there is none
};

}  // namespace asdic::detail
