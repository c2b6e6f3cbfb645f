#pragma once
#include <optional>
#include <span>
#include <vector>

#include "processing/array_shape.h"
#include "processing/delay_tables.h"
#include "processing/detection.h"
#include "raytrace/places/propagation_paths.h"
#include "sonar/scenario/scenario.h"
#include "sonar/scenario/track.h"
#include "sonar/scenario/transmitter.h"

namespace asdic::detail {

struct LocaliserSettings {
  double frequency = 4000.0;        ///< sets losses, by which one pair of paths is preferred [Hz]
  PropagationSettings propagation;  ///< which paths may be taken
  std::optional<double> depth;  ///< of what answers [m]; none: where the ray that came in at the
                                ///< measured elevation was, and `shallow` if none was measured
  double shallow = 100.0;       ///< [m]
  std::size_t ranges = 300;     ///< of the table
  std::optional<double> speed;  ///< straight rays of this speed instead of the ray model [m/s]
};

/// Ends of a pair that counts as one place are this far apart at most, per delay [m/s].
inline constexpr double farthest_apart = 30.0;

/// Who sent and who received one ping. Times count from the ping's start.
struct SonarPlaces {
  Kinematics source;                         ///< when the ping starts
  Track array;                               ///< of the array's reference point, from then on
  const TransmitPattern* pattern = nullptr;  ///< of the transmitter; none: azimuthally symmetric
  ArrayShape shape;                          ///< of the array
};

/// From delay, direction and Doppler factor to a place, by the paths of sound.
///
/// The delay of every pair of paths, out to a point in the direction looked at and back, is
/// tabulated over its range, one branch per history of the path; the ranges at which a pair's delay
/// is the measured one are candidates, and the one whose echo would be loudest (and whose elevation
/// fits, where it was measured) is taken and refined by Newton's method with exact eigenrays. A
/// line's cone is cut with the elevation of the path itself. The array has moved since the ping.
/// Built once per run; const and shared by threads, as far as PropagationPaths is.
/// Source: docs/theory/processing.md, eq. (8)
class Localiser {
 public:
  Localiser(const PropagationPaths& paths, const LocaliserSettings& settings);

  /// \param elevation_sigma  of the measured elevation, where there is one [rad]
  /// \return as Detection::locations
  [[nodiscard]] std::vector<Location> locate(const Detection& detection, const SonarPlaces& places,
                                             double elevation_sigma) const;
  /// Why locate() found none.
  [[nodiscard]] Unplaced reason(const Detection& detection, const SonarPlaces& places) const;

  /// The range from the array that an echo out of one bearing has at each of some times: of the
  /// loudest pair of paths with that delay, to a straight line between the table's nodes. For maps.
  /// \param times  rising, after the ping's start [s]   \return [times] [m]; NaN where no pair of
  /// paths takes so long
  [[nodiscard]] std::vector<double> ranges(double bearing, std::span<const double> times,
                                           const SonarPlaces& places) const;

  /// The most bounces that were left out of account where sound has more than are asked for here.
  [[nodiscard]] bool lacks_bounces() const noexcept { return tables_.lack_bounces(); }

 private:
  struct Query;
  [[nodiscard]] std::optional<Location> at_depth(const Query& query, double depth) const;
  [[nodiscard]] std::optional<Location> along_ray(const Query& query) const;
  [[nodiscard]] std::optional<Location> towards(Query query, std::optional<double> bearing) const;
  [[nodiscard]] Arrivals like(const PathHistory& wanted, const Vec3& from, const Vec3& to) const;

  const PropagationPaths& paths_;
  LocaliserSettings settings_;
  mutable DelayTables tables_;
};

}  // namespace asdic::detail
