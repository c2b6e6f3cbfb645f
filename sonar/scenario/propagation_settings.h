#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/units.h"

namespace asdic::detail {

class Fields;

/// Frequencies at which losses, patterns and the amplitudes of waves are computed.
enum class BandOfLosses : std::uint8_t {
  automatic,  ///< echoes and direct sound: as `wide` where that changes them, else as `narrow`
  narrow,     ///< the pulse's centre
  wide,       ///< all of the pulse
};
inline constexpr std::string_view band_of_losses_words[] = {"auto", "narrow", "wide"};
constexpr std::span<const std::string_view> words(BandOfLosses /*any*/) {
  return band_of_losses_words;
}

/// What is searched for. A path is kept when it is within all the limits.
struct PropagationSettings {
  int dimension = 2;  ///< 2: rays keep to vertical planes; 3: floors and fronts turn them sideways
  /// None ("auto"): as many as there is sound in, sonar/paths/enough_bounces.h.
  std::optional<int> max_surface_bounces = {};
  std::optional<int> max_bottom_bounces = {};
  double max_launch_angle = 0.5 * pi;  ///< from the horizontal [rad]
  bool direct_blast = true;            ///< arrays on other platforms receive the ping on its way
  bool fathometer = false;  ///< arrays on the transmitter's platform receive it off the boundaries
  BandOfLosses band = BandOfLosses::automatic;
  bool diffraction = true;       ///< echoes and direct sound where no ray goes, in stratified water
  bool exact_per_phone = false;  ///< eigenrays to every phone, also where a plane wave is enough

  void describe(Fields& field);
};

}  // namespace asdic::detail
