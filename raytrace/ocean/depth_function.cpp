#include "raytrace/ocean/depth_function.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "raytrace/ocean/number_text.h"

namespace asdic {

DepthFunction DepthFunction::table(std::span<const double> depth, std::span<const double> value) {
  if (depth.empty())
    throw InputError({.where = "depth", .got = "no samples", .expected = "at least one"});
  if (value.size() != depth.size())
    throw InputError({.where = "value",
                      .got = std::to_string(value.size()) + " values",
                      .expected = "as many as depths: " + std::to_string(depth.size())});
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (!std::isfinite(depth[i]))
      throw InputError({.where = element("depth", i),
                        .got = with_unit(depth[i], "m"),
                        .expected = "a finite depth"});
    if (i > 0 && depth[i] < depth[i - 1])
      throw InputError(
          {.where = element("depth", i),
           .got = with_unit(depth[i], "m"),
           .expected = "a depth not above the one before, " + with_unit(depth[i - 1], "m")});
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

}  // namespace asdic
