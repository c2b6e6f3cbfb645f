#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace asdic {

/// Variance of white noise sampled at `sample_rate` [Pa²]: a one-sided spectral level NL fills the
/// band to half the rate, 10^(NL/10)·fs/2 µPa² (PHYSICS: 40 dB at 16 kHz is 79.0 dB).
[[nodiscard]] double white_noise_variance(double spectral_level_db, double sample_rate) noexcept;

/// Adds Gaussian noise, white and independent from phone to phone and ping to ping.
///
/// Each phone's noise is its own stream, (seed, ambient_noise, ping, channel): the same bits for
/// any number of threads, and a phone's noise does not change when others are added. \param
/// pressure  [channels × samples] [Pa], row per phone   \param spectral_level_db  NL [dB re 1
/// µPa²/Hz]
void add_white_noise(std::span<float> pressure, std::size_t channels, double spectral_level_db,
                     double sample_rate, std::uint64_t seed, std::uint32_t ping);

}  // namespace asdic
