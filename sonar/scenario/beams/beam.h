#pragma once
#include <complex>
#include <concepts>
#include <span>
#include <string>
#include <string_view>

#include "core/fields.h"

namespace asdic::detail {

class ExactKey;

/// How a transmitter holds its beam, and in what water.
struct BeamMount {
  double wavelength;       ///< at the source [m]
  double sound_speed;      ///< there [m/s], for delays
  double heading = 0.0;    ///< of its platform [rad]
  double elevation = 0.0;  ///< of the beam's axis, positive up [rad]
  double reference = 0.0;  ///< wavelength to which a line's beamwidth refers [m]; 0: `wavelength`
};
void add_to(ExactKey& key, const BeamMount& mount);

/// What a beam sends in every direction: far-field amplitude over bearing and elevation [rad].
template <class P>
concept FarField = requires(const P& pattern, double angle) {
  { pattern.towards(angle, angle) } -> std::same_as<std::complex<double>>;
  { P::azimuthally_symmetric } -> std::convertible_to<bool>;  // the same at every bearing
  /// Delay between its parts as the far field sees them, at most [s].
  { pattern.longest_delay() } -> std::same_as<double>;
};

/// A beam as scenarios say it.
template <class B>
concept TransmitBeam = Described<B> && requires(const B& beam, const BeamMount& mount) {
  { B::name } -> std::convertible_to<std::string_view>;
  { B::steers } -> std::convertible_to<bool>;  // in elevation
  { beam.pattern(mount) } -> FarField;
  /// "8 projectors, steered to 30 deg true" \param elevation  of its axis [rad]
  { beam.text(mount.elevation) } -> std::same_as<std::string>;
};

/// What the bearings of a transmitter's projectors, table and steering count from.
enum class BearingFrame { north, heading };
inline constexpr std::string_view bearing_frame_words[] = {"north", "heading"};
constexpr std::span<const std::string_view> words(BearingFrame /*any*/) {
  return bearing_frame_words;
}

/// Where a beam is turned to in bearing.
struct BeamBearing {
  double bearing = 0.0;                      ///< [rad]
  BearingFrame frame = BearingFrame::north;  ///< of bearings and offsets; heading: the platform's
                                             ///< course, offsets (starboard, forward, down)
  void describe(Fields& field);
  /// Of the frame, clockwise from north [rad]. \param heading  of the platform [rad]
  [[nodiscard]] double north_of_frame(double heading) const noexcept {
    return frame == BearingFrame::heading ? heading : 0.0;
  }
  [[nodiscard]] std::string text() const;  ///< "30 deg true"
};

}  // namespace asdic::detail
