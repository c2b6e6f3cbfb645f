#pragma once
#include <complex>
#include <functional>
#include <span>
#include <vector>

#include "sonar/echoes/echo.h"
#include "sonar/signal/band_response.h"

namespace asdic::detail {

/// Frequencies at which a wave's amplitude is computed across a band, at most.
inline constexpr std::size_t most_wave_frequencies = 33;
/// Of its greatest value across the band: what is left between those frequencies.
inline constexpr double wave_response_error = 1e-3;

/// A response known at a few frequencies of a band, a polynomial between them.
struct SampledResponse {
  BandNodes nodes;
  std::vector<std::complex<double>> values;  ///< [nodes]
  double error =
      0.0;  ///< of the last nodes added, as those before foretold them, over the greatest

  [[nodiscard]] std::complex<double> at(double frequency) const noexcept;
};

/// At the ends, the middle and so on: Chebyshev–Lobatto points, twice as many until those added are
/// foretold to `error`, or there are `most`. \param response  of a frequency [Hz]
[[nodiscard]] SampledResponse sampled_response(
    double centre, double half_width, double error, std::size_t most,
    const std::function<std::complex<double>(double)>& response);

/// A leg whose amplitude is a wave's, a function of frequency of its own: not of kind `ray`.
struct WaveLeg {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< [m]
  Arrival path;                                 ///< at the centre frequency
  PathLimits limits;                            ///< within which it was found
};

/// What the amplitude of such a leg is at another frequency, over that of the leg as it stands. Its
/// phase belongs to the leg's delay. \param frequency  [Hz]
[[nodiscard]] std::complex<double> wave_response(const PropagationPaths& paths, const WaveLeg& leg,
                                                 double frequency);

/// The same across a band. \param centre, half_width  [Hz]
[[nodiscard]] SampledResponse wave_response(const PropagationPaths& paths, const WaveLeg& leg,
                                            double centre, double half_width);

/// The legs of an echo or a blast that are no rays, met where things are by then. \param legs  that
/// its paths belong to
[[nodiscard]] std::vector<WaveLeg> wave_legs(const EchoContext& context, const EchoPath& received,
                                             std::span<const Leg> legs);

}  // namespace asdic::detail
