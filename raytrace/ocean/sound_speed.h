#pragma once
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace asdic {

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
};

[[nodiscard]] std::string_view name(Interpolation interpolation) noexcept;

/// Munk's canonical deep-ocean profile, c = c₁·[1 + ε·(η − 1 + e^(−η))], η = 2(z − z₁)/B.
/// Munk, JASA 55, 220 (1974); Jensen et al. (2011), eq. (5.83).
struct MunkParameters {
  double axis_speed = 1500.0;     ///< c₁ [m/s]
  double axis_depth = 1300.0;     ///< z₁ [m]
  double scale_depth = 1300.0;    ///< B [m]
  double perturbation = 0.00737;  ///< ε
};

/// Sound speed along one water column: an analytic law, or samples and a rule between them.
///
/// Depth z [m] is positive down. Outside its samples a table goes on by the law of its first or
/// last interval. Source: Jensen et al., Computational Ocean Acoustics (2011), ch. 3.
class SoundSpeedProfile {
 public:
  /// \param depth  [n] strictly increasing [m], n ≥ 1 (one sample: the same speed everywhere)
  /// \param speed  [n] [m/s], each above zero
  /// \throws InputError naming the first sample at fault: "depth[3]", "speed[2]"
  static SoundSpeedProfile table(std::span<const double> depth, std::span<const double> speed,
                                 Interpolation interpolation);
  static SoundSpeedProfile munk(const MunkParameters& parameters = {});
  static SoundSpeedProfile isovelocity(double speed);

  [[nodiscard]] SoundSpeed at(double depth) const noexcept;

  /// The samples as given; empty for Munk's profile.
  [[nodiscard]] std::span<const double> depths() const noexcept { return depth_; }
  [[nodiscard]] std::span<const double> speeds() const noexcept { return speed_; }
  [[nodiscard]] Interpolation interpolation() const noexcept { return interpolation_; }
  [[nodiscard]] const std::optional<MunkParameters>& munk_parameters() const noexcept {
    return munk_;
  }

 private:
  SoundSpeedProfile() = default;
  [[nodiscard]] std::size_t interval(double depth) const noexcept;

  std::optional<MunkParameters> munk_;
  Interpolation interpolation_ = Interpolation::c_linear;
  std::vector<double> depth_, speed_;
  std::vector<double> slope_;  // dc/dz (spline, PCHIP) at the samples [1/s]
};

}  // namespace asdic
