#pragma once
#include <array>
#include <optional>
#include <string_view>

#include "io/text/toml_table.h"
#include "sonar/scenario/track.h"

namespace asdic::detail::serve {

/// How a command says that something moves, what decides first. `speed`, with `heading_deg`, is of
/// commands alone.
inline constexpr std::array<std::string_view, 5> motion_keys{"position", "waypoints", "velocity",
                                                             "speed", "heading_deg"};

/// Whether a command says how something moves, by any of these.
[[nodiscard]] bool has_motion(TomlTable& wanted);

/// When something moves otherwise.
struct MotionTime {
  double time = 0.0;  ///< of position and velocity [s]
  /// From when on its track keeps where it was before [s]; none: it keeps nothing.
  std::optional<double> since = {};
};

/// Writes a motion into the scenario's table of the thing that moves, in place of the earlier one.
/// Quantities that are not given continue.   \param now  its track so far   \return false if it
/// moves like that already, so that nothing is written   \throws InputError naming the command's
/// key
bool set_motion(TomlTable& wanted, const Track& now, const MotionTime& when, TomlValue& table);

/// A place and a velocity as the file has them: in a place, or from there on in a straight line.
void set_kinematics(const Kinematics& state, double time, TomlValue& table);

[[nodiscard]] TomlValue toml_vector(const Vec3& v);

}  // namespace asdic::detail::serve
