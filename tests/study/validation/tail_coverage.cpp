#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "core/random.h"
#include "study/measures/cell_counts.h"
#include "study/summary/k_shape.h"
#include "study/summary/tail.h"
#include "support/deep.h"
#include "support/gamma_draw.h"

// How often intervals of 95 % hold the truth, by counting over many sets of cells: the shape of the
// K distribution, and the rate at 10⁻⁶ by the fitted tail, a hundredth of what a set can count.
// docs/theory/studies.md, false-alarm rates

namespace asdic::detail::study {
namespace {

using support::gamma_draw;

constexpr double no_end = std::numeric_limits<double>::infinity();

/// Cells of one set by level, over a known mean or over that of 24 around.
std::vector<double> counts_of(double shape, int cells, bool around, std::uint64_t seed) {
  const std::vector<double> levels = cell_levels(1e-2);
  std::vector<double> counts(levels.size(), 0.0), power(static_cast<std::size_t>(cells));
  RandomStream random(seed, Draw::study_noise, 5, 0);
  for (double& x : power)
    x = -std::log(random.uniform()) * (std::isinf(shape) ? 1.0 : gamma_draw(shape, random));
  for (int i = 0; i < cells; ++i) {
    double u = power[static_cast<std::size_t>(i)];
    if (around) {
      double sum = 0.0;
      for (int k = 3; k < 15; ++k)
        sum += power[static_cast<std::size_t>((i + k) % cells)] +
               power[static_cast<std::size_t>((i - k + cells) % cells)];
      u = 24.0 * std::log1p(u / sum);
    }
    counts[static_cast<std::size_t>(std::upper_bound(levels.begin(), levels.end(), u) -
                                    levels.begin()) -
           1] += 1.0;
  }
  return counts;
}

/// −ln of the level u at which P(power > u) = 10⁻⁶, by halving.
double level_of(double shape) {
  if (std::isinf(shape)) return 6.0 * std::log(10.0);
  double low = 1.0, high = 1000.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (k_exceedance(middle, shape, no_end) > 1e-6 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

TEST(TailCoverage, OfManySets) {
  if (!support::deep()) GTEST_SKIP() << "ASDIC_DEEP=1: some minutes";
  constexpr int sets = 400;
  struct Case {
    double shape;
    bool around;
    int cells;
  };
  const std::vector<Case> cases{{no_end, false, 10000}, {no_end, true, 10000}, {10.0, false, 10000},
                                {2.0, false, 10000},    {0.5, false, 10000},   {2.0, false, 100000},
                                {0.5, false, 100000}};
  for (const Case& one : cases) {
    const double far = level_of(one.shape);
    const std::vector<double> levels = cell_levels(1e-2);
    int tail = 0, by_pareto = 0, shape = 0;
    double width = 0.0;
    for (int set = 0; set < sets; ++set) {
      const std::vector<double> counts =
          counts_of(one.shape, one.cells, one.around, 1000 + static_cast<std::uint64_t>(set));
      const std::vector<double> alone(counts.size(), 1.0);
      const double m = one.around ? 24.0 : no_end;
      const Tail fitted = fit_tail(levels, counts, alone, 0.95, false);
      const ShapeFit fit = fit_k_shape(levels, counts, m, 1.0, 0.95);
      const Interval pareto = fitted.interval(far), at = far_interval(fitted, fit, far, m);
      by_pareto += pareto.low <= 1e-6 && 1e-6 <= pareto.high;
      tail += at.low <= 1e-6 && 1e-6 <= at.high;
      width += std::log10(at.high / std::max(at.low, 1e-30)) / sets;
      shape += fit.low <= one.shape && one.shape <= fit.high;
    }
    std::printf(
        "shape %g%s, %d cells: 10^-6 in %d of %d (%d by the Pareto law alone; %.1f decades "
        "wide), shape in %d\n",
        one.shape, one.around ? " over 24 around" : "", one.cells, tail, sets, by_pareto, width,
        shape);
    // Of 400 sets at 95 %, fewer than 359 has a probability of 10⁻⁵.
    EXPECT_GE(tail, 359) << one.shape;
    EXPECT_GE(shape, 359) << one.shape;
    // The Pareto law alone lies too high where cells are spiky.
    if (one.shape < 1.0) {
      EXPECT_LT(by_pareto, 359) << one.cells;
    }
  }
}

}  // namespace
}  // namespace asdic::detail::study
