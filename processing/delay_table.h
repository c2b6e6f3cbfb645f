#pragma once
#include <optional>
#include <span>
#include <vector>

#include "raytrace/paths/eigenrays.h"

namespace asdic::detail {

/// What tells one kind of path between two depths from the others, whatever the range.
struct PathHistory {
  int surface_bounces = 0, bottom_bounces = 0, upper_turns = 0, lower_turns = 0, caustics = 0;
  bool upwards = false;  ///< leaves the platform upwards
  friend auto operator<=>(const PathHistory&, const PathHistory&) = default;
};

[[nodiscard]] PathHistory history_of(const Arrival& path) noexcept;

/// One-way eigenrays from a platform's depth to another depth, over range, each kind of path a
/// branch of its own: delay as a function of range.
class DelayTable {
 public:
  struct Node {
    double range = 0.0, delay = 0.0;
    double slope = 0.0;      ///< dτ/dr, the ray's horizontal slowness [s/m]
    double elevation = 0.0;  ///< at the platform [rad]
    double amplitude = 0.0;
    std::size_t place = 0;  ///< of the range among the table's
  };
  struct Branch {
    PathHistory history;
    std::vector<Node>
        nodes;  ///< in rising range; neighbours in the table unless a gap lies between
  };

  /// \param ranges  [n] evenly spaced, rising [m]   \param found  [n] eigenrays there, of which
  /// those within the limits' bounces are kept
  DelayTable(std::span<const double> ranges, std::span<const Arrivals> found,
             const PathLimits& limits);
  /// \param ranges  evenly spaced, rising [m]
  DelayTable(const EigenraySolver& solver, double platform_depth, double depth,
             std::span<const double> ranges, double frequency, const PathLimits& limits);

  [[nodiscard]] const std::vector<Branch>& branches() const noexcept { return branches_; }
  [[nodiscard]] double step() const noexcept { return step_; }
  [[nodiscard]] const std::vector<double>& ranges() const noexcept { return ranges_; }  ///< [m]
  /// By cubic interpolation; none where the branch has no path.
  [[nodiscard]] std::optional<Node> at(const Branch& branch, double range) const noexcept;

 private:
  std::vector<Branch> branches_;
  std::vector<double> ranges_;
  double step_ = 0.0;
};

}  // namespace asdic::detail
