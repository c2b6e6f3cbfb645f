// Part of Synthesizer: reverberation drawn by its covariance.
#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <span>

#include "core/normal.h"
#include "raytrace/parallel/parallel.h"
#include "sonar/reverberation/reverberation_covariance.h"
#include "sonar/signal/pulse_spectrum.h"
#include "sonar/synthesis/own_grid.h"
#include "sonar/synthesis/place_weights.h"
#include "sonar/synthesis/spectrum_product.h"
#include "sonar/synthesis/synthesis.h"
#include "sonar/synthesis/synthesis_plan.h"

namespace asdic::detail {
namespace {

using Scratch = FftBuffer<std::complex<float>>;

/// Of a pulse whose energy outside is below −80 dB: bins on either side. At most the plan's.
std::size_t bins_of(std::span<const std::complex<float>> spectrum) {
  constexpr double left_out = 1e-8;
  const auto power = [&](std::size_t i) { return static_cast<double>(std::norm(spectrum[i])); };
  const std::size_t middle = spectrum.size() / 2;
  double all = 0.0;
  for (std::size_t i = 0; i < spectrum.size(); ++i) all += power(i);
  const std::size_t k = outermost_pair(
      middle, left_out * all, [&](std::size_t i) { return power(middle - i) + power(middle + i); });
  return std::max<std::size_t>(k, 1);
}

/// Where delays lie on a grid of impulses.
struct DelayGrid {
  double first = 0.0;  // delay of sample 0 [s]
  double rate = 1.0;   // [Hz]
  std::size_t begin = 0, end = 0;

  [[nodiscard]] double delay(std::size_t i) const noexcept {
    return first + static_cast<double>(i) / rate;
  }
  /// The first sample at or after a delay.
  [[nodiscard]] std::size_t at(double delay) const noexcept {
    const double sample = std::ceil((delay - first) * rate);
    return std::clamp(static_cast<std::size_t>(std::max(0.0, sample)), begin, end);
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

/// Sets one segment's impulses x = F·z·√(I/rate) of all components.
/// \param grids  [components × stride]
void draw_segment(const ReverberationCovariance& of, std::size_t index, const CovarianceDraw& draw,
                  const DelayGrid& grid, std::complex<float>* grids, std::size_t stride) {
  const ReverberationCovariance::Segment& segment = of.segments[index];
  const std::size_t rank = segment.rank, components = of.components;
  const std::size_t begin = grid.at(static_cast<double>(segment.begin) * of.bin);
  const std::size_t end = grid.at(static_cast<double>(segment.end) * of.bin);
  if (rank == 0 || begin == end) return;
  const auto factor = std::span(of.columns).subspan(segment.first * components, rank * components);
  const std::size_t row = std::min(drawn, (end - begin + lanes - 1) / lanes * lanes);
  std::vector<float> normals(2 * rank * std::min(drawn, end - begin)), z(2 * rank * row);
  for (std::size_t start = begin; start < end; start += drawn) {
    const std::size_t n = std::min(drawn, end - start);
    fill_normal(std::span(normals).first(2 * rank * n), draw.seed, Draw::covariance_weight,
                draw.ping, index, 2 * rank * (start - begin));
    for (std::size_t i = 0; i < n; ++i) {
      const auto bin = static_cast<std::size_t>(grid.delay(start + i) / of.bin);
      // E|z|² = 1: half of it real.
      const auto scale = static_cast<float>(
          std::sqrt(0.5 * of.intensity[std::min(bin, of.intensity.size() - 1)] / grid.rate));
      const float* const normal = &normals[2 * rank * i];
      for (std::size_t j = 0; j < rank; ++j) {
        z[2 * j * row + i] = scale * normal[2 * j];
        z[(2 * j + 1) * row + i] = scale * normal[2 * j + 1];
      }
    }
    multiply(factor, z, row, n, components, grids + start, stride);
  }
}

}  // namespace

/// [K × bins] the pulse through ℓ_k, over the FFT's length; beyond the band ℓ_k is as at its edge.
std::shared_ptr<const std::vector<std::complex<float>>> Synthesizer::covariance_spectra(
    const BandNodes& band) const {
  using Spectra = std::vector<std::complex<float>>;
  const Plan& plan = *plan_;
  const auto make = [&] {
    Spectra pulse(2 * static_cast<std::size_t>(plan.highest_bin) + 1);
    Scratch scratch(plan.length);
    plan.stretched_spectrum(plan.pulses.front(), {}, plan.whole(), scratch.data(), pulse);
    // An impulse on a sample needs no spreading, nor what undoes it.
    for (std::size_t i = 0; i < pulse.size(); ++i)
      pulse[i] /= plan.deconvolution[i] * static_cast<float>(plan.length);
    const std::size_t highest = bins_of(pulse), lowest = pulse.size() / 2 - highest;
    const double period = static_cast<double>(plan.length) / plan.rate;
    auto spectra = std::make_shared<Spectra>();
    spectra->reserve(band.frequencies.size() * (2 * highest + 1));
    for (std::size_t k = 0; k < band.frequencies.size(); ++k)
      for (std::size_t i = 0; i <= 2 * highest; ++i) {
        const double beside = (static_cast<double>(i) - static_cast<double>(highest)) / period;
        const double frequency = std::clamp(plan.carrier + beside, band.centre - band.half_width,
                                            band.centre + band.half_width);
        spectra->push_back(pulse[lowest + i] * static_cast<float>(band.basis(k, frequency)));
      }
    return spectra;
  };
  if (memory_ == nullptr) return make();
  return memory_->remember(
      ExactKey(Kept::covariance_spectra, plan.identity, band.centre, band.half_width,
               band.frequencies),
      make, [](const Spectra& spectra) { return spectra.size() * sizeof(Spectra::value_type); });
}

Baseband Synthesizer::silence(const ReverberationCovariance& covariance,
                              std::vector<std::complex<float>> memory) const {
  const std::size_t responses = covariance.band.frequencies.size();
  const double bins = static_cast<double>(covariance_spectra(covariance.band)->size()) /
                      static_cast<double>(responses);
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
  const std::size_t bins = spectra->size() / responses, highest = bins / 2;
  // White noise of any rate above the pulse's band is as good as another: it stands on the coarsest
  // grid of the period. An impulse stands in the pulse's middle.
  const std::size_t fine = baseband.samples;
  const std::size_t length = std::min(fine, grid_length(static_cast<double>(bins + 1)));
  const double period = static_cast<double>(plan.length) / plan.rate;
  const double rate = static_cast<double>(length) / period;
  const DelayGrid grid{
      .first = plan.recording.start - static_cast<double>(plan.lead) / plan.rate -
               0.5 * plan.pulse_duration,
      .rate = rate,
      .begin = 0,
      .end = std::min(length, static_cast<std::size_t>(plan.last_position / plan.rate * rate) + 1)};
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
  in_parallel(phones, [&](std::size_t phone) {
    auto& [sum, values] = workspaces.local();
    sum.reserve(length);
    values.reserve(fine);
    std::fill_n(sum.data(), length, 0.0F);
    for (std::size_t k = 0; k < responses; ++k) {
      std::complex<float>* row = grids.data() + (k * phones + phone) * stride;
      coarse.forward(row);
      multiply_add(row, spectra->data() + k * bins, length, highest, sum.data());
    }
    std::fill_n(values.data(), fine, 0.0F);
    std::copy_n(sum.data(), highest + 1, values.data());
    std::copy_n(sum.data() + (length - highest), highest, values.data() + (fine - highest));
    fft.inverse(values.data());
    std::complex<float>* of_phone = baseband.values.data() + phone * fine;
    for (std::size_t i = 0; i < fine; ++i) of_phone[i] += values[i];
  });
}

}  // namespace asdic::detail
