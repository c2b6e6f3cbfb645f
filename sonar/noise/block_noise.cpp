#include "sonar/noise/block_noise.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/normal.h"
#include "raytrace/parallel/parallel.h"
#include "sonar/signal/fft.h"

namespace asdic::detail {
namespace {

constexpr std::size_t blocks_at_once = 4;
constexpr std::size_t tile = 256;  // bins of all phones that stay in the cache

}  // namespace

std::size_t BlockNoise::block_length(double sample_rate, std::span<const Vec3> phones,
                                     double across, double sound_speed) {
  for (const Vec3& a : phones)
    for (const Vec3& b : {phones.front(), phones.back()})
      across = std::max(across, 2.0 * (a - b).norm());  // a bound on the longest separation
  const double least = std::clamp(
      std::max(0.25 * sample_rate, 16.0 * across / sound_speed * sample_rate), 256.0, 1048576.0);
  std::size_t n = 256;
  while (static_cast<double>(n) < least) n *= 2;
  return n;
}

/// Spectra of a few blocks at once: [blocks × phones × bins], parts apart.
struct BlockNoise::Scratch {
  std::vector<float> real, imaginary, normals;
  FftBuffer<std::complex<float>> spectrum;
  FftBuffer<float> samples;
};

BlockNoise::BlockNoise(const std::function<double(double)>& density, double sample_rate,
                       double carrier, std::span<const Vec3> phones, NoiseCoherence coherence,
                       const NoiseDirections& directions, double sound_speed, const NoiseKey& key,
                       double across, PropagationMemory* memory)
    : shape_(phones.begin(), phones.end()),
      phones_(phones.size()),
      block_(block_length(sample_rate, phones, across, sound_speed)),
      bins_(carrier > 0.0 ? block_ : block_ / 2 + 1),
      complex_(carrier > 0.0),
      key_(key),
      coherence_(coherence),
      directions_(directions),
      sound_speed_(sound_speed),
      lowest_(complex_ ? carrier - 0.5 * sample_rate : 0.0),
      step_(sample_rate / static_cast<double>(block_)),
      memory_(memory),
      scale_(bins_, 0.0F),
      window_(block_) {
  for (std::size_t i = 0; i < bins_; ++i) {
    const double f = lowest_ + static_cast<double>(i) * step_;
    if (!(f > 0.0) || (!complex_ && i + 1 == bins_)) continue;  // the last bin has no phase
    // Real: E|a|² = S·Δf/2 for the bin and as much for its mirror. Complex: b has twice the
    // density.
    scale_[i] = static_cast<float>(std::sqrt(density(f) * step_ * (complex_ ? 1.0 : 0.25)));
  }
  for (std::size_t n = 0; n < block_; ++n)
    window_[n] = static_cast<float>(
        std::sin(pi * (static_cast<double>(n) + 0.5) / static_cast<double>(block_)));
  if (coherence != NoiseCoherence::independent && phones_ > 1) factors_ = factors_of(phones);
}

double BlockNoise::power() const noexcept {
  double sum = 0.0;
  for (const double scale : scale_) sum += scale * scale;
  return complex_ ? sum : 4.0 * sum;  // scale² is S·Δf, of real pressure S·Δf/4
}

std::shared_ptr<const CoherenceFactors> BlockNoise::factors_of(std::span<const Vec3> phones) const {
  return CoherenceFactors::recalled(memory_, coherence_, directions_, phones, sound_speed_, lowest_,
                                    step_, bins_);
}

/// Independent spectra of every phone, already scaled.
void BlockNoise::draw(std::span<const std::int64_t> blocks, std::uint32_t realisation,
                      Scratch& s) const {
  s.real.resize(blocks.size() * phones_ * bins_);
  s.imaginary.resize(s.real.size());
  s.normals.resize(2 * bins_);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    for (std::size_t phone = 0; phone < phones_; ++phone) {
      // Block −1 has its number too.
      const std::uint64_t entity = (static_cast<std::uint64_t>(blocks[b] + (1LL << 40)) << 16) |
                                   (key_.first_channel + phone);
      fill_normal(s.normals, key_.seed, key_.purpose, realisation, entity);
      float* real = s.real.data() + (b * phones_ + phone) * bins_;
      float* imaginary = s.imaginary.data() + (b * phones_ + phone) * bins_;
      for (std::size_t i = 0; i < bins_; ++i) {
        real[i] = scale_[i] * s.normals[i];
        imaginary[i] = scale_[i] * s.normals[bins_ + i];
      }
    }
  }
}

/// Blocks `from` … `to` − 1 in place, from the last phone up: row i needs the rows before it as
/// they were drawn.
void BlockNoise::correlate(const CoherenceFactors& factors, std::size_t from, std::size_t to,
                           Scratch& s) const {
  std::array<float, tile> re{}, im{};
  const bool real = factors.is_real();
  for (std::size_t first = 0; first < bins_; first += tile) {
    const std::size_t n = std::min(tile, bins_ - first);
    for (std::size_t i = phones_; i-- > 0;) {
      for (std::size_t j = i + 1; j-- > 0;) {
        factors.element(i, j, first, std::span(re).first(n), std::span(im).first(n));
        for (std::size_t b = from; b < to; ++b) {
          float* __restrict yr = s.real.data() + (b * phones_ + i) * bins_ + first;
          float* __restrict yi = s.imaginary.data() + (b * phones_ + i) * bins_ + first;
          const float* xr = s.real.data() + (b * phones_ + j) * bins_ + first;
          const float* xi = s.imaginary.data() + (b * phones_ + j) * bins_ + first;
          if (j == i) {  // the diagonal is real
            for (std::size_t k = 0; k < n; ++k) {
              yr[k] *= re[k];
              yi[k] *= re[k];
            }
          } else if (real) {
            for (std::size_t k = 0; k < n; ++k) {
              yr[k] += re[k] * xr[k];
              yi[k] += re[k] * xi[k];
            }
          } else {
            for (std::size_t k = 0; k < n; ++k) {
              yr[k] += re[k] * xr[k] - im[k] * xi[k];
              yi[k] += re[k] * xi[k] + im[k] * xr[k];
            }
          }
        }
      }
    }
  }
}

/// One phone's block in time, weighted: left in `samples` (real and imaginary part in turn).
void BlockNoise::sound(std::size_t block, std::size_t phone, Scratch& s) const {
  const float* real = s.real.data() + (block * phones_ + phone) * bins_;
  const float* imaginary = s.imaginary.data() + (block * phones_ + phone) * bins_;
  s.spectrum.reserve(bins_);
  s.samples.reserve(block_ * (complex_ ? 2 : 1));
  if (!complex_) {
    for (std::size_t i = 0; i < bins_; ++i) s.spectrum[i] = {real[i], imaginary[i]};
    RealFft<float>(block_).inverse(s.spectrum.data(), s.samples.data());
    for (std::size_t n = 0; n < block_; ++n) s.samples[n] *= window_[n];
    return;
  }
  const std::size_t half = block_ / 2;  // bin i is the offset i − N/2 from the carrier
  for (std::size_t i = 0; i < half; ++i) {
    s.spectrum[i] = {real[i + half], imaginary[i + half]};
    s.spectrum[i + half] = {real[i], imaginary[i]};
  }
  ComplexFft<float>(block_).inverse(s.spectrum.data());
  for (std::size_t n = 0; n < block_; ++n) {
    s.samples[2 * n] = window_[n] * s.spectrum[n].real();
    s.samples[2 * n + 1] = window_[n] * s.spectrum[n].imag();
  }
}

void BlockNoise::add(std::span<float> rows, std::int64_t first, std::uint32_t realisation) const {
  add_blocks(rows, first, realisation, [&](std::int64_t) { return factors_; });
}

void BlockNoise::add(std::span<float> rows, std::int64_t first, std::uint32_t realisation,
                     std::span<const Vec3> shape) const {
  assert(shape.size() == phones_);
  const bool as_ever = !factors_ || std::equal(shape.begin(), shape.end(), shape_.begin());
  const Factors factors = as_ever ? factors_ : factors_of(shape);
  add_blocks(rows, first, realisation, [&](std::int64_t) { return factors; });
}

void BlockNoise::add(std::span<float> rows, std::int64_t first, std::uint32_t realisation,
                     const ShapeAt& shape_at) const {
  if (!factors_) return add(rows, first, realisation);
  add_blocks(rows, first, realisation, [&](std::int64_t block) {
    const std::vector<Vec3> shape = shape_at((block + 1) * static_cast<std::int64_t>(block_ / 2));
    assert(shape.size() == phones_);
    return shape == shape_ ? factors_ : factors_of(shape);
  });
}

void BlockNoise::add_blocks(std::span<float> rows, std::int64_t first, std::uint32_t realisation,
                            const std::function<Factors(std::int64_t block)>& factors_in) const {
  const std::size_t width = complex_ ? 2 : 1;
  assert(rows.size() % (phones_ * width) == 0);
  const auto samples = static_cast<std::int64_t>(rows.size() / (phones_ * width));
  if (samples == 0) return;
  const auto hop = static_cast<std::int64_t>(block_ / 2);
  const auto floor_div = [](std::int64_t a, std::int64_t b) {
    return (a >= 0 ? a : a - b + 1) / b;
  };
  const std::int64_t from = floor_div(first, hop) - 1, to = floor_div(first + samples - 1, hop);
  tbb::enumerable_thread_specific<Scratch> scratch;
  // Even blocks, then odd ones: those of a pass do not overlap, and every sample is added to in the
  // same order whatever part is asked for.
  for (std::int64_t parity = 0; parity < 2; ++parity) {
    std::vector<std::int64_t> blocks;
    for (std::int64_t b = from; b <= to; ++b)
      if (((b % 2) + 2) % 2 == parity) blocks.push_back(b);
    const std::size_t tasks = (blocks.size() + blocks_at_once - 1) / blocks_at_once;
    in_parallel(tasks, [&](std::size_t task) {
      const std::span some =
          std::span(blocks)
              .subspan(task * blocks_at_once)
              .first(std::min(blocks_at_once, blocks.size() - task * blocks_at_once));
      // Before the scratch memory is taken: while factors are made this thread may do other tasks.
      std::vector<Factors> factors;
      for (const std::int64_t block : some) factors.push_back(factors_in(block));
      Scratch& s = scratch.local();
      draw(some, realisation, s);
      for (std::size_t b = 0, next = 0; b < some.size(); b = next) {  // those of one shape at once
        for (next = b + 1; next < some.size() && factors[next] == factors[b];) ++next;
        if (factors[b]) correlate(*factors[b], b, next, s);
      }
      for (std::size_t b = 0; b < some.size(); ++b) {
        const std::int64_t begin = some[b] * hop - first;  // of the block, in the rows
        const std::int64_t low = std::max<std::int64_t>(0, begin),
                           high = std::min(samples, begin + 2 * hop);
        if (low >= high) continue;
        for (std::size_t phone = 0; phone < phones_; ++phone) {
          sound(b, phone, s);
          const float* in = s.samples.data() + static_cast<std::size_t>(low - begin) * width;
          float* out =
              rows.data() +
              (phone * static_cast<std::size_t>(samples) + static_cast<std::size_t>(low)) * width;
          const std::size_t n = static_cast<std::size_t>(high - low) * width;
          for (std::size_t i = 0; i < n; ++i) out[i] += in[i];
        }
      }
    });
  }
}

}  // namespace asdic::detail
