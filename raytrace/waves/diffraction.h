#pragma once
#include <optional>

#include "raytrace/ocean/arrivals.h"
#include "raytrace/ocean/environment.h"
#include "raytrace/waves/waterborne.h"

namespace asdic::detail {

/// What the water carries to a receiver that no ray reaches without the bottom: below a duct,
/// beyond a limiting ray, on the dark side of a caustic. One arrival of kind `diffracted`, the wave
/// equation's field at `frequency` with a bottom that returns nothing. Its delay is the
/// group delay there, its elevations follow from the mean horizontal slowness
/// and from which way the energy goes. docs/theory/waves.md, "Arrivals"
///
/// Nothing where a ray gets there, where the sound is 40 dB under the rays that touch the bottom or
/// 60 dB under spherical spreading, and where it would take more than `most_diffraction_steps`.
///
/// What places share is kept: an arrival nearby costs microseconds (waterborne.h).
/// \param ocean  is_layered()   \param rays  that were found   \param kept  where what places have
/// in common is kept; null: nowhere   \param beside_bottom  with what a bottom close below an end
/// sends back at once, as `reflection`: not where other paths hold it (put_waves())
[[nodiscard]] std::optional<Arrival> diffracted_arrival(const Environment& ocean,
                                                        double source_depth, double receiver_depth,
                                                        double range, double frequency,
                                                        const Arrivals& rays,
                                                        const OceanMemory* kept = nullptr,
                                                        bool beside_bottom = true);

/// The same whatever rays there are, for a path that is followed.
[[nodiscard]] std::optional<Arrival> diffracted_arrival(const Environment& ocean,
                                                        double source_depth, double receiver_depth,
                                                        double range, double frequency,
                                                        const OceanMemory* kept = nullptr,
                                                        bool beside_bottom = true);

/// About the pressure that waves without the bottom have at a place where the direct ray is in its
/// shadow, so that rays arrive off the surface alone, less these rays [1/m × 1 m]. It has no
/// arrival, because the errors of those rays are in it as well. Nothing where another ray arrives
/// without the bottom, and where it would be too dear. \param rays  of the leg
[[nodiscard]] std::optional<double> pressure_beside_surface_rays(const Environment& ocean,
                                                                 double source_depth,
                                                                 double receiver_depth,
                                                                 double range, double frequency,
                                                                 const Arrivals& rays);

/// Whether it is computed at all, or too dear. \param range  [m]
[[nodiscard]] bool diffraction_is_affordable(const Environment& ocean, double range,
                                             double frequency, const OceanMemory* kept = nullptr);

/// Layers times wavenumbers of one arrival: a second of one core.
inline constexpr double most_diffraction_steps = 3e6;

}  // namespace asdic::detail
