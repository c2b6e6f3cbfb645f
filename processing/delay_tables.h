#pragma once
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>

#include "processing/delay_table.h"
#include "raytrace/places/propagation_paths.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// The delay tables that detections ask for, kept for those that come after. Shared by threads;
/// what comes out does not depend on what is kept.
class DelayTables {
 public:
  /// \param ranges  of a table
  DelayTables(const PropagationPaths& paths, double frequency, const PropagationSettings& settings,
              std::size_t ranges)
      : paths_(paths), frequency_(frequency), settings_(settings), ranges_(ranges) {}

  /// Bounces off either boundary of a table's paths at most, where "auto" asks for as many as there
  /// is sound in: pairs of paths out and home grow with its square.
  static constexpr int most_bounces = 48;
  /// Whether a table so far would have had paths of more.
  [[nodiscard]] bool lack_bounces() const noexcept { return lack_bounces_; }

  /// The farthest that sound of 1600 m/s comes in a delay, from one of two ends so far apart [m];
  /// rounded up so that tables serve many detections.
  [[nodiscard]] static double longest(double delay, double apart) noexcept;
  /// Over a map: of the plane of the middle of a bearing's 2.5°.
  /// \param platform  where the paths begin   \param depth  where they end [m]
  /// \param longest  of the ranges [m]
  [[nodiscard]] std::shared_ptr<const DelayTable> from(const Vec3& platform, double bearing,
                                                       double depth, double longest);

 private:
  [[nodiscard]] DelayTable made(const Plane& plane, double platform_depth, double depth,
                                double longest);
  using Key = std::tuple<double, double, double, double, double, double>;  // plane, depths, longest

  const PropagationPaths& paths_;
  double frequency_;
  PropagationSettings settings_;
  std::size_t ranges_;
  std::map<Key, std::shared_ptr<const DelayTable>> made_;
  std::mutex lock_;
  std::atomic<bool> lack_bounces_ = false;
};

}  // namespace asdic::detail
