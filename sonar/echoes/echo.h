#pragma once
#include <optional>
#include <vector>

#include "raytrace/places/propagation_paths.h"
#include "sonar/echoes/echo_path.h"
#include "sonar/echoes/target_response.h"
#include "sonar/paths/enough_bounces.h"
#include "sonar/paths/leg.h"
#include "sonar/paths/returns.h"
#include "sonar/scenario/ping_geometry.h"
#include "sonar/scenario/scenario.h"
#include "sonar/scenario/transmitter.h"

namespace asdic::detail {

/// What the echoes of one ping need to know. Times count from the start of the ping.
struct EchoContext {
  const PropagationPaths& paths;
  const PingGeometry& geometry;
  const TransmitPattern& pattern;
  double frequency;               ///< centre of the pulse [Hz]
  int array = 0;                  ///< that receives it
  const Pulse* pulse = nullptr;   ///< none: its leading edge alone is followed
  Reuse* reuse = nullptr;         ///< counts the eigenrays that were known
  bool listens = true;            ///< false: nobody asks for the phones' samples
  std::size_t most_pairs = 4096;  ///< of paths: where there are more, the loudest are listed
  /// Pairs of paths whose delays curve over the pulse: more are synthesised in two steps. About as
  /// many cost the same either way with 32 phones. It is no number of returns, since a phone alone
  /// receives what it receives in an array.
  std::size_t most_curved = 128;

  [[nodiscard]] const Scenario& scenario() const noexcept { return geometry.scenario(); }
  /// Who looks at a target in this ping.
  [[nodiscard]] Look look() const noexcept {
    return {.transmitter = geometry.sent().transmitter,
            .platform = geometry.array(array).platform,
            .ping = geometry.ping(),
            .own_ping = geometry.sent().own_ping};
  }
};

/// Whether a pulse passes the array as a plane wave (sonar/paths/plane_wave.h). \param received  at
/// the reference point   \param length  of its path to the array [m]
[[nodiscard]] bool is_plane_wave(const EchoContext& context, const Return& received, double length);

/// The echoes of one target: eigenrays out, eigenrays back, and every pair of them at every
/// highlight.
///
/// If `many` is set, nothing of `echoes` is to be gridded, because two_step_echo() makes their
/// sound; `echoes` holds the loudest pairs alone if there are more than EchoContext::most_pairs.
struct TargetEchoes {
  std::vector<Leg> legs;  ///< source → target, then target → array (or one per phone)
  std::vector<EchoPath> echoes;
  /// What each phone receives by paths of its own, where a plane wave about the reference point is
  /// not what they receive (sonar/paths/plane_wave.h), nor exact_per_phone has been asked for; else
  /// empty.
  std::vector<EchoPath> at_phones;
  std::vector<EchoPath> scattered;  ///< by rough boundaries, about the paths of the echoes
  Bounces bounces;                  ///< that were followed on either leg
  std::optional<ManyEchoes> many;
};

/// Delays are solved for the target's position when the sound strikes it and the array's when it is
/// received, path by path: 7 m/s over 20 s is 144 m. Each pair has its exact Doppler factor from
/// velocities, ray directions and local speeds, and a curve of its own where ranges change at
/// changing rates during the pulse. The legs hold the eigenrays at the times of the first arrivals.
/// Source: docs/theory/echoes.md, docs/theory/target.md
[[nodiscard]] TargetEchoes target_echoes(const EchoContext& context, int target);

}  // namespace asdic::detail
