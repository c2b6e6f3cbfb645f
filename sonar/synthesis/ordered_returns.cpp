#include "sonar/synthesis/ordered_returns.h"

#include <cmath>

#include "core/rotate_back.h"
#include "raytrace/parallel/parallel.h"

namespace asdic::detail {
namespace {

/// Puts the indices `from` into the order of their keys, equal ones as they were.
/// \param counts  scratch; afterwards counts[k] is where the indices of key k end
void counting_sort(std::span<const std::uint32_t> from, std::span<const std::uint32_t> keys,
                   std::size_t different, std::vector<std::uint32_t>& counts,
                   std::span<std::uint32_t> sorted) {
  counts.assign(different + 1, 0);
  for (const std::uint32_t i : from) ++counts[keys[i] + 1];
  for (std::size_t k = 0; k < different; ++k) counts[k + 1] += counts[k];
  for (const std::uint32_t i : from) sorted[counts[keys[i]]++] = i;
}

}  // namespace

OrderedReturns::OrderedReturns(std::vector<DopplerBand> found, const Grid& grid,
                               double pulse_duration, std::size_t channels, std::size_t responses)
    : expansion_(std::move(found)),
      grid_(grid),
      pulse_duration_(pulse_duration),
      channels_(channels),
      responses_(responses) {
  for (const DopplerBand& band : expansion_) {
    bands.push_back({.first_node = nodes.size(),
                     .nodes = band.nodes.size(),
                     .moved = band.ridge != 0.0,
                     .ends = {}});
    for (const double node : band.nodes)
      nodes.push_back({.doppler = node,
                       .late = band.late(node),
                       .rotation = band.rotation(node, grid_.carrier)});
  }
}

std::size_t OrderedReturns::bytes_each() const noexcept {
  std::size_t most = 0;
  for (const Band& band : bands) most = std::max(most, band.nodes);
  return sizeof(Return) + 6 * sizeof(double) + 6 * sizeof(std::uint32_t) +
         responses_ * 2 * sizeof(std::complex<float>) + (most > 1 ? most * sizeof(float) : 0);
}

double OrderedReturns::latest() const noexcept {
  double most = 0.0;
  for (const DopplerBand& band : expansion_)
    most = std::max(most, std::abs(band.late(band.highest)));
  return most;
}

void OrderedReturns::take(std::span<const ReturnBlock> blocks) {
  std::vector<std::size_t> first(blocks.size() + 1, 0);
  for (std::size_t b = 0; b < blocks.size(); ++b)
    first[b + 1] = first[b] + blocks[b].returns.size();
  const std::size_t n = first.back();
  source_.resize(n);
  for (auto* keys : {&sample_, &group_, &by_sample_, &order_}) keys->resize(n);
  for (auto* array : {&impulse, &slowness_x, &slowness_y, &slowness_z, &doppler_}) array->resize(n);
  const bool any_moved =
      std::any_of(bands.begin(), bands.end(), [](const Band& band) { return band.moved; });
  late.resize(any_moved ? n : 0);
  for (auto* array : {&real, &imag}) array->resize(responses_ * n);

  const auto middle_of = [&](const Return& r) {
    return r.delay + 0.5 * pulse_duration_ / r.doppler;
  };
  in_parallel(blocks.size(), [&](std::size_t b) {
    const Returns& returns = blocks[b].returns;
    for (std::size_t i = 0; i < returns.size(); ++i) {
      const Return& r = returns[i];
      const auto above = std::upper_bound(
          expansion_.begin() + 1, expansion_.end(), r.doppler,
          [](double doppler, const DopplerBand& band) { return doppler < band.lowest; });
      const auto band = static_cast<std::size_t>(above - expansion_.begin()) - 1;
      const auto listener = static_cast<std::size_t>(r.channel - Return::all_channels);
      source_[first[b] + i] = std::uint64_t{b} << 32 | i;
      double delay = middle_of(r);
      if (any_moved) delay += expansion_[band].late(r.doppler);
      sample_[first[b] + i] = static_cast<std::uint32_t>(sample_at(delay));
      group_[first[b] + i] = static_cast<std::uint32_t>(band * (channels_ + 1) + listener);
    }
  });
  sort(n);

  in_parallel_chunks(n, 8192, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint64_t source = source_[order_[i]], in_block = source & 0xFFFFFFFFU;
      const ReturnBlock& block = blocks[source >> 32];
      const Return& r = block.returns[in_block];
      impulse[i] = middle_of(r);
      doppler_[i] = r.doppler;
      slowness_x[i] = r.slowness.x();
      slowness_y[i] = r.slowness.y();
      slowness_z[i] = r.slowness.z();
      for (std::size_t k = 0; k < responses_; ++k) {
        const std::complex<float> amplitude = block.responses.empty()
                                                  ? std::complex<float>(r.amplitude)
                                                  : block.responses[in_block * responses_ + k];
        real[k * n + i] = amplitude.real();
        imag[k * n + i] = amplitude.imag();
      }
    }
  });
  largest_slowness = 0.0;
  for (std::size_t i = 0; i < n; ++i)
    largest_slowness =
        std::max(largest_slowness, slowness_x[i] * slowness_x[i] + slowness_y[i] * slowness_y[i] +
                                       slowness_z[i] * slowness_z[i]);
  largest_slowness = std::sqrt(largest_slowness);

  std::size_t weight_count = 0;
  for (std::size_t b = 0; b < bands.size(); ++b) {
    Band& band = bands[b];
    band.ends.assign(1, b == 0 ? 0 : bands[b - 1].ends.back());
    for (std::size_t listener = 0; listener <= channels_; ++listener)
      band.ends.push_back(group_ends_[b * (channels_ + 1) + listener]);
    band.first_weight = weight_count;
    if (band.nodes > 1) weight_count += (band.ends.back() - band.ends.front()) * band.nodes;
  }
  weights.resize(weight_count);
  for (std::size_t b = 0; b < bands.size(); ++b) {
    const Band& band = bands[b];
    const std::size_t from = band.ends.front();
    in_parallel_chunks(band.ends.back() - from, 1024, [&](std::size_t begin, std::size_t end) {
      if (band.moved) move(expansion_[b], from + begin, from + end);
      for (std::size_t i = begin; band.nodes > 1 && i < end; ++i) {
        const std::size_t row = band.first_weight + i * band.nodes;
        expansion_[b].weights(doppler_[from + i], std::span(weights).subspan(row, band.nodes));
      }
    });
  }
}

void OrderedReturns::move(const DopplerBand& band, std::size_t begin, std::size_t end) noexcept {
  const std::size_t n = size();
  for (std::size_t i = begin; i < end; ++i) {
    late[i] = band.late(doppler_[i]);
    impulse[i] += late[i];
  }
  for (std::size_t k = 0; k < responses_; ++k) {
    float* const re = real.data() + k * n;
    float* const im = imag.data() + k * n;
    for (std::size_t i = begin; i < end; ++i) {
      double a = re[i], b = im[i];
      rotate_back(-band.rotation(doppler_[i], grid_.carrier), a, b);
      re[i] = static_cast<float>(a);
      im[i] = static_cast<float>(b);
    }
  }
}

/// `order_`: by group, within a group by sample, within a sample as they came.
void OrderedReturns::sort(std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) order_[i] = static_cast<std::uint32_t>(i);
  counting_sort(order_, sample_, grid_.samples + 1, counts_, by_sample_);
  const std::size_t groups = bands.size() * (channels_ + 1);
  counting_sort(by_sample_, group_, groups, counts_, order_);
  group_ends_.assign(counts_.begin(), counts_.begin() + static_cast<std::ptrdiff_t>(groups));
}

}  // namespace asdic::detail
