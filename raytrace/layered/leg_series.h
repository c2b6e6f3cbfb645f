#pragma once
#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/level_namespace.h"
#include "raytrace/layered/simd_column.h"
#include "raytrace/math/polynomial_fit.h"

namespace asdic::detail {

/// What of a leg is smooth in σ, and so a series: r/ξ, σ·dr/dξ, τ − ξr (whose error is of second
/// order in that of σ) and the length.
enum LegQuantity : std::size_t { per_slowness, d_range, intercept, length, leg_quantities };

inline namespace ASDIC_LEVEL {

/// Several legs between two nodes of the fan as polynomials in σ: function
/// quantity × legs + leg.
template <std::size_t legs>
class LegFit {
 public:
  static constexpr std::size_t terms = PolynomialFit<legs * leg_quantities>::terms;

  /// Chebyshev's points `first` to `first` + lanes of a extent.
  [[nodiscard]] static Rays sigmas(const SigmaExtent& extent, std::size_t first) noexcept {
    return Rays([&](auto i) {
      return extent.middle +
             PolynomialFit<legs * leg_quantities>::point(first + i) / extent.per_half;
    });
  }
  /// A leg's values there.
  void put(std::size_t leg, std::size_t first, const SimdLegs& value,
           const SimdRays& rays) noexcept {
    const Rays values[leg_quantities] = {value.per_slowness, rays.sigma * value.d_range,
                                         value.intercept, value.length};
    for (std::size_t q = 0; q < leg_quantities; ++q)
      store(values[q], &fit_.numbers[(q * legs + leg) * terms + first]);
  }
  void fit() noexcept { fit_.fit(); }

  /// What the last two terms may amount to: the series are right to some three times as much.
  struct Tolerance {
    double range, time, slope;  ///< and length [m], [s], relative
  };
  /// \param c_ref  of σ [m/s]
  [[nodiscard]] bool good(std::size_t leg, double c_ref, const Tolerance& most) const noexcept {
    const auto holds = [&](LegQuantity of, double relative, double absolute) {
      const std::size_t f = of * legs + leg;
      return fit_.tail[f] <= absolute + relative * fit_.size[f];  // not if no number
    };
    return holds(per_slowness, 1e-15, most.range * c_ref) && holds(d_range, most.slope, 0.0) &&
           holds(intercept, 1e-15, most.time) && holds(length, 1e-15, most.range);
  }

  /// Two quantities of all legs at once, by Horner's rule: one by itself would wait for its own
  /// last product.
  struct Pair {
    std::array<Rays, legs> first, second;
  };
  [[nodiscard]] Pair at(const Rays& x, LegQuantity first, LegQuantity second) const noexcept {
    const auto of = [&](LegQuantity quantity, std::size_t j, std::size_t leg) {
      return fit_.numbers[j * (legs * leg_quantities) + quantity * legs + leg];
    };
    Pair value;
    for (std::size_t i = 0; i < legs; ++i) {
      value.first[i] = of(first, terms - 1, i);
      value.second[i] = of(second, terms - 1, i);
    }
    for (std::size_t j = terms - 1; j-- > 0;)
      for (std::size_t i = 0; i < legs; ++i) {
        value.first[i] = value.first[i] * x + of(first, j, i);
        value.second[i] = value.second[i] * x + of(second, j, i);
      }
    return value;
  }

 private:
  PolynomialFit<legs * leg_quantities> fit_;
};

/// The legs of an interval of the fan as Chebyshev series in σ, for extents with many roots: a
/// few walks through the column serve them all. Whether the series are right to rounding is told by
/// their last terms.
class LegSeries {
 public:
  /// \param c_ref  of σ [m/s]   \param low, high  σ between two nodes of the fan
  LegSeries(const Column& column, double c_ref, double low, double high);

  /// Ranges right to a micrometre, times to a picosecond, slopes to 3e-8 of themselves.
  [[nodiscard]] bool good() const noexcept { return good_; }
  [[nodiscard]] SimdColumn sums(const SimdRays& rays) const noexcept;
  [[nodiscard]] SimdColumn all(const SimdRays& rays) const noexcept;

 private:
  SigmaExtent extent_;
  LegFit<3> legs_;  ///< up, middle and down
  bool turns_above_ = false, turns_below_ = false, good_ = false;
};

/// Series over extents of an interval, from node to node, made where they are wanted and as short
/// as they must be.
class IntervalSeries {
 public:
  /// \param nodes  [n] increasing σ of the interval's nodes
  IntervalSeries(const Column& column, double c_ref, std::span<const double> nodes);

  /// One that holds between nodes `cell` and `cell` + 1, or nullptr if none does.
  [[nodiscard]] const LegSeries* at(std::size_t cell);
  /// Cells [first, last) that share a series with this one, as far as is known.
  struct Cells {
    std::size_t first, last;
  };
  [[nodiscard]] Cells around(std::size_t cell) const noexcept;

 private:
  struct Piece {
    std::size_t first, last;  ///< cells
    std::unique_ptr<LegSeries> series = nullptr;
  };
  [[nodiscard]] std::size_t piece_of(std::size_t cell) const noexcept;

  const Column& column_;
  double c_ref_;
  std::span<const double> nodes_;
  std::vector<Piece> pieces_;  ///< in order
};

}  // namespace ASDIC_LEVEL

/// How far a series reaches from σ on. The nearest singularity is where s vanishes at the next
/// slower knot, at ±ia, a² = (c_ref/c)² − 1: on a extent of 1.5 times its distance n terms leave
/// about 4^(−n). \param slower  the knot's speed, 0 if there is none [m/s]
[[nodiscard]] inline double series_reach(double from, double c_ref, double slower) noexcept {
  const double ratio = slower > 0.0 ? c_ref / slower : 2.0;
  return 0.7 * std::sqrt(ratio * ratio - 1.0 + from * from);
}

}  // namespace asdic::detail
