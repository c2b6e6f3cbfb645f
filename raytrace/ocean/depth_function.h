#pragma once
#include <span>
#include <vector>

namespace asdic::detail {

/// A quantity that varies with depth only: one value, or samples with straight lines between them,
/// constant above the first and below the last. Depth [m] is positive down.
class DepthFunction {
 public:
  DepthFunction(double constant = 0.0) : constant_(constant) {}  // NOLINT: a number is a function

  /// \param depth  [n] not decreasing [m]; two equal depths make a step (at the step itself the
  ///               second value holds, the one below it)
  /// \param value  [n]
  /// \throws InputError ("depth[3]", "value[2]") if n = 0, sizes differ, a depth decreases, or a
  ///         number is not finite
  static DepthFunction table(std::span<const double> depth, std::span<const double> value);

  [[nodiscard]] double at(double depth) const noexcept;
  /// The limit from above: differs from at() at a step only.
  [[nodiscard]] double just_above(double depth) const noexcept;
  [[nodiscard]] bool is_constant() const noexcept { return depth_.empty(); }

  /// The samples; empty for a constant.
  [[nodiscard]] std::span<const double> depths() const noexcept { return depth_; }
  [[nodiscard]] std::span<const double> values() const noexcept { return value_; }

  [[nodiscard]] bool operator==(const DepthFunction&) const = default;

 private:
  std::vector<double> depth_;  // [n], empty for a constant
  std::vector<double> value_;  // [n]
  double constant_ = 0.0;
};

}  // namespace asdic::detail
