#pragma once
#include <algorithm>
#include <cmath>
#include <variant>

#include "raytrace/math/gauss_legendre.h"
#include "raytrace/ocean/roughness.h"
#include "reverb/scattering/geometry.h"

namespace asdic::detail {

/// The share of the incident energy that a law scatters in all directions of the water,
/// (1/sin θᵢ)·∫σ dΩ over the upper hemisphere: of unit intensity sin θᵢ falls on a unit of area,
/// and σ is what leaves it per steradian. \param grazing  θᵢ [rad]   \param frequency [Hz]
/// \param beyond  directions nearer than this to the mirrored one are left out [rad]
template <class Law>
[[nodiscard]] double scattered_share(const Law& law, double grazing, double frequency,
                                     double beyond = 0.0) {
  const double sine = std::sin(grazing);
  if (!(sine > 0.0)) return 0.0;
  const auto sigma = law.at(frequency);
  // Laws peak about the mirrored direction: pieces that halve towards it, in elevation and bearing.
  const int halvings = beyond > 0.0 ? 3 : 8;
  double share = 0.0;
  const auto pieces = [&](double from, double to, auto&& f) {
    double end = to;
    for (int i = 0; i < halvings; ++i) {
      const double middle = i + 1 < halvings ? 0.5 * (from + end) : from;
      gauss_legendre<6>(std::min(middle, end), std::max(middle, end), f);
      end = middle;
    }
  };
  const auto over_bearings = [&](double out, double weight) {
    // cos of the angle to the mirrored direction: sin θᵢ sin θₛ + cos θᵢ cos θₛ cos φ
    const double edge = (std::cos(beyond) - sine * std::sin(out)) /
                        std::max(std::cos(grazing) * std::cos(out), 1e-12);
    if (edge <= -1.0) return;
    const double first = edge >= 1.0 ? 0.0 : std::acos(edge);
    pieces(first, pi, [&](double turn, double part) {
      share += 2.0 * part * weight * std::cos(out) *
               sigma(sines_of({.grazing_in = grazing, .grazing_out = out, .azimuth = turn}));
    });
  };
  pieces(grazing, 0.5 * pi, over_bearings);
  pieces(grazing, 0.0, over_bearings);
  return share / sine;
}

/// What a law sends nearer than this to the mirrored direction is what goes on along the path: laws
/// of scattering strength are not measured there, and the paths have it [rad].
inline constexpr double forward_lobe = pi / 6.0;

/// The share beyond the forward lobe of any law of a list, at grazing angles from 0 to π/2 and at
/// wavenumbers between those of two frequencies [Hz]. \param sound_speed  of the water at the
/// boundary [m/s]
template <class... Law>
[[nodiscard]] ScatteredElsewhere scattered_elsewhere(const std::variant<Law...>& law, double lowest,
                                                     double highest, double sound_speed) {
  constexpr std::size_t angles = 91;
  const int steps =
      highest > lowest ? 1 + static_cast<int>(std::ceil(std::log2(highest / lowest))) : 0;
  ScatteredElsewhere table{.wavenumbers = {}, .share = {}, .angles = angles};
  for (int i = 0; i <= steps; ++i) {
    const double frequency =
        steps == 0 ? lowest : lowest * std::pow(highest / lowest, double(i) / steps);
    table.wavenumbers.push_back(2.0 * pi * frequency / sound_speed);
    for (std::size_t a = 0; a < angles; ++a) {
      // Below half a step the share of what hardly falls on the boundary: that of the first angle.
      const double grazing = 0.5 * pi * std::max(double(a), 0.5) / double(angles - 1);
      table.share.push_back(std::visit(
          [&](const auto& model) {
            return scattered_share(model, grazing, frequency, forward_lobe);
          },
          law));
    }
  }
  return table;
}

}  // namespace asdic::detail
