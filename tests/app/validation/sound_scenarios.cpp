// The commands in the headers of the scenarios find what the headers say.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/units.h"
#include "io/hdf5/hdf5_file.h"
#include "support/program.h"

namespace asdic::detail {
namespace {

using support::asdic;

/// Every ping that the target is received in, processed as the header of the scenario says.
void expect_found(const support::TemporaryDirectory& folder, const std::string& name,
                  const std::string& options) {
  const std::string file = name + ".h5";
  const support::Outcome ping =
      asdic(folder, "ping '" ASDIC_SCENARIOS "/" + name + ".toml' -o " + file + " -q");
  ASSERT_EQ(ping.status, 0) << ping.err;
  const support::Outcome found = asdic(folder, "process " + file + " --no-maps -q " + options);
  ASSERT_EQ(found.status, 0) << found.err;
}

// Bent, the line tells right from left: its one place is the true one. By half a beam of its
// length, λ/L = 1.8 degrees, and by half of what the pulse's uncertain Doppler shifts a sweep's
// delay, at ±16 m/s of its filters v·T·f/B = 40 m. All of it in reverberation, whose first answers
// and edges are detections: 150 in four pings; by the background in time alone 1600.
TEST(SoundScenarioCommandsSlow, TheTowedLineFindsTheTargetInTheTurn) {
  const support::TemporaryDirectory folder;
  expect_found(folder, "towed_array_turn", "--target-depth 150m --elevations -10:10");
  const Hdf5File file = Hdf5File::open(folder / "towed_array_turn.h5");
  const auto hit = file.read<std::int32_t>("processed/targets/hit");
  const auto off = file.read<double>("processed/targets/position_error"),
             bearing = file.read<double>("processed/targets/bearing_error_deg");
  ASSERT_EQ(hit.size(), 4U);
  for (const std::size_t ping : {0U, 1U, 2U, 3U}) EXPECT_EQ(hit[ping], 1) << "ping " << ping + 1;
  for (const std::size_t ping : {2U, 3U}) {
    EXPECT_LT(std::abs(bearing[ping]), 0.9) << "ping " << ping + 1;
    EXPECT_LT(off[ping], 80.0) << "ping " << ping + 1;
  }
  EXPECT_LT(file.read<double>("processed/detections/time").size(), 300U);
}

// The listener receives the sea: after the last of the ping's own sound, 11.5 s, the record is 3 dB
// louder than noise alone for a second and a quarter, and as loud as echo, reverberation and noise
// are expected to be: quarters of a second of 100 Hz hold 25 independent values, so they stray by
// 4.3/sqrt(25) = 0.9 dB; four of that.
TEST(SoundScenarioCommands, TheListenerReceivesTheSeaAndFindsTheSubmarine) {
  const support::TemporaryDirectory folder;
  expect_found(folder, "bistatic", "--target-depth 400m");
  const Hdf5File file = Hdf5File::open(folder / "bistatic.h5");
  EXPECT_EQ(file.read<std::int32_t>("processed/targets/hit"), std::vector<std::int32_t>{1});
  // A filter half a Doppler step off shifts the sweep's delay by v·T·f/B, at 1.5 m/s of error 10 m;
  // a line's beam of λ/L/2 = 3.6 degrees at 8 km, a tenth of that by its SNR of 28 dB.
  EXPECT_LT(file.read<double>("processed/targets/position_error").at(0), 200.0);

  const auto pressure = file.read<float>("pressure");
  const double rate = file.attribute_number("pressure", "sample_rate_hz");
  const double first_time = file.attribute_number("levels/echo", "time_start"),
               time_step = file.attribute_number("levels/echo", "time_step");
  const auto echo = file.read<float>("levels/echo"), sea = file.read<float>("levels/reverberation"),
             noise = file.read<float>("levels/noise");
  const std::size_t samples = pressure.size() / 32;
  double loud = 0.0;
  for (double start = 11.5; start < 14.0; start += 0.25) {
    double received = 0.0, expected = 0.0, quiet = 0.0, steps = 0.0;
    const auto first = std::size_t(start * rate), last = std::size_t((start + 0.25) * rate);
    for (std::size_t i = first; i < last; ++i)
      for (std::size_t k = 0; k < 32; ++k) {  // 16 phones, two components each
        const double p = double(pressure[((k / 2) * samples + i) * 2 + k % 2]);
        received += 0.5 * p * p / 16.0;
      }
    for (std::size_t i = 0; i < echo.size(); ++i)
      if (const double time = first_time + double(i) * time_step;
          time >= start && time < start + 0.25)
        expected += double(echo[i] + sea[i] + noise[i]), quiet += double(noise[i]), ++steps;
    received /= double(last - first), expected /= steps, quiet /= steps;
    EXPECT_NEAR(db_from_power(received / expected), 0.0, 3.6) << start;
    if (received > 2.0 * quiet) loud += 0.25;
  }
  EXPECT_GE(loud, 1.25) << "seconds";
}

// The submarine is found in every ping, within its own half length of 35 m, half a beam of the 8
// phones at an SNR of 16 dB (1 degree, 42 m), and what Doppler shifts the sweep, v·T·f/B = 8 m.
// Of noise, 10^-6 of 3.5 s · 400 Hz · 9 beams · 16 filters, a fifth of a detection a ping is
// expected; surface and bottom are received faintly from 1.5 s on, and highlights that the truth
// does not know of as paths may count: ten in four pings.
TEST(SoundScenarioCommands, TheTurningSubmarineIsFoundInEveryPing) {
  const support::TemporaryDirectory folder;
  expect_found(folder, "highlight_target", "--target-depth 100m --from 1.5");
  const Hdf5File file = Hdf5File::open(folder / "highlight_target.h5");
  EXPECT_EQ(file.read<std::int32_t>("processed/targets/hit"), std::vector<std::int32_t>(4, 1));
  for (const double error : file.read<double>("processed/targets/position_error"))
    EXPECT_LT(error, 85.0);
  const auto target = file.read<std::int32_t>("processed/detections/target");
  EXPECT_LE(std::count(target.begin(), target.end(), -1), 2) << "none seen; one echo detected once";
}

TEST(SoundScenarioCommands, ValidateSaysWhatIsThere) {
  const support::TemporaryDirectory folder;
  const auto said = [&](const std::string& name) {
    return asdic(folder, "validate '" ASDIC_SCENARIOS "/" + name + ".toml'").out;
  };
  const std::string turn = said("towed_array_turn");
  for (const char* line :
       {"206 dB, 4 projectors, steered to 0 deg true", "64 phones, towed, 100 to 194.5 m behind",
        "gain or phase errors (drawn: 0.5 dB, 4 deg), 1 dead, band-pass 400 to "
        "600 Hz, 16 bits to 20 Pa",
        "submarine: 6 to 20 dB by aspect"})
    EXPECT_NE(turn.find(line), std::string::npos) << line << " in\n" << turn;
  // where things hang, and how they near one another: (5500·3 + 2500·4)/6054.7 m/s
  const std::string bistatic = said("bistatic");
  for (const char* line : {"beamwidth 30 deg, 600 m deep", "16 phones, 7.5 m across, 600 m deep",
                           "closing at 4.38 m/s"})
    EXPECT_NE(bistatic.find(line), std::string::npos) << line << " in\n" << bistatic;
  const std::string submarine = said("highlight_target");
  EXPECT_NE(submarine.find("submarine: 4 highlights, together "), std::string::npos) << submarine;
  EXPECT_NE(submarine.find("dB by aspect, Swerling 3,"), std::string::npos) << submarine;
}

}  // namespace
}  // namespace asdic::detail
