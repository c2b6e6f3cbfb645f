#pragma once
#include <span>

#include "raytrace/tracing/fan_ray.h"

namespace asdic {

/// Whether the rays between two neighbours of a fan are known well enough from the two: where both
/// cross a column on the same leg with the same history, the Hermite cubic through their depths and
/// slopes must tell the depth of a third ray between them.
class NeighbourTest {
 public:
  explicit NeighbourTest(std::span<const ReceiverColumn> columns) : columns_(columns) {}

  /// \param m  a ray launched between a and b. False: the interval must be split there.
  [[nodiscard]] bool holds(const FanRay& a, const FanRay& m, const FanRay& b) const;

 private:
  [[nodiscard]] bool leg_holds(const FanRay& a, const FanRay& m, const FanRay& b,
                               std::size_t leg) const;
  [[nodiscard]] bool ends_hold(const FanRay& a, const FanRay& m, const FanRay& b,
                               std::size_t leg) const;
  [[nodiscard]] bool parting_matters(const FanRay& a, const FanRay& m, const FanRay& b,
                                     std::size_t leg) const;

  std::span<const ReceiverColumn> columns_;
};

/// Where to split the interval between two neighbours: where they part at a node between two
/// facets, just beyond the ray that strikes it (Newton's method from the nearer ray, a little too
/// far, so that the node is soon enclosed from both sides); else in the middle.
[[nodiscard]] double splitting_angle(const FanRay& a, const FanRay& b,
                                     const Environment& environment) noexcept;

/// The first and one past the last column that a leg may cross on some ray between two neighbours:
/// those that either of the two crosses, and those that only rays between reach, where the place at
/// which the leg begins or ends is turned around by a caustic.
struct ColumnSpan {
  std::uint32_t first, last;
};
[[nodiscard]] ColumnSpan columns_between(const FanRay& a, const FanRay& b, std::size_t leg,
                                         std::span<const ReceiverColumn> columns) noexcept;

}  // namespace asdic
