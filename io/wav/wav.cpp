#include "io/wav/wav.h"

#include <sndfile.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "core/error.h"
#include "core/memory_budget.h"
#include "io/files/input_file.h"
#include "io/hdf5/own_files.h"
#include "io/text/csv_table.h"

namespace asdic::detail {
namespace {

struct CloseSound {
  void operator()(SNDFILE* file) const { sf_close(file); }
};
using SoundFile = std::unique_ptr<SNDFILE, CloseSound>;

/// \throws InputError for more samples than a pulse may have, or than there is memory for
void check_length(const std::filesystem::path& path, std::size_t samples) {
  constexpr std::size_t most = std::size_t{1} << 25;
  constexpr double bytes_each = 200.0;  // with the spectrum and the analytic signal of a pulse
  if (samples > most)
    throw InputError({.where = path.string(),
                      .got = "more than " + std::to_string(most) + " samples",
                      .expected = "no more in a pulse"});
  MemoryBudget budget = MemoryBudget::without_key();
  budget.take({.where = path.string(),
               .what = std::to_string(samples) + " samples of a pulse",
               .bytes = bytes_each * static_cast<double>(samples),
               .remedy = "a shorter pulse or a lower sample rate"});
}

constexpr const char* software = "asdic";

SampledPulse read_csv_pulse(const std::filesystem::path& path) {
  const CsvTable csv = read_csv(path);
  const auto& time = csv.column("time");
  SampledPulse pulse{.samples = csv.column("pressure")};
  const std::size_t n = time.size();
  if (n < 2) throw InputError({.where = csv.file, .got = "one sample", .expected = "at least two"});
  check_length(path, n);
  const double step = (time.back() - time.front()) / static_cast<double>(n - 1);
  for (std::size_t i = 1; i < n; ++i)  // times are often printed with few digits
    if (!(step > 0.0) || std::abs(time[i] - time[i - 1] - step) > 0.01 * step)
      throw InputError({.where = csv.file + ":" + std::to_string(csv.lines[i]) + ": time",
                        .got = "a step of " + std::to_string(time[i] - time[i - 1]) + " s",
                        .expected = "even steps of " + std::to_string(step) + " s"});
  pulse.sample_rate = 1.0 / step;
  return pulse;
}

SampledPulse read_sound_pulse(const std::filesystem::path& path) {
  SF_INFO info{};
  const InputFile input(path, "a mono WAV file");
  const SoundFile file(sf_open_fd(input.descriptor(), SFM_READ, &info, SF_FALSE));
  if (file == nullptr)
    throw InputError(
        {.where = path.string(),
         .got = "a file that libsndfile cannot read (" + std::string(sf_strerror(nullptr)) + ")",
         .expected = "a mono WAV file, or CSV with the header time,pressure"});
  if (info.channels != 1)
    throw InputError({.where = path.string(),
                      .got = std::to_string(info.channels) + " channels",
                      .expected = "one channel"});
  // A header may claim what it likes: memory grows with what is read.
  SampledPulse pulse{.samples = {}, .sample_rate = static_cast<double>(info.samplerate)};
  constexpr sf_count_t block = 65536;
  std::vector<double> samples(block);
  while (const sf_count_t n = sf_readf_double(file.get(), samples.data(), block)) {
    pulse.samples.insert(pulse.samples.end(), samples.begin(), samples.begin() + n);
    check_length(path, pulse.samples.size());
  }
  const std::size_t read = pulse.samples.size();
  if (static_cast<sf_count_t>(read) != info.frames || read < 2)
    throw InputError({.where = path.string(),
                      .got = std::to_string(read) + " samples, where its header claims " +
                             std::to_string(info.frames),
                      .expected = "a whole file of at least two samples"});
  return pulse;
}

std::string json_beside(const std::filesystem::path& path) { return path.string() + ".json"; }

}  // namespace

WavContent read_wav_content(const std::filesystem::path& path) {
  constexpr const char* expected = "a WAV file of asdic export";
  SF_INFO info{};
  const InputFile input(path, expected);
  const SoundFile file(sf_open_fd(input.descriptor(), SFM_READ, &info, SF_FALSE));
  if (file == nullptr)
    throw InputError(
        {.where = path.string(),
         .got = "a file that libsndfile cannot read (" + std::string(sf_strerror(nullptr)) + ")",
         .expected = expected});
  WavContent content{.channels = static_cast<std::size_t>(info.channels),
                     .samples = static_cast<std::size_t>(info.frames),
                     .scale = {.sample_rate = static_cast<double>(info.samplerate)}};
  std::error_code ignored;
  if (!std::filesystem::exists(json_beside(path), ignored)) return content;
  const std::string json = read_input(json_beside(path), "what asdic export wrote of a WAV file");
  try {
    const auto beside = nlohmann::json::parse(json);
    content.scale = {.pascal_per_unit = beside.at("pascal_per_unit"),
                     .sample_rate = beside.at("sample_rate_hz")};
    content.carrier = beside.value("carrier_hz", 0.0);
    content.has_scale = true;
  } catch (const nlohmann::json::exception& error) {
    throw InputError({.where = json_beside(path),
                      .got = "what cannot be read (" + std::string(error.what()) + ")",
                      .expected = "pascal_per_unit and sample_rate_hz of the WAV file"});
  }
  return content;
}

bool own::sound(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  SF_INFO info{};
  const SoundFile file(sf_open(path.c_str(), SFM_READ, &info));
  if (file == nullptr) return false;
  const char* const said = sf_get_string(file.get(), SF_STR_SOFTWARE);
  return (said != nullptr && std::string(said).starts_with(software)) ||
         own::sound_scale(path.string() + ".json");
}

SampledPulse read_pulse_file(const std::filesystem::path& path) {
  SampledPulse pulse = path.extension() == ".csv" ? read_csv_pulse(path) : read_sound_pulse(path);
  double peak = 0.0;
  for (const double sample : pulse.samples) {
    if (!std::isfinite(sample))
      throw InputError({.where = path.string(),
                        .got = "a sample that is not finite",
                        .expected = "finite samples"});
    peak = std::max(peak, std::abs(sample));
  }
  if (peak == 0.0)
    throw InputError({.where = path.string(), .got = "silence", .expected = "a pulse"});
  for (double& sample : pulse.samples) sample /= peak;
  return pulse;
}

WavScale write_wav(const std::filesystem::path& path, std::span<const float> pressure,
                   WavChannels content, double sample_rate, const OutputRules& rules) {
  const std::size_t parts = content.carrier > 0.0 ? 2 : 1;  // channels of a phone
  const std::size_t channels = content.phones * parts;
  if (channels == 0 || channels > most_wav_channels || pressure.size() % channels != 0)
    throw InputError({.where = path.string(),
                      .got = std::to_string(pressure.size()) + " samples on " +
                             std::to_string(channels) + " channels",
                      .expected = "1 to 1024 channels of equal length"});
  const std::size_t samples = pressure.size() / channels;
  if (static_cast<double>(pressure.size()) * sizeof(float) > 4.0e9)
    throw InputError({.where = path.string(),
                      .got = std::to_string(pressure.size()) + " samples in all",
                      .expected = "less than 4 GB, the most that a WAV file holds"});
  float peak = 0.0F;
  for (const float p : pressure) peak = std::max(peak, std::abs(p));
  const double scale = peak > 0.0F ? static_cast<double>(peak) : 1.0;

  OutputRules of_sound = rules, of_scale = rules;
  of_sound.own = own::sound;
  of_scale.own = own::sound_scale;
  OutputFile sound(path, of_sound), json(path.string() + ".json", of_scale);
  SF_INFO info{};
  info.samplerate = static_cast<int>(std::lround(sample_rate));
  info.channels = static_cast<int>(channels);
  info.format = SF_FORMAT_WAV | SF_FORMAT_FLOAT;
  SoundFile file(sf_open(sound.part().c_str(), SFM_WRITE, &info));
  if (file == nullptr)
    throw RunError(path.string() + ": cannot be written: " + sf_strerror(nullptr));
  sf_set_string(file.get(), SF_STR_SOFTWARE, software);
  constexpr std::size_t block = 65536;  // frames at a time: phones are interleaved here
  std::vector<float> frames;
  for (std::size_t start = 0; start < samples; start += block) {
    const std::size_t n = std::min(block, samples - start);
    frames.resize(n * channels);
    for (std::size_t channel = 0; channel < channels; ++channel)
      for (std::size_t i = 0; i < n; ++i)
        frames[i * channels + channel] = static_cast<float>(
            static_cast<double>(
                pressure[(channel / parts * samples + start + i) * parts + channel % parts]) /
            scale);
    if (sf_writef_float(file.get(), frames.data(), static_cast<sf_count_t>(n)) !=
        static_cast<sf_count_t>(n))
      throw RunError(path.string() + ": cannot be written: " + sf_strerror(file.get()));
  }

  if (sf_close(file.release()) != 0) throw RunError(path.string() + ": cannot be written");

  nlohmann::json about{{"pascal_per_unit", scale},
                       {"sample_rate_hz", sample_rate},
                       {"channels", channels},
                       {"samples", samples}};
  if (content.carrier > 0.0) about["carrier_hz"] = content.carrier;
  json.write(about.dump(2) + '\n');
  sound.finish();
  return {.pascal_per_unit = scale, .sample_rate = sample_rate};
}

}  // namespace asdic::detail
