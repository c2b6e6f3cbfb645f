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
  WavScale scale{};
  bool has_scale = false;  ///< NAME.wav.json is there; else the scale is not known
};
/// Reads what the head of a WAV file and the JSON beside it tell.
/// \throws InputError if the sound or what is beside it cannot be read
[[nodiscard]] WavContent read_wav_content(const std::filesystem::path& path);

/// Writes phones as 32-bit float WAV, full scale the largest |sample|, and NAME.wav.json with
/// pascal_per_unit, sample_rate_hz, channels and samples.
/// \param pressure  [channels × samples] row per phone [Pa]
/// \return the scale that was used
/// \throws RunError if the file cannot be written; InputError for a shape that does not fit, or for
/// files that are there and not ours (`rules` may force it)
WavScale write_wav(const std::filesystem::path& path, std::span<const float> pressure,
                   std::size_t channels, double sample_rate, const OutputRules& rules = {});

}  // namespace asdic::detail
