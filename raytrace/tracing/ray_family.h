#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "raytrace/tracing/fan_ray.h"

namespace asdic::detail {

/// The polynomial through values and slopes at n places, in Newton's form.
template <std::size_t n>
struct OsculatingPolynomial {
  std::array<double, 2 * n> place{}, term{};

  OsculatingPolynomial() = default;
  OsculatingPolynomial(const std::array<double, n>& at, const std::array<double, n>& value,
                       const std::array<double, n>& slope) noexcept {
    for (std::size_t i = 0; i < n; ++i) {
      place[2 * i] = place[2 * i + 1] = at[i];
      term[2 * i] = term[2 * i + 1] = value[i];
    }
    for (std::size_t k = 1; k < 2 * n; ++k)  // divided differences
      for (std::size_t i = 2 * n; i-- > k;)
        term[i] = place[i] == place[i - k] ? slope[i / 2]
                                           : (term[i] - term[i - 1]) / (place[i] - place[i - k]);
  }
  /// Through the values alone.
  OsculatingPolynomial(const std::array<double, n>& at,
                       const std::array<double, n>& value) noexcept {
    for (std::size_t i = 0; i < n; ++i) {
      place[i] = at[i];
      term[i] = value[i];
    }
    for (std::size_t k = 1; k < n; ++k)
      for (std::size_t i = n; i-- > k;)
        term[i] = (term[i] - term[i - 1]) / (place[i] - place[i - k]);
  }
  struct Value {
    double value, slope;
  };
  [[nodiscard]] Value at(double t) const noexcept {
    double v = term[2 * n - 1], d = 0.0;
    for (std::size_t i = 2 * n - 1; i-- > 0;) {
      d = v + (t - place[i]) * d;
      v = term[i] + (t - place[i]) * v;
    }
    return {v, d};
  }
};

/// A ray with all that is known of it.
struct WholeRay {
  RayTrajectory ray;
  FanRay fan;
  std::vector<std::uint64_t> signature;  ///< [legs] rays that share it run through the same cells
                                         ///< of the water and strike the same facets: what they do
                                         ///< is an analytic function of the launch angle

  void sign(const Environment& environment);  ///< makes the signature
};

/// How many rays a family is known by: at equal distances of launch angle, ends included.
inline constexpr std::size_t family_size = 5;
using FamilyRays = std::array<const WholeRay*, family_size>;

/// Rays of one signature between two launch angles where a leg crosses a column: every quantity a
/// polynomial in the launch angle through those of five rays. Depth and delay, whose derivatives
/// the rays carry as well (∂z/∂α by q, ∂τ/∂α = ζ·∂z/∂α), are of degree nine, all else of degree
/// four; so are they over curvilinear boundaries, where q is that of the turning tangent, not of
/// the straight facets.
class RayFamily {
 public:
  enum class Made : unsigned char {
    good,
    rows_differ,  ///< they cross the column in several rows of the water: no one polynomial
    too_wide,
  };
  /// Whether the polynomials tell the rays: what is left out is judged by leaving out two of the
  /// five, or one (ray_family.cpp).
  [[nodiscard]] Made make(const FamilyRays& rays, const RayTracer& tracer, std::size_t leg,
                          std::uint32_t column, double range);

  [[nodiscard]] std::uint32_t column() const noexcept { return column_; }
  /// Depth at the column, its derivative by the launch angle, |cos θ|.
  [[nodiscard]] ExactCrossing at(double angle) const noexcept;
  /// The rest of it.
  void complete(double angle, ExactCrossing& there) const noexcept;
  /// The bounces before it. \param out  its memory is reused
  void bounces(double angle, const FamilyRays& rays, std::vector<Bounce>& out) const;

 private:
  [[nodiscard]] bool tells_places() const noexcept;
  [[nodiscard]] bool tells_the_rest() const noexcept;
  [[nodiscard]] bool counts_agree() const noexcept;

  std::uint32_t column_ = 0;
  std::size_t leg_ = 0;
  double from_ = 0.0, width_ = 1.0, sign_ = 1.0;
  bool by_slopes_ = true;
  std::array<ExactCrossing, family_size> known_{};
  OsculatingPolynomial<family_size> depth_, delay_;
};

}  // namespace asdic::detail
