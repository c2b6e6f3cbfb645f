#pragma once
#include <complex>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sonar/signal/band_limited_pulse.h"
#include "sonar/signal/fft.h"
#include "sonar/synthesis/delay_kernel.h"
#include "sonar/synthesis/doppler_expansion.h"
#include "sonar/synthesis/synthesis.h"

namespace asdic::detail {

/// What a Synthesizer works out once: lengths, rates, the filtered pulse. Private to synthesis.
///
/// One period P holds the record and the pulses that hang over its ends, so nothing wraps into it.
/// P·sample_rate and P·baseband rate are both whole and products of 2, 3, 5, 7, and the carrier is
/// a whole number of 1/P: bin k of the baseband's FFT is bin k + carrier_bin of the passband's.
struct Synthesizer::Plan {
  Plan(const Pulse& pulse, const Recording& recording, double max_doppler,
       const std::vector<std::function<double(double)>>& filters);
  /// Of a sound that is no pulse: a return's delay is that of its middle.
  Plan(const BandLimitedPulse& sound, const Recording& recording, double max_doppler);

  /// Of the pulse as it is, out of `memory` if an equal one was made before.
  [[nodiscard]] static std::shared_ptr<const Plan> recalled(const Pulse& pulse,
                                                            const Recording& recording,
                                                            double max_doppler,
                                                            PropagationMemory& memory);

  std::uint64_t identity;  ///< for keys of what is worked out of it: no other plan's
  Recording recording;     ///< but for the epoch, which changes nothing here: 0
  double max_doppler;
  double pulse_duration;                 ///< T, unstretched [s]
  std::vector<BandLimitedPulse> pulses;  ///< [responses] through a filter each; alike but for that
  DopplerExpansion expansion;
  const DelayKernel& kernel = DelayKernel::shared();

  /// The period is a whole number of so many samples of the record, a power of two.
  std::size_t unit = 2;
  std::size_t length = 0;            ///< of the baseband FFT
  std::size_t passband_length = 0;   ///< of the real FFT at the phones' rate
  double rate = 0.0;                 ///< of the baseband [Hz]
  double carrier = 0.0;              ///< [Hz]
  std::ptrdiff_t carrier_bin = 0;    ///< carrier·P
  std::ptrdiff_t highest_bin = 0;    ///< the band is −highest_bin … highest_bin
  std::size_t lead = 0;              ///< grid samples before the record where impulses may lie
  double last_position = 0.0;        ///< of an impulse in the grid, in samples
  std::vector<float> deconvolution;  ///< [2·highest_bin + 1] 1/(kernel's spectrum · length)

  /// Times at which noise may have its impulses: whole numbers of 1/rate since the ping, the same
  /// ones in any record of it.
  struct Clock {
    double rate = 1.0;       ///< [Hz]
    std::size_t length = 0;  ///< impulses to a period
  };
  /// The slowest clock of at least that rate [Hz].
  [[nodiscard]] Clock clock(double least) const;

  /// A segment of the grid, or all of it, with an FFT of its own.
  struct Period {
    std::size_t length = 0;                ///< [samples]
    std::size_t lead = 0;                  ///< how much earlier than the impulse a pulse stands
    std::ptrdiff_t highest_bin = 0;        ///< of the same band
    std::span<const float> deconvolution;  ///< [2·highest_bin + 1]
  };
  [[nodiscard]] Period whole() const noexcept { return {length, lead, highest_bin, deconvolution}; }
  /// 1/(kernel's spectrum · length) at the bins of a period. \return [2·highest_bin + 1]
  [[nodiscard]] std::vector<float> deconvolution_of(std::size_t length,
                                                    std::ptrdiff_t highest_bin) const;

  /// Spectrum of a node's pulse over the kernel's spectrum and the FFT's length. \param scratch
  /// [on.length] \param spectrum [2·highest_bin + 1] from −highest_bin up
  void stretched_spectrum(const BandLimitedPulse& pulse, const DopplerNode& node, const Period& on,
                          std::complex<float>* scratch,
                          std::span<std::complex<float>> spectrum) const;

 private:
  /// \param sounds  [responses], and after several the one that none of them has filtered
  Plan(std::vector<BandLimitedPulse> sounds, double duration, std::size_t unit,
       const Recording& recording, double max_doppler);
};

}  // namespace asdic::detail
