#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "core/geometry.h"

namespace asdic::detail {

/// Where the phones are, coordinate by coordinate [m].
struct PhonePlaces {
  std::vector<double> x, y, z;

  explicit PhonePlaces(std::span<const Vec3> phones) {
    for (const Vec3& phone : phones) {
      x.push_back(phone.x());
      y.push_back(phone.y());
      z.push_back(phone.z());
    }
  }
};

/// How much later than the reference point phones receive a wave whose fronts are spheres about the
/// point R·u, u = −s/|s|: |s|·(|R·u − x| − R) [s]. \param s  length of the slowness; that of a mean
/// over directions that the phones do not tell apart is shorter [s/m]   \param curvature  1/R [1/m]
inline void find_lags(const Vec3& slowness, double s, double curvature, const PhonePlaces& at,
                      std::span<double> lags) noexcept {
  const Vec3 towards = s > 0.0 ? Vec3(slowness / s) : Vec3::Zero();
  for (std::size_t p = 0; p < lags.size(); ++p) {
    // (|R·u − x|² − R²)/R = 2·s·x/|s| + |x|²/R, over (|R·u − x| + R)/R.
    const double x = at.x[p], y = at.y[p], z = at.z[p];
    const double excess = 2.0 * (towards.x() * x + towards.y() * y + towards.z() * z) +
                          curvature * (x * x + y * y + z * z);
    lags[p] = s * excess / (1.0 + std::sqrt(std::max(0.0, 1.0 + curvature * excess)));
  }
}

}  // namespace asdic::detail
