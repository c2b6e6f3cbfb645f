#include "sonar/noise/noise.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/normal.h"
#include "core/units.h"
#include "raytrace/parallel/parallel.h"

namespace asdic::detail {

double white_noise_variance(double spectral_level_db, double sample_rate) noexcept {
  return power_from_db(spectral_level_db) * 0.5 * sample_rate * micropascal * micropascal;
}

double white_baseband_variance(double spectral_level_db, double sample_rate) noexcept {
  return 2.0 * white_noise_variance(spectral_level_db, sample_rate);
}

void add_white_noise(std::span<float> all, std::size_t channels, double variance,
                     std::uint64_t seed, std::uint32_t ping) {
  assert(channels > 0 && all.size() % channels == 0);
  const std::size_t samples = all.size() / channels;
  const auto rms = static_cast<float>(std::sqrt(variance));
  in_parallel(channels, [&](std::size_t channel) {
    float* row = all.data() + channel * samples;
    std::array<float, 1024> normals;
    for (std::size_t first = 0; first < samples; first += normals.size()) {
      const std::size_t n = std::min(normals.size(), samples - first);
      fill_normal(std::span(normals).first(n), seed, Draw::ambient_noise, ping, channel, first);
      for (std::size_t i = 0; i < n; ++i) row[first + i] += rms * normals[i];
    }
  });
}

}  // namespace asdic::detail
