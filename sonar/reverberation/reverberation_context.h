#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "core/memory_budget.h"
#include "core/units.h"
#include "raytrace/places/propagation_paths.h"
#include "reverb/pairs/scattering_sheet.h"
#include "reverb/pairs/transmit_pattern.h"
#include "sonar/scenario/carried.h"
#include "sonar/scenario/ping_geometry.h"
#include "sonar/signal/pulse.h"

namespace asdic::detail {

/// One ping as one array receives it.
struct ReverberationContext {
  PingGeometry geometry;
  const TransmitPattern& pattern;
  const Pulse& pulse;
  int array = 0;  ///< that receives it, an index
  /// Of a part of the array that receives it by itself; none: all about reverberation_point().
  std::optional<Carried> point = {};
  double latest = 0.0;     ///< end of the record, since the ping [s]
  Reuse* reuse = nullptr;  ///< is told what had to be traced or worked out
  /// From where it is received [m]; none: nothing is received by its covariance, all of it one by
  /// one.
  std::span<const Vec3> phones = {};
  std::span<const BandPoint> band = {};  ///< returns get an amplitude for each; none: the centre's
  MemoryBudget* budget = nullptr;        ///< is asked before pairs are collected; null: nobody is
  bool plane_waves = true;               ///< fit all of the phones, whatever is received
  /// Whether a sea that every ping draws anew may lie around the source, wherever that is.
  bool drifts = false;
  /// Whether no other ping and no other array receives these scatterers: the world is this ping's.
  bool received_once = false;
  bool level_alone = false;  ///< nothing but the expected level is asked for
  bool judged = false;       ///< what numbers of bounces leave out is estimated

  /// The key of weights that last one ping.
  [[nodiscard]] std::uint32_t ping() const noexcept {
    return static_cast<std::uint32_t>(geometry.ping());
  }
};

}  // namespace asdic::detail
