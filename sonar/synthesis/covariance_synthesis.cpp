// Part of Synthesizer: reverberation drawn by its covariance.
#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <span>

#include "core/normal.h"
#include "core/rotate_back.h"
#include "raytrace/parallel/parallel.h"
#include "sonar/reverberation/reverberation_covariance.h"
#include "sonar/synthesis/own_grid.h"
#include "sonar/synthesis/place_weights.h"
#include "sonar/synthesis/spectrum_product.h"
#include "sonar/synthesis/synthesis.h"
#include "sonar/synthesis/synthesis_plan.h"

namespace asdic::detail {
namespace {

using Scratch = FftBuffer<std::complex<float>>;

/// Impulses on the ping's clock: number i comes after the delay i/rate, in whatever record.
struct DelayGrid {
  double rate = 1.0;                  // [Hz]
  std::ptrdiff_t begin = 0, end = 0;  // numbers that a record may receive
  double middle = 0.0;                // time from an impulse to the middle of its pulse [s]
  double turn = 0.0;                  // baseband's carrier less the pulse's frequency [Hz]

  [[nodiscard]] double delay(std::ptrdiff_t i) const noexcept {
    return static_cast<double>(i) / rate;
  }
  /// Number of the first impulse at or after a delay.
  [[nodiscard]] std::ptrdiff_t at(double delay) const noexcept {
    return static_cast<std::ptrdiff_t>(std::ceil(delay * rate));
  }
};

constexpr std::size_t drawn = 64;  // samples at one time: normals, factor, sums stay in the cache
constexpr std::size_t lanes = 16;  // which their rows are filled up to

/// Sets the impulses of all components to F·z. \param factor  [rank × components]
/// \param z  [rank × (real, imaginary) × row]   \param grids  [components × stride], at the first
/// of `n` samples, n ≤ row
void multiply(std::span<const std::complex<float>> factor, const std::vector<float>& z,
              std::size_t row, std::size_t n, std::size_t components, std::complex<float>* grids,
              std::size_t stride) {
  const std::size_t rank = factor.size() / components;
  std::array<float, drawn> re, im;
  for (std::size_t c = 0; c < components; ++c) {
    std::fill_n(re.begin(), row, 0.0F);
    std::fill_n(im.begin(), row, 0.0F);
    for (std::size_t j = 0; j < rank; ++j) {
      const float a = factor[j * components + c].real(), b = factor[j * components + c].imag();
      const float *const x = &z[2 * j * row], *const y = x + row;
      if (b == 0.0F)  // as where an array lies flat and receives all bearings
        for (std::size_t i = 0; i < row; ++i) {
          re[i] += a * x[i];
          im[i] += a * y[i];
        }
      else
        for (std::size_t i = 0; i < row; ++i) {
          re[i] += a * x[i] - b * y[i];
          im[i] += a * y[i] + b * x[i];
        }
    }
    for (std::size_t i = 0; i < n; ++i) grids[c * stride + i] = {re[i], im[i]};
  }
}

/// Sets one segment's impulses x = F·z·√(I/rate) of all components. Those of the same number have
/// the same draws in any record. \param grids  [components × stride] from the first impulse on
void draw_segment(const ReverberationCovariance& of, std::size_t index, const CovarianceDraw& draw,
                  const DelayGrid& grid, std::complex<float>* grids, std::size_t stride) {
  const ReverberationCovariance::Segment& segment = of.segments[index];
  const std::size_t rank = segment.rank, components = of.components;
  const std::ptrdiff_t first = grid.at(static_cast<double>(segment.begin) * of.bin);
  const std::ptrdiff_t begin = std::max(grid.begin, first);
  const std::ptrdiff_t end = std::min(grid.end, grid.at(static_cast<double>(segment.end) * of.bin));
  if (rank == 0 || begin >= end) return;
  const auto factor = std::span(of.columns).subspan(segment.first * components, rank * components);
  constexpr auto together = static_cast<std::ptrdiff_t>(drawn);
  const std::size_t most =
      std::min(drawn, (static_cast<std::size_t>(end - first) + lanes - 1) / lanes * lanes);
  std::vector<float> normals(2 * rank * most), z(2 * rank * most);
  for (std::ptrdiff_t start = begin - (begin - first) % together; start < end; start += together) {
    const std::ptrdiff_t from = std::max(start, begin), to = std::min(start + together, end);
    const auto n = static_cast<std::size_t>(to - from), row = (n + lanes - 1) / lanes * lanes;
    fill_normal(std::span(normals).first(2 * rank * static_cast<std::size_t>(to - start)),
                draw.seed, Draw::covariance_weight, draw.ping, index,
                2 * rank * static_cast<std::size_t>(start - first));
    for (std::ptrdiff_t number = from; number < to; ++number) {
      const double delay = grid.delay(number);
      const auto bin = static_cast<std::size_t>(delay / of.bin);
      // E|z|² = 1: half of it real.
      double c = std::sqrt(0.5 * of.intensity[std::min(bin, of.intensity.size() - 1)] / grid.rate),
             s = 0.0;
      rotate_back(grid.turn * (delay + grid.middle), c, s);
      const auto re = static_cast<float>(c), im = static_cast<float>(s);
      const float* const normal = &normals[2 * rank * static_cast<std::size_t>(number - start)];
      float* const of_number = &z[static_cast<std::size_t>(number - from)];
      for (std::size_t j = 0; j < rank; ++j) {
        of_number[2 * j * row] = re * normal[2 * j] - im * normal[2 * j + 1];
        of_number[(2 * j + 1) * row] = re * normal[2 * j + 1] + im * normal[2 * j];
      }
    }
    multiply(factor, z, row, n, components, grids + (from - grid.begin), stride);
  }
}

}  // namespace

struct Synthesizer::CovarianceSpectra {
  double half_band = 0.0;   // band that holds the pulse up to −80 dB of its energy [Hz]
  std::size_t highest = 0;  // the same in bins of the period
  std::vector<std::complex<float>> values;  // [K × (2·highest + 1)]
};

/// The pulse through ℓ_k, over the FFT's length; beyond the band ℓ_k is as at its edge.
std::shared_ptr<const Synthesizer::CovarianceSpectra> Synthesizer::covariance_spectra(
    const BandNodes& band) const {
  const Plan& plan = *plan_;
  const auto make = [&] {
    constexpr double left_out = 1e-8;
    auto spectra = std::make_shared<CovarianceSpectra>();
    spectra->half_band = half_band_of_energy(plan.pulses.front(), left_out);
    const double period = static_cast<double>(plan.length) / plan.rate;
    const std::size_t highest = spectra->highest =
        std::min(static_cast<std::size_t>(plan.highest_bin),
                 static_cast<std::size_t>(std::ceil(spectra->half_band * period)));
    std::vector<std::complex<float>> pulse(2 * static_cast<std::size_t>(plan.highest_bin) + 1);
    Scratch scratch(plan.length);
    plan.stretched_spectrum(plan.pulses.front(), {}, plan.whole(), scratch.data(), pulse);
    // An impulse on a sample needs no spreading, nor what undoes it.
    for (std::size_t i = 0; i < pulse.size(); ++i)
      pulse[i] /= plan.deconvolution[i] * static_cast<float>(plan.length);
    const std::size_t lowest = pulse.size() / 2 - highest;
    spectra->values.reserve(band.frequencies.size() * (2 * highest + 1));
    for (std::size_t k = 0; k < band.frequencies.size(); ++k)
      for (std::size_t i = 0; i <= 2 * highest; ++i) {
        const double beside = (static_cast<double>(i) - static_cast<double>(highest)) / period;
        const double frequency = std::clamp(plan.carrier + beside, band.centre - band.half_width,
                                            band.centre + band.half_width);
        spectra->values.push_back(pulse[lowest + i] * static_cast<float>(band.basis(k, frequency)));
      }
    return spectra;
  };
  if (memory_ == nullptr) return make();
  return memory_->remember(ExactKey(Kept::covariance_spectra, plan.identity, band.centre,
                                    band.half_width, band.frequencies),
                           make, [](const CovarianceSpectra& spectra) {
                             return sizeof(CovarianceSpectra) +
                                    spectra.values.size() * sizeof(spectra.values[0]);
                           });
}

Baseband Synthesizer::silence(const ReverberationCovariance& covariance,
                              std::vector<std::complex<float>> memory) const {
  const std::size_t responses = covariance.band.frequencies.size();
  const double bins = 2.0 * static_cast<double>(covariance_spectra(covariance.band)->highest) + 1.0;
  return silence_of_band(covariance.components / responses, bins, std::move(memory));
}

/// \param bins  of the period that its sound fills
Baseband Synthesizer::silence_of_band(std::size_t phones, double bins,
                                      std::vector<std::complex<float>> memory) const {
  constexpr double least_rate = 50.0;  // [Hz]; a level's step holds two samples or more
  const Plan& plan = *plan_;
  if (!interpolates()) return silence(phones, std::move(memory));
  const double period = static_cast<double>(plan.length) / plan.rate;
  // A finer grid, of which half as many taps are enough, where that is far from the record's rate.
  const double oversampling = 4.0 * bins < static_cast<double>(plan.passband_length)
                                  ? oversampling_for_12_taps
                                  : DelayKernel::oversampling;
  const std::size_t length =
      std::min(plan.length, grid_length(std::max(bins * oversampling, least_rate * period)));
  return silence_of(phones, length, static_cast<double>(length) / bins, std::move(memory));
}

void Synthesizer::add_gaussian(const ReverberationCovariance& covariance,
                               const CovarianceDraw& draw, Baseband& baseband) const {
  const Plan& plan = *plan_;
  const std::size_t phones = baseband.channels, responses = covariance.band.frequencies.size();
  assert(covariance.components == phones * responses && baseband.samples <= plan.length);
  const auto spectra = covariance_spectra(covariance.band);
  // White noise of any rate above the pulse's band serves. The slowest clock of the ping is used,
  // so that the noise is the same in any record. An impulse lies in the middle of its pulse.
  const std::size_t fine = baseband.samples;
  const auto [rate, length] = plan.clock(2.0 * spectra->half_band);
  const std::size_t highest = std::min(spectra->highest, (std::min(length, fine) - 1) / 2);
  const double period = static_cast<double>(plan.length) / plan.rate;
  const double earliest =
      plan.recording.start - static_cast<double>(plan.lead) / plan.rate - 0.5 * plan.pulse_duration;
  const auto first = static_cast<std::ptrdiff_t>(std::ceil(earliest * rate));
  const DelayGrid grid{
      .rate = rate,
      .begin = first,
      .end =
          first + static_cast<std::ptrdiff_t>(std::min(
                      length, static_cast<std::size_t>(plan.last_position / plan.rate * rate) + 1)),
      .middle = 0.5 * plan.pulse_duration,
      .turn = plan.carrier - plan.pulses.front().centre_frequency()};
  const std::size_t stride = Scratch::row_stride(length);
  Scratch grids(covariance.components * stride);
  in_parallel(covariance.segments.size(), [&](std::size_t s) {
    draw_segment(covariance, s, draw, grid, grids.data(), stride);
  });
  const ComplexFft<float> coarse(length), fft(fine);
  struct Workspace {
    Scratch sum, values;
  };
  tbb::enumerable_thread_specific<Workspace> workspaces;
  // The clock's first impulse is not the period's first moment.
  const std::vector<std::complex<float>> later =
      delay_of_bins(static_cast<double>(first) / rate - earliest, period, highest);
  in_parallel(phones, [&](std::size_t phone) {
    auto& [sum, values] = workspaces.local();
    sum.reserve(length);
    values.reserve(fine);
    std::fill_n(sum.data(), length, 0.0F);
    for (std::size_t k = 0; k < responses; ++k) {
      std::complex<float>* row = grids.data() + (k * phones + phone) * stride;
      coarse.forward(row);
      const std::complex<float>* const response =
          spectra->values.data() + k * (2 * spectra->highest + 1);
      multiply_add(row, response + (spectra->highest - highest), length, highest, sum.data());
    }
    std::fill_n(values.data(), fine, 0.0F);
    for (std::size_t k = 0; k <= highest; ++k) values[k] = sum[k] * later[k];
    for (std::size_t k = 1; k <= highest; ++k)
      values[fine - k] = sum[length - k] * std::conj(later[k]);
    fft.inverse(values.data());
    std::complex<float>* of_phone = baseband.values.data() + phone * fine;
    for (std::size_t i = 0; i < fine; ++i) of_phone[i] += values[i];
  });
}

}  // namespace asdic::detail
