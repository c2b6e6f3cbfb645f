#pragma once
#include <memory>
#include <span>

#include "raytrace/layered/ray_at_range.h"
#include "raytrace/ocean/environment.h"

namespace asdic::detail {

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

}  // namespace asdic::detail
