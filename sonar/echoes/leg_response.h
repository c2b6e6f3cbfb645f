#pragma once
#include <complex>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "sonar/echoes/echo_path.h"
#include "sonar/paths/moving_paths.h"
#include "sonar/signal/band_response.h"
#include "sonar/signal/pulse.h"

namespace asdic::detail {

/// Largest number of frequencies at which a leg by waves is computed across a band.
inline constexpr std::size_t most_wave_frequencies = 65;
/// The same for a leg by rays, of which the boundaries' reflection alone is computed.
inline constexpr std::size_t most_ray_frequencies = 129;
/// Error that polynomials between those frequencies may have, over the greatest value: −48 dB.
inline constexpr double leg_response_error = 4e-3;

/// Responses known at a few frequencies of a band, polynomials between them.
struct SampledResponse {
  BandNodes nodes;
  std::vector<std::vector<std::complex<double>>> values;  ///< [nodes][responses]
  double error = 0.0;  ///< largest difference from what was computed between the nodes, over the
                       ///< greatest value, both root sums of squares over the responses

  [[nodiscard]] std::vector<std::complex<double>> at(double frequency) const;
};

/// Samples responses at Chebyshev–Lobatto points, twice as many until they foretell four of the
/// next ones to `error`, or there are `most`. \param responses  of a frequency [Hz]
[[nodiscard]] SampledResponse sampled_response(
    double centre, double half_width, double error, std::size_t most,
    const std::function<std::vector<std::complex<double>>(double)>& responses);

/// The paths of a leg between two places, as functions of frequency.
struct MetLeg {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< [m]
  Arrivals paths;                               ///< at the centre frequency
  double frequency = 0.0;                       ///< the centre [Hz]
  PathLimits limits = {};                       ///< within which they were found

  /// Whether any has the amplitude of waves.
  [[nodiscard]] bool by_waves() const noexcept;
};

/// The leg that a met path belongs to: `known`, or one of its own where it was met so far from
/// there that waves have another amplitude. \param path  number of the path in `known`
[[nodiscard]] PathOnLeg path_on_leg(const std::shared_ptr<const MetLeg>& known, std::size_t path,
                                    const Vec3& from, const MetPath& met);

/// Whether its amplitudes change with frequency otherwise than by absorption: those of waves do,
/// and those of rays off layers, off curves at several frequencies and off rough boundaries, but in
/// three dimensions.
[[nodiscard]] bool changes_with_frequency(const PropagationPaths& paths, const MetLeg& leg);

/// The amplitude of each path at another frequency; phases belong to the paths' delays at the
/// centre. Those of waves hold what absorption changes, those of rays do not. \return [leg.paths]
[[nodiscard]] std::vector<std::complex<double>> amplitudes_at(const PropagationPaths& paths,
                                                              const MetLeg& leg, double frequency);

/// Half of the band about a pulse's centre in which paths are computed [Hz]: where its spectrum is
/// less than 40 dB down, or twice as far as 99 % of its energy reach. Beyond it they are as at its
/// edge.
[[nodiscard]] double response_half_band(const Pulse& pulse) noexcept;

/// The same across a band. Paths by waves that the band does not resolve share their sum as at the
/// centre. \param centre, half_width  [Hz]
[[nodiscard]] SampledResponse leg_response(const PropagationPaths& paths, const MetLeg& leg,
                                           double centre, double half_width);

/// Whether a band is so narrow that the leg's waves cannot change across it by a share `least` of
/// their amplitude. \param half_width  [Hz]
[[nodiscard]] bool too_narrow_to_change(const MetLeg& leg, double half_width, double least);

}  // namespace asdic::detail
