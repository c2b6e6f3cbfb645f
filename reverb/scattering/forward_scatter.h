#pragma once
#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "core/units.h"
#include "raytrace/ocean/arrivals.h"
#include "raytrace/ocean/environment.h"

namespace asdic::detail {

/// One way of the sound between two ends, along one path.
struct ScatteredLeg {
  const Arrival* path = nullptr;
  Vec2 from = Vec2::Zero();  ///< where it begins, on the map [m]
  double bearing = 0.0;      ///< of travel [rad]
  double start = 0.0;        ///< when, since the start of the scenario [s]
};

/// One of the parts into which what rough boundaries scatter about a path is drawn.
struct ScatteredPart {
  std::complex<double> amplitude = 0.0;  ///< over the root of the intensity scattered: the mean of
                                         ///< Σ|amplitude|² over the parts is 1
  double delay = 0.0;                    ///< after the mirrored path [s]
  double shift = 0.0;                    ///< of the frequency [Hz]
  double elevation = 0.0;  ///< of travel at the end of the last leg, over the mirrored path's [rad]
  double bearing = 0.0;    ///< the same [rad]
};

/// What a rough boundary scatters about the mirrored path, as a sum of plane waves of the sea.
///
/// Kirchhoff's mean intensity e^{−G²(1−ρ)}, ρ the correlation of heights over place and time,
/// without its mean part, is Σ_{n≥1} e^{−G²}G^{2n}ρⁿ/n!: n waves of the sea, each drawn from its
/// spectrum, add their wavenumbers K and frequencies ±√(gK) to the sound's, n by Poisson's law of
/// mean G². One wave is first-order perturbation, many are slopes of Kirchhoff's approximation. The
/// sound meets the boundary where the ends of the path are joined by straight ways, as long as the
/// path's: where K is k(cos θ₂ − cos θ₁) of one wave, where the slope K/(2k sin θ) mirrors of many.
/// Two kinks δ of one leg of length L, at s_i and s_j, add δ_i δ_j s_<(L − s_>)/L besides. Each
/// part has a complex Gaussian weight and the phase Ωt − K·x of its waves at the places of the
/// bounces: so it changes from ping to ping, from place to place. docs/theory/surface-scattering.md
///
/// Draws are keyed by the seed and `entity`; they do not depend on the ping.
/// \param entity  which path of what, the same from ping to ping   \param frequency  [Hz]
/// \return none where nothing is rough
[[nodiscard]] std::vector<ScatteredPart> forward_scatter(const Environment& ocean,
                                                         std::span<const ScatteredLeg> legs,
                                                         double frequency, int parts,
                                                         std::uint64_t seed, std::uint64_t entity,
                                                         Sea sea = Sea::isotropic);

/// How far forward_scatter() shifts a frequency at most, over it: by four standard deviations of
/// the sea's vertical velocity, 0.0646·U, and by one wave of twice the sound's wavenumber. 0 where
/// the surface is smooth.
[[nodiscard]] double scatter_doppler(const Environment& ocean, double frequency);

/// A number that names a path from ping to ping: how often it met what, and how it began.
[[nodiscard]] std::uint64_t scatter_history(const Arrival& path) noexcept;

}  // namespace asdic::detail
