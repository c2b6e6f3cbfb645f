#include "raytrace/waves/waterborne.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "raytrace/parallel/parallel.h"
#include "raytrace/parallel/stop.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t together = 8;  // layers that an end may be in, for kernels to be known

/// What the surface lets be at an edge above the upper end, and the bottom at one below the lower
/// end, scaled so that their product is g.
struct EdgeWaves {
  DepthWave above, below;
};

/// Those of all wavenumbers of a window, at two edges.
struct EdgePair {
  WaterWindow window;
  std::vector<EdgeWaves> waves;  // [window.count]
  [[nodiscard]] std::size_t bytes() const noexcept {
    return sizeof *this + waves.capacity() * sizeof(EdgeWaves);
  }
};

std::shared_ptr<EdgePair> edge_pair(const Environment& ocean, const WaveColumn& column,
                                    double frequency, double furthest, std::size_t upper,
                                    std::size_t lower) {
  auto pair = std::make_shared<EdgePair>();
  pair->window = water_window(column, angle_of_spreading(ocean, frequency), furthest);
  pair->waves.resize(pair->window.count);
  constexpr std::size_t piece = 16;
  in_parallel_chunks(pair->window.count, piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; j += DepthWaves::count) {
      stop_point();
      const Wavenumbers xi(std::min(DepthWaves::count, end - j),
                           [&](std::size_t lane) { return pair->window.at(j + lane); });
      const DepthWaves from_above = column.above(xi, upper), kept = column.below(xi, lower);
      DepthWaves from_below = kept;
      column.ascend(from_below, xi, lower, column.edge(upper));
      for (std::size_t l = 0; l < xi.used; ++l) {
        const DepthWave above = from_above.get(l), below = from_below.get(l), there = kept.get(l);
        // g = −2uv/W, W = uv′ − u′v where both are known; `below` has its derivative upwards.
        const Complex scale = -2.0 / (-above.u * below.du - above.du * below.u);
        // u's growth is in W too, so it cancels, and of v's what it grew on the way up is left.
        pair->waves[j + l] = {{above.u * scale, above.du * scale, 0.0},
                              {there.u, there.du, there.growth - below.growth}};
      }
    }
  });
  return pair;
}

}  // namespace

WaveAt WaveAt::mixed_with(const WaveAt& other, double share) const noexcept {
  const auto mixed = [&](Complex a, Complex b) { return (1.0 - share) * a + share * b; };
  return {mixed(p, other.p), mixed(along, other.along), mixed(by_source, other.by_source),
          mixed(by_receiver, other.by_receiver)};
}

Environment without_bottom(Environment ocean) {
  ocean.bottom.material = ReflectionTable{{0.0, 0.5 * pi}, {0.0, 0.0}, {0.0, 0.0}};
  ocean.bottom.roughness = {};
  return ocean;
}

std::size_t WaterColumn::bytes() const noexcept {
  constexpr std::size_t numbers_a_sample = 16;
  return sizeof *this + column_.layers() * (sizeof(WaveLayer) + sizeof(double)) +
         ocean_.water.depths().size() * numbers_a_sample * sizeof(double);
}

WaterborneWaves::WaterborneWaves(const Environment& ocean, const Need& need,
                                 const OceanMemory& kept) {
  const auto water = kept.memory.remember(
      ExactKey(Kept::water_column, kept.ocean, need.frequency, need.cut_for),
      [&] { return std::make_shared<WaterColumn>(ocean, need.frequency, need.cut_for); });
  const WaveColumn& column = water->column();
  const std::size_t upper = column.layer_at(need.upper) / together * together,
                    lower = std::min(column.layers(),
                                     (column.layer_at(need.lower) / together + 1) * together);
  const auto pair = kept.memory.remember(
      ExactKey(Kept::layer_pair, kept.ocean, need.frequency, need.cut_for, need.furthest, upper,
               lower),
      [&] { return edge_pair(ocean, column, need.frequency, need.furthest, upper, lower); });
  window_ = pair->window;
  kernels_.resize(window_.count);
  constexpr std::size_t piece = 64;
  in_parallel_chunks(window_.count, piece, [&](std::size_t begin, std::size_t end) {
    stop_point();
    for (std::size_t j = begin; j < end; j += DepthWaves::count) {
      const Wavenumbers xi(std::min(DepthWaves::count, end - j),
                           [&](std::size_t lane) { return window_.at(j + lane); });
      DepthWaves above, below;
      for (std::size_t l = 0; l < xi.used; ++l) {
        above.set(l, pair->waves[j + l].above);
        below.set(l, pair->waves[j + l].below);
      }
      column.descend(above, xi, upper, need.upper);
      column.ascend(below, xi, lower, need.lower);
      for (std::size_t l = 0; l < xi.used; ++l) {
        const DepthWave u = above.get(l), v = below.get(l);
        const double grown = std::min(u.growth + v.growth, 100.0);
        const Complex scale = 0.5 * window_.spacing * std::sqrt(2.0 / pi) *
                              window_.weight(xi.xi[l].real()) * std::sqrt(xi.xi[l]) *
                              std::polar(std::exp(grown), 0.25 * pi);
        kernels_[j + l] = {scale * u.u * v.u, scale * u.du * v.u, -scale * u.u * v.du};
      }
    }
  });
}

WaveAt WaterborneWaves::at(double range, bool source_is_upper) const noexcept {
  constexpr std::size_t block = 64;  // wavenumbers between which phases are products
  const auto factor = [&](Complex xi) {
    return std::polar(std::exp(xi.imag() * range), -std::fmod(xi.real() * range, 2.0 * pi));
  };
  const Complex step = std::polar(1.0, -std::fmod(window_.spacing * range, 2.0 * pi));
  Complex p = 0.0, along = 0.0, by_upper = 0.0, by_lower = 0.0, f = 0.0;
  for (std::size_t j = 0; j < kernels_.size(); ++j) {
    const Complex xi = window_.at(j);
    f = j % block == 0 ? factor(xi) : f * step;
    const Kernel& k = kernels_[j];
    const Complex here = f * k.g;
    p += here;
    along += Complex(xi.imag(), -xi.real()) * here;
    by_upper += f * k.by_upper;
    by_lower += f * k.by_lower;
  }
  const double spread = 1.0 / std::sqrt(range);
  WaveAt sum{spread * p, spread * along, spread * by_upper, spread * by_lower};
  if (!source_is_upper) std::swap(sum.by_source, sum.by_receiver);
  return sum;
}

std::size_t WaterborneWaves::bytes() const noexcept {
  return sizeof *this + kernels_.capacity() * sizeof(Kernel);
}

void add_to(ExactKey& key, const WaterborneWaves::Need& need) {
  // Every member by name: one more does not compile until it is here.
  const auto& [frequency, cut_for, upper, lower, furthest] = need;
  key.add_all(frequency, cut_for, upper, lower, furthest);
}

double furthest_in_step(double range) { return std::exp2(std::ceil(4.0 * std::log2(range)) / 4.0); }

}  // namespace asdic::detail
