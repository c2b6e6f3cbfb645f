#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "reverb/pairs/boundary_fans.h"

namespace asdic::detail {

/// A level of the water that paths are wanted to.
struct WantedLevel {
  GroundLevel level;
  PathLimits limits;
};

/// The paths from one place to several levels: fans of one plane, in whatever direction.
///
/// In a layered ocean one fan for each level serves all bearings. Elsewhere each plane is traced
/// when it is asked for and not kept: one fan of so many rays for all levels (mean_paths()).
class PlaneFans {
 public:
  static constexpr int rays = 128;

  /// \param paths  must outlive this   \param spacing  of the cells [m]   \param reach  [m]
  PlaneFans(const PropagationPaths& paths, const Vec3& place, std::vector<WantedLevel> levels,
            double spacing, double reach, double frequency);

  using Fans = std::vector<std::shared_ptr<const BoundaryFan>>;  // [levels]
  /// \param bearing  [rad]
  [[nodiscard]] Fans at(double bearing) const;
  /// Fans of all directions, a plane a sector; of a layered ocean as at().
  /// \param tell  called with the share that is done, from any thread
  [[nodiscard]] Fans all_round(int sectors, const std::function<void(double)>& tell) const;

 private:
  [[nodiscard]] std::vector<FanPlane> planes(double bearing) const;

  const PropagationPaths& paths_;
  BoundaryFans fans_;
  Vec3 place_;
  std::vector<WantedLevel> levels_;
  double spacing_, reach_, frequency_;
  Fans everywhere_;  // of a layered ocean
};

}  // namespace asdic::detail
