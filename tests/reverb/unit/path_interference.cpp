// The mean over an array's phones of two paths' phases. Truth: the sum over every phone, with the
// standard library's Bessel function.
#include "reverb/power/path_interference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace asdic::detail {
namespace {

constexpr double frequency = 4000.0;

std::complex<double> plain(const std::vector<Vec3>& phones, const Vec3& apart, bool over_bearings) {
  std::complex<double> sum = 0.0;
  const double omega = 2.0 * std::numbers::pi * frequency;
  for (const Vec3& x : phones) {
    const double level = omega * apart.head<2>().norm() * x.head<2>().norm();
    sum += over_bearings
               ? std::cyl_bessel_j(0.0, level) * std::polar(1.0, -omega * apart.z() * x.z())
               : std::polar(1.0, -omega * apart.dot(x));
  }
  return sum / double(phones.size());
}

/// A ship's array: four rings of 24, told to a tenth of a millimetre.
std::vector<Vec3> cylinder() {
  std::vector<Vec3> phones;
  for (int row = 0; row < 4; ++row)
    for (int k = 0; k < 24; ++k) {
      const double b = k * std::numbers::pi / 12.0;
      const auto told = [](double x) { return std::round(1e4 * x) / 1e4; };
      phones.emplace_back(told(0.75 * std::sin(b)), told(0.75 * std::cos(b)), 0.4 * row - 0.6);
    }
  return phones;
}

std::vector<Vec3> line() {
  std::vector<Vec3> phones;
  for (int k = 0; k < 40; ++k) phones.emplace_back(0.15 * (k - 19.5), 0.01 * k, 0.3);
  return phones;
}

/// Two exact rings about other axes, a few phones beside them, in no order.
std::vector<Vec3> leaning() {
  std::vector<Vec3> phones{{0.3, 0.1, 0.9}, {-1.0, 2.0, 0.2}};
  for (int k = 0; k < 31; ++k) {
    const double b = 0.3 + 2.0 * std::numbers::pi * k / 31.0;
    phones.emplace_back(0.4 + 1.1 * std::sin(b), 1.1 * std::cos(b) - 0.2, 0.5);
    if (k < 12) phones.emplace_back(std::cos(31.0 * b / 12.0), std::sin(31.0 * b / 12.0), -0.5);
  }
  std::shuffle(phones.begin(), phones.end(), std::mt19937_64(3));
  return phones;
}

std::vector<Vec3> strewn() {
  std::mt19937_64 chance(2);
  std::uniform_real_distribution<double> even(-3.0, 3.0);
  std::vector<Vec3> phones(30);
  for (Vec3& x : phones) x = Vec3(even(chance), even(chance), even(chance));
  return phones;
}

TEST(PathInterference, IsTheMeanOverEveryPhone) {
  const PulseCoherence pulse;
  std::mt19937_64 chance(7);
  std::uniform_real_distribution<double> even(-1.0, 1.0);
  for (const auto& phones : {cylinder(), line(), leaning(), strewn()})
    for (const bool over_bearings : {true, false}) {
      const PathInterference interference(phones, frequency, pulse, over_bearings);
      for (int i = 0; i < 400; ++i) {
        // From nearly alike to opposite.
        const double scale = std::pow(10.0, -4.0 * std::abs(even(chance))) / 1500.0;
        const Vec3 apart = scale * Vec3(even(chance), even(chance), even(chance));
        EXPECT_LT(std::abs(interference.over_phones(apart) - plain(phones, apart, over_bearings)),
                  over_bearings || phones.size() == 96 ? 3e-4 : 1e-6);
      }
    }
}

}  // namespace
}  // namespace asdic::detail
