#pragma once
#include <vector>

#include "raytrace/area/earth_places.h"
#include "raytrace/cases/propagation_case.h"

namespace asdic::detail {

/// Where the vertical plane of a run is on the Earth. It is known where the map's [0, 0] is, and
/// where the run has a bearing: over an area, along a transect.
class EarthLine {
 public:
  EarthLine() = default;  ///< nothing is known
  explicit EarthLine(const PropagationCase& run_case);

  [[nodiscard]] bool known() const noexcept { return earth_.known(); }
  [[nodiscard]] const EarthPlaces& earth() const noexcept { return earth_; }
  /// Of growing range, clockwise from north [rad].
  [[nodiscard]] double bearing() const noexcept { return bearing_; }
  /// Of a range from the sources, on the map [m].
  [[nodiscard]] Vec2 on_map(double range) const noexcept;
  [[nodiscard]] GeographicPlace at(double range) const noexcept;

 private:
  EarthPlaces earth_;
  Vec2 place_ = Vec2::Zero();
  double bearing_ = 0.0;
};

}  // namespace asdic::detail
