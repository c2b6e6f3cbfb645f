#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace asdic::detail {

/// Sound speed at one depth, with the derivatives a beam needs.
struct SoundSpeed {
  double c = 0.0;        ///< [m/s]
  double dc_dz = 0.0;    ///< [1/s]
  double d2c_dz2 = 0.0;  ///< [1/(m·s)]
};

/// How the speed runs between the samples of a profile.
enum class Interpolation {
  c_linear,   ///< c linear in depth: rays are arcs of circles
  n2_linear,  ///< 1/c² linear in depth: rays are parabolas
  spline,     ///< cubic spline, not-a-knot at both ends: c, dc/dz and d²c/dz² continuous
  pchip,      ///< monotone cubic Hermite, Fritsch & Butland: no overshoot, c and dc/dz continuous
  pchip_spline_slopes,  ///< monotone cubic Hermite whose slopes are a clamped spline's, limited:
                        ///< the "PCHIP" of BELLHOP's input files (docs/theory/sound-speed.md)
};

[[nodiscard]] std::string_view name(Interpolation interpolation) noexcept;

/// Munk's canonical deep-ocean profile, c = c₁·[1 + ε·(η − 1 + e^(−η))], η = 2(z − z₁)/B.
/// Munk, JASA 55, 220 (1974); Jensen et al. (2011), eq. (5.83).
struct MunkParameters {
  double axis_speed = 1500.0;     ///< c₁ [m/s]
  double axis_depth = 1300.0;     ///< z₁ [m]
  double scale_depth = 1300.0;    ///< B [m]
  double perturbation = 0.00737;  ///< ε

  [[nodiscard]] bool operator==(const MunkParameters&) const = default;
};

/// The exact law of one interval of a table, a polynomial in t = depth − z0:
///
///   p(t) = a[0] + a[1]·t + a[2]·t² + a[3]·t³
///
/// p is the speed c [m/s], except for Interpolation::n2_linear, where it is 1/c² [s²/m²]. The
/// linear laws have a[2] = a[3] = 0.
struct IntervalLaw {
  double z0 = 0.0;  ///< depth of the interval's upper sample [m]
  std::array<double, 4> a{};

  [[nodiscard]] bool operator==(const IntervalLaw&) const = default;
};

/// Sound speed along one water column: an analytic law, or samples and a rule between them.
///
/// Depth z [m] is positive down. Outside its samples a table goes on by the law of its first or
/// last interval, as long as that stays between half the lowest and twice the highest sample;
/// beyond, the speed is held there (a line of 1/c² would otherwise reach c = ∞, a falling c would
/// reach 0). Source: Jensen et al., Computational Ocean Acoustics (2011), ch. 3;
/// docs/theory/sound-speed.md.
class SoundSpeedProfile {
 public:
  /// \param depth  [n] strictly increasing [m], n ≥ 1 (one sample: the same speed everywhere)
  /// \param speed  [n] [m/s], each above zero
  /// \throws InputError naming the first sample at fault ("depth[3]", "speed[2]"), or a spline that
  ///         swings outside the limits above between two samples
  static SoundSpeedProfile table(std::span<const double> depth, std::span<const double> speed,
                                 Interpolation interpolation);
  /// \throws InputError if a parameter is not finite, or axis_speed, scale_depth ≤ 0, perturbation
  ///         < 0
  static SoundSpeedProfile munk(const MunkParameters& parameters = {});
  /// \throws InputError unless speed > 0
  static SoundSpeedProfile isovelocity(double speed);

  /// Speed and derivatives at a depth [m]. At a sample, the law of the interval below it holds.
  [[nodiscard]] SoundSpeed at(double depth) const noexcept;

  /// The samples as given; empty for Munk's profile.
  [[nodiscard]] std::span<const double> depths() const noexcept { return depth_; }
  [[nodiscard]] std::span<const double> speeds() const noexcept { return speed_; }
  [[nodiscard]] Interpolation interpolation() const noexcept { return interpolation_; }
  [[nodiscard]] const std::optional<MunkParameters>& munk_parameters() const noexcept {
    return munk_;
  }

  /// How many intervals a table has: one less than samples (a single sample: 1, a constant law);
  /// 0 for Munk's profile.
  [[nodiscard]] std::size_t intervals() const noexcept { return law_.size(); }
  /// The law between samples i and i + 1. \param i  below intervals()
  [[nodiscard]] const IntervalLaw& law(std::size_t i) const noexcept { return law_[i]; }
  /// The interval that holds a depth: the one below a sample, the first or last one outside. A
  /// table only.
  [[nodiscard]] std::size_t interval(double depth) const noexcept;
  /// Speed and derivatives at a depth [m] by the law of interval i, whether the depth lies inside
  /// or not: so the gradient on either side of a sample can be had. Never clamped. A table only.
  [[nodiscard]] SoundSpeed at(double depth, std::size_t i) const noexcept;

  [[nodiscard]] bool operator==(const SoundSpeedProfile&) const = default;

 private:
  SoundSpeedProfile() = default;

  std::optional<MunkParameters> munk_;
  Interpolation interpolation_ = Interpolation::c_linear;
  std::vector<double> depth_, speed_;  // [n]
  std::vector<IntervalLaw> law_;       // [max(1, n − 1)]
  double lowest_ = 0.0;                // the limits of extrapolation [m/s]
  double highest_ = 0.0;
};

}  // namespace asdic::detail
