#pragma once
#include <vector>

#include "raytrace/layered/branch_table.h"

namespace asdic::support {

/// The intervals of a fan whose rays come no further than this, in order. \param furthest  [m]
inline std::vector<const FanInterval*> fan_intervals(const BranchTable& table, double furthest) {
  std::vector<const FanInterval*> all;
  table.for_each_stretch(0.0, furthest, [&](const MonotoneStretch& stretch) {
    if (all.empty() || all.back() != stretch.interval) all.push_back(stretch.interval);
  });
  return all;
}

}  // namespace asdic::support
