// In a shallow guide thirteen paths of nearly the same strength meet at every place of the bottom,
// and a hundred and sixty-nine pairs of them interfere: maxima and minima 10 dB apart in range.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "support/reverberant_sea.h"

namespace asdic::detail {
namespace {

constexpr double c = 1500.0, depth = 20.0, source_depth = 8.0, frequency = 1500.0, duration = 0.1,
                 mu_db = -27.0;
constexpr int bounces = 6;
const FluidHalfSpace mud{.speed = 1650.0, .density = 1700.0, .attenuation_db_per_wavelength = 0.5};

Scenario guide() {
  Scenario s = support::mirrored_floor(
      depth, source_depth, mu_db,
      {.waveform = Lfm{.start_frequency = frequency - 10.0, .end_frequency = frequency + 10.0},
       .duration = duration,
       .window = PulseWindow::tukey,
       .tukey_fraction = 0.2});
  s.environment.bottom.material = mud;
  s.environment.absorption = NoAbsorption{};
  s.transmitters[0].beam = LineBeam{.taper = Taper::omnidirectional};
  s.propagation.max_surface_bounces = s.propagation.max_bottom_bounces = bounces;
  s.reverberation.resolve_azimuth = false;
  s.pings.recording_duration = 2.8;
  s.pings.sample_rate = 4000.0;
  return s;
}

/// Rayleigh's reflection coefficient of the bottom, for e^{+iωt}.
std::complex<double> reflection(double grazing, double water_density) {
  const double k = 2.0 * pi * frequency / c;
  const std::complex<double> below(
      2.0 * pi * frequency / mud.speed,
      -mud.attenuation_db_per_wavelength / db_per_neper * frequency / mud.speed);
  const double along = k * std::cos(grazing), up = k * std::sin(grazing);
  std::complex<double> down = std::sqrt(below * below - along * along);
  if (down.imag() > 0.0) down = -down;
  return (mud.density * up - water_density * down) / (mud.density * up + water_density * down);
}

/// Of the images of the source that light a place of the bottom, by two mirrors.
struct Path {
  std::complex<double> pressure;  // times √sin θ of Lambert's law
  double delay;
};
std::vector<Path> paths_to(double range, double water_density) {
  std::vector<Path> paths;
  for (int n = 0; n <= bounces; ++n)
    for (const bool up : {false, true}) {
      const int surface = up ? n + 1 : n;
      if (surface > bounces) continue;
      const double height = (up ? depth + source_depth : depth - source_depth) + 2.0 * depth * n;
      const double length = std::hypot(range, height), grazing = std::atan2(height, range);
      paths.push_back({std::pow(-1.0, surface) * std::pow(reflection(grazing, water_density), n) /
                           length * std::sqrt(std::sin(grazing)),
                       length / c});
    }
  return paths;
}

/// Mean over scatterers of |p|² at a time per unit source: all pairs of images in phase, over
/// rings.
double truth(const Pulse& pulse, double t, double water_density) {
  constexpr double step = 0.25;
  double sum = 0.0;
  for (double r = 0.5 * c * (t - duration) - 60.0; r < 0.5 * c * t; r += step) {
    const std::vector<Path> paths = paths_to(r, water_density);
    std::complex<double> together = 0.0;
    for (const Path& a : paths)
      for (const Path& b : paths) {
        const double delay = a.delay + b.delay, since = t - delay;
        if (since <= 0.0 || since >= duration) continue;
        together += a.pressure * b.pressure * pulse.analytic(since);
      }
    sum += power_from_db(mu_db) * std::norm(together) * 2.0 * pi * r * step;
  }
  return sum;
}

// What covariance and streams receive in 300 pings, 12 dB of interference between 0.5 and 2.7
// s: 1.1 dB rms of that of all images in phase, 4 dB in a minimum. With the 32 strongest pairs of a
// place alone the rms is 2 dB.
TEST(ReverberationOfModes, IsThatOfAllImagesInPhase) {
  const double density = guide().environment.water_density.at(depth);
  const Pulse pulse(guide().pulse);
  std::vector<double> times, exact;
  for (double t = 0.5; t < 2.7; t += 0.1) {
    times.push_back(t);
    exact.push_back(0.0);
    for (const double beside : {-0.02, -0.01, 0.0, 0.01, 0.02})
      exact.back() += truth(pulse, t + beside, density) / 5.0;
  }
  for (const auto how : {ScattererSynthesis::covariance, ScattererSynthesis::streams}) {
    Scenario s = guide();
    s.reverberation.synthesis = how;
    const support::ReverberantSea sea(s);
    std::vector<double> power(times.size(), 0.0);
    constexpr int pings = 300;
    for (int ping = 1; ping <= pings; ++ping) {
      const Baseband received = sea.receive(static_cast<std::uint32_t>(ping));
      for (std::size_t i = 0; i < times.size(); ++i)
        for (const double beside : {-0.02, -0.01, 0.0, 0.01, 0.02})
          power[i] += std::norm(support::at(received, 0, times[i] + beside)) / (5.0 * pings);
    }
    double mean = 0.0, squares = 0.0;
    std::vector<double> off;
    for (std::size_t i = 0; i < times.size(); ++i) {
      off.push_back(db_from_power(power[i] / exact[i]));
      mean += off.back() / double(times.size());
    }
    for (std::size_t i = 0; i < times.size(); ++i) {
      EXPECT_NEAR(off[i], mean, 4.5) << times[i];
      squares += (off[i] - mean) * (off[i] - mean) / double(times.size());
    }
    EXPECT_LT(std::sqrt(squares), 1.25);
    EXPECT_NEAR(mean, 0.0, 0.4);
  }
}

}  // namespace
}  // namespace asdic::detail
