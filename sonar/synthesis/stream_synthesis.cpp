// Part of Synthesizer: reverberation as streams of noise.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "core/normal.h"
#include "core/rotate_back.h"
#include "raytrace/parallel/parallel.h"
#include "reverb/power/reverberation_streams.h"
#include "sonar/reverberation/reverberation_covariance.h"
#include "sonar/signal/band_response.h"
#include "sonar/signal/complex_product.h"
#include "sonar/signal/pulse_spectrum.h"
#include "sonar/signal/tap_sums.h"
#include "sonar/synthesis/own_grid.h"
#include "sonar/synthesis/place_weights.h"
#include "sonar/synthesis/synthesis.h"
#include "sonar/synthesis/synthesis_plan.h"
#include "sonar/synthesis/wave_lags.h"

namespace asdic::detail {
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

/// to += at·turn^k·sound over the bins k, |turn| = 1. \param bins  a whole number of lanes
void add_rotated(const float* __restrict re, const float* __restrict im, std::size_t bins,
                 std::complex<double> at, std::complex<double> rotation, float* __restrict to_re,
                 float* __restrict to_im) {
  alignas(64) std::array<float, lanes> c, s;
  c[0] = 1.0F;
  s[0] = 0.0F;
  for (std::size_t m = 1; m < lanes;
       m *= 2, rotation = finite_product(rotation, rotation)) {  // turn = turn^m
    const auto a = static_cast<float>(rotation.real()), b = static_cast<float>(rotation.imag());
    for (std::size_t l = 0; l < m; ++l) {
      c[m + l] = c[l] * a - s[l] * b;
      s[m + l] = c[l] * b + s[l] * a;
    }
  }
  for (std::size_t k = 0; k < bins; k += lanes) {
    const auto a = static_cast<float>(at.real()), b = static_cast<float>(at.imag());
    for (std::size_t l = 0; l < lanes; ++l) {
      const float x = a * c[l] - b * s[l], y = a * s[l] + b * c[l];
      to_re[k + l] += re[k + l] * x - im[k + l] * y;
      to_im[k + l] += re[k + l] * y + im[k + l] * x;
    }
    at = finite_product(at, rotation);
  }
}

/// The pulse's spectrum, finely enough for a polynomial between its values.
class FineSpectrum {
 public:
  explicit FineSpectrum(const BandLimitedPulse& pulse) : half_band_(pulse.half_band()) {
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

  /// scale·∫ s₊(ηu + T/2)·e^{−i2πfu} du [s] at frequencies f from ηf_c + `beside` on.
  /// \param spectrum  a whole number of lanes
  void fill(double beside, double spacing, double doppler, double scale,
            std::span<std::complex<float>> spectrum) const noexcept {
    const double begin = beside / doppler / step_ - first_, on = spacing / doppler / step_;
    const double end = static_cast<double>(re_.size() - taps);
    const auto gain = static_cast<float>(scale / doppler);
    alignas(64) std::array<float, lanes> t;
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
        const auto [real, imaginary] = gather<float, taps, 2>(
            [&](std::size_t i) { return weight[i][l]; },
            [&](std::size_t i, std::size_t part) { return (part == 0 ? x : y)[i]; });
        spectrum[k + l] = {real, imaginary};
      }
    }
  }

 private:
  static constexpr std::size_t taps = 6;
  double half_band_, step_ = 1.0, first_ = 0.0;
  std::vector<float> re_, im_;
};

/// What a piece needs to know of the grid and of the pulse.
///
/// Sample number i is that of the delay i/rate since the ping, in whatever record, and the sound's
/// carrier is the pulse's own frequency.
struct StreamGrid {
  double rate = 1.0;                  // [Hz]
  std::ptrdiff_t begin = 0, end = 0;  // numbers of impulses that a record may receive
  std::size_t guard = 0;              // samples by which a pulse hangs over its impulse
  double half_band = 0.0;             // of the sound about the carrier [Hz]
  double centre = 0.0;                // frequency of the pulse, and carrier [Hz]
  double turn = 0.0;                  // record's carrier less that frequency [Hz]
  double own_half_band = 0.0;         // of the pulse about it, as any stream's factor has it [Hz]
  double pulse_duration = 1.0;        // [s]

  /// The sample at or before a delay.
  [[nodiscard]] std::ptrdiff_t before(double delay) const noexcept {
    return static_cast<std::ptrdiff_t>(std::floor(delay * rate));
  }
  [[nodiscard]] double delay_of(std::ptrdiff_t sample) const noexcept {
    return static_cast<double>(sample) / rate;
  }
};

/// The pulse as Doppler factors segment it, each in the bins about its own shifted carrier. Factors
/// to a 32nd of what a pulse resolves are shifted alike; shapes whose phases at the band's edges
/// are alike to 0.04 rad are one.
class StretchedPulses {
 public:
  StretchedPulses(const FineSpectrum& pulse, const StreamGrid& grid, double spacing)
      : pulse_(pulse),
        grid_(grid),
        spacing_(spacing),
        highest_(static_cast<std::ptrdiff_t>(std::ceil(grid.own_half_band / spacing)) + 1),
        places_(std::ceil(16.0 * grid.pulse_duration * spacing)),
        // A sweep of the band B has the phase 2πf²T/B·η at f from its centre.
        segment_(0.05 / (2.0 * grid.own_half_band * grid.pulse_duration)) {}

  /// Bins of each; its carrier is the middle one.
  [[nodiscard]] std::size_t bins() const noexcept {
    return static_cast<std::size_t>(2 * highest_ + 1);
  }
  [[nodiscard]] std::size_t stride() const noexcept { return (bins() + lanes - 1) / lanes * lanes; }
  /// [stride] from bin `first` beside the carrier on.
  struct Shifted {
    std::ptrdiff_t first = 0;
    const std::complex<float>* values = nullptr;
  };
  [[nodiscard]] Shifted at(double doppler) {
    const double shift = grid_.centre * (doppler - 1.0) / spacing_;
    const double bin = std::floor(shift);
    const long place = std::min(std::lround((shift - bin) * places_), std::lround(places_));
    const long segment = std::lround((doppler - 1.0) / segment_);
    auto [known, is_new] = spectra_.try_emplace({segment, place});
    if (is_new) {
      known->second.resize(stride());
      const double lowest =
          -static_cast<double>(highest_) - static_cast<double>(place) / places_;  // [bins]
      pulse_.fill(lowest * spacing_, spacing_, 1.0 + static_cast<double>(segment) * segment_,
                  spacing_, known->second);
    }
    return {static_cast<std::ptrdiff_t>(bin) - highest_, known->second.data()};
  }

 private:
  const FineSpectrum& pulse_;
  const StreamGrid& grid_;
  double spacing_;
  std::ptrdiff_t highest_;
  double places_, segment_;  // to a bin; of factors
  std::map<std::pair<long, long>, std::vector<std::complex<float>>> spectra_;
};

/// One block's sound at all phones.
struct Piece {
  std::ptrdiff_t first = 0;  // sample of the grid
  std::size_t samples = 0;
  std::vector<std::complex<float>> values;  // [phones × samples]
};

/// What a stream's intensity over delay sends into each of the steps between edges.
class PowerOfSteps {
 public:
  /// \param from, to  delays of the first edge and the last [s]
  PowerOfSteps(const StreamBlock& block, double bin, double from, double to, double step)
      : bin_(bin), bins_(block.end - block.begin), sum_(bins_ + 1) {
    const auto n = static_cast<std::size_t>(std::ceil((to - from) / step));
    for (std::size_t j = 0; j <= n; ++j) {
      const double delay = std::min(to, from + static_cast<double>(j) * step);
      const double at = std::clamp(delay / bin - static_cast<double>(block.begin), 0.0,
                                   static_cast<double>(bins_));
      const std::size_t below = std::min(static_cast<std::size_t>(at), bins_ - 1);
      edges_.push_back({below, at - static_cast<double>(below)});
    }
  }
  [[nodiscard]] std::size_t steps() const noexcept { return edges_.size() - 1; }
  /// \param power  [steps] of [bins of the block] intensity [1/s]
  void find(const float* intensity, std::span<float> power) {
    for (std::size_t i = 0; i < bins_; ++i)
      sum_[i + 1] = sum_[i] + bin_ * static_cast<double>(intensity[i]);
    double before = at(0, intensity);
    for (std::size_t j = 0; j < power.size(); ++j) {
      const double until = at(j + 1, intensity);
      power[j] = static_cast<float>(std::max(0.0, until - before));
      before = until;
    }
  }

 private:
  struct Edge {
    std::size_t bin;
    double within;
  };
  [[nodiscard]] double at(std::size_t edge, const float* intensity) const noexcept {
    const Edge& e = edges_[edge];
    return sum_[e.bin] + e.within * bin_ * static_cast<double>(intensity[e.bin]);
  }

  double bin_;
  std::size_t bins_;
  std::vector<double> sum_;  // up to each bin
  std::vector<Edge> edges_;
};

/// A block's streams. Each has impulses of white noise at the rate of its own band, wherever that
/// lies: noise that is shifted is as white.
Piece piece_of(const ReverberationStreams& sea, const StreamBlock& block, const FineSpectrum& pulse,
               const StreamGrid& grid, std::span<const Vec3> phones, const CovarianceDraw& draw) {
  const double block_begin = static_cast<double>(block.begin) * sea.bin,
               block_end = static_cast<double>(block.end) * sea.bin;
  const std::ptrdiff_t begin = grid.before(block_begin), end = grid.before(block_end) + 1;
  Piece piece;
  // Blocks that were received before the record begins have no impulse that it receives.
  if (end <= grid.begin || begin >= grid.end || block.first == block.last) return piece;
  const auto n = static_cast<std::size_t>(end - begin);
  const std::size_t length = grid_length(static_cast<double>(n + 2 * grid.guard));
  const double spacing = grid.rate / static_cast<double>(length);  // of bins [Hz]
  const std::size_t highest =
      std::min(static_cast<std::size_t>(std::ceil(grid.half_band / spacing)), (length - 1) / 2);
  const std::size_t bins = 2 * highest + 1;
  StretchedPulses pulses(pulse, grid, spacing);
  const std::size_t own = pulses.bins(), stride = pulses.stride();
  const std::size_t own_length = grid_length(static_cast<double>(own));
  const double step = 1.0 / (spacing * static_cast<double>(own_length));  // between impulses [s]
  const double origin = grid.delay_of(begin);
  PowerOfSteps power_of(block, sea.bin, origin, block_end, step);
  // All of the block is drawn, whatever part of it is received.
  const auto received_step = [&](std::size_t j) {
    const double delay = origin + (static_cast<double>(j) + 0.5) * step;
    return delay >= grid.delay_of(grid.begin) && delay < grid.delay_of(grid.end);
  };
  const ComplexFft<float> own_fft(own_length);
  Scratch noise_of(own_length);
  std::vector<float> power(power_of.steps()), normals(2 * power_of.steps());
  Rows sound, received;
  sound.reset(1, own);
  received.reset(phones.size(), bins + 2 * stride);  // factors beyond the band are cut off
  struct Rotation {
    double re = 1.0, im = 0.0;
  };
  const PhonePlaces places(phones);
  std::vector<double> late(phones.size());
  std::vector<Rotation> first(phones.size()), on(phones.size());
  for (std::size_t s = block.first; s < block.last; ++s) {
    const ReverberationStreams::Stream& stream = sea.streams[s];
    const std::uint32_t ping = stream.lasts ? draw.lasting : draw.ping;
    const ReverberationStreams::Part& part = sea.part_of(stream, draw.seed, ping);
    const StretchedPulses::Shifted stretched = pulses.at(part.doppler);
    const std::ptrdiff_t place =
        static_cast<std::ptrdiff_t>(stride + highest) + stretched.first;  // in the rows received
    if (place < 0 || place > static_cast<std::ptrdiff_t>(bins + stride)) continue;
    const double lowest = grid.centre + spacing * static_cast<double>(stretched.first);
    power_of.find(&sea.intensity[stream.first], power);
    for (std::size_t noise = 0; noise < part.weight.size(); ++noise) {
      if (part.weight[noise][0] == 0.0 && part.weight[noise][1] == 0.0) continue;
      fill_normal(normals, draw.seed, Draw::covariance_weight, ping, stream.entity + noise);
      for (std::size_t j = 0; j < power.size(); ++j) {
        const float root = received_step(j) ? std::sqrt(0.5F * power[j]) : 0.0F;
        noise_of[j] = {root * normals[2 * j], root * normals[2 * j + 1]};
      }
      std::fill(noise_of.data() + power.size(), noise_of.data() + own_length, 0.0F);
      own_fft.forward(noise_of.data());
      const auto take = [&](std::size_t from, std::size_t count, std::size_t to) {
        for (std::size_t k = 0; k < count; ++k) {
          const std::complex<float> x = noise_of[from + k], h = stretched.values[to + k];
          sound.re(0)[to + k] = x.real() * h.real() - x.imag() * h.imag();
          sound.im(0)[to + k] = x.real() * h.imag() + x.imag() * h.real();
        }
      };
      take(own_length - own / 2, own / 2, 0);
      take(0, own / 2 + 1, own / 2);
      for (std::size_t wave = 0; wave < part.slowness.size(); ++wave) {
        if (part.weight[noise][wave] == 0.0) continue;
        find_lags(part.slowness[wave], part.length[wave], part.curvature[wave], places, late);
        for (std::size_t p = 0; p < phones.size(); ++p) {
          // An impulse stands in the middle of its step.
          const double delay = 0.5 * step + late[p];
          first[p] = on[p] = {};
          rotate_back(delay * lowest, first[p].re, first[p].im);
          rotate_back(delay * spacing, on[p].re, on[p].im);
        }
        for (std::size_t p = 0; p < phones.size(); ++p)
          add_rotated(sound.re(0), sound.im(0), stride,
                      finite_product(part.weight[noise][wave], {first[p].re, first[p].im}),
                      {on[p].re, on[p].im}, received.re(p) + place, received.im(p) + place);
      }
    }
  }
  piece.first = begin - static_cast<std::ptrdiff_t>(grid.guard);
  piece.samples = n + 2 * grid.guard;
  piece.values.resize(phones.size() * piece.samples);
  const ComplexFft<float> fft(length);
  Scratch scratch(length);
  std::vector<std::complex<float>> turned;  // to the record's carrier, since the ping
  for (std::size_t i = 0; i < piece.samples; ++i) {
    double c = 1.0, s = 0.0;
    const double delay = grid.delay_of(piece.first + static_cast<std::ptrdiff_t>(i));
    rotate_back(grid.turn * (delay + 0.5 * grid.pulse_duration), c, s);
    turned.emplace_back(std::complex<double>(c, s));
  }
  for (std::size_t p = 0; p < phones.size(); ++p) {
    std::fill_n(scratch.data(), length, 0.0F);
    const float *const re = received.re(p) + stride, *const im = received.im(p) + stride;
    for (std::size_t k = 0; k < bins; ++k)
      scratch[k < highest ? length - highest + k : k - highest] = {re[k], im[k]};
    fft.inverse(scratch.data());
    std::complex<float>* const to = piece.values.data() + p * piece.samples;
    for (std::size_t i = 0; i < piece.samples; ++i)
      to[i] = turned[i] * scratch[i < grid.guard ? length - grid.guard + i : i - grid.guard];
  }
  return piece;
}

}  // namespace

Synthesizer::StreamBand Synthesizer::band_of(const ReverberationStreams& sea) const {
  constexpr double left_out = 1e-6;  // of a pulse's energy
  const BandLimitedPulse& pulse = plan_->pulses.front();
  double most = 0.0;
  for (const ReverberationStreams::Part& part : sea.parts)
    most = std::max(most, std::abs(part.doppler - 1.0));
  const double one = half_band_of_energy(pulse, left_out) * (1.0 + most);
  return {.one = one, .all = one + most * pulse.centre_frequency()};
}

Baseband Synthesizer::silence(const ReverberationStreams& sea, std::size_t phones,
                              std::vector<std::complex<float>> memory) const {
  const double period = static_cast<double>(plan_->length) / plan_->rate;
  const double bins = std::ceil(band_of(sea).all * period + 1.0);  // the carrier is on a bin
  return silence_of_band(phones, 2.0 * bins + 1.0, std::move(memory));
}

void Synthesizer::add_streams(const ReverberationStreams& sea, std::span<const Vec3> phones,
                              const CovarianceDraw& draw, Baseband& baseband,
                              const HeardPart& heard) const {
  const Plan& plan = *plan_;
  assert(phones.size() == baseband.channels && baseband.samples <= plan.length);
  const std::size_t fine = baseband.samples;
  const double period = static_cast<double>(plan.length) / plan.rate;
  const StreamBand band = band_of(sea);
  const auto [rate, length] = plan.clock(2.0 * band.all);
  const BandLimitedPulse& pulse = plan.pulses.front();
  // The period begins with the first number at its first moment or after.
  const double origin = plan.recording.start - 0.5 * plan.pulse_duration,
               before = static_cast<double>(plan.lead) / plan.rate;
  const auto first = static_cast<std::ptrdiff_t>(std::ceil(origin * rate));
  const StreamGrid grid{
      .rate = rate,
      .begin = static_cast<std::ptrdiff_t>(std::ceil((origin - before) * rate)),
      .end =
          first + static_cast<std::ptrdiff_t>((plan.last_position / plan.rate - before) * rate) + 1,
      .guard = static_cast<std::size_t>(
                   std::ceil(pulse.half_duration() / (1.0 - plan.max_doppler) * rate)) +
               lanes,
      .half_band = band.all,
      .centre = pulse.centre_frequency(),
      .turn = plan.carrier - pulse.centre_frequency(),
      .own_half_band = band.one,
      .pulse_duration = plan.pulse_duration};
  const FineSpectrum spectrum(pulse);
  std::vector<Piece> pieces(sea.blocks.size());
  double aperture = 0.0;  // [s]
  for (const Vec3& phone : phones) aperture = std::max(aperture, phone.norm() / 1000.0);
  const double beside =  // of a block, that it sounds
      2.0 * (static_cast<double>(grid.guard) / grid.rate + plan.pulse_duration + aperture);
  in_parallel(pieces.size(), [&](std::size_t b) {
    if (!heard.meets(static_cast<double>(sea.blocks[b].begin) * sea.bin - beside,
                     static_cast<double>(sea.blocks[b].end) * sea.bin + beside))
      return;
    pieces[b] = piece_of(sea, sea.blocks[b], spectrum, grid, phones, draw);
  });
  const ComplexFft<float> coarse(length), fft(fine);
  const std::size_t highest =
      std::min({static_cast<std::size_t>(std::ceil(band.all * period + 1.0)),
                static_cast<std::size_t>(plan.highest_bin), (std::min(length, fine) - 1) / 2});
  const std::vector<std::complex<float>> later =
      delay_of_bins(static_cast<double>(first) / rate - origin, period, highest);
  in_parallel(phones.size(), [&](std::size_t phone) {
    Scratch sum(length), values(fine);
    for (const Piece& piece : pieces) {
      const std::complex<float>* const from = piece.values.data() + phone * piece.samples;
      const auto n = static_cast<std::ptrdiff_t>(length);
      auto at = static_cast<std::size_t>(((piece.first - first) % n + n) % n);
      for (std::size_t i = 0; i < piece.samples; ++i) {
        sum[at] += from[i];
        if (++at == length) at = 0;
      }
    }
    coarse.forward(sum.data());
    const float scale = 1.0F / static_cast<float>(length);
    for (std::size_t k = 0; k <= highest; ++k) values[k] = sum[k] * later[k];
    for (std::size_t k = 1; k <= highest; ++k)
      values[fine - k] = sum[length - k] * std::conj(later[k]);
    fft.inverse(values.data());
    std::complex<float>* of_phone = baseband.values.data() + phone * fine;
    for (std::size_t i = 0; i < fine; ++i) of_phone[i] += scale * values[i];
  });
}

}  // namespace asdic::detail
