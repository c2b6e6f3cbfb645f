#include "raytrace/ocean/depth_function.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "raytrace/ocean/number_text.h"
#include "raytrace/ocean/samples.h"

namespace asdic::detail {

DepthFunction DepthFunction::table(std::span<const double> depth, std::span<const double> value) {
  check_count(depth.size(), "depth", 1);
  check_as_many(value.size(), "value", depth.size(), "depths");
  for (std::size_t i = 0; i < depth.size(); ++i) {
    check_place(depth, i, "depth", "a depth not above", true);
    if (!std::isfinite(value[i]))
      throw InputError({.where = element("value", i),
                        .got = with_unit(value[i], ""),
                        .expected = "a finite number"});
  }
  DepthFunction function(value[0]);
  function.depth_.assign(depth.begin(), depth.end());
  function.value_.assign(value.begin(), value.end());
  function.constant_ = 0.0;
  return function;
}

double DepthFunction::at(double depth) const noexcept {
  if (depth_.empty()) return constant_;
  // The first sample below `depth`, so that at a step the value below it holds.
  const auto next = std::upper_bound(depth_.begin(), depth_.end(), depth);
  if (next == depth_.begin()) return value_.front();
  if (next == depth_.end()) return value_.back();
  const auto i = static_cast<std::size_t>(next - depth_.begin());
  const double share = (depth - depth_[i - 1]) / (depth_[i] - depth_[i - 1]);
  return std::lerp(value_[i - 1], value_[i], share);
}

double DepthFunction::just_above(double depth) const noexcept {
  if (depth_.empty()) return constant_;
  const auto next = std::lower_bound(depth_.begin(), depth_.end(), depth);  // first not above it
  if (next == depth_.begin()) return value_.front();
  if (next == depth_.end()) return value_.back();
  const auto i = static_cast<std::size_t>(next - depth_.begin());
  const double share = (depth - depth_[i - 1]) / (depth_[i] - depth_[i - 1]);
  return std::lerp(value_[i - 1], value_[i], share);
}

}  // namespace asdic::detail
