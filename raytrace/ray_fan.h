#pragma once
#include <complex>
#include <memory>
#include <span>

#include "raytrace/environment.h"

namespace asdic {

/// A ray and its beam where it first crosses a range.
struct RayAtRange {
  bool arrived = false;    ///< false: it turned back, or a boundary kept it
  double depth = 0.0;      ///< [m]
  double elevation = 0.0;  ///< of travel there, positive up [rad]
  double time = 0.0;       ///< τ [s]
  double q = 0.0;          ///< ∂n/∂(launch angle) [m/rad]
  double p = 0.0;          ///< dq/ds = c·p
  int surface_bounces = 0, bottom_bounces = 0, turns = 0, caustics = 0;
  std::complex<double> reflection = 1.0;  ///< product of the boundaries' coefficients
};

/// A fan of dynamic rays at one range, without their paths: what a search starts from, or a plot of
/// depth over angle. Any ocean; where the speed is linear in depth between samples and the
/// boundaries are flat, whole cycles of a ray are counted instead of followed. Built once per
/// environment, frequency and source; const and shared by threads.
class RayFan {
 public:
  /// \param environment  must outlive this \param frequency  of reflections [Hz]
  /// \param source_depth  at range 0 [m]
  RayFan(const Environment& environment, double frequency, double source_depth);
  ~RayFan();

  /// \param elevations  [n] positive up [rad], within ±π/2 \param range  > 0 [m] \param out  [n]
  void trace(std::span<const double> elevations, double range, std::span<RayAtRange> out) const;

 private:
  struct Solvers;
  std::unique_ptr<const Solvers> solvers_;
};

}  // namespace asdic
