#pragma once
#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <numbers>

namespace asdic::detail {

/// A small matrix that lies in memory alike whatever instructions a file is compiled for: Eigen's
/// own alignment grows with them.
template <int rows, int columns>
using SmallMatrix = Eigen::Matrix<double, rows, columns, Eigen::DontAlign>;

/// East, north, depth [m]. The triple is left-handed (z points down): no cross products.
using Vec3 = Eigen::Vector3d;  // of 24 bytes: never aligned
using Vec2 = SmallMatrix<2, 1>;

inline constexpr double pi = std::numbers::pi;
inline constexpr double db_per_neper = 8.685889638065036553;  // 20·log₁₀ e
inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double micropascal = 1e-6;  ///< the reference pressure of underwater levels [Pa]

constexpr double radians(double degrees) { return degrees * (pi / 180.0); }
constexpr double degrees(double radians) { return radians * (180.0 / pi); }

/// A bearing in degrees, 0 ≤ x < 360, out of radians of any sign.
inline double compass_degrees(double radians) {
  const double turn = std::fmod(degrees(radians), 360.0);
  return turn < 0.0 ? turn + 360.0 : turn;
}

/// 10^(x/10): a ratio of powers out of decibels. −∞ dB is 0.
inline double power_from_db(double db) { return std::pow(10.0, db / 10.0); }
/// 10^(x/20): a ratio of amplitudes out of decibels. −∞ dB is 0.
inline double amplitude_from_db(double db) { return std::pow(10.0, db / 20.0); }
inline double db_from_power(double ratio) { return 10.0 * std::log10(ratio); }
inline double db_from_amplitude(double ratio) { return 20.0 * std::log10(ratio); }

}  // namespace asdic::detail
