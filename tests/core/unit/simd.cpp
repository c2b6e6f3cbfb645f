#include "core/simd.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

// Each function of lanes against its plain form: a loop, or the library's function of one number.
namespace asdic::detail {
namespace {

/// The largest difference from the library's function over [from, to], relative to max(|f|,
/// `floor`).
template <class Numbers, class Of, class Expected>
double worst(double from, double to, const Of& of, const Expected& expected,
             double floor = 1e-300) {
  double error = 0.0;
  for (int i = 0; i <= 20'000; ++i) {
    const auto x = static_cast<typename Numbers::value_type>(from + (to - from) * i / 20'000);
    const double want = expected(static_cast<double>(x));
    const double got = of(Numbers(x))[0];
    error = std::max(error, std::abs(got - want) / std::max(std::abs(want), floor));
  }
  return error;
}

/// 1, 2, 3, …
template <class T>
std::vector<T> counted(std::size_t n) {
  std::vector<T> numbers(n);
  std::iota(numbers.begin(), numbers.end(), T(1));
  return numbers;
}

// A handful of roundings of 1.1e-16 each; e^x besides has x's own, 600 × 1.1e-16 × 2⁻⁵² of it less
// the reduction, which is exact to 1e-26·n.
TEST(Simd, ExponentialIsTheLibrarys) {
  const auto of = [](const SimdDoubles& x) { return exponential(x); };
  const auto plain = [](double x) { return std::exp(x); };
  EXPECT_LT(worst<SimdDoubles>(-20.0, 20.0, of, plain), 1e-15);
  EXPECT_LT(worst<SimdDoubles>(-600.0, 600.0, of, plain), 1e-15);
}

// Absolute: near zeros of either function x has a rounding of its own.
TEST(Simd, CosineAndSineAreTheLibrarys) {
  const auto cosine = [](const SimdDoubles& x) {
    SimdDoubles c, s;
    cos_sin(x, c, s);
    return c;
  };
  const auto sine = [](const SimdDoubles& x) {
    SimdDoubles c, s;
    cos_sin(x, c, s);
    return s;
  };
  for (const double most : {1.0, 30.0, 1e5}) {
    EXPECT_LT(worst<SimdDoubles>(
                  -most, most, cosine, [](double x) { return std::cos(x); }, 1.0),
              5e-16);
    EXPECT_LT(worst<SimdDoubles>(
                  -most, most, sine, [](double x) { return std::sin(x); }, 1.0),
              5e-16);
  }
}

TEST(Simd, LogarithmIsTheLibrarys) {
  const auto of = [](const SimdDoubles& x) { return logarithm(x); };
  const auto plain = [](double x) { return std::log(x); };
  EXPECT_LT(worst<SimdDoubles>(1e-3, 0.7, of, plain), 1e-15);
  EXPECT_LT(worst<SimdDoubles>(1.5, 1e6, of, plain), 1e-15);
  // Near 1 the last step of n·ln 2 + ln m is exact, and s is right to a rounding.
  EXPECT_LT(
      worst<SimdDoubles>(
          0.75, 1.35, [](const SimdDoubles& x) { return SimdDoubles(logarithm(x) - (x - 1.0)); },
          [](double x) { return std::log1p(x - 1.0) - (x - 1.0); }),
      1e-9);  // of a difference that vanishes at 1
}

// Beyond the series: (1 + x)/(1 − x) is right to two roundings, 2e-16 of 1, and its logarithm at
// least 0.12.
TEST(Simd, AtanhAndAsinAreTheLibrarys) {
  const auto atanh = [](double x) { return x == 0.0 ? 1.0 : std::atanh(x) / x; };
  const auto asin = [](double x) { return x == 0.0 ? 1.0 : std::asin(x) / x; };
  EXPECT_LT(worst<SimdDoubles>(-0.999, 0.999, atanh_over, atanh), 5e-15);
  EXPECT_LT(worst<SimdDoubles>(-1.0, 1.0, asin_over, asin), 1e-15);
}

TEST(Simd, AngleIsTheLibrarys) {
  const auto of = [](const SimdDoubles& x) { return angle_of(x, SimdDoubles(1.0)); };
  EXPECT_LT(worst<SimdDoubles>(1e-6, 1.0, of, [](double x) { return std::atan(x); }), 1e-15);
  EXPECT_LT(worst<SimdDoubles>(1.0, 1e4, of, [](double x) { return std::atan(x); }), 1e-15);
}

// Lanes of different size take different ways; none disturbs another.
TEST(Simd, LanesAreIndependent) {
  const SimdDoubles x([](auto i) { return i % 2 == 0 ? 0.01 : 0.7; });
  const SimdDoubles ratio = atanh_over(x), angle = asin_over(x);
  for (std::size_t i = 0; i < doubles_at_once; ++i) {
    EXPECT_NEAR(ratio[i], std::atanh(x[i]) / x[i], 5e-15);
    EXPECT_NEAR(angle[i], std::asin(x[i]) / x[i], 5e-15);
  }
}

// Single precision: roundings of 6e-8. cos 2h = 1 − 2 sin²h has four times the error of sin h,
// whose series leaves 6e-8 at π/2 besides.
TEST(Simd, FunctionsOfSinglePrecisionAreTheLibrarys) {
  const auto exponential_of = [](const SimdFloats& x) { return exponential(x); };
  EXPECT_LT(worst<SimdFloats>(-80.0, 80.0, exponential_of, [](double x) { return std::exp(x); }),
            3e-7);
  const auto logarithm_of = [](const WideFloats& x) { return logarithm(x); };
  EXPECT_LT(worst<WideFloats>(
                1e-9, 1.0, logarithm_of, [](double x) { return std::log(x); }, 1.0),
            2e-7);
  const auto cosine = [](const SimdFloats& x) {
    SimdFloats c, s;
    cos_sin(x, c, s);
    return c;
  };
  const auto sine = [](const SimdFloats& x) {
    SimdFloats c, s;
    cos_sin(x, c, s);
    return s;
  };
  EXPECT_LT(worst<SimdFloats>(
                -100.0, 100.0, cosine, [](double x) { return std::cos(x); }, 1.0),
            1e-6);
  EXPECT_LT(worst<SimdFloats>(
                -100.0, 100.0, sine, [](double x) { return std::sin(x); }, 1.0),
            1e-6);
  const auto half_cosine = [](const WideFloats& x) {
    WideFloats c, s;
    cos_sin_of_half(x, c, s);
    return c;
  };
  const auto half_sine = [](const WideFloats& x) {
    WideFloats c, s;
    cos_sin_of_half(x, c, s);
    return s;
  };
  EXPECT_LT(worst<WideFloats>(
                -1.57, 1.57, half_cosine, [](double x) { return std::cos(x); }, 1.0),
            2e-7);
  EXPECT_LT(worst<WideFloats>(
                -1.57, 1.57, half_sine, [](double x) { return std::sin(x); }, 1.0),
            2e-7);
}

TEST(Simd, SignsAndWholeNumbersArePlainOnes) {
  for (const float x : {-2.6F, -0.4F, 0.4F, 2.6F, 1e6F}) {
    EXPECT_EQ(with_sign(SimdFloats(3.0F), SimdFloats(x))[0], std::copysign(3.0F, x));
    EXPECT_EQ(nearest(SimdFloats(x))[0], std::nearbyint(x));
  }
  for (std::size_t i = 0; i < simd_width; ++i) EXPECT_EQ(ramp()[i], static_cast<float>(i));
}

TEST(Simd, LoadsAndStoresKeepOrder) {
  const auto floats = counted<float>(simd_width + 1);
  const auto doubles = counted<double>(doubles_at_once + 1);
  std::vector<float> float_copy(simd_width);
  std::vector<double> double_copy(doubles_at_once);
  store(load(floats.data() + 1), float_copy.data());  // not aligned
  store(load(doubles.data() + 1), double_copy.data());
  EXPECT_EQ(float_copy, std::vector<float>(floats.begin() + 1, floats.end()));
  EXPECT_EQ(double_copy, std::vector<double>(doubles.begin() + 1, doubles.end()));
  const auto ints = counted<std::int32_t>(simd_width);
  const SimdFloats same = to_floats(load(ints.data()));
  for (std::size_t i = 0; i < simd_width; ++i) EXPECT_EQ(same[i], floats[i]);
  const std::array<double, 5> five{1.0, 2.0, 3.0, 4.0, 5.0};
  std::array<double, 4> four{};
  store_lanes(load_lanes<Lanes<double, 4>>(five.data() + 1), four.data());
  EXPECT_EQ(four, (std::array<double, 4>{2.0, 3.0, 4.0, 5.0}));
}

TEST(Simd, PackingPutsTheWantedSideBySide) {
  const auto floats = counted<float>(simd_width);
  const auto ints = counted<std::int32_t>(simd_width);
  for (unsigned bits = 0; bits < 1U << simd_width; ++bits) {
    const SimdInts flags([&](auto i) { return static_cast<std::int32_t>(bits >> i & 1U); });
    const Packing packing(flags > 0);
    std::vector<float> packed(simd_width), plain;
    std::vector<std::int32_t> packed_ints(simd_width);
    packing.pack(floats.data(), packed.data());
    packing.pack(ints.data(), packed_ints.data());
    for (std::size_t i = 0; i < simd_width; ++i)
      if ((bits >> i & 1U) != 0) plain.push_back(floats[i]);
    ASSERT_EQ(packing.count(), plain.size());
    for (std::size_t i = 0; i < plain.size(); ++i) {
      EXPECT_EQ(packed[i], plain[i]) << bits;
      EXPECT_EQ(packed_ints[i], static_cast<std::int32_t>(plain[i])) << bits;
    }
  }
}

TEST(Simd, TransposedSquaresAreTurnedOverTheDiagonal) {
  const auto square = counted<float>(simd_width * simd_width);
  std::vector<float> turned = square;
  transpose(turned.data());
  for (std::size_t i = 0; i < simd_width; ++i)
    for (std::size_t j = 0; j < simd_width; ++j)
      EXPECT_EQ(turned[i * simd_width + j], square[j * simd_width + i]);
  std::array<Lanes<double, 4>, 4> rows{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) rows[i][j] = static_cast<double>(10 * i + j);
  transpose(rows);
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) EXPECT_EQ(rows[i][j], static_cast<double>(10 * j + i));
}

}  // namespace
}  // namespace asdic::detail
