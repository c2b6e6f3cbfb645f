// Echoes and blasts whose losses and patterns change across the band, against the pulse's spectrum
// multiplied by the response frequency by frequency.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "raytrace/ocean/absorption.h"
#include "sonar/band_response.h"
#include "sonar/fft.h"
#include "support/two_platforms.h"

namespace asdic {
namespace {

TEST(BandNodes, SufficeForWhatTheyArePromisedFor) {
  for (const auto& [nepers, turn] :
       {std::pair{0.0, 0.0}, {0.5, 0.0}, {3.0, 0.0}, {0.0, 2.0}, {0.3, 8.0}}) {
    const double delay = turn / pi;  // π·half_width·delay with a half width of 1 Hz
    const BandNodes band = band_nodes(0.0, 1.0, nepers, delay);
    const auto response = [&](double x) {
      return std::exp(std::complex<double>(-nepers * x, turn * x));
    };
    double worst = 0.0;
    for (double x = -1.0; x <= 1.0; x += 0.01) {
      std::complex<double> sum = 0.0;
      for (std::size_t k = 0; k < band.frequencies.size(); ++k)
        sum += band.basis(k, x) * response(band.frequencies[k]);
      worst = std::max(worst, std::abs(sum - response(x)));
    }
    EXPECT_LT(worst, 1e-4) << nepers << " Np, " << turn << " rad";
    EXPECT_LE(band.frequencies.size(), 4 + std::size_t(2.0 * nepers + 2.5 * turn) + 6);
  }
}

/// A wide sweep, 8 km away, by an array of projectors steered elsewhere.
Scenario wide() {
  Scenario s = support::two_platforms();
  s.environment.absorption = Thorp{};
  s.platforms[1].track.start.position = {5000.0, 6000.0, 100.0};
  s.arrays[0] = line_array(1, 1.0, 0.0, 0.0);
  s.arrays[0].platform = 1;
  for (int i = 0; i < 4; ++i)
    s.transmitters[0].projectors.push_back({.offset = {0.12 * i, 0.05 * i, 0.02 * i}});
  s.transmitters[0].bearing = radians(25.0);
  s.pulse = {.kind = PulseKind::lfm,
             .start_frequency = 2500.0,
             .end_frequency = 5500.0,
             .duration = 0.1,
             .window = PulseWindow::hann};
  s.pings.sample_rate = 20000.0;
  s.pings.recording_start = 5.0;
  s.pings.recording_duration = 0.6;
  s.propagation.wide_band = true;
  return s;
}

/// Largest difference from the direct evaluation over its peak [dB].
double error_db(const Scenario& s) {
  const PingSimulator simulator(s);
  const PingRecord record = simulator.sound(1);
  const Pulse& pulse = simulator.pulse();
  const Vec3 there = s.platforms[1].track.start.position;
  const double distance = (there - Vec3(0, 0, 100)).norm(), delay = distance / 1500.0;
  const double bearing = std::atan2(there.x(), there.y());
  const std::size_t n = record.recording.samples;
  FftBuffer<std::complex<double>> x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = pulse.analytic(5.0 + double(i) / 20000.0 - delay);
  const ComplexFft<double> fft(n);
  fft.forward(x.data());
  for (std::size_t k = 0; k < n; ++k) {
    const double f = double(k) * 20000.0 / double(n);
    if (f < 100.0 || f > 9900.0) {
      x[k] = 0.0;
      continue;
    }
    const BeamPattern pattern(s.transmitters[0], 1500.0 / f, 1500.0);
    const double db = absorption_db_per_km(s.environment.absorption, f) * distance / 1000.0;
    x[k] *= pattern.towards(bearing, 0.0) * amplitude_from_db(-db) / distance * std::sqrt(2.0) *
            1e-6 * 1e10 / double(n);
  }
  fft.inverse(x.data());
  double worst = 0.0, peak = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    worst = std::max(worst, std::abs(x[i].real() - double(record.pressure[i])));
    peak = std::max(peak, std::abs(x[i]));
  }
  return db_from_amplitude(worst / peak);
}

// The response is interpolated to −80 dB of the unsteered level, and the beam's side is 10 dB down:
// −65 dB of the echo's own peak leaves that and the synthesis' error room. One amplitude for the
// whole band must fail.
TEST(WideBand, IsTheSpectrumTimesTheResponse) {
  Scenario s = wide();
  EXPECT_LT(error_db(s), -65.0);
  s.propagation.wide_band = false;
  EXPECT_GT(error_db(s), -20.0);
}

// Where nothing depends on frequency, wide and narrow are the same but for rounding.
TEST(WideBand, ChangesNothingWhereNothingDependsOnFrequency) {
  Scenario s = support::two_platforms();
  s.environment.absorption = NoAbsorption{};
  s.transmitters[0] = {.source_level_db = 200.0, .taper = Taper::omnidirectional};
  const PingRecord narrow = PingSimulator(s).sound(1);
  s.propagation.wide_band = true;
  const PingRecord wide = PingSimulator(s).sound(1);
  ASSERT_EQ(narrow.pressure.size(), wide.pressure.size());
  for (std::size_t i = 0; i < wide.pressure.size(); ++i)
    ASSERT_NEAR(narrow.pressure[i], wide.pressure[i], 1e-4);
}

}  // namespace
}  // namespace asdic
