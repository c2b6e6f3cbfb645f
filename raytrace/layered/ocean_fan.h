#pragma once
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "core/level_namespace.h"
#include "raytrace/layered/fan_nodes.h"
#include "raytrace/layered/simd_column.h"

namespace asdic::detail {

inline namespace ASDIC_LEVEL {

/// What every layer of an ocean adds to the rays at the nodes of its fan, wherever source and
/// receiver lie: these only cut two layers in two, and two intervals of the fan. So the fan of any
/// pair of depths is made of sums of what is kept here (BranchTable).
///
/// An interval is computed when it is first asked for; the numbers do not depend on who asks.
class OceanFan {
 public:
  /// An ocean of more layers would take too much memory, and is summed anew for each pair of
  /// depths.
  static constexpr std::size_t most_layers = 256;

  /// \param layers  uncut; must outlive this
  explicit OceanFan(std::span<const Layer> layers);

  enum class Reach : unsigned char {
    none,     ///< no ray of the interval comes there
    crossed,  ///< by all
    turned,   ///< all turn in it
    mixed,    ///< inside an analytic law: some turn, and their zeros stand beyond
  };
  struct Interval {
    std::vector<double> sigma;  ///< nodes, the last repeated to fill lanes
    std::size_t nodes = 0;
    double between = 0.0;                       ///< a speed inside it [m/s]
    std::vector<Reach> reach;                   ///< [layers]
    std::vector<double> per_slowness, d_range;  ///< [layers × sigma] of SimdLegs
  };

  /// The interval between two critical speeds; nullptr where it is not one of the uncut ocean.
  [[nodiscard]] const Interval* find(const CriticalSpeed& slow, const CriticalSpeed& fast) const;

 private:
  struct Slot {
    std::once_flag once;
    Interval interval;
  };
  std::span<const Layer> layers_;
  std::vector<CriticalSpeed> critical_;
  std::unique_ptr<Slot[]> slots_;  ///< [critical − 1]
};

}  // namespace ASDIC_LEVEL

}  // namespace asdic::detail
