#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "raytrace/ocean/arrivals.h"
#include "raytrace/ocean/environment.h"
#include "raytrace/ocean/path_limits.h"
#include "raytrace/tracing/receiver_columns.h"

namespace asdic::detail {

class BranchTable;
class RayTracer;

/// Finds every eigenray of an ocean, by whichever of two solvers applies. Built once per
/// environment; then const and shared by threads.
///
/// A layered ocean (speed a function of depth, flat boundaries, losses the same at every depth)
/// needs no marching: eigenrays are roots of r(σ) = range on every branch (history) of the fan,
/// bracketed on the tabulated fan, with pairs hidden between two nodes found through the extrema of
/// r, and refined by Newton's method to a miss below a hundredth of a millimetre
/// (docs/theory/layered-rays.md). Any other ocean is searched with a fan of marched rays from range
/// 0 (docs/theory/eigenrays.md). Where both apply they agree to rounding.
class EigenraySolver {
 public:
  /// \throws InputError ("bottom.depth") if the bottom is not below the surface everywhere
  explicit EigenraySolver(const Environment& environment);

  [[nodiscard]] const Environment& environment() const noexcept { return environment_; }
  [[nodiscard]] bool layered() const noexcept { return layered_; }

  /// All eigenrays to one receiver, sorted by delay. Source and receiver must lie within the water;
  /// `range` ≥ 0 [m] from the source, which is at range 0; `frequency` [Hz] sets losses.
  [[nodiscard]] Arrivals find(double source_depth, double receiver_depth, double range,
                              double frequency, const PathLimits& limits = {}) const;

  /// The same for many receivers at one depth, out of one fan. \param ranges [n] any order \return
  /// [n]
  [[nodiscard]] std::vector<Arrivals> find(double source_depth, double receiver_depth,
                                           std::span<const double> ranges, double frequency,
                                           const PathLimits& limits = {}) const;

  /// The same for receivers anywhere. \param receivers [n] ranges ≥ 0 \return [n]
  [[nodiscard]] std::vector<Arrivals> find(double source_depth,
                                           std::span<const ReceiverPoint> receivers,
                                           double frequency, const PathLimits& limits = {}) const;

  /// A path of a layered ocean after its ends have moved by metres, from what it was: microseconds
  /// where a search takes a fan. Null where a search might find something else (raytrace/layered/
  /// followed_branch.h): then it has to be searched for. \param known  what find() gave
  [[nodiscard]] std::optional<Arrival> follow(const Arrival& known, double source_depth,
                                              double receiver_depth, double range, double frequency,
                                              const PathLimits& limits = {}) const;

  /// The marching tracer of this ocean at a frequency [Hz], made when first asked for.
  [[nodiscard]] std::shared_ptr<const RayTracer> tracer(double frequency) const;

  /// The fan between two depths of a layered ocean, for those who follow branches rather than
  /// receivers (boundary_paths). The last few are kept.
  [[nodiscard]] std::shared_ptr<const BranchTable> table(double source_depth, double receiver_depth,
                                                         const PathLimits& limits) const;

 private:
  struct Tracers;
  struct Columns;
  struct Searches;

  Environment environment_;
  bool layered_;
  struct LayeredOcean;
  std::shared_ptr<const LayeredOcean> water_;  // shared by copies, as is what follows
  std::shared_ptr<Tracers> tracers_;
  std::shared_ptr<Columns> columns_;
  std::shared_ptr<Searches> searches_;
};

}  // namespace asdic::detail
