#pragma once
#include <optional>
#include <vector>

#include "sonar/paths/leg.h"
#include "sonar/ping/ping.h"

namespace asdic::detail {

/// A receiver that somebody asks about.
struct AskedReceiver {
  double range = 0.0;                    ///< horizontal, from the source [m]
  double depth = 0.0;                    ///< [m]
  std::optional<double> source_depth{};  ///< [m]; none: the transmitter's
  std::optional<double> bearing{};       ///< [rad]; none: along the transect, or north
  std::optional<double> frequency{};     ///< of the losses [Hz]; none: the pulse's centre

  /// What needs no ocean. \throws InputError ("range", "bearing", "frequency")
  void check() const;
};

/// Where the transmitter of a ping is when it sends. \param ping  from 1
/// \throws InputError ("ping") if there is no such
[[nodiscard]] Vec3 source_of(const PingSimulator& simulator, int ping);

/// The same, and the next function, of a ping whose place and time the schedule does not say.
[[nodiscard]] Leg leg_to(const PingSimulator& simulator, const PingGeometry& geometry,
                         const AskedReceiver& receiver);
[[nodiscard]] std::vector<Leg> legs_of_targets(const PingSimulator& simulator,
                                               const PingGeometry& geometry,
                                               std::optional<int> target,
                                               std::optional<double> frequency);

/// Eigenrays from where a ping is sent to any depth and range.
/// \throws InputError ("ping", "range", "depth", "source_depth", "bearing", "frequency")
[[nodiscard]] Leg leg_to(const PingSimulator& simulator, int ping, const AskedReceiver& receiver);

/// Eigenrays of a ping to the targets and from them to the arrays.
/// \param target  this one alone, from 0   \param frequency  of the losses [Hz]; none: the pulse's
[[nodiscard]] std::vector<Leg> legs_of_targets(const PingSimulator& simulator, int ping,
                                               std::optional<int> target = {},
                                               std::optional<double> frequency = {});

}  // namespace asdic::detail
