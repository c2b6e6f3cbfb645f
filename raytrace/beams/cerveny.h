#pragma once
#include <complex>

#include "raytrace/beams/beam.h"

namespace asdic::detail::beams {

/// ε = Q/P at the source [m²/s]: iω·w²/2 for a beam of half-width w whose front is flat there; real
/// for WKB beams, whose fronts are those of one horizontal slowness in a layered ocean.
/// \param last_range  [m] of the receivers: where beams of Width::cerveny are to be narrowest
[[nodiscard]] std::complex<double> initial_ratio(const BeamSetting& setting,
                                                 const RayTrajectory& ray, double last_range);

/// Q and P of a beam of complex curvature along a ray: a combination of the two real solutions that
/// changes only where a reflection's jump of p is not the standard one; and √(ε/Q), which follows Q
/// around 0 continuously (the KMAH index of the real case).
class ComplexBeam {
 public:
  ComplexBeam(CervenyBeams::Curvature curvature, double source_speed, std::complex<double> epsilon);

  [[nodiscard]] std::complex<double> q(const RayState& state) const noexcept {
    return point_ * state.q + plane_ * state.q_plane;
  }
  [[nodiscard]] std::complex<double> p(const RayState& state) const noexcept {
    return point_ * state.p + plane_ * state.p_plane;
  }
  /// √(ε/Q) at a state of the segment that the beam was followed to: Q turns by less than π in it.
  [[nodiscard]] std::complex<double> spread(const RayState& state) const noexcept;
  /// Goes on from one segment to the next.
  void pass(const RaySegment& before, const RaySegment& after) noexcept;

 private:
  void follow(const RayState& state) noexcept;

  std::complex<double> point_, plane_;  // (Q, P) = point·(q, p) + plane·(q_plane, p_plane)
  std::complex<double> last_;           // Q at the segment's begin
  std::complex<double> spread_ = 1.0;   // √(ε/Q) there
  double jump_factor_ = 1.0;
};

}  // namespace asdic::detail::beams
