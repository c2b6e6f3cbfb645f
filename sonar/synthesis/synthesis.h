#pragma once
#include <complex>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/propagation_memory.h"
#include "sonar/paths/delay_curve.h"
#include "sonar/paths/return_source.h"
#include "sonar/signal/pulse.h"
#include "sonar/signal/recording.h"

namespace asdic::detail {

struct BandNodes;
struct CovarianceDraw;
struct ReverberationCovariance;
struct ReverberationStreams;

/// Complex baseband of every phone: p₊(t)·e^{−i2πf_c t}, |·| is the peak envelope.
///
/// A row is one period of the synthesis: its first `recorded` samples cover the record, the rest is
/// the overlap that keeps pulses from wrapping into it, and that interpolation to the phones' rate
/// needs.
struct Baseband {
  double carrier = 0.0;      ///< f_c [Hz], within one FFT bin of the pulse's centre frequency
  double sample_rate = 0.0;  ///< [Hz]
  double start = 0.0;        ///< [s]
  std::size_t channels = 0, samples = 0;
  std::size_t recorded = 0;                 ///< samples of a row that lie within the record
  double oversampling = 1.35;               ///< sample_rate over the width of its band, at least
  std::vector<std::complex<float>> values;  ///< [channels × samples]

  [[nodiscard]] std::span<const std::complex<float>> channel(std::size_t n) const {
    return {values.data() + n * samples, samples};
  }
};

/// Puts the channels of another array under those that are there. Both of one synthesizer.
void append_channels(Baseband& all, Baseband&& more);

/// Turns sparse returns into phones' time series: band-limited impulse responses, convolved with
/// the pulse by FFT in complex baseband, Doppler by a low-rank (Chebyshev) expansion over the span
/// of factors; passband by FFT interpolation at the end. Built once per pulse, recording and band
/// of Doppler factors; immutable, shared by threads, deterministic for any number of them. Error
/// below −80 dB of the strongest return against direct_synthesis(). Source:
/// docs/theory/synthesis.md
class Synthesizer {
 public:
  /// \param max_doppler  largest |η − 1| any return will have
  /// \throws InputError ("sample_rate") if the phones' sampling is too slow for the band
  /// \param filter  real response that the pulse is passed through, over the frequency from its
  /// centre [Hz]; none: 1. What is added up of several is of the same shape whatever the filter.
  Synthesizer(const Pulse& pulse, const Recording& recording, double max_doppler,
              const std::function<double(double)>& filter = {});
  /// The same of several frequency responses: what a source's returns are across the band is Σ_k
  /// a_k·(the pulse through filter k).
  Synthesizer(const Pulse& pulse, const Recording& recording, double max_doppler,
              const std::vector<std::function<double(double)>>& filters);
  /// The first, unfiltered, out of what is kept for an equal pulse, recording and Doppler bound:
  /// the same bits. The waveforms of curved returns are kept as well. \param memory  must outlive
  /// this
  Synthesizer(const Pulse& pulse, const Recording& recording, double max_doppler,
              PropagationMemory& memory);
  ~Synthesizer();
  Synthesizer(Synthesizer&&) noexcept;

  /// \param phones  [n] positions relative to the array's reference point [m]
  /// \return baseband [n × samples] in units of the peak source pressure at 1 m. Returns outside
  /// the record are cut, not wrapped.
  [[nodiscard]] Baseband baseband(std::span<const Return> returns,
                                  std::span<const Vec3> phones) const;
  /// The same of returns that are made on the way. Memory is that of the phones' baseband and, if
  /// these are more, some 64 MB each for impulse responses and for returns, whatever their number.
  [[nodiscard]] Baseband baseband(const ReturnSource& source, std::span<const Vec3> phones) const;

  /// Adds returns whose delays are curves, one by one: cost returns × samples of a pulse × the
  /// fewer of phones and of lags between which a return's waveform is smooth.
  void add_curved(std::span<const CurvedReturn> returns, std::span<const Vec3> phones,
                  Baseband& baseband) const;

  /// Nothing received at some phones. \param memory  used for the samples, if it is large enough
  [[nodiscard]] Baseband silence(std::size_t phones,
                                 std::vector<std::complex<float>> memory = {}) const;

  /// Nothing received yet at a covariance's phones, on a grid for its sound alone: where samples
  /// are interpolated from it, as coarse as its band and levels every 50 ms allow. Else as the
  /// other.
  [[nodiscard]] Baseband silence(const ReverberationCovariance& covariance,
                                 std::vector<std::complex<float>> memory = {}) const;

  /// Adds reverberation of a known covariance: at every sample of the baseband a Gaussian impulse
  /// at all phones, through the pulse. \param baseband  of as many phones as the covariance has;
  /// one of this synthesizer's silences, at least
  void add_gaussian(const ReverberationCovariance& covariance, const CovarianceDraw& draw,
                    Baseband& baseband) const;

  /// The same for streams.
  [[nodiscard]] Baseband silence(const ReverberationStreams& sea, std::size_t phones,
                                 std::vector<std::complex<float>> memory = {}) const;

  /// Adds reverberation that is known as streams of noise, through the pulse. \param phones  [n]
  /// relative to where the streams are received, no further apart than they were made for [m]
  /// \param baseband  of as many phones, one of this synthesizer's silences, at least
  /// \param heard  blocks of delay that are not heard are left out
  void add_streams(const ReverberationStreams& sea, std::span<const Vec3> phones,
                   const CovarianceDraw& draw, Baseband& baseband,
                   const HeardPart& heard = {}) const;

  /// The pulse has nothing further than this from its centre frequency [Hz].
  [[nodiscard]] double half_band() const noexcept;

  /// Adds scale·p₊ to the phones' samples: its real part where they are pressure, p₊·e^{−i2πf(t +
  /// epoch)}, real and imaginary part in turn, where they are complex. \param samples [channels ×
  /// recording.samples × components], row per phone
  void add_samples(const Baseband& baseband, double scale, std::span<float> samples) const;

 private:
  void add_passband(const Baseband& baseband, double scale, std::span<float> pressure) const;
  void add_complex(const Baseband& baseband, double scale, std::span<float> samples) const;
  [[nodiscard]] bool interpolates() const noexcept;
  void add_by_fft(const Baseband& baseband, double scale, std::span<float> samples) const;
  void add_by_interpolation(const Baseband& baseband, double scale, std::span<float> samples) const;
  [[nodiscard]] Baseband silence_of(std::size_t phones, std::size_t length, double oversampling,
                                    std::vector<std::complex<float>> memory) const;
  [[nodiscard]] Baseband silence_of_band(std::size_t phones, double bins,
                                         std::vector<std::complex<float>> memory) const;
  /// Half the band of streams [Hz]: of any one about the pulse's frequency as it receives it, of
  /// all about the pulse's frequency.
  struct StreamBand {
    double one = 0.0, all = 0.0;
  };
  [[nodiscard]] StreamBand band_of(const ReverberationStreams& sea) const;
  struct CovarianceSpectra;
  [[nodiscard]] std::shared_ptr<const CovarianceSpectra> covariance_spectra(
      const BandNodes& band) const;

  friend class BlockSynthesis;
  friend class CurvedSynthesis;
  struct Plan;
  std::shared_ptr<const Plan> plan_;     // apart from this, it keeps FFTW's types out of the header
  double epoch_;                         // of the recording; a plan serves all
  PropagationMemory* memory_ = nullptr;  // null: nothing is kept
};

}  // namespace asdic::detail
