#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace asdic::detail {

/// Variance of white noise sampled at `sample_rate` [Pa²]: a one-sided spectral level NL fills the
/// band to half the rate, 10^(NL/10)·fs/2 µPa² (40 dB at 16 kHz is 79.0 dB).
[[nodiscard]] double white_noise_variance(double spectral_level_db, double sample_rate) noexcept;

/// The same in complex baseband, of the real as of the imaginary part: p = Re{b e^{iωt}} has half
/// of E|b|², and the band is as wide as the rate.
[[nodiscard]] double white_baseband_variance(double spectral_level_db, double sample_rate) noexcept;

/// Adds Gaussian noise, white and independent from phone to phone and ping to ping.
///
/// Each phone's noise is its own stream, (seed, ambient_noise, ping, channel): the same bits for
/// any number of threads, and a phone's noise does not change when others are added. \param
/// all  [channels × samples] [Pa], row per phone, real or the parts of complex ones in turn
/// \param variance  of each number [Pa²]
void add_white_noise(std::span<float> all, std::size_t channels, double variance,
                     std::uint64_t seed, std::uint32_t ping);

/// The same of a stream, which has no pings: numbers `first` … of every phone's, whatever part of
/// it is asked for.
void add_stream_of_white_noise(std::span<float> all, std::size_t channels, double variance,
                               std::uint64_t seed, std::int64_t first);

}  // namespace asdic::detail
