#pragma once
#include <complex>
#include <cstdint>
#include <vector>

namespace asdic::detail {

enum class BoundaryKind : std::uint8_t { surface, bottom };

/// One meeting of a ray with a boundary.
struct Bounce {
  BoundaryKind boundary = BoundaryKind::surface;
  double grazing = 0.0;  ///< angle between ray and boundary [rad]
  double range = 0.0;    ///< horizontal distance from the source [m]
};

/// What an arrival is.
enum class ArrivalKind : std::uint8_t {
  ray,
  diffracted,  ///< where no ray comes: waves/diffraction.h. No bounces, turns or q
  caustic,     ///< a ray with waves' amplitude: waves/caustics.h, waves/cycles.h
};

/// One eigenray: a path that sound takes from a source to a receiver. Unit source at 1 m; neither
/// source level nor directivity.
///
/// Elevations are positive up and tell the direction of *travel*: seen from the receiver the sound
/// comes from −arrival_elevation. Time dependence e^{+iωt}: a caustic multiplies by e^{+iπ/2}, a
/// pressure-release surface by −1. The stored pressure of the path is Re{amplitude · s₊(t −
/// delay)}, s₊ the analytic pulse.
struct Arrival {
  ArrivalKind kind = ArrivalKind::ray;
  double launch_elevation = 0.0;   ///< [rad]
  double arrival_elevation = 0.0;  ///< [rad]
  /// By how much the way that sound travels is turned clockwise from the straight line on the map,
  /// where it leaves and where it arrives; 0 where rays keep to a vertical plane [rad]
  double launch_deflection = 0.0;
  double arrival_deflection = 0.0;  ///< [rad]
  double delay = 0.0;               ///< τ [s]
  std::complex<double> amplitude =
      0.0;                 ///< spreading × reflections × absorption × caustic phase [1/m × 1 m]
  double spreading = 0.0;  ///< |amplitude| of the ray tube alone, tube_amplitude() [1/m × 1 m]
  std::complex<double> reflection = 1.0;  ///< product of the boundaries' coefficients
  /// What rough boundaries scatter about the path: |amplitude|² + scattered is the mean intensity
  /// that arrives along it, |amplitude|² that of the mean field [1/m² × 1 m²]
  double scattered = 0.0;
  double absorption_db = 0.0;  ///< along the path [dB]
  double q = 0.0;            ///< ∂n/∂(launch elevation), signed by the caustics passed [m/rad]
  double path_length = 0.0;  ///< [m]
  double horizontal_slowness = 0.0;  ///< Snell's invariant cos θ/c [s/m]
  int surface_bounces = 0;
  int bottom_bounces = 0;
  int upper_turns = 0;          ///< turning points below the surface
  int lower_turns = 0;          ///< turning points above the bottom
  int caustics = 0;             ///< zeros of q passed
  std::vector<Bounce> bounces;  ///< in the order in which they happen
};

/// True bearings of travel at both ends. \param line  of the straight line between them [rad]
[[nodiscard]] inline double launch_bearing(const Arrival& path, double line) noexcept {
  return line + path.launch_deflection;
}
[[nodiscard]] inline double arrival_bearing(const Arrival& path, double line) noexcept {
  return line + path.arrival_deflection;
}

/// Eigenrays from one source to one receiver, sorted by delay.
using Arrivals = std::vector<Arrival>;

}  // namespace asdic::detail
