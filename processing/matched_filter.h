#pragma once
#include <complex>
#include <span>
#include <vector>

#include "processing/replica.h"
#include "sonar/signal/fft.h"
#include "sonar/signal/pulse.h"
#include "sonar/signal/recording.h"
#include "sonar/synthesis/synthesis.h"

namespace asdic::detail {

/// What the filter matched to η = 1 makes of an echo of another Doppler factor.
struct DopplerAnswer {
  double response = 1.0;  ///< |χ|, where most is left of it; 1 at η = 1
  double delay = 0.0;     ///< and by how much that is late [s]
};
/// \param sub_bands  as of MatchedFilterBank: the mean of theirs, as |χ|²
[[nodiscard]] DopplerAnswer doppler_answer(const Replica& replica, double doppler,
                                           int sub_bands = 1);

/// Where a pulse's band is cut into parts of equal energy, without the outermost ends [Hz].
/// \return [parts − 1]
[[nodiscard]] std::vector<double> sub_band_edges(const Replica& replica, int parts);

/// Half the span of factors in which a filter answers within 3 dB.
[[nodiscard]] double doppler_cell(const Replica& replica, int sub_bands = 1);

/// How far around an echo a background must be left out that the filter's own answer to it would
/// otherwise be: 0 where that is below −24 dB in the mean between two delays, else the last delay
/// with an answer over −30 dB. Side lobes of sweeps and tones are; those of combs, trains and
/// Costas pulses reach as far as the pulse is long. \param first, last  of the background [s]
[[nodiscard]] double reach_of_answer(const Replica& replica, double first, double last);

/// Mean of the filter's own answer between two delays, 1 at the echo; what of the pulse's length
/// lies between. \param first, last [s]
[[nodiscard]] double mean_answer(const Replica& replica, double first, double last,
                                 int sub_bands = 1);

/// The loudest answer beside the echo's own, past where it has fallen below a quarter of it.
struct Nail {
  double offset = 0.0;  ///< of the delay [s], or of the Doppler factor
  double power = 0.0;   ///< of the answer, 1 at the echo
};
[[nodiscard]] Nail nail_in_delay(const Replica& replica);
/// \param span  of offsets of the factor; at most the first 200 resolution cells of it
[[nodiscard]] Nail nail_in_doppler(const Replica& replica, double span);

/// Ambiguity surface |χ(τ, η)|² of a pulse: the answer of the filter matched to η = 1 to an echo of
/// factor η and delay τ. \return [dopplers × delays], 1 at (0, 1)
[[nodiscard]] std::vector<double> ambiguity(const Replica& replica, std::span<const double> delays,
                                            std::span<const double> dopplers);

/// Factors 1 − span … 1 + span, evenly spaced and 1 among them, so close that an echo between two
/// of them loses at most `loss_db`: every half cycle over the pulse for a tone (0.5/T [Hz]), few
/// for a wide sweep. \throws InputError ("max_speed") if more than 20 000 were needed
[[nodiscard]] std::vector<double> doppler_bank(const Replica& replica, double span,
                                               double loss_db = 0.25, int sub_bands = 1);

/// Filters matched to an echo at each of many Doppler factors.
///
/// y(τ) = ∫ p₊(t)·s₊*(η(t − τ)) dt / ∫|s₊(ηt)|²dt: an echo A·s₊(η(t − τ₀)) gives |y| = |A| at its
/// leading edge τ₀; real noise of one-sided density N₀ gives E|y|² = 2N₀/E, E = ∫|s₊|²dt/η. Only
/// the bins where the pulse has energy are transformed back, so a tone's output is as slow as it
/// may be. Built once per replica and baseband; const and shared by threads. Source:
/// docs/theory/processing.md, eq. (3)
class MatchedFilterBank {
 public:
  /// \param like  rows of the same rate, carrier, start and length are filtered
  /// \throws InputError ("dopplers") if a filter lies outside the band
  /// \param sub_bands  of equal energy, each filtered by itself: power() is their mean
  MatchedFilterBank(const Replica& replica, std::span<const double> dopplers, const Baseband& like,
                    int sub_bands = 1);

  [[nodiscard]] std::size_t filters() const noexcept { return dopplers_.size(); }
  [[nodiscard]] double doppler(std::size_t k) const noexcept { return dopplers_[k]; }
  [[nodiscard]] double sample_rate() const noexcept { return rate_; }  ///< of the output [Hz]
  /// Samples of the output that lie within the record; the first at its start.
  [[nodiscard]] std::size_t samples() const noexcept { return samples_; }
  [[nodiscard]] double time(double sample) const noexcept { return start_ + sample / rate_; }

  /// The spectrum of a row, as filter() wants it. \param row [like.samples] \param out the same
  void transform(std::span<const std::complex<float>> row, std::complex<float>* out) const;
  /// y of filter k, without the phase of the carrier. \param work, out  work() long, an FftBuffer;
  /// the first samples() of it are meant
  void filter(std::size_t k, const std::complex<float>* spectrum, std::complex<float>* out) const;
  /// |y|² of filter k; of sub-bands the mean of theirs, each with its own energy in the place of E,
  /// so that an echo of amplitude A gives |A|² still. All are matched at one factor η, and so an
  /// echo of that factor comes at one time in all of them: sweeps are aligned along their ridge.
  /// Source: docs/theory/continuous.md   \param work  as `out` of filter()   \param out [samples()]
  void power(std::size_t k, const std::complex<float>* spectrum, std::complex<float>* work,
             float* out) const;
  [[nodiscard]] int sub_bands() const noexcept { return sub_bands_; }
  [[nodiscard]] std::size_t work() const noexcept { return length_; }

 private:
  void filter(std::size_t k, const std::complex<float>* spectrum, std::ptrdiff_t from,
              std::ptrdiff_t to, std::complex<float>* out) const;

  int sub_bands_ = 1;
  std::vector<std::ptrdiff_t> edges_;  // [filters × (sub-bands + 1)] bins of weights_
  std::vector<double> dopplers_;
  std::vector<std::ptrdiff_t> first_;         // [filters] bin, counted from the carrier
  std::vector<std::complex<float>> weights_;  // [filters × bins_] of S*(f/η)/η/E
  std::size_t bins_ = 0, length_ = 0, row_ = 0, samples_ = 0;
  double rate_ = 0.0, start_ = 0.0;
};

/// The same filter in its plain form: the integral as a sum over a record's samples in time, in
/// double, for one factor and one delay of each of several phones (a beam steered at what is
/// listened for), and for as many samples later or earlier as are asked for.
///
/// y = Σ_n ∫ p₊ s₊*(η(t − τ_n)) dt / Σ_n ∫|s₊(ηt)|² dt
class MatchedFilterAt {
 public:
  /// When one phone receives the echo.
  struct Phone {
    std::size_t channel = 0;  ///< of the record
    double delay = 0.0;       ///< τ_n [s]
  };
  /// \param whole  record, from whose start samples count   \param doppler  η
  MatchedFilterAt(const Recording& whole, const Pulse& pulse, double doppler,
                  std::vector<Phone> phones);

  // The samples of the whole record that it needs are first() … end() − 1, and as many later.
  [[nodiscard]] std::ptrdiff_t first() const noexcept;
  [[nodiscard]] std::ptrdiff_t end() const noexcept;
  [[nodiscard]] const std::vector<Phone>& phones() const noexcept { return phones_; }

  /// |y|² so many samples after the delays. \param pressure [channels × samples × components] of
  /// the record or of a part of it [Pa]   \param samples  of each channel   \param from  its first
  /// sample; what first() and end() say, `later`, lies within
  [[nodiscard]] double answer(std::span<const float> pressure, std::size_t samples,
                              std::ptrdiff_t from, std::ptrdiff_t later) const;
  /// |y|² at `first`, `first` + `step`, … samples after the delays, by a transform of the record:
  /// in time that grows with its samples. NaN where they are not there. \return [count]
  [[nodiscard]] std::vector<double> answers(std::span<const float> pressure, std::size_t samples,
                                            std::ptrdiff_t from, std::ptrdiff_t first,
                                            std::ptrdiff_t step, std::size_t count) const;
  /// E|y|² of white noise that is independent from phone to phone. \param density [Pa²/Hz]
  [[nodiscard]] double noise(double density) const noexcept;

 private:
  Recording whole_;
  std::vector<Phone> phones_;
  std::ptrdiff_t length_ = 0;
  std::vector<std::ptrdiff_t> first_;          // [phones]
  std::vector<std::complex<double>> weights_;  // [phones × length] s₊*, as the record has it
  double energy_ = 0.0;                        // Σ|w|²
};

}  // namespace asdic::detail
