// The public face: real places, profiles, waveforms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "asdic/asdic.h"
#include "support/program.h"
#include "support/temporary_directory.h"

namespace {

namespace support = asdic::detail::support;
using testing::HasSubstr;

TEST(PublicOcean, FaultsNameTheArgumentAndTheFile) {
  const support::TemporaryDirectory folder;
  try {
    static_cast<void>(asdic::ocean({.latitude_deg = 30.5, .longitude_deg = -60.5, .range = 5e3}));
    FAIL();
  } catch (const asdic::InputError& error) {
    EXPECT_EQ(error.key(), "bearing_deg");
  }
  try {
    static_cast<void>(
        asdic::ocean({.latitude_deg = 30.5, .longitude_deg = -60.5, .data = folder.path()}));
    FAIL();
  } catch (const asdic::InputError& error) {
    EXPECT_EQ(error.file(), (folder.path() / "etopo5.cdf").string());
    EXPECT_THAT(error.what(), HasSubstr("ferret-datasets"));
  }
}

TEST(PublicSoundSpeed, IsWhatRaysMeet) {
  const asdic::Scenario sea = asdic::Scenario::parse(R"(
    [environment.sound_speed]
    kind = "munk"
    [environment.bottom]
    kind = "rigid"
    depth = 5000.0
    [run]
    frequency = 50.0
    source.depth = 1000.0
    receivers = { depth = 1.0, range = 1.0 }
  )");
  // Munk's profile: c = c1·(1 + ε·(η + e^{−η} − 1)), η = 2(z − z1)/B.
  const std::vector<double> z{0.0, 1300.0, 4000.0}, c = asdic::sound_speed(sea, z);
  for (std::size_t i = 0; i < z.size(); ++i) {
    const double eta = 2.0 * (z[i] - 1300.0) / 1300.0;
    EXPECT_NEAR(c[i], 1500.0 * (1.0 + 0.00737 * (eta + std::exp(-eta) - 1.0)), 0.1);
  }
  EXPECT_THROW(static_cast<void>(asdic::sound_speed(sea, {std::nan("")})), asdic::InputError);
}

TEST(PublicWaveform, IsTheFormulaOfATone) {
  asdic::Scenario sea = asdic::Scenario::parse(support::small_scenario);
  sea.set("pulse", asdic::Cw{.frequency = 1000.0, .duration = 0.1, .window = "hann"});
  const asdic::Waveform sent = asdic::waveform(sea, 0, 8000.0);
  ASSERT_EQ(sent.analytic.size(), 801U);
  EXPECT_EQ(sent.centre_frequency, 1000.0);
  EXPECT_NEAR(sent.energy, 3.0 / 8.0 * 0.1, 1e-9);  // of a Hann window
  for (const int i : {100, 400, 777}) {
    const double t = i / 8000.0, window = std::pow(std::sin(asdic::radians(180.0) * t / 0.1), 2);
    const double phase = asdic::radians(360.0) * 1000.0 * t;
    EXPECT_LT(std::abs(sent.analytic[i] - std::polar(window, phase)), 1e-9);
  }
  EXPECT_THROW(static_cast<void>(asdic::waveform(sea, 3)), asdic::InputError);
  EXPECT_THROW(static_cast<void>(asdic::waveform(sea, 0, 0.0)), asdic::InputError);
}

}  // namespace
