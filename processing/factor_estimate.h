#pragma once
#include <array>

#include "processing/replica.h"

namespace asdic::detail {

/// Tells a Doppler factor by two filters h below and h above the loudest, each asked where it
/// answers most: along the ridge.
///
/// A filter that is off by δ answers an echo with the amplitude ρ(δ), and the noise of two filters
/// is correlated by the same ρ. With L = ln(|y|²/η), the power over the noise that a filter
/// receives, an echo at the offset o gives
///
///   D(o) = L₊ − L₋ = 2 ln ρ(o − h) − 2 ln ρ(o + h),   σ² = 4 (1 − ρ(2h))/(ρ(h) D′(0))² · (1 +
///   1/S)/S
///
/// D is tabulated from the pulse's ambiguity function and read backwards. Where ρ² falls as
/// 1 − β²δ², σ² is Cramér and Rao's bound for small h, 1/(2Sβ²). Where it falls at once, 1 − c|δ|,
/// as of pulses that begin at once, there is no β. The variance of N sub-bands is an Nth, S a
/// sub-band's. Source: docs/theory/processing.md, eq. (13)
class FactorEstimate {
 public:
  FactorEstimate() = default;
  /// \param apart  h   \param cell  as of doppler_cell()
  FactorEstimate(const Replica& replica, double apart, double cell, int sub_bands);

  /// \param difference  L₊ − L₋   \return o, at most h to either side
  [[nodiscard]] double offset(double difference) const noexcept;
  /// \param snr  power over mean background, S + 1   \return standard deviation of noise
  [[nodiscard]] double sigma(double snr) const noexcept;

 private:
  static constexpr int side = 4;  // offsets of a quarter of h each, to either side
  std::array<double, 2 * side + 1> difference_{};
  double apart_ = 0.0;
  double unit_ = 0.0;   // of S = 1
  double floor_ = 0.0;  // of the table itself
};

}  // namespace asdic::detail
