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
/// Largest number for a leg by rays, for which only the boundaries' reflection is computed.
inline constexpr std::size_t most_ray_frequencies = 129;
/// Tolerated error of the polynomials between frequencies, over the largest value: of a few, and of
/// 33 and more, each of which costs as much as the centre.
struct ResponseError {
  double few = 4e-3;     ///< −48 dB
  double many = 1.2e-2;  ///< −38 dB
};

/// Responses at a few frequencies of a band, interpolated by polynomials.
struct SampledResponse {
  BandNodes nodes;
  std::vector<std::vector<std::complex<double>>> values;  ///< [nodes][responses]
  double error = 0.0;  ///< largest difference from values computed between the nodes, over the
                       ///< largest value; both are root sums of squares over the responses

  [[nodiscard]] std::vector<std::complex<double>> at(double frequency) const;
  /// Greatest energy at a node: sum of squares over the responses.
  [[nodiscard]] double energy() const;
  /// Degree of a polynomial that leaves out what ResponseError tolerates: of many nodes all of it,
  /// of a few half. \param loudest  energy of the loudest leg beside it, of which that is a share
  [[nodiscard]] std::size_t degree(double loudest = 0.0) const;
};

/// Samples responses at Chebyshev–Lobatto points, and doubles their number until they predict four
/// of the next ones to `error`, or there are `most`.   \param responses  functions of a frequency
/// [Hz]
[[nodiscard]] SampledResponse sampled_response(
    double centre, double half_width, const ResponseError& error, std::size_t most,
    const std::function<std::vector<std::complex<double>>(double)>& responses);

/// The paths of a leg between two places, as functions of frequency.
struct MetLeg {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< [m]
  Arrivals paths;                               ///< at the centre frequency
  double frequency = 0.0;                       ///< the centre [Hz]
  PathLimits limits = {};                       ///< limits of their search

  /// Whether any path has the amplitude of waves.
  [[nodiscard]] bool by_waves() const noexcept;
};

/// Leg of a met path: `known`, or a leg of its own if it was met so far away that the amplitude of
/// waves differs.   \param path  number of the path in `known`
[[nodiscard]] PathOnLeg path_on_leg(const std::shared_ptr<const MetLeg>& known, std::size_t path,
                                    const Vec3& from, const MetPath& met);

/// Whether a leg's amplitudes depend on frequency by more than absorption. Those of waves do, and
/// those of rays off layers, off curves at several frequencies and off rough boundaries. Rays in
/// three dimensions count as independent of it.
[[nodiscard]] bool changes_with_frequency(const PropagationPaths& paths, const MetLeg& leg);

/// Amplitude of each path at another frequency, with phases for the delays at the centre.
/// Amplitudes of waves include the change of absorption, those of rays do not.   \return
/// [leg.paths]
[[nodiscard]] std::vector<std::complex<double>> amplitudes_at(const PropagationPaths& paths,
                                                              const MetLeg& leg, double frequency);

/// Half width of the band about a pulse's centre in which paths are computed [Hz]. It reaches to
/// where the spectrum is 40 dB down, or twice as far as 99 % of the energy. Beyond it the
/// amplitudes are those at its edge.
[[nodiscard]] double response_half_band(const Pulse& pulse) noexcept;

/// Time by which a response that is sampled over that band delays sound at most [s].
[[nodiscard]] inline double delay_of_response(const Pulse& pulse) noexcept {
  return 32.0 / response_half_band(pulse);
}

/// Amplitudes of a leg's paths across a band. Paths by waves that the band does not resolve share
/// their sum as at the centre.   \param centre, half_width  [Hz]
[[nodiscard]] SampledResponse leg_response(const PropagationPaths& paths, const MetLeg& leg,
                                           double centre, double half_width);

/// Whether a band is too narrow for the leg's waves to change across it by a share `least` of their
/// amplitude.   \param half_width  [Hz]
[[nodiscard]] bool too_narrow_to_change(const MetLeg& leg, double half_width, double least);

}  // namespace asdic::detail
