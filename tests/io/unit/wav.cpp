#include "io/wav/wav.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sndfile.h>
#include <sys/resource.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/units.h"
#include "io/scenario/scenario_reader.h"
#include "io/text/csv_table.h"
#include "support/temporary_directory.h"

namespace asdic::detail {
namespace {

using support::TemporaryDirectory;
using testing::HasSubstr;

std::string message(const std::filesystem::path& path) {
  try {
    static_cast<void>(read_pulse_file(path));
  } catch (const InputError& error) {
    return error.what();
  }
  return "read without complaint";
}

TEST(Wav, PhonesComeBackThroughTheScale) {
  const TemporaryDirectory folder;
  const std::size_t samples = 70'001;  // more than one block of the writer
  std::vector<float> pressure(2 * samples);
  for (std::size_t i = 0; i < pressure.size(); ++i)
    pressure[i] = 3.0e-4F * static_cast<float>(std::sin(0.01 * static_cast<double>(i)));
  const WavScale scale = write_wav(folder / "p.wav", pressure, {.phones = 2}, 16000.0);
  const auto json = nlohmann::json::parse(read_text_file(folder / "p.wav.json"));
  EXPECT_EQ(json["pascal_per_unit"], scale.pascal_per_unit);
  EXPECT_EQ(json["channels"], 2);
  EXPECT_EQ(json["samples"], samples);

  SF_INFO info{};
  SNDFILE* file = sf_open((folder / "p.wav").c_str(), SFM_READ, &info);
  ASSERT_NE(file, nullptr);
  EXPECT_EQ(info.channels, 2);
  EXPECT_EQ(info.samplerate, 16000);
  EXPECT_EQ(info.format & SF_FORMAT_SUBMASK, SF_FORMAT_FLOAT);
  std::vector<float> frames(2 * samples);
  EXPECT_EQ(sf_readf_float(file, frames.data(), static_cast<sf_count_t>(samples)),
            static_cast<sf_count_t>(samples));
  sf_close(file);
  // Two roundings to float, 2⁻²⁴ each, of full scale.
  for (std::size_t i = 0; i < samples; ++i)
    for (std::size_t channel = 0; channel < 2; ++channel)
      ASSERT_NEAR(static_cast<double>(frames[2 * i + channel]) * scale.pascal_per_unit,
                  static_cast<double>(pressure[channel * samples + i]), 1.2e-7 * 3.0e-4);
}

TEST(Wav, TheContentOfAFileIsReadWithAndWithoutItsScale) {
  const TemporaryDirectory folder;
  const std::vector<float> pressure{0.25F, -2.0F, 1.0F, 0.5F, 0.0F, 0.125F};
  write_wav(folder / "p.wav", pressure, {.phones = 2}, 3999.6);
  const WavContent whole = read_wav_content(folder / "p.wav");
  EXPECT_EQ(whole.channels, 2U);
  EXPECT_EQ(whole.samples, 3U);
  EXPECT_TRUE(whole.has_scale);
  EXPECT_EQ(whole.scale.pascal_per_unit, 2.0);
  EXPECT_EQ(whole.scale.sample_rate, 3999.6);
  std::filesystem::remove(folder / "p.wav.json");
  const WavContent bare = read_wav_content(folder / "p.wav");
  EXPECT_FALSE(bare.has_scale);
  EXPECT_EQ(bare.scale.sample_rate, 4000.0);  // what the header rounds to
  static_cast<void>(folder.write("p.wav.json", "{}"));
  EXPECT_THROW(static_cast<void>(read_wav_content(folder / "p.wav")), InputError);
  EXPECT_THROW(static_cast<void>(read_wav_content(folder / "none.wav")), InputError);
}

TEST(Wav, ShapesAndFoldersThatDoNotFit) {
  const TemporaryDirectory folder;
  const std::vector<float> pressure(9, 1.0F);
  EXPECT_THROW(write_wav(folder / "p.wav", pressure, {.phones = 2}, 16000.0), InputError);
  EXPECT_THROW(write_wav(folder / "p.wav", pressure, {.phones = 0}, 16000.0), InputError);
  EXPECT_THROW(write_wav(folder / "none/p.wav", pressure, {.phones = 3}, 16000.0), InputError);
}

TEST(PulseFile, CsvAndWavGiveTheSamePulse) {
  const TemporaryDirectory folder;
  std::string csv = "time,pressure\n";
  std::vector<float> wav;
  for (int i = 0; i < 400; ++i) {
    const double x = 0.5 * std::sin(2.0 * pi * 1000.0 * i / 8000.0) * std::sin(pi * i / 400.0);
    csv += std::to_string(i / 8000.0) + "," + std::to_string(x) + "\n";
    wav.push_back(static_cast<float>(x));
  }
  write_wav(folder / "p.wav", wav, {.phones = 1}, 8000.0);
  const SampledPulse a = read_pulse_file(folder.write("p.csv", csv));
  const SampledPulse b = read_pulse_file(folder / "p.wav");
  EXPECT_NEAR(a.sample_rate, 8000.0, 0.1);  // times are printed to a microsecond
  EXPECT_EQ(b.sample_rate, 8000.0);
  ASSERT_EQ(a.samples.size(), b.samples.size());
  for (std::size_t i = 0; i < a.samples.size(); ++i)  // six decimals of 0.5
    EXPECT_NEAR(a.samples[i], b.samples[i], 4e-6);
  EXPECT_EQ(*std::max_element(b.samples.begin(), b.samples.end()), 1.0);
}

TEST(PulseFile, FaultsAreNamed) {
  const TemporaryDirectory folder;
  EXPECT_THAT(message(folder / "none.wav"), HasSubstr("none.wav: found no such file"));
  EXPECT_THAT(message(folder.write("text.wav", "hello")), HasSubstr("libsndfile cannot read"));
  EXPECT_THAT(message(folder.write("uneven.csv", "time,pressure\n0,0\n1,1\n3,0\n4,0\n")),
              HasSubstr("uneven.csv:3: time: found a step of 1"));
  EXPECT_THAT(message(folder.write("silent.csv", "time,pressure\n0,0\n1,0\n")),
              HasSubstr("silent.csv: found silence, expected a pulse"));
  EXPECT_THAT(message(folder.write("short.csv", "time,pressure\n0,1\n")),
              HasSubstr("found one sample, expected at least two"));
  const std::vector<float> stereo(20, 1.0F);
  write_wav(folder / "stereo.wav", stereo, {.phones = 2}, 8000.0);
  EXPECT_THAT(message(folder / "stereo.wav"), HasSubstr("found 2 channels, expected one channel"));
}

// What a header claims is not what is asked of the machine: 250 million samples are 2 GB.
TEST(PulseFile, AHeaderMayClaimWhatItLikes) {
  const std::filesystem::path data = ASDIC_TEST_DATA "/pulse-files";
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  EXPECT_THAT(message(data / "claims-250M-samples.flac"),
              HasSubstr("found 0 samples, where its header claims 250000000, expected a whole"));
  EXPECT_EQ(read_pulse_file(data / "lie.wav").samples.size(), 800U);
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 50'000);  // [kB]
}

TEST(PulseFile, TooLongIsSaid) {
  const TemporaryDirectory folder;
  SF_INFO info{};
  info.samplerate = 8000;
  info.channels = 1;
  info.format = SF_FORMAT_FLAC | SF_FORMAT_PCM_16;  // silence takes nothing there
  SNDFILE* file = sf_open((folder / "long.flac").c_str(), SFM_WRITE, &info);
  ASSERT_NE(file, nullptr);
  const std::vector<short> block(1 << 20);
  for (int i = 0; i < 33; ++i) sf_writef_short(file, block.data(), 1 << 20);
  sf_close(file);
  EXPECT_LT(std::filesystem::file_size(folder / "long.flac"), 1'000'000U);
  EXPECT_THAT(message(folder / "long.flac"),
              HasSubstr("found more than 33554432 samples, expected no more in a pulse"));
}

TEST(PulseFile, StandsInAScenario) {
  const TemporaryDirectory folder;
  std::vector<float> wav;
  for (int i = 0; i < 1600; ++i)
    wav.push_back(static_cast<float>(std::sin(2.0 * pi * 1000.0 * i / 16000.0) *
                                     std::pow(std::sin(pi * i / 1600.0), 2)));
  write_wav(folder / "p.wav", wav, {.phones = 1}, 16000.0);
  const std::string path = std::string(ASDIC_SCENARIOS) + "/isovelocity.toml";
  const std::vector<std::string> overrides{"pulse={kind=\"file\", file=\"" +
                                           (folder / "p.wav").string() + "\"}"};
  const Scenario s = read_scenario(path, overrides);
  EXPECT_EQ(name_of(s.pulse.waveform), "file");
  EXPECT_NEAR(Pulse(s.pulse).centre_frequency(), 1000.0, 1.0);
  EXPECT_NEAR(Pulse(s.pulse).duration(), 0.1, 1e-9);
}

}  // namespace
}  // namespace asdic::detail
