#pragma once
#include "raytrace/layered/column.h"
#include "raytrace/ocean/arrivals.h"

namespace asdic::detail {

/// A history of a ray from source to receiver: whether it starts upward, and how many vertices
/// (turning points or boundary bounces, by turns top and bottom) it has before it arrives.
struct Branch {
  bool starts_up = true;
  int vertices = 0;

  [[nodiscard]] int top_vertices() const noexcept {
    return starts_up ? (vertices + 1) / 2 : vertices / 2;
  }
  [[nodiscard]] int bottom_vertices() const noexcept { return vertices - top_vertices(); }
  /// Direction of travel at the receiver: downward after a top vertex.
  [[nodiscard]] bool arrives_upward() const noexcept {
    return vertices == 0 ? starts_up : (vertices % 2 == 1) != starts_up;
  }
};

/// The history of a ray that was found.
[[nodiscard]] inline Branch branch_of(const Arrival& ray) noexcept {
  return {.starts_up = ray.launch_elevation > 0.0,
          .vertices = ray.surface_bounces + ray.bottom_bounces + ray.upper_turns + ray.lower_turns};
}

/// The history of the same ray from its other end.
[[nodiscard]] inline Branch reversed(const Branch& branch) noexcept {
  return {.starts_up = !branch.arrives_upward(), .vertices = branch.vertices};
}

/// How often a branch passes the three pieces of the column.
struct BranchWeights {
  double up = 0.0, middle = 0.0, down = 0.0;

  [[nodiscard]] double of(double u, double m, double d) const noexcept {
    return up * u + middle * m + down * d;
  }
};

/// Pieces before the first vertex: source → first vertex, then half cycles from vertex to vertex,
/// then vertex → receiver. No vertex at all: the piece between source and receiver.
[[nodiscard]] inline BranchWeights weights(const Branch& branch, bool source_is_upper) noexcept {
  if (branch.vertices == 0) return {.middle = 1.0};
  const double half_cycles = branch.vertices - 1;
  BranchWeights w{.up = half_cycles, .middle = half_cycles, .down = half_cycles};
  (branch.starts_up ? w.up : w.down) += 1.0;  // source → first vertex …
  if (branch.starts_up != source_is_upper)
    w.middle += 1.0;  // … passing the receiver's depth if that lies on the way
  const bool last_is_top = branch.starts_up == (branch.vertices % 2 == 1);
  (last_is_top ? w.up : w.down) += 1.0;  // last vertex → receiver
  if (last_is_top == source_is_upper) w.middle += 1.0;
  return w;
}

}  // namespace asdic::detail
