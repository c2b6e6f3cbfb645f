#pragma once
#include <deque>
#include <functional>

#include "raytrace/math/hermite.h"
#include "raytrace/ocean/arrivals.h"
#include "raytrace/ocean/level_rays.h"
#include "raytrace/tracing/fan_ray.h"
#include "raytrace/tracing/marching_eigenrays.h"
#include "raytrace/tracing/ray_family.h"
#include "raytrace/tracing/search_watch.h"

namespace asdic::detail {

/// Finds the eigenrays between two neighbours of a fan: by re-tracing single rays, or where there
/// are many, by families of five rays that tell all between (ray_family.h).
class RootFinder {
 public:
  /// Receivers between two rays for which families are made: each root re-traces two or three rays.
  static constexpr std::size_t worth_a_family = 6;
  using Found = std::function<void(std::uint32_t receiver, Arrival&&)>;

  RootFinder(const RayTracer& tracer, double source_range, double source_depth,
             const TraceLimits& limits, std::span<const ReceiverColumn> columns)
      : tracer_(tracer),
        source_range_(source_range),
        source_depth_(source_depth),
        limits_(limits),
        spreading_(spreading_across(tracer.environment())),
        columns_(columns) {
    for (const ReceiverColumn& column : columns) receivers_ += column.depths.size();
  }

  /// Every path between two neighbours to every receiver, on the legs whose history they share.
  void search(const FanRay& a, const FanRay& b, int max_turns, const Found& found);
  /// The same of rays that stay on a kink of least sound speed up to their first reflection
  /// (LevelRays): on the first leg the level ray stands for all of them.
  /// \param level  its depth, and the largest distance of receivers that it reaches
  void search_level(const FanRay& a, const FanRay& b, const LevelRays& level, int max_turns,
                    const Found& found);

  [[nodiscard]] const SearchCost& cost() const noexcept { return cost_; }  ///< so far

 private:
  void trace(double angle, const TraceLimits& limits, RayTrajectory& out);
  void search_legs(const FanRay& a, const FanRay& b, std::size_t first_leg);
  [[nodiscard]] std::size_t expected(const FanRay& a, const FanRay& b, std::size_t first_leg) const;
  WholeRay& whole_ray(std::size_t slot, double angle);
  void search_families(const WholeRay& a, const WholeRay& m, const WholeRay& b,
                       std::size_t first_leg, std::size_t slot);
  [[nodiscard]] bool search_family(const FamilyRays& rays, std::size_t leg);
  void search_column(const FanRay& a, const FanRay& b, std::size_t leg, std::uint32_t column);
  void search_piece(const HermiteNode& a, const HermiteNode& b, const Hermite& cubic);
  void refine(const HermiteNode& a, const HermiteNode& b, const Hermite& cubic, double depth,
              std::uint32_t receiver);
  [[nodiscard]] HermiteNode extremum(HermiteNode a, HermiteNode b, double guess);
  [[nodiscard]] std::optional<ExactCrossing> exact(double angle);
  void pair_at_node(double angle, double depth, std::uint32_t receiver);
  [[nodiscard]] Arrival arrival(const ExactCrossing& there, double depth) const;

  const RayTracer& tracer_;
  double source_range_, source_depth_;
  TraceLimits limits_;
  Spreading spreading_;
  std::span<const ReceiverColumn> columns_;
  std::size_t receivers_ = 0;
  SearchCost cost_;
  RayTrajectory ray_;
  std::deque<WholeRay> whole_rays_;  // three, and two for each depth of splitting
  std::vector<RayFamily> families_;
  std::vector<std::uint32_t> family_columns_, edge_columns_;
  FamilyRays family_rays_{};
  const RayFamily* family_ = nullptr;  // that stands for re-traced rays
  // of the search under way
  const ReceiverColumn* column_ = nullptr;
  const Found* found_ = nullptr;
  std::size_t leg_ = 0;
  std::uint64_t history_ = 0;
  double cosine_ = 1.0;
  double farthest_ = 0.0;  // where legs up to this one began at most [m]
  double reach_ = 0.0;     // how far rays have to be traced [m]
  int max_turns_ = 0;
};

}  // namespace asdic::detail
