#pragma once
#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "core/units.h"
#include "raytrace/ocean/arrivals.h"
#include "raytrace/ocean/environment.h"
#include "reverb/scattering/sea_draws.h"

namespace asdic::detail {

/// A bounce of a path off a rough boundary, as if straight lines of the path's length led to it.
struct RoughBounce {
  double coherent = 1.0;               ///< share of the energy that stays in the mean field
  double energy = 1.0;                 ///< share of the energy that is left in all
  double all_on = 1.0, mean_on = 1.0;  ///< products of `energy` and `coherent` from here on
  double mean_waves = 0.0;             ///< G²
  double scale = 0.0;                  ///< K of the spectrum: K² = scale²/(−ln u) [rad/m]
  double k = 0.0;                      ///< wavenumber of the sound [rad/m]
  double grazing = 0.0, sine = 0.0, cosine = 1.0;
  double along = 0.0;  ///< distance s along the path [m]
  double share = 0.0;  ///< share of the path's length and delay up to it
  double range = 0.0;  ///< horizontal distance to it [m]
  bool moves = false;  ///< whether it is off the surface, whose waves move
};

/// Change of direction at a bounce, with the waves of the sea that make it and turn the phase.
struct Kink {
  double down = 0.0, aside = 0.0;        ///< [rad]
  double out = 0.0;                      ///< θ₂ less the mirrored path's grazing angle [rad]
  double excess = 0.0;                   ///< added to the path's length [m]
  double along_way = 0.0, across = 0.0;  ///< wavenumber along the path and to its right [rad/m]
  double omega = 0.0;                    ///< frequency of the waves [rad/s]
};

/// Bounces of a path off rough boundaries, with the kinks that they give it in each part. All pairs
/// of paths to which the path belongs share them.
struct RoughPath {
  double length = 0.0, delay = 0.0;  ///< length and delay of the path [m], [s]
  std::vector<RoughBounce> bounces;  ///< in their order along it
  std::vector<Kink> kinks;           ///< [parts × bounces]
};

/// Draws the kinks of a path; they do not depend on the ping.
/// \param frequency  [Hz]   \param draws  of the scenario's seed
/// \param entity  which path of what, the same from ping to ping
[[nodiscard]] RoughPath rough_path(const Environment& ocean, const Arrival& path, double frequency,
                                   int parts, SeaDraws& draws, std::uint64_t entity);

/// One way of the sound between two ends, along one path.
struct ScatteredLeg {
  const RoughPath* path = nullptr;  ///< drawn with at least as many parts
  Vec2 from = Vec2::Zero();         ///< beginning, on the map [m]
  double bearing = 0.0;             ///< bearing of travel [rad]
  double start = 0.0;               ///< time at its beginning, since the start of the scenario [s]
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
/// The seed and `entity` key which bounces scatter, and the weights, so that both are the same from
/// ping to ping. The kinks are those of the paths (rough_path()).
/// \param frequency  [Hz]   \return none where nothing is rough
[[nodiscard]] std::vector<ScatteredPart> forward_scatter(const Environment& ocean,
                                                         std::span<const ScatteredLeg> legs,
                                                         double frequency, int parts,
                                                         std::uint64_t seed, std::uint64_t entity);

/// How far forward_scatter() shifts a frequency at most, over it: by four standard deviations of
/// the sea's vertical velocity, 0.0646·U, and by one wave of twice the sound's wavenumber. 0 where
/// the surface is smooth.
[[nodiscard]] double scatter_doppler(const Environment& ocean, double frequency);

/// A number that names a path from ping to ping: how often it met what, and how it began.
[[nodiscard]] std::uint64_t scatter_history(const Arrival& path) noexcept;

}  // namespace asdic::detail
