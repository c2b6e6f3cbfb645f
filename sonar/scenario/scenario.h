#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "raytrace/area/ocean_on_map.h"
#include "raytrace/ocean/ocean_origin.h"
#include "reverb/fields/reverberation_settings.h"
#include "sonar/scenario/array.h"
#include "sonar/scenario/interferer.h"
#include "sonar/scenario/noise_settings.h"
#include "sonar/scenario/ping_schedule.h"
#include "sonar/scenario/platform.h"
#include "sonar/scenario/propagation_settings.h"
#include "sonar/scenario/target.h"
#include "sonar/scenario/transmitter.h"
#include "sonar/signal/pulse.h"

namespace asdic::detail {

/// All that a simulation needs, as plain data. Times in s, lengths in m, angles in rad.
struct Scenario {
  std::string title;
  std::uint64_t seed = 1;
  Environment environment;                       ///< along the transect
  Transect transect;                             ///< where its range axis lies on the map
  std::optional<OceanOrigin> origin;             ///< where the map is, and what it was made of
  std::shared_ptr<const Area> area;              ///< the ocean over the map; none: the transect's
  double wind_speed = 10.0;                      ///< at 10 m [m/s]
  std::vector<Platform> platforms = {{}};        ///< carry transmitters and arrays
  std::vector<Transmitter> transmitters = {{}};  ///< [n ≥ 1]
  PulseSettings pulse;                           ///< of the transmitters without one of their own
  std::vector<ReceiverArray> arrays = {{}};      ///< [n ≥ 1]
  std::vector<Target> targets;
  std::vector<Interferer> interferers;
  NoiseSettings noise;
  ReverberationSettings reverberation;
  PropagationSettings propagation;
  PingSchedule pings;

  std::string text;                    ///< the scenario file, verbatim
  std::string path;                    ///< where it was read
  std::vector<std::string> overrides;  ///< "key.path=value" that changed the text's values
  std::vector<std::string> notes;      ///< what the reader did that the user should know
};

/// The ocean as it lies on the map. The scenario outlives it.
[[nodiscard]] inline OceanOnMap ocean_on_map(const Scenario& scenario) noexcept {
  return {scenario.environment, scenario.transect, scenario.area.get()};
}

/// Where a transmitter is and how it moves: asked once, of a scenario as it is read. What asks
/// again and again has a PingGeometry or an ArrayMotion (sonar/scenario/ping_geometry.h,
/// carried.h). \param transmitter  index   \param time  since the start of the scenario [s]
[[nodiscard]] Kinematics transmitter_at(const Scenario& scenario, int transmitter, double time);
/// The same of an array's reference point, the middle of its phones.
[[nodiscard]] Kinematics array_at(const Scenario& scenario, int array, double time);
/// Its phones as they lie then, from its reference point at that time.
/// \param ping  of the run, counted from 1: its shape   \param time  since the start of the
/// scenario [s]
[[nodiscard]] std::vector<Vec3> phones_at(const Scenario& scenario, int array, int ping,
                                          double time);
/// The course of a platform, north if it never moves [rad].
[[nodiscard]] double platform_heading(const Scenario& scenario, int platform, double time);
/// The pulse that a transmitter sends: its own or the scenario's.
[[nodiscard]] const PulseSettings& pulse_of(const Scenario& scenario, int transmitter);
/// Phones of all arrays, one after the other: the channels of a record.
[[nodiscard]] std::size_t channels_of(const Scenario& scenario);
/// The channel of an array's first phone.
[[nodiscard]] std::size_t first_channel(const Scenario& scenario, int array);

}  // namespace asdic::detail
