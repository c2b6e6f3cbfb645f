#include "processing/matched_filter.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/units.h"
#include "raytrace/parallel/parallel.h"
#include "sonar/signal/complex_product.h"

namespace asdic::detail {
namespace {

constexpr double oversampling = 2.0;  // of the output: half a sample off a peak loses 0.9 dB
constexpr std::size_t most_filters = 20000;

/// S(f)·S*(f/η)/η over the pulse's band, at bins fine enough for delays of two durations.
struct CrossSpectrum {
  double first = 0.0, spacing = 0.0;  // [Hz]
  std::vector<std::complex<double>> bins;

  CrossSpectrum(const Replica& replica, double doppler) {
    spacing = 0.25 / replica.duration();
    const double margin = replica.highest_frequency() * std::abs(doppler - 1.0);
    first = replica.lowest_frequency() - 0.5 * replica.bandwidth() - margin;
    const double last = replica.highest_frequency() + 0.5 * replica.bandwidth() + margin;
    const auto n = static_cast<std::size_t>(std::ceil((last - first) / spacing)) + 1;
    for (std::size_t k = 0; k < n; ++k) {
      const double f = first + static_cast<double>(k) * spacing;
      bins.push_back(replica.spectrum(f, doppler) * std::conj(replica.spectrum(f)));
    }
  }
  /// ∫ … e^{i2πfτ} df, without a common phase
  [[nodiscard]] std::complex<double> at(double delay) const {
    std::complex<double> sum = 0.0, rotation = 1.0;
    const std::complex<double> step = std::polar(1.0, 2.0 * pi * spacing * delay);
    for (const auto& bin : bins) {
      sum += bin * rotation;
      rotation *= step;
    }
    return sum * spacing;
  }
};

}  // namespace

std::vector<double> sub_band_edges(const Replica& replica, int parts) {
  std::vector<double> edges;
  if (parts < 2) return edges;
  // The spectrum of a pulse of length T is told by values 1/T apart.
  const double spacing = 0.125 / replica.duration(), room = 0.5 * replica.bandwidth();
  const double first = replica.lowest_frequency() - room;
  const auto count =
      static_cast<std::size_t>(std::ceil((replica.highest_frequency() + room - first) / spacing));
  std::vector<double> sums{0.0};
  for (std::size_t k = 0; k < count; ++k)
    sums.push_back(sums.back() +
                   std::norm(replica.spectrum(first + (static_cast<double>(k) + 0.5) * spacing)));
  std::size_t k = 0;
  for (int part = 1; part < parts; ++part) {
    const double wanted = sums.back() * part / parts;
    while (sums[k + 1] < wanted) ++k;
    edges.push_back(
        first + (static_cast<double>(k) + (wanted - sums[k]) / (sums[k + 1] - sums[k])) * spacing);
  }
  return edges;
}

namespace {

/// Mean over the sub-bands of |their transform over their part of the energy|², times the whole
/// energy's square. \param edges  between them   \return [n] delays
std::vector<double> sub_band_powers(const CrossSpectrum& cross, std::vector<double> edges,
                                    std::size_t n) {
  FftBuffer<std::complex<double>> work(n);
  std::vector<double> power(n, 0.0);
  edges.push_back(infinity);
  std::size_t from = 0;
  for (const double edge : edges) {  // each by its own energy, which is E/parts: their mean
    std::size_t to = from;
    while (to < cross.bins.size() && cross.first + static_cast<double>(to) * cross.spacing < edge)
      ++to;
    work.clear();
    std::copy(cross.bins.begin() + static_cast<std::ptrdiff_t>(from),
              cross.bins.begin() + static_cast<std::ptrdiff_t>(to), work.data() + from);
    ComplexFft<double>(n).inverse(work.data());
    for (std::size_t i = 0; i < n; ++i)
      power[i] += static_cast<double>(edges.size()) * std::norm(work[i]);
    from = to;
  }
  return power;
}

}  // namespace

DopplerAnswer doppler_answer(const Replica& replica, double doppler, int sub_bands) {
  const CrossSpectrum cross(replica, doppler);
  const std::size_t n = fast_fft_length(4 * cross.bins.size());
  const std::vector<double> power = sub_band_powers(cross, sub_band_edges(replica, sub_bands), n);
  std::size_t top = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (power[i] > power[top]) top = i;
  const double before = power[(top + n - 1) % n], here = power[top], after = power[(top + 1) % n];
  const double bend = before - 2.0 * here + after;
  const double offset = bend < 0.0 ? 0.5 * (before - after) / bend : 0.0;
  const double most = here - 0.25 * (before - after) * offset;
  double place = static_cast<double>(top) + offset;
  if (place > 0.5 * static_cast<double>(n)) place -= static_cast<double>(n);
  // √(energies) of both: an echo of factor η has the energy E/η
  return {.response = std::sqrt(most * doppler) * cross.spacing / replica.energy(),
          .delay = place / (static_cast<double>(n) * cross.spacing)};
}

namespace {

/// The offset of η from 1 at which the response has fallen to `least`, or `most` if it has not.
double offset_of_response(const Replica& replica, double least, double most, int sub_bands) {
  double inside = 0.0, outside = 0.02 / (replica.centre_frequency() * replica.duration());
  while (outside < most && doppler_answer(replica, 1.0 + outside, sub_bands).response > least) {
    inside = outside;
    outside *= 2.0;
  }
  outside = std::min(outside, most);
  for (int i = 0; i < 20; ++i) {
    const double middle = 0.5 * (inside + outside);
    (doppler_answer(replica, 1.0 + middle, sub_bands).response > least ? inside : outside) = middle;
  }
  return inside;
}

}  // namespace

double doppler_cell(const Replica& replica, int sub_bands) {
  return offset_of_response(replica, std::numbers::sqrt2 / 2.0, 0.1, sub_bands);
}

namespace {

/// |χ(τ, 1)|² at even delays from 0 to the pulse's length.
struct AnswerOverDelay {
  double step = 0.0;  // [s]
  std::vector<double> power;
};
AnswerOverDelay answer_over_delay(const Replica& replica, int sub_bands = 1) {
  const CrossSpectrum cross(replica, 1.0);
  const std::size_t n = fast_fft_length(4 * cross.bins.size());
  AnswerOverDelay found{.step = 1.0 / (static_cast<double>(n) * cross.spacing), .power = {}};
  for (std::size_t i = 0; i < n / 2 && static_cast<double>(i) * found.step <= replica.duration();
       ++i)
    found.power.push_back(0.0);
  const std::vector<double> power = sub_band_powers(cross, sub_band_edges(replica, sub_bands), n);
  for (std::size_t i = 0; i < found.power.size(); ++i) found.power[i] = power[i] / power[0];
  return found;
}

/// Takes answers at rising offsets. Past the first below a quarter it remembers the loudest to
/// which they have risen.
class NailFinder {
 public:
  void look(double offset, double power) {
    fallen_ = fallen_ || power < 0.25;
    if (fallen_ && power > before_ && power > found.power)
      found = {.offset = offset, .power = power};
    before_ = power;
  }
  Nail found;

 private:
  bool fallen_ = false;
  double before_ = 1.0;
};

}  // namespace

double reach_of_answer(const Replica& replica, double first, double last) {
  constexpr double heard = 4e-3, silent = 1e-3;
  if (!(mean_answer(replica, first, last) > heard)) return 0.0;
  const AnswerOverDelay answer = answer_over_delay(replica);
  double reach = 0.0;
  for (std::size_t i = 1; i < answer.power.size(); ++i)
    if (answer.power[i] > silent) reach = static_cast<double>(i) * answer.step;
  return reach;
}

double mean_answer(const Replica& replica, double first, double last, int sub_bands) {
  const AnswerOverDelay answer = answer_over_delay(replica, sub_bands);
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 1; i < answer.power.size(); ++i) {
    const double delay = static_cast<double>(i) * answer.step;
    if (delay < first || delay > last) continue;
    sum += answer.power[i];
    count += 1.0;
  }
  return count > 0.0 ? sum / count : 0.0;
}

Nail nail_in_delay(const Replica& replica) {
  const AnswerOverDelay answer = answer_over_delay(replica);
  NailFinder finder;
  for (std::size_t i = 1; i < answer.power.size(); ++i)
    finder.look(static_cast<double>(i) * answer.step, answer.power[i]);
  return finder.found;
}

Nail nail_in_doppler(const Replica& replica, double span) {
  const double step = 0.25 * doppler_cell(replica);
  NailFinder finder;
  for (int k = 1; k <= 800 && k * step <= span; ++k)
    finder.look(k * step, std::pow(doppler_answer(replica, 1.0 + k * step).response, 2.0));
  return finder.found;
}

std::vector<double> ambiguity(const Replica& replica, std::span<const double> delays,
                              std::span<const double> dopplers) {
  std::vector<double> surface;
  surface.reserve(delays.size() * dopplers.size());
  for (const double doppler : dopplers) {
    const CrossSpectrum cross(replica, doppler);
    for (const double delay : delays)
      surface.push_back(std::norm(cross.at(-delay)) * doppler /
                        (replica.energy() * replica.energy()));
  }
  return surface;
}

std::vector<double> doppler_bank(const Replica& replica, double span, double loss_db,
                                 int sub_bands) {
  if (!(span > 0.0)) return {1.0};
  const double inside = offset_of_response(replica, amplitude_from_db(-loss_db), span, sub_bands);
  const double half = std::ceil(span / (2.0 * inside));
  if (2.0 * half + 1.0 > static_cast<double>(most_filters))
    throw InputError(
        {.where = "max_speed",
         .got = "a span that asks for " + std::to_string(2.0 * half + 1.0) + " Doppler filters",
         .expected = "at most " + std::to_string(most_filters)});
  const int side = static_cast<int>(half);
  std::vector<double> factors;
  for (int k = -side; k <= side; ++k) factors.push_back(1.0 + span / side * k);
  return factors;
}

MatchedFilterBank::MatchedFilterBank(const Replica& replica, std::span<const double> dopplers,
                                     const Baseband& like, int sub_bands)
    : sub_bands_(sub_bands),
      dopplers_(dopplers.begin(), dopplers.end()),
      row_(like.samples),
      start_(like.start) {
  const double spacing = like.sample_rate / static_cast<double>(like.samples);
  // The pulse's band; what lies outside it is 40 dB weaker, but an unwindowed tone keeps a
  // hundredth of its energy there: as much again on either side.
  const double widest = *std::max_element(dopplers_.begin(), dopplers_.end());
  const double room = 0.25 * replica.bandwidth();
  bins_ =
      static_cast<std::size_t>(std::ceil((replica.bandwidth() + 2.0 * room) * widest / spacing));
  bins_ = std::min(bins_ + 1, like.samples);
  length_ = fast_fft_length(
      static_cast<std::size_t>(std::ceil(oversampling * replica.bandwidth() * widest / spacing)));
  length_ = std::max(length_, fast_fft_length(bins_));
  rate_ = static_cast<double>(length_) * spacing;
  const double recorded = static_cast<double>(like.recorded) / like.sample_rate * rate_;
  samples_ = std::min(length_, static_cast<std::size_t>(std::ceil(recorded)));

  const auto half_row = static_cast<std::ptrdiff_t>(like.samples / 2);
  for (const double doppler : dopplers_) {
    const double low = (replica.lowest_frequency() - room) * doppler - like.carrier;
    first_.push_back(static_cast<std::ptrdiff_t>(std::floor(low / spacing)));
    const double centre = replica.centre_frequency() * doppler - like.carrier;
    if (std::abs(centre) > 0.5 * like.sample_rate)
      throw InputError({.where = "dopplers",
                        .got = "a factor of " + std::to_string(doppler),
                        .expected = "one whose echo lies within the band"});
  }
  const std::vector<double> cuts = sub_band_edges(replica, sub_bands);
  for (std::size_t f = 0; f < dopplers_.size(); ++f) {
    edges_.push_back(0);
    for (const double cut : cuts) {
      const double bin = std::ceil((cut * dopplers_[f] - like.carrier) / spacing);
      edges_.push_back(std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(bin) - first_[f], 0,
                                                  static_cast<std::ptrdiff_t>(bins_)));
    }
    edges_.push_back(static_cast<std::ptrdiff_t>(bins_));
  }
  weights_.resize(dopplers_.size() * bins_);
  in_parallel(dopplers_.size(), [&](std::size_t f) {
    const double energy = replica.energy() / dopplers_[f];
    const double scale = 1.0 / (static_cast<double>(like.samples) * energy);
    for (std::size_t k = 0; k < bins_; ++k) {
      const std::ptrdiff_t bin = first_[f] + static_cast<std::ptrdiff_t>(k);
      if (std::abs(bin) < half_row)  // nothing outside the row's band
        weights_[f * bins_ + k] = std::complex<float>(
            scale * std::conj(replica.spectrum(like.carrier + static_cast<double>(bin) * spacing,
                                               dopplers_[f])));
    }
  });
}

void MatchedFilterBank::transform(std::span<const std::complex<float>> row,
                                  std::complex<float>* out) const {
  assert(row.size() == row_);
  std::copy(row.begin(), row.end(), out);
  ComplexFft<float>(row_).forward(out);
}

void MatchedFilterBank::filter(std::size_t k, const std::complex<float>* spectrum,
                               std::complex<float>* out) const {
  filter(k, spectrum, 0, static_cast<std::ptrdiff_t>(bins_), out);
}

void MatchedFilterBank::power(std::size_t k, const std::complex<float>* spectrum,
                              std::complex<float>* work, float* out) const {
  const auto parts = static_cast<std::size_t>(sub_bands_);
  const std::ptrdiff_t* edge = edges_.data() + k * (parts + 1);
  for (std::size_t part = 0; part < parts; ++part) {
    filter(k, spectrum, edge[part], edge[part + 1], work);
    if (part == 0)
      for (std::size_t i = 0; i < samples_; ++i) out[i] = std::norm(work[i]);
    else
      for (std::size_t i = 0; i < samples_; ++i) out[i] += std::norm(work[i]);
  }
  if (parts > 1)
    for (std::size_t i = 0; i < samples_; ++i) out[i] *= static_cast<float>(parts);
}

void MatchedFilterBank::filter(std::size_t k, const std::complex<float>* spectrum,
                               std::ptrdiff_t from, std::ptrdiff_t to,
                               std::complex<float>* out) const {
  // Bins below the carrier lie at the end of the row; what would lie beyond either has no weight.
  const auto n = static_cast<std::ptrdiff_t>(row_), count = static_cast<std::ptrdiff_t>(bins_);
  const std::complex<float>* weight = weights_.data() + k * bins_;
  const auto multiply = [&](std::ptrdiff_t begin, std::ptrdiff_t end, std::ptrdiff_t shift) {
    for (std::ptrdiff_t i = begin; i < end; ++i)
      out[i] = finite_product(spectrum[first_[k] + i + shift], weight[i]);
  };
  const auto within = [&](std::ptrdiff_t i) { return std::clamp<std::ptrdiff_t>(i, 0, count); };
  const std::ptrdiff_t lowest = within(-n - first_[k]), zero = within(-first_[k]),
                       end = within(n - first_[k]);
  std::fill(out, out + lowest, 0.0F);
  multiply(lowest, zero, n);
  multiply(zero, end, 0);
  std::fill(out + end, out + count, 0.0F);
  std::fill(out + bins_, out + length_, 0.0F);
  std::fill(out, out + from, 0.0F);
  std::fill(out + to, out + count, 0.0F);
  ComplexFft<float>(length_).inverse(out);
}

MatchedFilterAt::MatchedFilterAt(const Recording& whole, const Pulse& pulse, double doppler,
                                 std::vector<Phone> phones)
    : whole_(whole), phones_(std::move(phones)) {
  const Recording& r = whole_;
  length_ = static_cast<std::ptrdiff_t>(std::ceil(pulse.duration() / doppler * r.sample_rate)) + 1;
  weights_.resize(phones_.size() * static_cast<std::size_t>(length_));
  for (std::size_t n = 0; n < phones_.size(); ++n) {
    // The first sample at or after this phone's leading edge.
    const double edge = (phones_[n].delay - r.start) * r.sample_rate;
    first_.push_back(static_cast<std::ptrdiff_t>(std::ceil(edge)));
    for (std::ptrdiff_t k = 0; k < length_; ++k) {
      const double t = r.start + static_cast<double>(first_[n] + k) / r.sample_rate;
      std::complex<double> w = std::conj(pulse.analytic(doppler * (t - phones_[n].delay)));
      if (r.is_complex()) w *= std::polar(1.0, 2.0 * pi * r.carrier * (t + r.epoch));
      weights_[n * static_cast<std::size_t>(length_) + static_cast<std::size_t>(k)] = w;
      energy_ += std::norm(w);
    }
  }
}

std::ptrdiff_t MatchedFilterAt::first() const noexcept {
  return *std::min_element(first_.begin(), first_.end());
}

std::ptrdiff_t MatchedFilterAt::end() const noexcept {
  return *std::max_element(first_.begin(), first_.end()) + length_;
}

double MatchedFilterAt::answer(std::span<const float> pressure, std::size_t samples,
                               std::ptrdiff_t from, std::ptrdiff_t later) const {
  std::complex<double> sum = 0.0;
  for (std::size_t n = 0; n < first_.size(); ++n) {
    const std::ptrdiff_t begin = first_[n] + later - from;
    const std::complex<double>* w = weights_.data() + n * static_cast<std::size_t>(length_);
    const float* p =
        pressure.data() +
        (phones_[n].channel * samples + static_cast<std::size_t>(begin)) * whole_.components();
    for (std::ptrdiff_t k = 0; k < length_; ++k)
      sum += whole_.is_complex()
                 ? w[k] * std::complex<double>(static_cast<double>(p[2 * k]),
                                               static_cast<double>(p[2 * k + 1]))
                 : 2.0 * w[k] * static_cast<double>(p[k]);  // p₊ = 2p, its negative half aside
  }
  return std::norm(sum) / (energy_ * energy_);
}

std::vector<double> MatchedFilterAt::answers(std::span<const float> pressure, std::size_t samples,
                                             std::ptrdiff_t from, std::ptrdiff_t first,
                                             std::ptrdiff_t step, std::size_t count) const {
  // Σ_k w_k p_(k+s) has the spectrum P·conj(W*), W* that of conj(w); each phone's own first sample
  // is a phase.
  const auto row = static_cast<std::ptrdiff_t>(samples);
  const std::size_t n = fast_fft_length(samples + static_cast<std::size_t>(length_));
  const ComplexFft<double> transform(n);
  FftBuffer<std::complex<double>> sum(n), received(n), replica(n);
  const std::ptrdiff_t earliest = this->first();
  for (std::size_t phone = 0; phone < first_.size(); ++phone) {
    received.clear();
    replica.clear();
    const float* p = pressure.data() + phones_[phone].channel * samples * whole_.components();
    for (std::size_t k = 0; k < samples; ++k)
      received[k] = whole_.is_complex()
                        ? std::complex<double>(static_cast<double>(p[2 * k]),
                                               static_cast<double>(p[2 * k + 1]))
                        : std::complex<double>(2.0 * static_cast<double>(p[k]), 0.0);
    const std::size_t at = phone * static_cast<std::size_t>(length_);
    for (std::size_t k = 0; k < static_cast<std::size_t>(length_); ++k)
      replica[k] = std::conj(weights_[at + k]);
    transform.forward(received.data());
    transform.forward(replica.data());
    const double turn =
        2.0 * pi * static_cast<double>(first_[phone] - earliest) / static_cast<double>(n);
    for (std::size_t k = 0; k < n; ++k)
      sum[k] += finite_product(finite_product(received[k], std::conj(replica[k])),
                               std::polar(1.0, turn * static_cast<double>(k)));
  }
  transform.inverse(sum.data());
  const double scale = 1.0 / (static_cast<double>(n) * energy_);
  std::vector<double> all(count, std::nan(""));
  for (std::size_t i = 0; i < count; ++i) {
    const std::ptrdiff_t later = first + static_cast<std::ptrdiff_t>(i) * step;
    const std::ptrdiff_t begin = earliest + later - from;
    if (begin < 0 || end() + later - from > row) continue;
    all[i] = std::norm(scale * sum[static_cast<std::size_t>(begin)]);
  }
  return all;
}

double MatchedFilterAt::noise(double density) const noexcept {
  return 2.0 * density * whole_.sample_rate / energy_;
}

}  // namespace asdic::detail
