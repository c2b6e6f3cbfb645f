#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "study/sampling/design.h"
#include "study/sampling/sobol.h"
#include "support/kolmogorov.h"

namespace asdic::detail::study {
namespace {

std::vector<double> coordinate(const PointDesign& design, std::size_t dimension, std::uint64_t n) {
  std::vector<double> u(design.dimensions()), result;
  for (std::uint64_t i = 0; i < n; ++i) {
    design.point(i, u);
    result.push_back(u[dimension]);
  }
  return result;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - 0.5) * (b[i] - 0.5);
    aa += (a[i] - 0.5) * (a[i] - 0.5);
    bb += (b[i] - 0.5) * (b[i] - 0.5);
  }
  return ab / std::sqrt(aa * bb);
}

/// Kolmogorov's distance from the uniform distribution.
double kolmogorov(const std::vector<double>& u) {
  return support::kolmogorov_distance(u, [](double x) { return x; });
}

TEST(RandomDesign, IsUniformAndItsCoordinatesIndependent) {
  const PointDesign design(Design::random, 5, 0, 3);
  const auto a = coordinate(design, 0, 20000), b = coordinate(design, 1, 20000);
  // P(√n·D > 2.69) = 2·exp(−2·2.69²) = 1e-6 (Kolmogorov).
  EXPECT_LT(kolmogorov(a) * std::sqrt(20000.0), 2.69);
  EXPECT_LT(std::abs(correlation(a, b)) * std::sqrt(20000.0), 4.9);  // normal, 1e-6
}

TEST(LatinHypercube, HasOnePointInEveryStratumOfEveryCoordinateForEveryN) {
  std::vector<std::uint64_t> sizes;
  for (std::uint64_t n = 1; n <= 130; ++n) sizes.push_back(n);
  for (const std::uint64_t n : {255, 256, 257, 1000, 4095, 4097, 10007}) sizes.push_back(n);
  for (const std::uint64_t n : sizes) {
    const PointDesign design(Design::latin_hypercube, 11, n, 3);
    for (std::size_t d = 0; d < 3; ++d) {
      std::vector<int> hits(n, 0);
      for (const double u : coordinate(design, d, n)) {
        ASSERT_GT(u, 0.0);
        ASSERT_LT(u, 1.0);
        ++hits[std::size_t(u * double(n))];
      }
      EXPECT_TRUE(std::all_of(hits.begin(), hits.end(), [](int h) { return h == 1; }))
          << n << " points, coordinate " << d;
    }
  }
}

TEST(LatinHypercube, PermutesEveryCoordinateByItself) {
  const PointDesign design(Design::latin_hypercube, 3, 4000, 4);
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < a; ++b)
      EXPECT_LT(std::abs(correlation(coordinate(design, a, 4000), coordinate(design, b, 4000))),
                4.9 / std::sqrt(4000.0));  // as independent permutations: 1e-6
  const PointDesign other(Design::latin_hypercube, 4, 4000, 1);
  EXPECT_NE(coordinate(design, 0, 10), coordinate(other, 0, 10));
}

TEST(Sobol, BeginsAsPublished) {
  // Joe & Kuo's example: the first points in natural order, in units of 1/8.
  const std::array<std::array<int, 3>, 8> eighths{
      {{0, 0, 0}, {4, 4, 4}, {2, 6, 6}, {6, 2, 2}, {1, 5, 3}, {5, 1, 7}, {3, 3, 5}, {7, 7, 1}}};
  for (std::uint32_t i = 0; i < 8; ++i)
    for (std::size_t d = 0; d < 3; ++d)
      EXPECT_EQ(sobol_digits(i, d) >> 29, std::uint32_t(eighths[i][d])) << i << ' ' << d;
}

TEST(Sobol, EveryCoordinateOfEveryDyadicBlockIsStratified) {
  // Direction numbers with m odd make each coordinate a (0, 1)-sequence.
  for (std::size_t d = 0; d < most_sobol_dimensions; ++d)
    for (const unsigned m : {1U, 5U, 10U}) {
      std::set<std::uint32_t> strata;
      for (std::uint32_t i = 0; i < (1U << m); ++i) strata.insert(sobol_digits(i, d) >> (32 - m));
      EXPECT_EQ(strata.size(), std::size_t{1} << m) << d;
    }
}

/// Every elementary interval of area 2^−m of two coordinates holds one of 2^m points.
bool is_net(const std::vector<double>& a, const std::vector<double>& b, unsigned m) {
  for (unsigned k = 0; k <= m; ++k) {
    std::set<std::pair<unsigned, unsigned>> cells;
    for (std::size_t i = 0; i < a.size(); ++i)
      cells.insert({unsigned(a[i] * double(1U << k)), unsigned(b[i] * double(1U << (m - k)))});
    if (cells.size() != a.size()) return false;
  }
  return true;
}

TEST(Sobol, ScrambledPointsOfTheFirstTwoCoordinatesAreANet) {
  for (const std::uint64_t seed : {1, 2, 77}) {
    const PointDesign design(Design::sobol, seed, 0, 2);
    for (const unsigned m : {3U, 6U, 10U}) {
      const std::uint64_t n = std::uint64_t{1} << m;
      EXPECT_TRUE(is_net(coordinate(design, 0, n), coordinate(design, 1, n), m)) << seed;
    }
  }
  // The wrong model must fail: random points are no net.
  const PointDesign random(Design::random, 1, 0, 2);
  EXPECT_FALSE(is_net(coordinate(random, 0, 64), coordinate(random, 1, 64), 6));
}

TEST(Sobol, ScramblingsOfDifferentSeedsAreIndependentAndUniform) {
  // One point under many seeds is uniform on the square.
  std::vector<double> x, y;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    std::vector<double> u(2);
    PointDesign(Design::sobol, seed, 0, 2).point(5, u);
    x.push_back(u[0]);
    y.push_back(u[1]);
  }
  EXPECT_LT(kolmogorov(x) * std::sqrt(4000.0), 2.69);
  EXPECT_LT(kolmogorov(y) * std::sqrt(4000.0), 2.69);
  EXPECT_LT(std::abs(correlation(x, y)) * std::sqrt(4000.0), 4.9);
}

/// Root of the mean square error of the mean of ∏(½ + u_d), whose mean is 1, over 200 seeds.
double integration_error(Design kind, std::uint64_t n) {
  double squares = 0.0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const PointDesign design(kind, seed, n, 5);
    double sum = 0.0;
    std::vector<double> u(5);
    for (std::uint64_t i = 0; i < n; ++i) {
      design.point(i, u);
      double product = 1.0;
      for (const double x : u) product *= 0.5 + x;
      sum += product;
    }
    squares += (sum / double(n) - 1.0) * (sum / double(n) - 1.0);
  }
  return std::sqrt(squares / 200.0);
}

TEST(Designs, IntegrateAsWellAsTheyShould) {
  // Variance of the product (13/12)⁵ − 1 = 0.4921; its additive part 5/12, which a Latin hypercube
  // leaves nothing of (Stein 1987), so that 0.0754 remains. Of scrambled nets the error falls
  // nearly as n^−3/2 (Owen 1997). The rms over 200 seeds is known to 1/√400 = 5 %; five of these.
  constexpr double n = 256.0;
  EXPECT_NEAR(integration_error(Design::random, 256) / std::sqrt(0.4921 / n), 1.0, 0.25);
  EXPECT_NEAR(integration_error(Design::latin_hypercube, 256) / std::sqrt(0.0754 / n), 1.0, 0.25);
  EXPECT_LT(integration_error(Design::sobol, 256), 0.2 * std::sqrt(0.0754 / n));
}

TEST(Designs, PointsDependOnSeedAndIndexAlone) {
  for (const Design kind : {Design::random, Design::latin_hypercube, Design::sobol, Design::grid}) {
    const PointDesign design(kind, 21, 500, 6), again(kind, 21, 500, 6);
    std::vector<double> a(6), b(6);
    design.point(499, a);
    again.point(0, b);
    again.point(499, b);
    EXPECT_EQ(a, b) << name(kind);
    design.point(498, b);
    EXPECT_NE(a, b) << name(kind);
  }
}

}  // namespace
}  // namespace asdic::detail::study
