#pragma once
#include <vector>

#include "raytrace/cases/propagation_case.h"

namespace asdic::detail {

/// The launch elevations of the beams of one source and the angle that each of them stands for.
struct BeamFan {
  std::vector<double> elevation;  ///< [n] increasing [rad], positive up
  double spacing = 0.0;           ///< Δα, mean angle from beam to beam [rad]
  bool graded = false;            ///< each beam reaches to its neighbours, else Δα to both sides

  /// Angle from beam i to the next higher one [rad]; beyond the ends as within.
  [[nodiscard]] double to_next(std::size_t i) const noexcept {
    const std::size_t k = i + 1 < elevation.size() ? i : i - 1;
    return elevation[k + 1] - elevation[k];
  }
};

/// Evenly from the lowest to the highest elevation, both included; of a full circle the last beam,
/// which is the first, is left out. \param count  ≥ 2
[[nodiscard]] BeamFan even_fan(double lowest, double highest, int count);

/// The elevations half way between those of an even fan: the two together are one of half the
/// spacing, which is theirs. Around a full circle also that between its last and its first.
[[nodiscard]] BeamFan fan_between(const BeamFan& even);

/// How narrow the tubes of a fan may get [rad].
struct FinestTubes {
  double width = 0.0;  ///< any of them
  double level = 0.0;  ///< those that hold an elevation below this (LevelRays::angle)
};

/// Some `count` beams, where a tube between two rays whose error has a share S of the whole is
/// divided in √S·λ equal parts (1 to 8): since an error falls at least as fast as the width, that
/// leaves the least Σ S for the number. Fewer where tubes are the finest already.
/// \param share  [beams − 1] ≥ 0
[[nodiscard]] BeamFan graded_fan(const BeamFan& fan, const std::vector<double>& share,
                                 std::size_t count, const FinestTubes& finest = {});

/// Exactly the elevations asked for (two or more). They are taken as evenly spaced.
[[nodiscard]] BeamFan given_fan(const std::vector<double>& elevations);

/// Amplitude with which the source launches a beam: its pattern and, for a semi-coherent field, the
/// Lloyd mirror √2·|sin φ|, φ = ω z_s sin α/c₀, of a surface at z = 0. Of a rough one, which leaves
/// the mean field m and the energy E, the beam that it mirrors and the one that goes down have
/// 1 + E − 2m cos 2φ together: each is launched with 1 − 2m/(1 + E)·cos 2φ of intensity.
[[nodiscard]] double launch_amplitude(const PropagationCase& run_case, double source_depth,
                                      double source_speed, double elevation) noexcept;

}  // namespace asdic::detail
