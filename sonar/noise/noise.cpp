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

namespace {

constexpr std::size_t at_once = 1024;

/// Numbers `first` … of a phone's stream, which fill_normal() makes from multiples of 64 on.
void add_normals(std::span<float> row, float rms, std::uint64_t seed, std::uint32_t realisation,
                 std::size_t channel, std::uint64_t first) {
  constexpr std::uint64_t grid = 64;
  std::array<float, at_once> normals;
  for (std::size_t done = 0; done < row.size();) {
    const std::uint64_t at = first + done, from = at / grid * grid;
    const auto skipped = static_cast<std::size_t>(at - from);
    const std::size_t n = std::min(normals.size() - skipped, row.size() - done);
    fill_normal(std::span(normals).first(skipped + n), seed, Draw::ambient_noise, realisation,
                channel, from);
    for (std::size_t i = 0; i < n; ++i) row[done + i] += rms * normals[skipped + i];
    done += n;
  }
}

}  // namespace

void add_white_noise(std::span<float> all, std::size_t channels, double variance,
                     std::uint64_t seed, std::uint32_t ping) {
  assert(channels > 0 && all.size() % channels == 0);
  const std::size_t samples = all.size() / channels;
  const auto rms = static_cast<float>(std::sqrt(variance));
  in_parallel(channels, [&](std::size_t channel) {
    add_normals(all.subspan(channel * samples, samples), rms, seed, ping, channel, 0);
  });
}

void add_stream_of_white_noise(std::span<float> all, std::size_t channels, double variance,
                               std::uint64_t seed, std::int64_t first) {
  assert(channels > 0 && all.size() % channels == 0);
  const std::size_t samples = all.size() / channels;
  const auto rms = static_cast<float>(std::sqrt(variance));
  // So many numbers to a realisation: its counter holds four times as many. Realisations of pings
  // are counted from 1 up; those of a stream from 0xC0000000, with time before 0 below it.
  constexpr std::int64_t most = std::int64_t{1} << 32;
  constexpr std::uint32_t streams = 0xC0000000U;
  in_parallel(channels, [&](std::size_t channel) {
    for (std::size_t done = 0; done < samples;) {
      const std::int64_t at = first + static_cast<std::int64_t>(done);
      const std::int64_t turn = at >= 0 ? at / most : -((most - 1 - at) / most);
      const auto within = static_cast<std::uint64_t>(at - turn * most);
      const std::size_t n =
          std::min<std::uint64_t>(samples - done, static_cast<std::uint64_t>(most) - within);
      add_normals(all.subspan(channel * samples + done, n), rms, seed,
                  streams + static_cast<std::uint32_t>(turn), channel, within);
      done += n;
    }
  });
}

}  // namespace asdic::detail
