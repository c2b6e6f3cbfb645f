#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "io/bellhop/bellhop_files.h"
#include "io/compare/statistics.h"

namespace asdic::detail::compare {

struct RayOptions {
  double angle_deg = 1e-6;  ///< rays of a pair differ by no more in launch angle
};

/// Two sets of rays; B is the reference.
///
/// Rays are paired that bounced as often and left at the same angle, then those that left within
/// the tolerance of angle; where there is a choice, the nearest ends first (eigenrays to several
/// receivers). For each pair the distance of A's points from B's path, a polyline, is taken, so
/// steps need not be the same.
struct RayDifference {
  std::size_t rays_a = 0, rays_b = 0, points_a = 0, points_b = 0;
  std::size_t not_finite = 0;  ///< rays with a NaN or an infinity, which are left out
  std::size_t paired = 0;
  Spread path_m;    ///< of each pair the largest distance of A's points from B's path [m]
  Spread inside_m;  ///< the same without points beyond B's ends: the runs may end elsewhere
  Spread end_m;     ///< between the last points [m]
  struct Worst {
    double launch_angle_deg = 0.0, range = 0.0, depth = 0.0, distance = 0.0;
  } worst;  ///< the point of A that is furthest from its path [m]

  /// Of the rays of both files those that could be compared.
  [[nodiscard]] double compared_pct() const noexcept {
    return share_pct(rays_a + rays_b - not_finite, rays_a + rays_b);
  }
  [[nodiscard]] double paired_pct() const noexcept;
};

[[nodiscard]] RayDifference compare_rays(const bellhop::RayFile& a, const bellhop::RayFile& b,
                                         const RayOptions& options = {});

/// A path in the plane that finds the nearest of its points: exactly, and soon for points that are
/// asked for in order.
class Polyline {
 public:
  /// \param range, depth  [n ≥ 1] [m]
  Polyline(const std::vector<double>& range, const std::vector<double>& depth);

  struct Nearest {
    double distance = 0.0;    ///< [m]
    bool beyond_end = false;  ///< the nearest point is the first or the last of the path
  };
  [[nodiscard]] Nearest nearest(double range, double depth) noexcept;

 private:
  [[nodiscard]] double to_segment(std::size_t k, double range, double depth,
                                  double& place) const noexcept;

  std::vector<double> range_, depth_, length_;  ///< [n] along the path
  std::size_t last_ = 0;                        ///< segment where the last point was
};

}  // namespace asdic::detail::compare
