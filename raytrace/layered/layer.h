#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "raytrace/ocean/sound_speed.h"

namespace asdic::detail {

/// A slab of water in which the speed is monotone in depth and follows one law.
struct Layer {
  enum class Law : unsigned char { c_linear, n2_linear, cubic, munk };

  double top = 0.0, bottom = 0.0;      ///< depths [m]
  double c_top = 0.0, c_bottom = 0.0;  ///< speeds there [m/s]
  Law law = Law::c_linear;
  double gradient = 0.0;  ///< c-linear: dc/dz [1/s]; n²-linear: d(1/c²)/dz [s²/m³]
  double origin = 0.0;    ///< cubic: depth from which its polynomial counts [m]
  std::array<double, 4> coefficient{};  ///< cubic: c = Σ aᵢ(z − origin)ⁱ; Munk: c₁, z₁, B, ε

  bool evenly_bent = false;  ///< dc/dz varies by less than a factor of two
  bool gentle = true;        ///< dc/dz is nowhere three times that of the whole layer
  double slope_top = 0.0, slope_bottom = 0.0;  ///< smooth laws: dc/dz at the edges [1/s]
  /// Smooth laws: c at the Gauss–Legendre nodes in depth of 4, 6 and 8 points, one after the other.
  std::array<double, 18> node_speed{};
  template <std::size_t n>
  static constexpr std::size_t first_node = n == 4   ? 0
                                            : n == 6 ? 4
                                                     : 10;

  [[nodiscard]] SoundSpeed at(double depth) const noexcept;
  [[nodiscard]] double thickness() const noexcept { return bottom - top; }
  [[nodiscard]] bool closed_form() const noexcept {
    return law == Law::c_linear || law == Law::n2_linear;
  }
};

/// The water between two depths as layers from top to bottom: cut at the profile's samples and
/// wherever dc/dz is zero.
[[nodiscard]] std::vector<Layer> make_layers(const SoundSpeedProfile& water, double top,
                                             double bottom);

/// The layers with a further cut at `depth`. No change where there is a cut within `same_depth`: a
/// layer thinner than rounding has no gradient. \return the depth of the cut
double cut_at(std::vector<Layer>& layers, double depth);

inline constexpr double same_depth = 1e-7;  ///< [m]

}  // namespace asdic::detail
