#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace asdic::detail {

/// J₀ by cubics between places a sixteenth apart, from its values and slopes −J₁ there: right to
/// ⅜·h⁴/384 = 1.5e-8.
class BesselTable {
 public:
  /// \param furthest  argument
  explicit BesselTable(double furthest);
  /// \param x  from 0 to the furthest
  [[nodiscard]] double operator()(double x) const noexcept {
    const auto place = static_cast<std::int32_t>(x * steps);
    const std::array<double, 4>& c = (*cubics_)[static_cast<std::size_t>(place)];
    const double t = x * steps - static_cast<double>(place);
    return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
  }
  /// x ← J₀(x), one after the other.
  void replace(std::span<double> x) const noexcept {
    for (double& value : x) value = (*this)(value);
  }

 private:
  using Cubics = std::vector<std::array<double, 4>>;
  static constexpr double steps = 16.0;
  std::shared_ptr<const Cubics> cubics_;
};

}  // namespace asdic::detail
