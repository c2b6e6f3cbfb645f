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
  [[nodiscard]] bool parting_matters(const FanRay& a, const FanRay& m, const FanRay& b,
                                     std::size_t leg) const;

  std::span<const ReceiverColumn> columns_;
};

/// The first and one past the last column that either of two legs crosses.
struct ColumnSpan {
  std::uint32_t first, last;
};
[[nodiscard]] ColumnSpan columns_of(const RayLeg& a, const RayLeg& b) noexcept;

}  // namespace asdic
