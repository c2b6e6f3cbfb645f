#pragma once
#include <array>
#include <cmath>
#include <cstddef>

namespace asdic::detail {

struct HermiteNode {
  double x = 0.0, value = 0.0, slope = 0.0;
};

/// The cubic through two values with two slopes.
class Hermite {
 public:
  Hermite(const HermiteNode& a, const HermiteNode& b) : x0_(a.x), h_(b.x - a.x) {
    const double rise = b.value - a.value;
    a_ = {a.value, h_ * a.slope, 3.0 * rise - h_ * (2.0 * a.slope + b.slope),
          h_ * (a.slope + b.slope) - 2.0 * rise};
  }

  [[nodiscard]] double value(double x) const noexcept {
    const double t = (x - x0_) / h_;
    return a_[0] + t * (a_[1] + t * (a_[2] + t * a_[3]));
  }
  [[nodiscard]] double slope(double x) const noexcept {
    const double t = (x - x0_) / h_;
    return (a_[1] + t * (2.0 * a_[2] + 3.0 * t * a_[3])) / h_;
  }

  [[nodiscard]] double bend(double x) const noexcept {  ///< second derivative
    const double t = (x - x0_) / h_;
    return (2.0 * a_[2] + 6.0 * t * a_[3]) / (h_ * h_);
  }

  /// Where it has a value, by a few of Newton's steps from a guess; anywhere if they do not
  /// converge.
  [[nodiscard]] double root_near(double x, double wanted) const noexcept {
    for (int i = 0; i < 6; ++i) {
      const double step = (value(x) - wanted) / slope(x);
      x -= step;
      if (std::abs(step) < 1e-12 * std::abs(h_)) break;
    }
    return x;
  }

  /// At most two places strictly inside, in order.
  struct Places {
    std::array<double, 2> x{};
    std::size_t count = 0;
    [[nodiscard]] bool empty() const noexcept { return count == 0; }
    [[nodiscard]] double front() const noexcept { return x[0]; }
    [[nodiscard]] std::size_t size() const noexcept { return count; }
  };

  /// Where the slope is zero.
  [[nodiscard]] Places extrema() const noexcept {
    Places places;
    const double a = 3.0 * a_[3], b = 2.0 * a_[2], c = a_[1];
    const double discriminant = b * b - 4.0 * a * c;
    if (discriminant <= 0.0) return places;
    const double half = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    double t1 = a != 0.0 ? half / a : -1.0, t2 = half != 0.0 ? c / half : -1.0;
    if (t1 > t2) std::swap(t1, t2);
    constexpr double edge = 1e-9;
    for (const double t : {t1, t2})
      if (t > edge && t < 1.0 - edge) places.x[places.count++] = x0_ + t * h_;
    return places;
  }

 private:
  double x0_, h_;
  std::array<double, 4> a_{};
};

}  // namespace asdic::detail
