// A ping with a ship beside it, from simulation to file: what stands in /interference and what the
// spectrum of the recorded pressure shows.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "io/ping/ping_file.h"
#include "support/temporary_directory.h"
#include "support/two_platforms.h"

namespace asdic::detail {
namespace {

/// A ship comes straight towards the buoy's array from 3 km, with a tonal at 700 Hz, below the
/// ping's band; an echo sounder's worth of ambient noise.
Scenario approached() {
  Scenario s = support::two_platforms();
  s.text = "a ship that comes";
  s.interferers.push_back({.name = "freighter"});
  s.interferers[0].tonals = {{.frequency = 700.0, .level_db = 160.0}};
  s.interferers[0].track.start = {.position = {900.0, 4200.0, 8.0}, .velocity = {0.0, -9.0, 0.0}};
  s.noise.law = WhiteNoise{40.0};
  s.pings.recording_duration = 5.0;
  return s;
}

/// When what is received at a time left the ship, straight lines at 1500 m/s.
double left_at(const Track& track, const Vec3& place, double time) {
  double left = time;
  for (int i = 0; i < 60; ++i) left = time - (place - track.at(left).position).norm() / 1500.0;
  return left;
}

/// Amplitude of a frequency in 4 s of samples under a Hann window.
double amplitude(const std::vector<float>& pressure, double rate, double frequency) {
  const auto n = static_cast<std::size_t>(4.0 * rate);
  std::complex<double> sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double window = 1.0 - std::cos(2.0 * pi * double(i) / double(n));
    sum += window * double(pressure[i]) * std::polar(1.0, -2.0 * pi * frequency * double(i) / rate);
  }
  return 2.0 * std::abs(sum) / double(n);
}

TEST(InterferenceInAFile, StandsThereAndIsReceived) {
  const Scenario s = approached();
  const support::TemporaryDirectory folder;
  {
    PingFileWriter writer(folder / "p.h5", s, {.program_version = "0.1"});
    writer.append(PingSimulator(s).simulate(1));
    writer.finish(true);
  }
  const PingFile file(folder / "p.h5");
  const Hdf5File& h5 = file.file();
  EXPECT_EQ(h5.attribute_text("interference", "names"), "freighter");
  ASSERT_EQ(h5.read<std::int32_t>("interference/interferer"), std::vector<std::int32_t>{0});
  EXPECT_EQ(h5.read<std::int32_t>("interference/ping"), std::vector<std::int32_t>{1});
  EXPECT_EQ(h5.read<std::int32_t>("interference/array"), std::vector<std::int32_t>{0});
  EXPECT_EQ(h5.read<std::int32_t>("interference/surface_bounces"), std::vector<std::int32_t>{0});

  // The one path is a straight line: delay, direction, Doppler factor and amplitude by hand.
  const Track& track = s.interferers[0].track;
  const Vec3 buoy = s.platforms[1].track.start.position;
  const double left = left_at(track, buoy, 0.0);
  const Vec3 way = buoy - track.at(left).position;
  const double factor = (left_at(track, buoy, 0.5) - left_at(track, buoy, -0.5));
  const auto column = [&](const char* name) {
    return h5.read<double>(std::string("interference/") + name).at(0);
  };
  EXPECT_NEAR(column("delay"), -left, 1e-6);
  EXPECT_NEAR(column("doppler_factor"), factor, 1e-6);
  EXPECT_NEAR(column("range"), way.head<2>().norm(), 1e-3);
  EXPECT_NEAR(column("bearing_deg"), 180.0, 1e-6);
  EXPECT_NEAR(column("arrival_elevation_deg"), degrees(std::atan2(-way.z(), way.head<2>().norm())),
              1e-3);
  EXPECT_NEAR(std::hypot(column("amplitude_real"), column("amplitude_imag")), 1.0 / way.norm(),
              1e-3 / way.norm());

  // In the first 4 s the ship comes 36 m of 3 km nearer, the level rises by 0.1 dB and the factor
  // by 10⁻⁷: it is a line, within a bin's hundredth (the noise, 60 dB below, moves it by less), at
  // the level of the middle of that time. The ping's band begins 200 Hz higher.
  const auto pressure = file.pressure(0, 0);
  double peak = 0.0, at = 0.0;
  const auto search = [&](double from, double to, double step) {
    for (double f = from; f <= to; f += step)
      if (const double a = amplitude(pressure, file.sample_rate(), f); a > peak) peak = a, at = f;
  };
  search(650.0, 750.0, 0.25);
  search(at - 0.25, at + 0.25, 0.002);
  EXPECT_NEAR(at, 700.0 * factor, 0.005);
  EXPECT_GT(at, 704.0);  // 4.2 Hz above what it sends
  const Vec3 then = buoy - track.at(left_at(track, buoy, 2.0)).position;
  const double level = 160.0 - 20.0 * std::log10(then.norm());
  EXPECT_NEAR(db_from_amplitude(peak / std::sqrt(2.0) * 1e6), level, 0.05);
}

}  // namespace
}  // namespace asdic::detail
