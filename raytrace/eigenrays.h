#pragma once
#include <memory>
#include <span>
#include <vector>

#include "raytrace/arrivals.h"
#include "raytrace/environment.h"
#include "raytrace/layered/branch_table.h"

namespace asdic {

/// Finds every eigenray of a layered ocean (speed a function of depth, flat boundaries). Built once
/// per environment; then const and shared by threads.
///
/// Eigenrays are roots of r(σ) = range on every branch (history) of the fan, bracketed on the
/// tabulated fan, with pairs hidden between two nodes found through the extrema of r, and refined
/// by Newton's method to a miss below a hundredth of a millimetre. docs/theory/layered-rays.md
class EigenraySolver {
 public:
  /// \throws InputError ("bottom.depth") if the bottom is not below the surface
  explicit EigenraySolver(const Environment& environment);

  [[nodiscard]] const Environment& environment() const noexcept { return environment_; }

  /// All eigenrays to one receiver, sorted by delay. Source and receiver must lie within the water;
  /// `range` ≥ 0 [m]; `frequency` [Hz] sets losses.
  [[nodiscard]] Arrivals find(double source_depth, double receiver_depth, double range,
                              double frequency, const PathLimits& limits = {}) const;

  /// The same for many receivers at one depth, out of one fan. \param ranges [n] any order \return
  /// [n]
  [[nodiscard]] std::vector<Arrivals> find(double source_depth, double receiver_depth,
                                           std::span<const double> ranges, double frequency,
                                           const PathLimits& limits = {}) const;

  /// The fan between two depths, for those who follow branches rather than receivers
  /// (ground_paths).
  [[nodiscard]] BranchTable table(double source_depth, double receiver_depth,
                                  const PathLimits& limits) const;

 private:
  Environment environment_;
  std::vector<Layer> layers_;
};

}  // namespace asdic
