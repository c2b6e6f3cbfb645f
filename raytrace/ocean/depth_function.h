#pragma once
#include <span>
#include <vector>

namespace asdic {

/// A quantity that varies with depth only: one value, or samples with straight lines between them,
/// constant above the first and below the last. Depth [m] is positive down.
class DepthFunction {
 public:
  DepthFunction(double constant = 0.0) : value_{constant} {}  // NOLINT: a number is a function

  /// \param depth  [n] not decreasing [m]; two equal depths make a step (at the step itself the
  ///               lower value holds)
  /// \param value  [n]
  /// \throws InputError ("depth[3]", "value[2]") if n = 0, sizes differ, a depth decreases, or a
  ///         number is not finite
  static DepthFunction table(std::span<const double> depth, std::span<const double> value);

  [[nodiscard]] double at(double depth) const noexcept;
  [[nodiscard]] bool is_constant() const noexcept { return depth_.empty(); }

  /// The samples; empty for a constant.
  [[nodiscard]] std::span<const double> depths() const noexcept { return depth_; }
  [[nodiscard]] std::span<const double> values() const noexcept { return value_; }

 private:
  std::vector<double> depth_;  // [n], or empty
  std::vector<double> value_;  // [n], or the constant
};

}  // namespace asdic
