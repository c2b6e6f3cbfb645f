#pragma once
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "core/level_namespace.h"
#include "raytrace/layered/branch_table.h"
#include "raytrace/layered/leg_series.h"
#include "raytrace/layered/ocean_series.h"
#include "raytrace/layered/simd_column.h"
#include "raytrace/math/hermite.h"

namespace asdic::detail {

/// A monotone piece that has roots, told by its ends.
struct RootPiece {
  const FanInterval* interval = nullptr;
  std::size_t cell = 0;  ///< of the interval
  Branch branch;
  BranchWeights weights;   ///< of the branch
  bool steep = false;      ///< −cos θ is the variable x of the next two, else σ
  HermiteNode begin, end;  ///< x, r, dr/dx at the ends of the piece

  RootPiece(const MonotonePiece& piece, bool source_is_upper) noexcept;
  /// Of a root found by other means.
  RootPiece(const Branch& history, bool source_is_upper) noexcept
      : branch(history), weights(asdic::detail::weights(history, source_is_upper)) {}
};

/// A root of r(σ) = range, known to lie between the ends of a piece.
struct RootTask {
  const RootPiece* piece = nullptr;
  std::size_t receiver = 0;  ///< whose it is
  double range = 0.0;        ///< [m]
};

inline namespace ASDIC_LEVEL {

/// As many tasks as lanes, side by side; the last one fills what is left.
struct SimdTasks {
  std::array<const RootTask*, rays_at_once> task{};
  std::size_t count = 0;  ///< of different ones
  Rays range;             ///< [m]
  Rays up, middle, down;  ///< BranchWeights

  SimdTasks(const RootTask* const* tasks, std::size_t n) noexcept;

  [[nodiscard]] Rays of(const Rays& u, const Rays& m, const Rays& d) const noexcept {
    return up * u + middle * m + down * d;
  }
};

/// The rays of an interval that a batch of tasks asked for.
struct FoundRays {
  SimdRays rays;
  SimdColumn legs;
};

/// Where the legs of a batch of rays come from: a series of the column that holds between the
/// tasks' ends, or series of the ocean, or neither: the column is walked.
struct LegSource {
  const Column& column;
  const LegSeries* series = nullptr;
  const OceanLegs* kept = nullptr;
  OceanSeries::Found found;  ///< of `kept`

  [[nodiscard]] SimdColumn sums(const SimdRays& rays) const noexcept {
    if (series != nullptr) return series->sums(rays);
    return kept != nullptr ? kept->sums(column, found, rays) : walk_sums(column, rays);
  }
  [[nodiscard]] SimdColumn all(const SimdRays& rays) const noexcept {
    if (series != nullptr) return series->all(rays);
    return kept != nullptr ? kept->all(column, found, rays) : walk_all(column, rays);
  }
};

}  // namespace ASDIC_LEVEL

/// The roots: from the cubic through the piece's ends by Newton's method, kept inside a shrinking
/// bracket, until what is missed is below 0.01 mm, or what the next step would leave is below 0.1
/// mm and 1e-8 of the slope; path_builder.cpp sees to the rest.
[[nodiscard]] FoundRays find_roots(const LegSource& source, double c_ref,
                                   const SimdTasks& tasks) noexcept;

inline namespace ASDIC_LEVEL {

/// Of the tasks of one interval, those that are solved alike: with one series, or with walks.
class RootGroups {
 public:
  RootGroups(const BranchTable& fan, const FanInterval& interval, std::span<const RootTask> tasks);

  /// Calls found(SimdTasks, FoundRays) with every batch.
  template <class Found>
  void solve(Found&& found) {
    std::size_t begin = 0;
    while (begin < order_.size()) {
      const Group group = next(begin);
      for (std::size_t i = begin; i < group.end; i += rays_at_once) {
        const SimdTasks batch(&order_[i], std::min(rays_at_once, group.end - i));
        found(batch, find_roots(group.source, interval_.reference_speed, batch));
      }
      begin = group.end;
    }
  }

 private:
  struct Group {
    LegSource source;
    std::size_t end;
  };
  /// As many walks as a series takes: 16 rays with times against two or three, one of them with
  /// times, for each root.
  static constexpr std::size_t worth_a_series = 9;

  [[nodiscard]] Group next(std::size_t begin);
  [[nodiscard]] Group few(std::size_t begin, std::size_t end) const;
  [[nodiscard]] std::size_t first_at(std::size_t begin, std::size_t cell) const noexcept;

  const Column& column_;
  const OceanLegs* kept_;
  const FanInterval& interval_;
  IntervalSeries series_;               ///< of no cells where no series can be worth while
  std::vector<const RootTask*> order_;  ///< by cell
};

}  // namespace ASDIC_LEVEL

}  // namespace asdic::detail
