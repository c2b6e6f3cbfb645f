#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "io/files/output_file.h"
#include "sonar/signal/waveforms/sampled_pulse.h"

namespace asdic::detail {

/// Reads a pulse from a mono WAV file (or any other format of libsndfile), or from a CSV file with
/// the header time,pressure and evenly spaced times. Scaled to a largest |sample| of 1.
/// \throws InputError if it cannot be read, has several channels, is silent or unevenly sampled
[[nodiscard]] SampledPulse read_pulse_file(const std::filesystem::path& path);

/// What a WAV file cannot say about itself; stands in NAME.wav.json beside it.
struct WavScale {
  double pascal_per_unit = 1.0;
  double sample_rate = 0.0;  ///< exact; the WAV header rounds it to whole Hz [Hz]
};

/// What a file of write_wav() holds.
struct WavContent {
  std::size_t channels = 0, samples = 0;
  double carrier = 0.0;  ///< of complex baseband, two channels a phone [Hz]; 0: pressure
  WavScale scale{};
  bool has_scale = false;  ///< NAME.wav.json is there; else the scale is not known
};
/// Reads what the head of a WAV file and the JSON beside it tell.
/// \throws InputError if the sound or what is beside it cannot be read
[[nodiscard]] WavContent read_wav_content(const std::filesystem::path& path);

/// What the channels are: phones, or of complex baseband two channels a phone, real part (I) and
/// imaginary part (Q), so that one phone is a stereo file with I on the left.
struct WavChannels {
  std::size_t phones = 1;
  double carrier = 0.0;  ///< of complex baseband [Hz]; 0: pressure
};

/// Writes phones as 32-bit float WAV, full scale the largest |sample|, and NAME.wav.json with
/// pascal_per_unit, sample_rate_hz, channels and samples; of complex baseband carrier_hz, too.
/// \param pressure  [phones × samples] row per phone, of complex baseband [phones × samples × 2],
/// I and Q in turn [Pa]
/// \return the scale that was used
/// \throws RunError if the file cannot be written; InputError for a shape that does not fit, or for
/// files that are there and not ours (`rules` may force it)
WavScale write_wav(const std::filesystem::path& path, std::span<const float> pressure,
                   WavChannels content, double sample_rate, const OutputRules& rules = {});
inline constexpr std::size_t most_wav_channels = 1024;  ///< of libsndfile

}  // namespace asdic::detail
