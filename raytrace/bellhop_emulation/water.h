#pragma once
#include <array>
#include <complex>
#include <vector>

#include "raytrace/ocean/environment.h"

namespace asdic::detail::bellhop_emulation {

/// Sound speed at a point, complex for its loss: c + i·α·c²/ω, with the derivatives of the real
/// part.
struct WaterPoint {
  double c = 0.0;                             ///< [m/s]
  double c_loss = 0.0;                        ///< imaginary part [m/s]
  double c_r = 0.0, c_z = 0.0;                ///< gradient [1/s]
  double c_rr = 0.0, c_rz = 0.0, c_zz = 0.0;  ///< [1/(m·s)]

  [[nodiscard]] Vec2 gradient() const noexcept { return {c_r, c_z}; }
};

/// The depth interval and (range-dependent water) range interval that a ray is in. Carried along
/// it, because on a node the direction of travel decides.
struct WaterCell {
  std::size_t row = 0, column = 0;
  [[nodiscard]] bool operator==(const WaterCell&) const noexcept = default;
};

/// The water as BELLHOP interpolates it: complex speeds at the nodes, real and imaginary part by
/// the law of the profile (1/c² linear: the complex 1/c²).
class LiteralWater {
 public:
  LiteralWater(const Environment& environment, double frequency);

  /// Moves `cell` to the one that holds `x`; on a node, to the side to which `direction` points.
  void locate(const Vec2& x, const Vec2& direction, WaterCell& cell) const noexcept;
  [[nodiscard]] WaterPoint at(const Vec2& x, const WaterCell& cell) const noexcept;
  [[nodiscard]] double density(double depth) const noexcept { return density_.at(depth); }

  /// Limits of a cell [m]; ∓infinity where there are none.
  [[nodiscard]] double upper(const WaterCell& cell) const noexcept;
  [[nodiscard]] double lower(const WaterCell& cell) const noexcept;
  [[nodiscard]] double left(const WaterCell& cell) const noexcept;
  [[nodiscard]] double right(const WaterCell& cell) const noexcept;
  /// First and last depth of the profile [m]; those of the boundaries for an analytic one.
  [[nodiscard]] double first_depth() const noexcept { return first_depth_; }
  [[nodiscard]] double last_depth() const noexcept { return last_depth_; }

 private:
  /// Σ aᵢ(z − z0)ⁱ: c, or 1/c² (n²-linear).
  struct ComplexLaw {
    double z0 = 0.0;
    std::array<std::complex<double>, 4> a{};
  };
  void make_laws(const SoundSpeedProfile& water, const std::vector<double>& loss);
  [[nodiscard]] WaterPoint in_section(const Vec2& x, const WaterCell& cell) const noexcept;

  SoundSpeedProfile water_;
  DepthFunction density_, attenuation_;
  std::vector<double> depth_;    // [n] nodes; empty: no nodes at all
  std::vector<ComplexLaw> law_;  // [n − 1]
  std::vector<double> range_;    // [m] of a section
  std::vector<double> speed_;    // [m × n] of a section
  std::vector<double> loss_;     // [n] imaginary parts at the nodes of a section [m/s]
  double angular_frequency_;
  double first_depth_, last_depth_;
};

}  // namespace asdic::detail::bellhop_emulation
