#pragma once
#include <cstddef>
#include <vector>

#include "raytrace/beams/crossings.h"

namespace asdic::detail {

/// One ray of a fan where it crosses the columns, and what it foretells of its neighbours there.
struct RayAtColumns {
  Crossings crossings;
  std::vector<double> size, growth;  ///< [n] |q| and its change downwards along the column
  std::vector<double> cosine;        ///< [n] |cos θ|
  std::vector<double> higher;        ///< [n] +1: higher rays are deeper, −1: shallower
  std::vector<double> amplitude;     ///< [n] of the ray, squared where intensities are added
  std::vector<double> power;         ///< [n] amplitude² × |q|/cos θ
  std::vector<double> phase;         ///< [n] reflections, caustics and −ωτ [rad]
  std::vector<double> wave_number;   ///< [n] dφ/dz [rad/m]
  std::vector<double> least;         ///< [n] least σ of a Gaussian [m]; 0: a hat

  void resize(std::size_t n);  ///< all but the crossings
  /// Fills all but the crossings out of these.
  void foretell(const BeamSetting& setting, const BeamLaunch& launch);
};

}  // namespace asdic::detail
