// Reverberation of bottom and volume, its coherence in space, its Doppler, its statistics.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "support/kolmogorov.h"
#include "support/received_spectrum.h"
#include "support/reverberant_sea.h"

namespace asdic::detail {
namespace {

using support::at, support::quiet_sea, support::ridge, support::Sector, support::spectrum;
using Sea = support::ReverberantSea;

/// ∫w²(u)·i(t − u) du over a Hann window w of length T: what a density of intensity i over time
/// makes of a pulse. Simpson's rule.
double through_hann(const std::function<double(double)>& density, double t, double length) {
  constexpr int n = 32;
  double sum = 0.0;
  for (int k = 0; k <= n; ++k) {
    const double u = length * k / n, w = 0.5 - 0.5 * std::cos(2.0 * pi * k / n);
    sum += (k == 0 || k == n ? 1.0 : k % 2 ? 4.0 : 2.0) * w * w * density(t - u);
  }
  return sum * length / n / 3.0;
}

/// Mean of |b|²/expected over times and pings, one sample a step, with its count.
struct Mean {
  double value = 0.0, count = 0.0;
};
Mean normalised_mean(const Sea& sea, int pings, double from, double to, double step,
                     const std::function<double(double)>& expected) {
  double sum = 0.0, count = 0.0;
  for (std::uint32_t ping = 1; ping <= std::uint32_t(pings); ++ping) {
    const Baseband received = sea.receive(ping);
    for (double t = from; t < to; t += step, count += 1.0) {
      const double sampled =
          received.start +
          std::lround((t - received.start) * received.sample_rate) / received.sample_rate;
      sum += std::norm(at(received, 0, t)) / expected(sampled);
    }
  }
  return {sum / count, count};
}

// A Lambert bottom 900 m below: 2π∫μ sin²θ R⁻³ dR, sin θ = h/R, R = ct/2. One independent sample
// per pulse length: 40 pings of 45 samples, 0.024 rms of an exponential's mean; 4.9 sigma is 0.115
// = 0.5 dB.
TEST(ReverberationField, LambertBottomIsTheAnnulusIntegral) {
  Scenario s = quiet_sea();
  s.reverberation.bottom = Lambert{.mu_db = -27.0};
  s.reverberation.bottom_field.statistics.coherence_time = 0.0;
  s.pings.recording_duration = 8.2;
  const Sea sea(s);
  const auto expected = [](double t) {
    return through_hann(
        [](double u) {
          return 2.0 * pi * power_from_db(-27.0) * 900.0 * 900.0 * 750.0 * std::pow(750.0 * u, -5);
        },
        t, 0.12);
  };
  const Mean mean = normalised_mean(sea, 40, 2.0, 8.0, 0.13, expected);
  EXPECT_NEAR(mean.value, 1.0, 4.9 / std::sqrt(mean.count));
  // The expected level that summaries tell is the same integral, on a grid: 0.05 dB.
  const PingReverberation ping = sea.ping(1);
  for (double t = 2.0; t < 8.0; t += 0.7)
    EXPECT_NEAR(ping.expected_db(t), 220.0 + db_from_power(expected(t)), 0.05) << t;
}

// A layer from 200 to 600 m above: ∫dz 2π∫s_v R⁻³ dR, all of it received from 0.9 s on. 40 pings of
// 45 samples, as above.
TEST(ReverberationField, VolumeLayerIsTheShellIntegral) {
  Scenario s = quiet_sea();
  s.reverberation.volume = {{.top = 3900.0, .bottom = 4300.0, .strength_db = -75.0}};
  s.pings.recording_duration = 7.2;
  s.reverberation.azimuths = 6;
  const Sea sea(s);
  const auto expected = [](double t) {
    return through_hann(
        [](double u) {
          return 2.0 * pi * power_from_db(-75.0) * 400.0 * 750.0 * std::pow(750.0 * u, -3);
        },
        t, 0.12);
  };
  const Mean mean = normalised_mean(sea, 40, 1.2, 7.0, 0.13, expected);
  EXPECT_NEAR(mean.value, 1.0, 4.9 / std::sqrt(mean.count));
  const PingReverberation ping = sea.ping(1);
  for (double t = 1.2; t < 7.0; t += 0.7)
    EXPECT_NEAR(ping.expected_db(t), 220.0 + db_from_power(expected(t)), 0.05) << t;
}

/// Complex coherence of phones 0 and n, n = 1…, over pings and times; samples independent.
struct Coherence {
  std::vector<std::complex<double>> of;
  double count = 0.0;
};
Coherence coherence(const Sea& sea, int pings, double from, double to, double step) {
  const std::size_t phones = sea.scenario().arrays[0].phones.size();
  std::vector<std::complex<double>> cross(phones);
  std::vector<double> power(phones);
  Coherence found;
  for (std::uint32_t ping = 1; ping <= std::uint32_t(pings); ++ping) {
    const Baseband received = sea.receive(ping);
    for (double t = from; t < to; t += step, found.count += 1.0) {
      const std::complex<double> first = at(received, 0, t);
      for (std::size_t n = 0; n < phones; ++n) {
        const std::complex<double> other = at(received, n, t);
        cross[n] += std::conj(first) * other * t * t * t;  // nearly the same weight at all times
        power[n] += std::norm(other) * t * t * t;
      }
    }
  }
  for (std::size_t n = 1; n < phones; ++n)
    found.of.push_back(cross[n] / std::sqrt(power[0] * power[n]));
  return found;
}

// Van Cittert–Zernike: the coherence of two phones is the Fourier transform of the distribution of
// directions. A ring at elevation θ, seen by a horizontal line: J₀(kd cos θ). Each of N samples of
// two complex Gaussians of coherence γ gives γ ± (1 − |γ|²)/√(2N) in the real part; N = 80·49, 4.9
// sigma 0.055.
TEST(ReverberationField, CoherenceOfARingIsABesselFunction) {
  Scenario s = support::even_sea();
  s.platforms[0].track.start.position.z() = 500.0;
  s.pulse = {.duration = 0.12};
  s.reverberation.azimuths = 36;
  s.pings.recording_start = 6.0;
  s.pings.recording_duration = 6.2;
  s.arrays[0].phones = {Vec3::Zero()};
  const double wavelength = 0.375;
  for (const double share : {0.2, 0.383, 0.61, 1.1})
    s.arrays[0].phones.emplace_back(0.6 * share * wavelength, 0.8 * share * wavelength, 0.0);
  const Sea sea(s);
  const Coherence found = coherence(sea, 80, 6.3, 12.1, 0.12);
  const double elevation = std::asin(500.0 / (750.0 * 9.0));  // cos θ 0.997 ± 0.001
  for (std::size_t n = 0; n < found.of.size(); ++n) {
    const double kd = 2.0 * pi / wavelength * s.arrays[0].phones[n + 1].norm();
    const double expected = std::cyl_bessel_j(0.0, kd * std::cos(elevation));
    EXPECT_NEAR(found.of[n].real(), expected, 4.9 / std::sqrt(2.0 * found.count)) << kd;
    EXPECT_NEAR(found.of[n].imag(), 0.0, 4.9 / std::sqrt(2.0 * found.count)) << kd;
  }
}

// Directions from all sides alike: sin(kd)/(kd), whichever way the phones lie. A layer 2 km up and
// down around the vehicle, received before its edges: a sphere of scatterers. N = 30·15, 4.9 sigma
// 0.16.
TEST(ReverberationField, CoherenceOfAnIsotropicSeaIsASinc) {
  Scenario s = quiet_sea();
  s.platforms[0].track.start.position.z() = 2200.0;
  s.reverberation.volume = {{.top = 50.0, .bottom = 4350.0, .strength_db = -80.0, .sheets = 43}};
  s.pulse = {.duration = 0.06};
  s.pings.recording_start = 1.6;
  s.pings.recording_duration = 1.0;
  s.arrays[0].phones = {Vec3::Zero()};
  const double wavelength = 0.375;
  for (const double share : {0.25, 0.5, 0.72})
    for (const Vec3& way : {Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(0.6, 0.64, 0.48)})
      s.arrays[0].phones.emplace_back(share * wavelength * way);
  const Sea sea(s);
  const Coherence found = coherence(sea, 30, 1.67, 2.56, 0.06);
  for (std::size_t n = 0; n < found.of.size(); ++n) {
    const double kd = 2.0 * pi / wavelength * s.arrays[0].phones[n + 1].norm();
    EXPECT_NEAR(found.of[n].real(), std::sin(kd) / kd, 4.9 / std::sqrt(2.0 * found.count)) << n;
    EXPECT_NEAR(found.of[n].imag(), 0.0, 4.9 / std::sqrt(2.0 * found.count)) << n;
  }
}

// A vehicle that makes 6 m/s to the east receives the surface at 2v·cos(angle)·cos θ/λ: a line of
// 48 phones along its way, tones of 1 s in windows of 1 s (bins of 1 Hz). Beams from astern to
// ahead; the ridge is within one bin everywhere, and at zero on broadside.
TEST(ReverberationField, DopplerFollowsTheAngleAcrossBeams) {
  Scenario s = support::even_sea();
  s.platforms[0].track.start = {.position = {0.0, 0.0, 300.0}, .velocity = {6.0, 0.0, 0.0}};
  s.pulse = {.waveform = Cw{.frequency = 1500.0}, .duration = 1.0};
  s.arrays[0] = line_array(48, 0.5, 0.5 * pi, 0.0);
  s.reverberation.azimuths = 120;
  s.pings.sample_rate = 4000.0;
  s.pings.recording_start = 5.0;
  s.pings.recording_duration = 6.0;
  const Sea sea(s);
  std::vector<double> frequencies;
  for (double f = -16.0; f <= 16.0; f += 0.25) frequencies.push_back(f);
  constexpr int beams = 9;
  std::vector<std::vector<double>> power(beams, std::vector<double>(frequencies.size()));
  const double wavelength = 1.0;
  const double level = std::cos(std::asin(300.0 / (750.0 * 8.0)));
  const auto sine = [](int b) { return 0.9 * (b - 4) / 4.0; };  // towards, from broadside
  for (std::uint32_t ping = 1; ping <= 6; ++ping) {
    const Baseband received = sea.receive(ping);
    for (int b = 0; b < beams; ++b) {
      std::vector<std::complex<double>> beam;
      for (std::size_t n = 0; n < 48; ++n) {
        const double window = 0.5 - 0.5 * std::cos(2.0 * pi * (double(n) + 0.5) / 48.0);
        // Sound from ahead reaches the phones ahead first: undo −k·x·sin.
        beam.push_back(std::polar(
            window, -2.0 * pi / wavelength * level * sine(b) * s.arrays[0].phones[n].x()));
      }
      for (double from = 5.5; from < 10.0; from += 1.0) {
        const auto more = spectrum(received, beam, from, from + 1.0, frequencies);
        for (std::size_t k = 0; k < more.size(); ++k)
          power[std::size_t(b)][k] += more[k] * from * from * from;
      }
    }
  }
  for (int b = 0; b < beams; ++b) {
    const double expected = 2.0 * 6.0 * sine(b) * level / wavelength;
    EXPECT_NEAR(ridge(power[std::size_t(b)], frequencies), expected, 1.0) << sine(b);
  }
  EXPECT_NEAR(ridge(power[4], frequencies), 0.0, 0.5);
}

// The surface's Bragg lines: ±√(gQ)/2π, Q = 2k cos θ = 4.17 rad/m at 500 Hz, ±1.02 Hz; windows of
// 8 s have bins of 1/8 Hz. A share of 0.2 recedes: its line has a quarter of the other's power,
// 8 pings of 3 windows: each line's power (48 degrees of freedom) to 20 %, 1 dB; the ratio
// to 4.9·√2 of that, 6 dB. Between the lines and beyond, 15 dB less.
TEST(ReverberationField, BraggLinesLieWhereTheWavesPutThem) {
  Scenario s = support::even_sea();
  s.platforms[0].track.start.position.z() = 500.0;
  s.pulse = {.waveform = Cw{.frequency = 500.0}, .duration = 8.0};
  s.reverberation.surface_field.motion = {.kind = ScattererMotion::Kind::bragg,
                                          .receding_share = 0.2};
  s.pings.sample_rate = 2000.0;
  s.pings.recording_start = 12.0;
  s.pings.recording_duration = 28.0;
  const Sea sea(s);
  std::vector<double> frequencies;
  for (double f = -3.0; f <= 3.0; f += 0.0625) frequencies.push_back(f);
  std::vector<double> power(frequencies.size());
  const std::complex<double> one = 1.0;
  for (std::uint32_t ping = 1; ping <= 8; ++ping) {
    const Baseband received = sea.receive(ping);
    for (double from = 13.0; from < 31.0; from += 8.5) {
      const auto more = spectrum(received, {&one, 1}, from, from + 8.0, frequencies);
      for (std::size_t k = 0; k < more.size(); ++k) power[k] += more[k] * std::pow(from + 4.0, 4.0);
    }
  }
  const auto middle = frequencies.size() / 2;
  const std::span<const double> all(power), f(frequencies);
  const double line = std::sqrt(9.80665 * 2.0 * (2.0 * pi * 500.0 / 1500.0)) / (2.0 * pi);
  EXPECT_NEAR(ridge(all.subspan(middle), f.subspan(middle)), line, 0.125);
  EXPECT_NEAR(ridge(all.first(middle), f.first(middle)), -line, 0.125);
  const double up = *std::max_element(power.begin() + std::ptrdiff_t(middle), power.end());
  const double down = *std::max_element(power.begin(), power.begin() + std::ptrdiff_t(middle));
  EXPECT_NEAR(db_from_power(down / up), -6.0, 4.5);
  EXPECT_LT(db_from_power(power[middle] / up), -15.0);
  EXPECT_LT(db_from_power(power.front() / up), -15.0);
}

// Clutter with a gamma texture of shape ν, constant in squares much larger than what a narrow beam
// lights up: the intensity is K-distributed, P(I > x) = 2(νx)^{ν/2} K_ν(2√(νx))/Γ(ν). One sample a
// square, over many seeds; Kolmogorov–Smirnov at 1e-6. An exponential (Rayleigh) must fail, and so
// must a sea without texture against the K-distribution.
TEST(ReverberationField, ClutterIsKDistributed) {
  const double shape = 0.6;
  const auto k_law = [shape](double x) {
    const double y = std::sqrt(shape * x);
    return 1.0 - 2.0 * std::pow(y, shape) * std::cyl_bessel_k(shape, 2.0 * y) / std::tgamma(shape);
  };
  const auto samples = [&](std::optional<double> texture) {
    std::vector<double> found;
    for (int seed = 1; seed <= 100; ++seed) {
      Scenario s = quiet_sea();
      s.seed = std::uint64_t(seed);
      s.platforms[0].track.start.position.x() = 750.0;  // the beam to the north lies in one column
      s.reverberation.bottom = Lambert{};
      s.reverberation.bottom_field.statistics = {.k_shape = texture, .correlation_length = 1500.0};
      s.reverberation.scatterers_per_cell = 10;
      s.pings.recording_duration = 11.0;
      const Sea sea(s, std::make_unique<Sector>(radians(5.0)));
      const Baseband received = sea.receive(1);
      // Annuli of less than 90 m at odd multiples of 750 m: one in each square, well inside it.
      for (double range = 2250.0; range < 7000.0; range += 1500.0) {
        const double t = std::hypot(range, 900.0) / 750.0;
        found.push_back(std::norm(at(received, 0, t + 0.06)) * std::pow(t, 5.0));
      }
    }
    double mean = 0.0;
    for (const double x : found) mean += x / double(found.size());
    for (double& x : found) x /= mean;
    return found;
  };
  using support::exponential_law, support::kolmogorov_distance;
  const auto clutter = samples(shape), plain = samples(std::nullopt);
  const double limit = std::sqrt(std::log(2e6) / (2.0 * double(clutter.size())));
  EXPECT_LT(kolmogorov_distance(clutter, k_law), limit);
  EXPECT_GT(kolmogorov_distance(clutter, exponential_law), limit);
  EXPECT_LT(kolmogorov_distance(plain, exponential_law), limit);
  EXPECT_GT(kolmogorov_distance(plain, k_law), limit);
}

}  // namespace
}  // namespace asdic::detail
