#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/level_namespace.h"
#include "core/units.h"
#include "sonar/signal/windowed_sinc.h"

namespace asdic::detail {

/// The taps of a windowed-sinc interpolator as functions of the place between two samples, each a
/// polynomial: sinc and Kaiser window are smooth there, and degree 11 through Chebyshev nodes is
/// right to 1e-9. Kaiser & Schafer, IEEE Trans. ASSP 28, 105 (1980).
template <class Real, int n_taps>
class InterpolationTaps {
 public:
  static constexpr int taps = n_taps;
  static constexpr int before = taps / 2 - 1;  ///< of them before the sample at or below the place
  using Weights = Eigen::Array<Real, taps, 1, Eigen::DontAlign>;

  /// \param beta  of the Kaiser window
  explicit InterpolationTaps(double beta) {
    using Exact = Eigen::Array<double, taps, 1>;
    std::array<double, degree + 1> node{};  // in y = 2·fraction − 1
    std::array<Exact, degree + 1> difference, coefficient;
    for (std::size_t k = 0; k <= degree; ++k) {
      node[k] = std::cos(pi * (static_cast<double>(k) + 0.5) / (degree + 1.0));
      for (int tap = 0; tap < taps; ++tap) {
        const double x = 0.5 * (node[k] + 1.0) - (tap - before);
        difference[k][tap] = windowed_sinc(x, taps, beta);
      }
    }
    for (std::size_t order = 1; order <= degree; ++order)  // Newton's divided differences …
      for (std::size_t k = degree; k >= order; --k)
        difference[k] = (difference[k] - difference[k - 1]) / (node[k] - node[k - order]);
    for (Exact& c : coefficient) c.setZero();
    for (std::size_t k = degree + 1; k-- > 0;) {  // … multiplied out: p ← p·(y − y_k) + d_k
      for (std::size_t i = degree; i > 0; --i)
        coefficient[i] = coefficient[i - 1] - node[k] * coefficient[i];
      coefficient[0] = difference[k] - node[k] * coefficient[0];
    }
    for (std::size_t i = 0; i <= degree; ++i)
      coefficient_[i] = coefficient[i].template cast<Real>();
  }

  /// \param fraction  of the place after the sample below it, in [0, 1)
  [[nodiscard]] Weights at(Real fraction) const noexcept {
    const Real y = Real(2) * fraction - Real(1);
    // Not a copy first: that would go by way of memory, in halves that are waited for.
    Weights sum = coefficient_[degree] * y + coefficient_[degree - 1];
    for (std::size_t i = degree - 1; i-- > 0;) sum = sum * y + coefficient_[i];
    return sum;
  }

  /// Of two places at once: one by itself waits for its own last product.
  struct Two {
    Weights first, second;
  };
  [[nodiscard]] Two at(Real first, Real second) const noexcept {
    const Real y = Real(2) * first - Real(1), z = Real(2) * second - Real(1);
    Two sum{coefficient_[degree] * y + coefficient_[degree - 1],
            coefficient_[degree] * z + coefficient_[degree - 1]};
    for (std::size_t i = degree - 1; i-- > 0;) {
      sum.first = sum.first * y + coefficient_[i];
      sum.second = sum.second * z + coefficient_[i];
    }
    return sum;
  }

 private:
  static constexpr std::size_t degree = 11;
  std::array<Weights, degree + 1> coefficient_;
};

}  // namespace asdic::detail
