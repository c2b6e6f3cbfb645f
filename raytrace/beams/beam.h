#pragma once
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "raytrace/cases/propagation_case.h"
#include "raytrace/tracing/ray_trajectory.h"

namespace asdic::detail {

/// What all beams of a field have in common.
struct BeamSetting {
  BeamKind kind = BeamKind::hat;
  bool coherent = true;                          ///< pressures are added, else intensities
  bool point_source = true;                      ///< spreads into the third dimension too
  Spreading spreading = Spreading::cylindrical;  ///< and then by this law
  double frequency = 1000.0;                     ///< [Hz]
  double spacing = 0.0;                          ///< Δα, angle from beam to beam [rad]
  CervenyBeams cerveny;
  const Environment* environment = nullptr;  ///< where images of Cerveny beams are mirrored
};

/// One beam as it leaves the source.
struct BeamLaunch {
  double elevation = 0.0;  ///< [rad], positive up
  double amplitude = 1.0;  ///< the source's pattern there
  /// Angles to the next higher and lower ray, where a graded fan has hats of two unequal halves
  /// (0: no half on that side) [rad]. Both 0: BeamSetting::spacing.
  double higher = 0.0, lower = 0.0;
};

/// Receivers and what has arrived at them: columns of equal range, one after the other.
struct FieldSum {
  std::span<const double> ranges;  ///< [m] increasing [m]
  std::span<const double> depths;  ///< [n] increasing [m]; irregular: [m], one for each range
  bool irregular = false;
  std::vector<std::complex<double>> sum;  ///< [m × rows] pressure, or intensity in the real part

  [[nodiscard]] std::size_t rows() const noexcept { return irregular ? 1 : depths.size(); }
  [[nodiscard]] std::span<const double> column_depths(std::size_t column) const noexcept {
    return irregular ? depths.subspan(column, 1) : depths;
  }
  [[nodiscard]] std::complex<double>* column(std::size_t column) noexcept {
    return sum.data() + column * rows();
  }
};

/// Adds what one ray and the beam around it bring to every receiver, without the factor of range
/// that is the same for all beams (field_scale). Plain, one receiver at a time: the reference for
/// whatever is faster. docs/theory/beams.md
void add_beam(const BeamSetting& setting, const BeamLaunch& launch, const RayTrajectory& ray,
              FieldSum& field);

/// What is left to multiply a pressure with: 1/√|r| for a point source that spreads cylindrically,
/// 1 for one whose crossings know how it spreads, 0 for either at r = 0, where the way up or down
/// is no crossing; 4√π, which is BELLHOP's choice, for a line source.
[[nodiscard]] double field_scale(const BeamSetting& setting, double range) noexcept;

}  // namespace asdic::detail
