#pragma once
#include <array>
#include <cstddef>

#include "raytrace/tracing/cell.h"

namespace asdic::detail::tracing {

/// Value and derivative.
struct ValueSlope {
  double value = 0.0, slope = 0.0;
};

/// The first coefficients of a power series in travel time, and of four at once.
using Series = std::array<double, 13>;
using FourSeries = std::array<std::array<double, 4>, 13>;

/// A ray and its beam as power series in the travel time t from where it is. With the unit tangent
/// (t_r, t_z) and P = c·p the equations of docs/theory/rays.md are polynomial,
///
///   ṙ = c·t_r   ż = c·t_z   ṫ_r = c_n·t_z   ṫ_z = −c_n·t_r   q̇ = c·P   Ṗ = c_s·P − c_nn·q   ṡ = c,
///
/// so that each coefficient follows from those before it by sums of products (Cauchy's rule);
/// Taylor's method, as in Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I
/// (1993), §I.8. Four series that are made alike lie side by side and are made at once.
struct PowerSeries {
  enum SimdFloat : std::size_t { range, depth, q, q_plane };   ///< of `place`
  enum Motion : std::size_t { tr, tz, growth, growth_plane };  ///< of `motion`; growth: P
  alignas(32) FourSeries place;   ///< range and depth less those of the begin [m], q, q_plane
  alignas(32) FourSeries motion;  ///< each the rate of its lane of `place`, over c
  Series length, nepers;          ///< less those of the begin
  std::size_t order = 0;          ///< of the last term
  double reach = 0.0;             ///< up to where all of it is right [s]

  /// \param wanted  how far it is needed [s]: no more terms are made than that asks for
  void expand(const Cell& cell, const RayState& y, const Local& here, double wanted) noexcept;

  [[nodiscard]] double value(const Series& a, double h) const noexcept {
    double v = a[order];
    for (std::size_t i = order; i-- > 0;) v = a[i] + h * v;
    return v;
  }
  [[nodiscard]] ValueSlope value_and_slope(const FourSeries& a, std::size_t lane,
                                           double h) const noexcept {
    double v = a[order][lane], d = 0.0;
    for (std::size_t i = order; i-- > 0;) {
      d = v + h * d;
      v = a[i][lane] + h * v;
    }
    return {v, d};
  }
  /// All four at once.
  [[nodiscard]] std::array<double, 4> values(const FourSeries& a, double h) const noexcept;
  /// ∫c ds = ∫c² dt.
  [[nodiscard]] double speed_integral(double h) const noexcept;
  /// Of range and depth.
  [[nodiscard]] std::array<ValueSlope, 2> where(double h) const noexcept;
};

/// Error accepted at the end of one segment [m], and of the quintics of state_at within it [m].
inline constexpr double position_tolerance = 1e-7, quintic_tolerance = 1e-5;

}  // namespace asdic::detail::tracing
