#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <span>

#include "core/normal.h"
#include "raytrace/parallel.h"
#include "sonar/band_response.h"
#include "sonar/own_grid.h"
#include "sonar/place_weights.h"
#include "sonar/reverberation_covariance.h"
#include "sonar/reverberation_streams.h"
#include "sonar/synthesis.h"
#include "sonar/synthesis_plan.h"

namespace asdic {
namespace {

using Scratch = FftBuffer<std::complex<float>>;
using StreamBlock = ReverberationStreams::Block;

constexpr std::size_t lanes = 16;

/// Real and imaginary parts in rows of their own, bins from the band's lower edge up.
struct Rows {
  std::size_t stride = 0;
  std::vector<float> values;

  void reset(std::size_t rows, std::size_t bins) {
    stride = (bins + lanes - 1) / lanes * lanes;
    values.assign(2 * rows * stride, 0.0F);
  }
  [[nodiscard]] float* re(std::size_t row) noexcept { return values.data() + 2 * row * stride; }
  [[nodiscard]] float* im(std::size_t row) noexcept { return re(row) + stride; }
};

/// Without a look at infinities that never come.
std::complex<double> times(std::complex<double> a, std::complex<double> b) noexcept {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

/// phone += weight·e^{−i(base + step·k)}·sound over the bins k.
void add_turned(const float* __restrict re, const float* __restrict im, std::size_t stride,
                std::complex<double> weight, double base, double step, float* __restrict to_re,
                float* __restrict to_im) {
  alignas(64) std::array<float, lanes> c, s;
  const std::complex<double> turn = std::polar(1.0, -step);
  std::complex<double> on = 1.0;  // after these lanes
  for (std::size_t l = 0; l < lanes; ++l) {
    c[l] = static_cast<float>(on.real());
    s[l] = static_cast<float>(on.imag());
    on = times(on, turn);
  }
  std::complex<double> at = times(weight, std::polar(1.0, -base));
  for (std::size_t k = 0; k < stride; k += lanes) {
    const auto a = static_cast<float>(at.real()), b = static_cast<float>(at.imag());
    for (std::size_t l = 0; l < lanes; ++l) {
      const float x = a * c[l] - b * s[l], y = a * s[l] + b * c[l];
      to_re[k + l] += re[k + l] * x - im[k + l] * y;
      to_im[k + l] += re[k + l] * y + im[k + l] * x;
    }
    at = times(at, on);
  }
}

/// How much later than the reference point a phone hears a wave whose fronts are spheres about the
/// point R·u, u = −s/|s|: |s|·(|R·u − x| − R) [s]. \param curvature  1/R [1/m]
double lag(const Vec3& slowness, double curvature, const Vec3& phone) noexcept {
  const double s = slowness.norm(), plane = slowness.dot(phone);
  if (!(s > 0.0)) return 0.0;
  // (|R·u − x|² − R²)/R = 2·s·x/|s| + |x|²/R, over (|R·u − x| + R)/R.
  const double excess = 2.0 * plane / s + phone.squaredNorm() * curvature;
  return s * excess / (1.0 + std::sqrt(std::max(0.0, 1.0 + curvature * excess)));
}

/// The pulse's spectrum, finely enough for a polynomial between its values.
class FineSpectrum {
 public:
  explicit FineSpectrum(const BandLimitedPulse& pulse)
      : centre_(pulse.centre_frequency()), half_band_(pulse.half_band()) {
    // Of a signal D long, 16 values to 1/D: six of them foretell those between to 1e-6.
    constexpr double finer = 16.0, oversampling = 1.25;
    const double duration = 2.0 * pulse.half_duration();
    const double least = finer * duration * 2.0 * half_band_ * oversampling;
    const std::size_t n = fast_fft_length(static_cast<std::size_t>(std::ceil(least)) + 64);
    const double rate = static_cast<double>(n) / (finer * duration);
    step_ = rate / static_cast<double>(n);
    Scratch samples(n);
    const auto reach = static_cast<std::ptrdiff_t>(pulse.half_duration() * rate);
    for (std::ptrdiff_t j = -reach; j <= reach; ++j)
      samples[static_cast<std::size_t>(j < 0 ? j + static_cast<std::ptrdiff_t>(n) : j)] =
          std::complex<float>(pulse.at(static_cast<double>(j) / rate) / rate);
    ComplexFft<float>(n).forward(samples.data());
    const auto middle = static_cast<std::ptrdiff_t>(n / 2 - 1);
    const auto half = std::min(static_cast<std::ptrdiff_t>(half_band_ / step_) + 4, middle);
    // Nothing beyond either end, so that every place has neighbours.
    first_ = static_cast<double>(-half) - static_cast<double>(taps);
    const auto room = static_cast<std::size_t>(2 * half + 1) + 2 * taps;
    re_.assign(room, 0.0F);
    im_.assign(room, 0.0F);
    for (std::ptrdiff_t k = -half; k <= half; ++k) {
      const std::complex<float> value =
          samples[static_cast<std::size_t>(k < 0 ? k + static_cast<std::ptrdiff_t>(n) : k)];
      re_[static_cast<std::size_t>(k + half) + taps] = value.real();
      im_[static_cast<std::size_t>(k + half) + taps] = value.imag();
    }
  }

  /// scale·∫ s₊(ηu + T/2)·e^{−i2πfu} du [s] at frequencies from `lowest` on.
  /// \param spectrum  a whole number of lanes
  void fill(double lowest, double spacing, double doppler, double scale,
            std::span<std::complex<float>> spectrum) const noexcept {
    const double begin = (lowest / doppler - centre_) / step_ - first_,
                 on = spacing / doppler / step_;
    const double end = static_cast<double>(re_.size() - taps);
    const auto gain = static_cast<float>(scale / doppler);
    alignas(64) std::array<float, lanes> t, re, im;
    alignas(64) std::array<std::int32_t, lanes> at;
    alignas(64) std::array<std::array<float, lanes>, taps> weight;
    for (std::size_t k = 0; k < spectrum.size(); k += lanes) {
      for (std::size_t l = 0; l < lanes; ++l) {
        const double place = std::clamp(begin + on * static_cast<double>(k + l), 2.0, end);
        at[l] = static_cast<std::int32_t>(place);
        t[l] = static_cast<float>(place - static_cast<double>(at[l]));
      }
      // Lagrange's polynomials through the values −2 … 3 beside each place.
      for (std::size_t l = 0; l < lanes; ++l) {
        const float x = t[l], a = x + 2.0F, b = x + 1.0F, d = x - 1.0F, e = x - 2.0F, f = x - 3.0F;
        const float ab = gain * a * b, ef = e * f, xd = x * d;
        weight[0][l] = gain * b * xd * ef * (-1.0F / 120.0F);
        weight[1][l] = gain * a * xd * ef * (1.0F / 24.0F);
        weight[2][l] = ab * d * ef * (-1.0F / 12.0F);
        weight[3][l] = ab * x * ef * (1.0F / 12.0F);
        weight[4][l] = ab * xd * f * (-1.0F / 24.0F);
        weight[5][l] = ab * xd * e * (1.0F / 120.0F);
      }
      for (std::size_t l = 0; l < lanes; ++l) {
        const float *const x = &re_[static_cast<std::size_t>(at[l]) - 2],
                           *const y = &im_[static_cast<std::size_t>(at[l]) - 2];
        re[l] = im[l] = 0.0F;
        for (std::size_t i = 0; i < taps; ++i) {
          re[l] += weight[i][l] * x[i];
          im[l] += weight[i][l] * y[i];
        }
      }
      for (std::size_t l = 0; l < lanes; ++l) spectrum[k + l] = {re[l], im[l]};
    }
  }

 private:
  static constexpr std::size_t taps = 6;
  double centre_, half_band_, step_ = 1.0, first_ = 0.0;
  std::vector<float> re_, im_;
};

/// One block's sound at all phones.
struct Piece {
  std::ptrdiff_t first = 0;  // sample of the grid
  std::size_t samples = 0;
  std::vector<std::complex<float>> values;  // [phones × samples]
};

/// What a piece needs to know of the grid.
struct StreamGrid {
  double rate = 1.0;                  // [Hz]
  double first = 0.0;                 // delay of sample 0 [s]
  std::ptrdiff_t begin = 0, end = 0;  // of impulses
  double carrier = 0.0;               // [Hz]
  std::size_t guard = 0;              // samples by which a pulse hangs over its impulse
  double half_band = 0.0;             // of the sound about the carrier [Hz]
  double pulse_duration = 1.0;        // [s]

  [[nodiscard]] std::ptrdiff_t at(double delay) const noexcept {
    return std::clamp(static_cast<std::ptrdiff_t>(std::ceil((delay - first) * rate)), begin, end);
  }
};

Piece piece_of(const ReverberationStreams& sea, const StreamBlock& block, const FineSpectrum& pulse,
               const StreamGrid& grid, std::span<const Vec3> phones, const CovarianceDraw& draw) {
  const std::ptrdiff_t begin = grid.at(static_cast<double>(block.begin) * sea.bin),
                       end = grid.at(static_cast<double>(block.end) * sea.bin);
  Piece piece;
  if (begin == end || block.first == block.last) return piece;
  const auto n = static_cast<std::size_t>(end - begin);
  const std::size_t length = grid_length(static_cast<double>(n + 2 * grid.guard));
  const double spacing = grid.rate / static_cast<double>(length);  // of bins [Hz]
  const std::size_t highest =
      std::min(static_cast<std::size_t>(std::ceil(grid.half_band / spacing)), (length - 1) / 2);
  const std::size_t bins = 2 * highest + 1;
  const double lowest = grid.carrier - spacing * static_cast<double>(highest);
  const ComplexFft<float> fft(length);
  Scratch scratch(length);
  std::vector<float> normals(2 * n), scale(n);
  std::vector<std::size_t> bin_of(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double delay =
        grid.first + static_cast<double>(begin + static_cast<std::ptrdiff_t>(i)) / grid.rate;
    const auto b = static_cast<std::size_t>(std::max(0.0, delay) / sea.bin);
    bin_of[i] = std::clamp(b, block.begin, block.end - 1) - block.begin;
  }
  // Doppler factors to a 32nd of what a pulse tells apart share a spectrum.
  const double factors = 16.0 * grid.carrier * grid.pulse_duration;
  std::map<long, std::vector<std::complex<float>>> spectra;
  Rows sound, heard;
  sound.reset(1, bins);
  heard.reset(phones.size(), bins);
  for (std::size_t s = block.first; s < block.last; ++s) {
    const ReverberationStreams::Stream& stream = sea.streams[s];
    const ReverberationStreams::Part& part = sea.part_of(stream, draw.seed, draw.ping);
    const long factor = std::lround((part.doppler - 1.0) * factors);
    auto [known, is_new] = spectra.try_emplace(factor);
    if (is_new) {
      known->second.resize(sound.stride);
      pulse.fill(lowest, spacing, 1.0 + static_cast<double>(factor) / factors, spacing,
                 known->second);
    }
    const float* const intensity = &sea.intensity[stream.first];
    for (std::size_t noise = 0; noise < part.weight.size(); ++noise) {
      if (part.weight[noise][0] == 0.0 && part.weight[noise][1] == 0.0) continue;
      fill_normal(normals, draw.seed, Draw::covariance_weight, draw.ping, stream.entity + noise);
      std::fill_n(scratch.data(), length, 0.0F);
      for (std::size_t i = 0; i < n; ++i) {
        const float root = std::sqrt(0.5F * intensity[bin_of[i]] / static_cast<float>(grid.rate));
        scratch[i] = {root * normals[2 * i], root * normals[2 * i + 1]};
      }
      fft.forward(scratch.data());
      const auto take = [&](std::size_t from, std::size_t count, std::size_t to) {
        for (std::size_t k = 0; k < count; ++k) {
          const std::complex<float> x = scratch[from + k], h = known->second[to + k];
          sound.re(0)[to + k] = x.real() * h.real() - x.imag() * h.imag();
          sound.im(0)[to + k] = x.real() * h.imag() + x.imag() * h.real();
        }
      };
      take(length - highest, highest, 0);
      take(0, highest + 1, highest);
      for (std::size_t wave = 0; wave < part.slowness.size(); ++wave) {
        if (part.weight[noise][wave] == 0.0) continue;
        for (std::size_t p = 0; p < phones.size(); ++p) {
          const double late = 2.0 * pi * lag(part.slowness[wave], part.curvature[wave], phones[p]);
          add_turned(sound.re(0), sound.im(0), sound.stride, part.weight[noise][wave],
                     late * lowest, late * spacing, heard.re(p), heard.im(p));
        }
      }
    }
  }
  piece.first = begin - static_cast<std::ptrdiff_t>(grid.guard);
  piece.samples = n + 2 * grid.guard;
  piece.values.resize(phones.size() * piece.samples);
  for (std::size_t p = 0; p < phones.size(); ++p) {
    std::fill_n(scratch.data(), length, 0.0F);
    for (std::size_t k = 0; k < bins; ++k)
      scratch[k < highest ? length - highest + k : k - highest] = {heard.re(p)[k], heard.im(p)[k]};
    fft.inverse(scratch.data());
    std::complex<float>* const to = piece.values.data() + p * piece.samples;
    std::copy_n(scratch.data() + (length - grid.guard), grid.guard, to);
    std::copy_n(scratch.data(), n + grid.guard, to + grid.guard);
  }
  return piece;
}

}  // namespace

double Synthesizer::half_band_of(const ReverberationStreams& sea) const {
  const Plan& plan = *plan_;
  const double period = static_cast<double>(plan.length) / plan.rate;
  const double still =
      0.5 * static_cast<double>(covariance_spectra(chebyshev_nodes(plan.carrier, 0.0, 1))->size());
  double most = 0.0;
  for (const ReverberationStreams::Part& part : sea.parts)
    most = std::max(most, std::abs(part.doppler - 1.0));
  return std::min(static_cast<double>(plan.highest_bin),
                  std::ceil(still * (1.0 + most) + most * plan.carrier * period));
}

Baseband Synthesizer::silence(const ReverberationStreams& sea,
                              std::vector<std::complex<float>> memory) const {
  return silence_of_band(sea.phones, 2.0 * half_band_of(sea) + 1.0, std::move(memory));
}

void Synthesizer::add_streams(const ReverberationStreams& sea, std::span<const Vec3> phones,
                              const CovarianceDraw& draw, Baseband& baseband) const {
  const Plan& plan = *plan_;
  assert(phones.size() == baseband.channels && baseband.samples <= plan.length);
  const std::size_t fine = baseband.samples;
  const double period = static_cast<double>(plan.length) / plan.rate;
  const double half_band = half_band_of(sea);  // [bins]
  const std::size_t length = std::min(fine, grid_length(2.0 * half_band + 2.0));
  const double rate = static_cast<double>(length) / period;
  const double before = static_cast<double>(plan.lead) / plan.rate;
  const BandLimitedPulse& pulse = plan.pulses.front();
  const StreamGrid grid{
      .rate = rate,
      .first = plan.recording.start - 0.5 * plan.pulse_duration,
      .begin = -static_cast<std::ptrdiff_t>(before * rate),
      .end = static_cast<std::ptrdiff_t>((plan.last_position / plan.rate - before) * rate) + 1,
      .carrier = plan.carrier,
      .guard = static_cast<std::size_t>(
                   std::ceil(pulse.half_duration() / (1.0 - plan.max_doppler) * rate)) +
               lanes,
      .half_band = half_band / period,
      .pulse_duration = plan.pulse_duration};
  const FineSpectrum spectrum(pulse);
  std::vector<Piece> pieces(sea.blocks.size());
  in_parallel(pieces.size(), [&](std::size_t b) {
    pieces[b] = piece_of(sea, sea.blocks[b], spectrum, grid, phones, draw);
  });
  const ComplexFft<float> coarse(length), fft(fine);
  const auto highest = std::min(static_cast<std::size_t>(half_band), (length - 1) / 2);
  in_parallel(phones.size(), [&](std::size_t phone) {
    Scratch sum(length), values(fine);
    for (const Piece& piece : pieces) {
      const std::complex<float>* const from = piece.values.data() + phone * piece.samples;
      auto at = static_cast<std::size_t>((piece.first + 2 * static_cast<std::ptrdiff_t>(length)) %
                                         static_cast<std::ptrdiff_t>(length));
      for (std::size_t i = 0; i < piece.samples; ++i) {
        sum[at] += from[i];
        if (++at == length) at = 0;
      }
    }
    coarse.forward(sum.data());
    const float scale = 1.0F / static_cast<float>(length);
    std::copy_n(sum.data(), highest + 1, values.data());
    std::copy_n(sum.data() + (length - highest), highest, values.data() + (fine - highest));
    fft.inverse(values.data());
    std::complex<float>* of_phone = baseband.values.data() + phone * fine;
    for (std::size_t i = 0; i < fine; ++i) of_phone[i] += scale * values[i];
  });
}

}  // namespace asdic
