#pragma once
#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "raytrace/ground_paths.h"
#include "reverb/scattering/models.h"

namespace asdic {

/// One way that sound takes to a ground cell and back: an outgoing and a returning path. Unit
/// source at 1 m, omnidirectional both ways; the whole ring of the cell.
struct Patch {
  std::uint32_t cell = 0;  ///< of the ground grid: the weight's key
  double range = 0.0;      ///< of the cell's centre [m]
  double area = 0.0;       ///< of the ring [m²]
  double delay = 0.0;      ///< there and back [s]
  std::complex<double> amplitude =
      0.0;  ///< A_out·A_back·√(σ·area): pressure at 1 m of the receiver's side per unit weight
  double cross_section = 0.0;                  ///< σ(θ_in, θ_out) [1/sr]
  double grazing_in = 0.0, grazing_out = 0.0;  ///< [rad]
  double launch_elevation = 0.0;               ///< of the outgoing path [rad]
  double return_elevation = 0.0;  ///< of the returning path *as launched from the receiver* [rad]:
                                  ///< the sound arrives from there
  double outgoing_slowness = 0.0, returning_slowness = 0.0;  ///< Snell invariants [s/m]
};

/// How a cell of a surface that is not level answers, against the same cell seen in the plane of
/// the rays alone.
struct CellTilt {
  double grazing = 1.0;  ///< sin of the angle to the surface over sin of the angle to its line in
                         ///< the plane (GroundPath::grazing): √(1 + h′²cos²β)/√(1 + h′²)
  double area = 1.0;  ///< of the sloping facet over its horizontal projection: √(1 + h′²)
};

/// All pairs of paths to every ground cell and back to the source (monostatic), cell by cell.
/// Within a cell, pairs more than 80 dB below its strongest are dropped. The pairs of one cell
/// share one random weight and add coherently, so that (a, b) and (b, a) enhance as reciprocity
/// demands. \param tilt  of every cell; empty where the surface is level
[[nodiscard]] std::vector<Patch> patches(const GroundPaths& ground,
                                         const AnySurfaceScattering& scattering, double frequency,
                                         std::span<const CellTilt> tilt = {});

/// Spacing of the ground grid [m]: the two-way delay from cell to cell is 1/(2B), B the full −40 dB
/// bandwidth of the pulse. The mean intensity is the pulse's |s|² sampled at the cells' delays; its
/// spectrum ends at B (−40 dB), so that at twice that rate the sum has no ripple (a 1 s CW would
/// get 187 m by c·τ/4, and a staircase).
[[nodiscard]] double ground_spacing(double bandwidth_40db, double surface_sound_speed) noexcept;

}  // namespace asdic
