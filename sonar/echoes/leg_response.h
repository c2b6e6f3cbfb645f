#pragma once
#include <complex>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "sonar/echoes/echo_path.h"
#include "sonar/paths/moving_paths.h"
#include "sonar/signal/band_response.h"

namespace asdic::detail {

/// Frequencies at which a leg by waves is computed across a band, at most.
inline constexpr std::size_t most_wave_frequencies = 65;
/// The same of a leg by rays, of which the boundaries' reflection alone is computed.
inline constexpr std::size_t most_ray_frequencies = 129;
/// Of the greatest value across the band: what is left between those frequencies.
inline constexpr double leg_response_error = 1e-3;

/// Responses known at a few frequencies of a band, polynomials between them.
struct SampledResponse {
  BandNodes nodes;
  std::vector<std::vector<std::complex<double>>> values;  ///< [nodes][responses]
  double error = 0.0;  ///< of the last nodes added, as those before foretold them, over the
                       ///< greatest, both root sums of squares over the responses

  [[nodiscard]] std::vector<std::complex<double>> at(double frequency) const;
};

/// At the ends, the middle and so on: Chebyshev–Lobatto points, twice as many until those added are
/// foretold to `error`, or there are `most`. \param responses  of a frequency [Hz]
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

/// The same across a band. \param centre, half_width  [Hz]
[[nodiscard]] SampledResponse leg_response(const PropagationPaths& paths, const MetLeg& leg,
                                           double centre, double half_width);

/// Whether a band is so narrow that the leg's waves cannot change across it by a share `least` of
/// their amplitude. \param half_width  [Hz]
[[nodiscard]] bool too_narrow_to_change(const MetLeg& leg, double half_width, double least);

}  // namespace asdic::detail
