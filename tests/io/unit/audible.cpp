#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <random>
#include <sstream>

#include "io/wav/audible.h"
#include "io/wav/wav.h"
#include "io/wav/wav_stream.h"
#include "support/temporary_directory.h"

// Baseband as sound, and WAV files that are written while they are heard.

namespace asdic::detail {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

/// exp(2πi·f·n/rate), I and Q in turn.
std::vector<float> tone_in_baseband(double frequency, double rate, int samples) {
  std::vector<float> all;
  for (int n = 0; n < samples; ++n) {
    const double angle = two_pi * frequency * n / rate;
    all.push_back(static_cast<float>(std::cos(angle)));
    all.push_back(static_cast<float>(std::sin(angle)));
  }
  return all;
}

// Closed form: what lies f above the carrier is heard f above the tone, at its level and in phase.
// Where the window has settled, its stop band of -80 dB leaves 1e-3 of it.
TEST(Audible, IsTheToneAtItsPlace) {
  constexpr int samples = 400, edge = 32;
  for (const double rate : {114.0, 750.0, 9000.0})
    for (const double share : {-0.45, -0.1, 0.0, 0.3, 0.45}) {
      const double tone = Audible::usual_tone(rate), frequency = share * rate;
      Audible sound(rate, tone);
      const auto heard = sound.take(tone_in_baseband(frequency, rate, samples));
      EXPECT_GE(sound.rate(), 8000.0);
      EXPECT_GT(sound.rate(), 2.0 * (tone + 0.5 * rate));
      const auto factor = static_cast<std::size_t>(std::lround(sound.rate() / rate));
      for (std::size_t k = edge * factor; k < heard.size(); ++k)
        ASSERT_NEAR(static_cast<double>(heard[k]),
                    std::cos(two_pi * (tone + frequency) * double(k) / sound.rate()), 2e-3)
            << rate << " " << share << " " << k;
      EXPECT_EQ(heard.size() + sound.rest().size(), samples * factor);
    }
}

TEST(Audible, DoesNotDependOnTheParts) {
  std::mt19937 random(2);
  std::vector<float> noise(2 * 500);
  for (float& x : noise) x = static_cast<float>(random() % 1000) / 500.0F - 1.0F;
  Audible whole(200.0, 1000.0), parts(200.0, 1000.0);
  const auto truth = whole.take(noise);
  std::vector<float> heard;
  for (std::size_t at = 0; at < noise.size();) {
    const std::size_t n = std::min<std::size_t>(2 * (random() % 40), noise.size() - at);
    const auto part = parts.take(std::span(noise).subspan(at, n));
    heard.insert(heard.end(), part.begin(), part.end());
    at += n;
  }
  EXPECT_EQ(heard, truth);
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return bytes.str();
}

// libsndfile is another reader. What a pipe got is the same, but that its header knows no end.
TEST(WavStream, IsReadByLibsndfile) {
  const support::TemporaryDirectory folder;
  const std::vector<float> pressure{0.0F, 0.5F, -2.0F, 0.25F, 1.0F};
  for (const auto sample : {WavStream::Sample::float32, WavStream::Sample::int16}) {
    const auto path = folder / "a.wav";
    std::FILE* const file = std::fopen(path.c_str(), "w+");
    std::array<int, 2> pipe{};
    ASSERT_EQ(::pipe(pipe.data()), 0);
    const WavStream::Form form{.sample_rate = 8094.4, .sample = sample, .full_scale = 1.0};
    WavStream stream(fileno(file), "a.wav", form), piped(pipe[1], "-", form);
    for (WavStream* one : {&stream, &piped}) {
      one->put(std::span(pressure).first(2));
      one->put(std::span(pressure).subspan(2));
      one->finish();
      EXPECT_EQ(one->samples(), 5U);
      EXPECT_EQ(one->clipped(), 1U);
    }
    std::fclose(file);
    ::close(pipe[1]);
    std::string heard(1000, '\0');
    heard.resize(static_cast<std::size_t>(::read(pipe[0], heard.data(), heard.size())));
    ::close(pipe[0]);
    const std::string written = bytes_of(path);
    ASSERT_EQ(heard.size(), written.size());
    const std::size_t data = 5 * (sample == WavStream::Sample::int16 ? 2 : 4);
    EXPECT_EQ(heard.substr(heard.size() - data), written.substr(heard.size() - data));
    EXPECT_EQ(heard.substr(4, 4), "\xff\xff\xff\xff");
    const WavContent content = read_wav_content(path);
    EXPECT_EQ(content.channels, 1U);
    EXPECT_EQ(content.samples, 5U);
    EXPECT_EQ(content.scale.sample_rate, 8094.0);
    const SampledPulse pulse = read_pulse_file(path);  // of unit peak
    const double loudest = sample == WavStream::Sample::int16 ? 1.0 : 2.0;
    for (std::size_t i = 0; i < 5; ++i)
      EXPECT_NEAR(pulse.samples[i], std::clamp(double(pressure[i]), -loudest, loudest) / loudest,
                  1e-4);
  }
}

TEST(WavStream, SaysThatItsReaderHasGone) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  ::close(pipe[0]);
  const auto before = ::signal(SIGPIPE, SIG_IGN);
  WavStream stream(pipe[1], "-", {});
  EXPECT_TRUE(stream.closed());
  ::signal(SIGPIPE, before);
  ::close(pipe[1]);
}

}  // namespace
}  // namespace asdic::detail
