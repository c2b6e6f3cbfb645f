#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "raytrace/tracing/power_series.h"

namespace asdic::detail::tracing {

inline constexpr std::size_t most_terms = std::tuple_size_v<Series> - 1;

/// h at which |a|·hⁿ = tolerance.
[[nodiscard]] inline double within(double a, int n, double tolerance) noexcept {
  return a == 0.0 ? 1e300 : std::pow(tolerance / std::abs(a), 1.0 / n);
}

/// When a power series ends: as soon as its last two terms are small enough where it is wanted;
/// what is left out is smaller. q counts by its size.
class SeriesEnd {
 public:
  /// \param y  with its first terms
  SeriesEnd(double wanted, const PowerSeries& y) noexcept
      : q_weight_(10.0 / (1.0 + std::abs(y.place[0][PowerSeries::q]))),
        plane_weight_(10.0 / (1.0 + std::abs(y.place[0][PowerSeries::q_plane]))),
        wanted_(wanted) {}

  /// The weights of a term's lanes: its size is the greatest of them all.
  [[nodiscard]] std::array<double, 4> place_weights() const noexcept {
    return {1.0, 1.0, q_weight_, plane_weight_};
  }
  static constexpr std::array<double, 4> motion_weights = {1e3, 1e3, 0.0, 0.0};

  /// After term k + 1. \return false: it was the last; y.reach is set
  template <std::size_t k>
  [[gnu::always_inline]] bool goes_on(PowerSeries& y) noexcept {
    const auto &a = y.place[k + 1], &d = y.motion[k + 1];
    return goes_on<k>(y,
                      std::max(std::max({std::abs(a[0]), std::abs(a[1]), q_weight_ * std::abs(a[2]),
                                         plane_weight_ * std::abs(a[3])}),
                               1e3 * std::max(std::abs(d[0]), std::abs(d[1]))));
  }
  /// \param size  of term k + 1
  template <std::size_t k>
  [[gnu::always_inline]] bool goes_on(PowerSeries& y, double size) noexcept {
    before_ = last_;
    last_ = size;
    const double before_it = before_ * power_;
    power_ *= wanted_;
    y.order = k + 1;
    if (k >= 3 && last_ * power_ + 0.1 * before_it <= position_tolerance) {
      y.reach = wanted_;
      return false;
    }
    if constexpr (k + 1 == most_terms)
      y.reach = std::min(within(last_, most_terms, position_tolerance),
                         within(0.1 * before_, most_terms - 1, position_tolerance));
    return true;
  }

  /// The quintic of a segment leaves out a₆·t³(t − h)³ and more: a₆·h⁶/64 at most.
  void shorten(PowerSeries& y) const noexcept {
    if (y.order < 6) return;
    const auto& a = y.place[6];
    const double sixth = std::max({std::abs(a[0]), std::abs(a[1]), 0.1 * q_weight_ * std::abs(a[2]),
                                   0.1 * plane_weight_ * std::abs(a[3])}) /
                         64.0;
    const double h3 = y.reach * y.reach * y.reach;
    if (sixth * h3 * h3 > quintic_tolerance) y.reach = within(sixth, 6, quintic_tolerance);
  }

 private:
  double q_weight_, plane_weight_, wanted_;
  double power_ = 1.0, last_ = 0.0, before_ = 0.0;  // the last two terms, weighted, without powers
};

/// PowerSeries::expand where c is bilinear in range and depth. \param s  c there
/// \param row  its attenuation counted from the ray's depth   \param y  with its first terms
void expand_bilinear(const SoundSpeed2D& s, const Row& row, double wanted, PowerSeries& y) noexcept;

}  // namespace asdic::detail::tracing
