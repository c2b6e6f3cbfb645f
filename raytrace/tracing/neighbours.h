#pragma once
#include <cmath>
#include <initializer_list>
#include <span>

#include "raytrace/tracing/fan_ray.h"

namespace asdic::detail {

/// How far from the place where a leg turns around a column may be to be looked at, and a receiver
/// from a ray that no gap between rays is left beside it [m].
inline constexpr double least_room = 0.1;

/// Launch angles closer than this are no longer resolved [rad].
[[nodiscard]] inline bool finest_apart(double a, double b) noexcept {
  return std::abs(b - a) < 4e-15 + 4e-16 * std::abs(a);
}

/// From the source to a range [m].
[[nodiscard]] inline double way_to(const FanRay& ray, double range) noexcept {
  return std::abs(range - ray.legs.front().begin.range);
}

/// Whether the rays between two neighbours of a fan are known well enough from the two: where both
/// cross a column on the same leg with the same history, the Hermite cubic through their depths and
/// slopes must tell the depth of a third ray between them.
class NeighbourTest {
 public:
  NeighbourTest(const Environment& environment, std::span<const ReceiverColumn> columns)
      : environment_(environment), columns_(columns) {}

  /// \param m  a ray launched between a and b. False: the interval must be split there.
  [[nodiscard]] bool holds(const FanRay& a, const FanRay& m, const FanRay& b) const;
  /// Whether the rays between two neighbours that are far apart are all of one kind: they turn in
  /// the same rows of the water, and where one strikes a boundary tells where the next does.
  [[nodiscard]] bool regular(const FanRay& a, const FanRay& m, const FanRay& b) const;
  /// Whether two neighbours are so close that no third ray is needed: their depths, places and the
  /// slopes of these lie on lines, and where they part nothing is lost between them.
  [[nodiscard]] bool pair_tells(const FanRay& a, const FanRay& b) const;

 private:
  [[nodiscard]] bool leg_holds(const FanRay& a, const FanRay& m, const FanRay& b, std::size_t leg,
                               bool evenly) const;
  [[nodiscard]] bool ends_hold(const FanRay& a, const FanRay& m, const FanRay& b,
                               std::size_t leg) const;
  [[nodiscard]] bool parting_matters(const FanRay& a, const FanRay& m, const FanRay& b,
                                     std::size_t leg) const;
  [[nodiscard]] bool begins_behind_the_box(const FanRay& a, const FanRay& m, const FanRay& b,
                                           std::size_t leg) const;
  [[nodiscard]] bool gap_is_clear(std::initializer_list<const FanRay*> rays, double width,
                                  std::size_t leg) const;
  [[nodiscard]] bool ends_far_from_receivers(
      std::initializer_list<const FanRay*> rays) const noexcept;
  [[nodiscard]] bool one_facet(double from, double to) const noexcept;

  const Environment& environment_;
  std::span<const ReceiverColumn> columns_;
};

/// Where to split the interval between two neighbours: where they part at a node between two
/// facets, just beyond the ray that strikes it (Newton's method from the nearer ray, a little too
/// far, so that the node is soon enclosed from both sides); where one grazes a flat boundary that
/// the other does not reach, likewise; else in the middle.
[[nodiscard]] double splitting_angle(const FanRay& a, const FanRay& b,
                                     const Environment& environment) noexcept;

/// The first and one past the last column that a leg may cross on some ray between two neighbours:
/// those that either of the two crosses, those between them, and those that only rays between
/// reach, where the place at which the leg begins or ends is turned around by a caustic.
struct ColumnSpan {
  std::uint32_t first, last;
};
[[nodiscard]] ColumnSpan columns_between(const FanRay& a, const FanRay& b, std::size_t leg,
                                         std::span<const ReceiverColumn> columns) noexcept;

}  // namespace asdic::detail
