#include "sonar/noise/interference.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <complex>

#include "sonar/ping/ping_record.h"
#include "sonar/scenario/sampling.h"
#include "sonar/signal/fft.h"
#include "support/two_platforms.h"

namespace asdic::detail {
namespace {

/// A ship passes 800 m from a buoy's array in open water of 1500 m/s: the direct path alone.
Scenario passing_ship() {
  Scenario s = support::two_platforms();
  s.arrays[0] = line_array(3, 0.5, 0.4, 0.2);
  s.arrays[0].platform = 1;
  s.interferers.push_back({.name = "ship"});
  s.interferers[0].track.start = {.position = {800.0, 2000.0, 10.0}, .velocity = {2.0, -12.0, 0.0}};
  s.pings.count = 1;
  s.pings.recording_duration = 6.0;
  s.pings.sample_rate = 4000.0;
  return s;
}

/// A record that nothing else is received in, of samples from … of the scenario's own time.
PingRecord silence(const Scenario& s, std::size_t from, std::size_t samples) {
  PingRecord record;
  record.recording = recording_of(s);
  record.recording.samples = samples;
  record.start_time = static_cast<double>(from) / record.recording.sample_rate;
  if (s.pings.continuous) record.recording.epoch = record.start_time;
  record.phones.resize(channels_of(s));
  record.pressure.assign(channels_of(s) * samples * record.recording.components(), 0.0F);
  return record;
}

PingRecord received(const Scenario& s, std::size_t from, std::size_t samples) {
  const PropagationPaths paths(s.environment, s.transect);
  PingRecord record = silence(s, from, samples);
  record.interference = Interference(s, paths).add(record.samples());
  return record;
}

/// When what is received at a place and time left a track: t_e + |x − x_s(t_e)|/c = t.
double left_at(const Track& track, const Vec3& place, double time) {
  double left = time;
  for (int i = 0; i < 60; ++i) left = time - (place - track.at(left).position).norm() / 1500.0;
  return left;
}

// Exact: p = (1/R(t_e))·√2 P cos(2πf t_e + φ) at every phone. Straight delays between nodes 0.5 s
// apart are off by Δ²/8·τ″, τ″ < v²/(cR) = 1.25e-4/s: 4e-6 s, 0.0125 rad at 500 Hz. A plane wave
// over phones up to 0.5 m off the reference, 790 m away, is off by L²/(2Rc) = 1e-7 s, 3e-4 rad; its
// amplitude by L/R = 6e-4. Amplitude between nodes: 6 m of 800, second order, 1e-5. So 1.5 % of the
// peak. (With the slowness for ∇τ, 2.4e-6 s at the outer phones, it is more.)
TEST(PassingShip, TonalHasTheExactDelayDopplerAndSpreading) {
  for (const Samples kind : {Samples::pressure, Samples::baseband}) {
    Scenario s = passing_ship();
    const double f = 500.0;
    s.interferers[0].tonals = {{.frequency = f, .level_db = 160.0}};
    s.pings.samples = kind;
    s.pings.carrier = 450.0;
    s.pings.baseband_rate = 400.0;
    const double rate = recorded_rate(s);
    const auto n = static_cast<std::size_t>(6.0 * rate);
    const PingRecord record = received(s, 0, n);
    const std::size_t width = record.recording.components();
    double worst = 0.0, phase = 0.0, least = 1.0, most = 0.0;
    for (std::size_t phone = 0; phone < 3; ++phone) {
      const Vec3 place = array_at(s, 0, 0.0).position + s.arrays[0].phones[phone];
      for (std::size_t i = 0; i < n; ++i) {
        const double t = static_cast<double>(i) / rate;
        const double left = left_at(s.interferers[0].track, place, t);
        const double distance = (place - s.interferers[0].track.at(left).position).norm();
        const double peak = std::sqrt(2.0) * 1e-6 * std::pow(10.0, 8.0) / distance;
        const float* p = record.pressure.data() + (phone * n + i) * width;
        if (phone == 0 && i == 0 && width == 2)
          phase = std::arg(std::complex<double>(double(p[0]), double(p[1]))) - 2.0 * pi * f * left;
        if (phone == 0 && i == 0 && width == 1) {  // of a real sine: by a quarter period's pair
          RandomStream draw(s.seed, Draw::ship_tonal, 0, 0);
          phase = 2.0 * pi * draw.uniform();
        }
        const std::complex<double> exact =
            std::polar(peak, 2.0 * pi * (f * left - (width == 2 ? 450.0 * t : 0.0)) + phase);
        const double error =
            width == 2 ? std::abs(exact - std::complex<double>(double(p[0]), double(p[1])))
                       : std::abs(exact.real() - double(p[0]));
        worst = std::max(worst, error / peak);
        least = std::min(least, distance);
        most = std::max(most, distance);
      }
    }
    EXPECT_LT(worst, 0.015);
    ASSERT_EQ(record.interference.size(), 1U);
    const ReceivedPath& path = record.interference[0];
    const Vec3 place = array_at(s, 0, 0.0).position;
    const double h = 1e-3;
    const double doppler =
        (left_at(s.interferers[0].track, place, h) - left_at(s.interferers[0].track, place, -h)) /
        (2.0 * h);
    EXPECT_NEAR(path.doppler, doppler, 1e-8);
    EXPECT_NEAR(path.delay, -left_at(s.interferers[0].track, place, 0.0), 1e-7);
    EXPECT_GT(path.doppler, 1.005) << "it comes at 10 m/s";
  }
}

// SL − 20 lg R: 145 dB at 1 kHz, −20 dB a decade. A band of 500 … 1500 Hz over 6 s: 6000
// independent bins, 5σ = 0.28 dB; R changes by 10 m a second and is taken as it is half-way.
TEST(PassingShip, BroadbandHasItsLevelAndIsCoherentBetweenPhones) {
  Scenario s = passing_ship();
  s.interferers[0].level_db = 145.0;
  const std::size_t n = 24000;
  const PingRecord record = received(s, 0, n);
  const ComplexFft<double> fft(n);
  std::vector<std::vector<std::complex<double>>> spectra;
  for (std::size_t phone = 0; phone < 3; ++phone) {
    FftBuffer<std::complex<double>> x(n);
    for (std::size_t i = 0; i < n; ++i) x[i] = double(record.pressure[phone * n + i]);
    fft.forward(x.data());
    spectra.emplace_back(x.data(), x.data() + n);
  }
  const Vec3 place = array_at(s, 0, 0.0).position;
  const double distance =
      (place - s.interferers[0].track.at(left_at(s.interferers[0].track, place, 3.0)).position)
          .norm();
  double power = 0.0, expected = 0.0;
  std::complex<double> cross = 0.0;
  const Vec3 travel = record.interference[0].slowness;
  for (std::size_t k = 3000; k < 9000; ++k) {  // 1/6 Hz a bin
    const double f = static_cast<double>(k) / 6.0;
    power += 2.0 * std::norm(spectra[0][k]) / (double(n) * 4000.0) / 6.0;
    expected += std::pow(10.0, 14.5 - 2.0 * std::log10(f / 1000.0)) * 1e-12 / 6.0;
    // Phone 2 receives it s·(x₂ − x₀) later.
    const double late = travel.dot(s.arrays[0].phones[2] - s.arrays[0].phones[0]);
    cross += spectra[2][k] * std::conj(spectra[0][k]) * std::polar(1.0, 2.0 * pi * f * late) * 2.0 /
             (double(n) * 4000.0) / 6.0;
  }
  EXPECT_NEAR(10.0 * std::log10(power / expected) + 20.0 * std::log10(distance), 0.0, 0.35);
  EXPECT_GT(std::abs(cross) / power, 0.98) << "one plane wave";
}

// A ship that lies 12 km away, received directly and by a surface over bubbles: |Σ_paths
// A(f)e^{−i2πfτ}|² of the eigenrays of every frequency is the truth. Bands of 500 Hz over 6 s have
// 3000 bins, whose expected powers e (fringes) give σ = √Σe²/Σe, 1.8 % where they are alike: 5σ,
// and 0.1 dB for amplitudes that are straight between frequencies. The losses of the pulse's
// centre, 1 kHz, are 5 dB off at 7.5 kHz, and must fail.
TEST(PassingShip, IsReceivedWithTheLossesOfEveryFrequency) {
  Scenario s = passing_ship();
  s.environment.absorption = Thorp{};
  s.environment.surface.roughness.bubble_wind = 10.0;
  s.propagation.max_surface_bounces = 1;
  s.arrays[0] = line_array(1, 0.5, 0.0, 0.0);
  s.arrays[0].platform = 1;
  s.interferers[0].track.start = {.position = {12900.0, 1200.0, 10.0}, .velocity = Vec3::Zero()};
  s.interferers[0].level_db = 145.0;
  s.interferers[0].slope_db_per_decade = 0.0;
  s.pings.sample_rate = 16000.0;
  const std::size_t n = 96000;
  const EigenraySolver solver(s.environment);
  const Vec3 array = array_at(s, 0, 0.0).position, ship = s.interferers[0].track.start.position;
  const double range = (array - ship).head<2>().norm();
  const auto worst = [&](bool wide) {
    s.propagation.band = wide ? BandOfLosses::wide : BandOfLosses::narrow;
    const PingRecord record = received(s, 0, n);
    const ComplexFft<double> fft(n);
    FftBuffer<std::complex<double>> x(n);
    for (std::size_t i = 0; i < n; ++i) x[i] = double(record.pressure[i]);
    fft.forward(x.data());
    double most = 0.0;
    for (double low = 500.0; low < 7500.0; low += 500.0) {
      double power = 0.0, expected = 0.0, squares = 0.0;
      for (double f = low; f < low + 500.0; f += 20.0) {
        std::complex<double> sum = 0.0;
        for (const Arrival& a :
             solver.find(ship.z(), array.z(), range, f, limits_of(s.propagation)))
          sum += a.amplitude * std::polar(1.0, -2.0 * pi * f * a.delay);
        const double here = std::pow(10.0, 14.5) * 1e-12 * std::norm(sum) / 25.0;
        expected += here;
        squares += here * here / 120.0;
        for (std::size_t k = 0; k < 120; ++k)
          power += 2.0 * std::norm(x[static_cast<std::size_t>(f * 6.0) + k]) /
                   (double(n) * 16000.0) / 3000.0;
      }
      const double allowed = 0.1 + 10.0 * std::log10(1.0 + 5.0 * std::sqrt(squares) / expected);
      most = std::max(most, std::abs(10.0 * std::log10(power / expected)) / allowed);
    }
    return most;
  };
  EXPECT_LT(worst(true), 1.0);
  EXPECT_GT(worst(false), 5.0);
}

/// A ship that lies 700 m away from one phone, under a sea of 12 m/s: direct, and by the surface.
Scenario under_a_rough_sea() {
  Scenario s = passing_ship();
  s.environment.surface.roughness = {
      .rms_height = pierson_moskowitz_height(12.0), .sea_wind = 12.0, .floor_db = -300.0};
  s.propagation.max_surface_bounces = 1;
  s.propagation.max_bottom_bounces = 0;
  s.arrays[0] = line_array(1, 0.5, 0.0, 0.0);
  s.arrays[0].platform = 1;
  const Vec3 array = array_at(s, 0, 0.0).position;
  s.interferers[0].track.start = {.position = {array.x() + 700.0, array.y(), 100.0},
                                  .velocity = Vec3::Zero()};
  return s;
}

/// The paths of it at a frequency: intensities of the mean fields and of what is scattered.
std::array<double, 2> intensities(const Scenario& s, double frequency) {
  const Vec3 array = array_at(s, 0, 0.0).position;
  std::array<double, 2> sum{};
  for (const Arrival& a : EigenraySolver(s.environment)
                              .find(100.0, array.z(), 700.0, frequency, limits_of(s.propagation))) {
    sum[0] += std::norm(a.amplitude);
    sum[1] += a.scattered;
  }
  return sum;
}

// The surface path's mean field is gone (G > 3) and its energy is not: the band's power is both
// paths'. 1000 … 1800 Hz over 6 s: 4800 bins, 5σ = 0.33 dB; eight parts of one path cross in pairs,
// s·(2·28)^½/8 of a band's mean by 0.9 of √(1/(B·spread)), under 0.1 dB over 16 records.
TEST(PassingShip, OverARoughSeaHasThePowerOfItsPaths) {
  Scenario s = under_a_rough_sea();
  s.interferers[0].level_db = 145.0;
  s.interferers[0].slope_db_per_decade = 0.0;
  const std::size_t n = 24000;
  const ComplexFft<double> fft(n);
  for (const bool wide : {false, true}) {
    s.propagation.band = wide ? BandOfLosses::wide : BandOfLosses::narrow;
    double power = 0.0;
    constexpr int records = 16;
    for (int seed = 1; seed <= records; ++seed) {
      s.seed = static_cast<std::uint64_t>(seed);
      const PingRecord record = received(s, 0, n);
      FftBuffer<std::complex<double>> x(n);
      for (std::size_t i = 0; i < n; ++i) x[i] = double(record.pressure[i]);
      fft.forward(x.data());
      for (std::size_t k = 6000; k < 10800; ++k)
        power += 2.0 * std::norm(x[k]) / (double(n) * 4000.0) / 6.0 / records;
    }
    double mean = 0.0, all = 0.0;
    const double centre = Pulse(pulse_of(s, 0)).centre_frequency();
    for (int i = 0; i < 80; ++i) {
      const auto [coherent, scattered] = intensities(s, wide ? 1005.0 + 10.0 * i : centre);
      mean += coherent / 80.0;
      all += (coherent + scattered) / 80.0;
    }
    const double source = std::pow(10.0, 14.5) * 1e-12 * 800.0;
    EXPECT_NEAR(db_from_power(power / (source * all)), 0.0, 0.3) << wide;
    EXPECT_GT(db_from_power(all / mean), 2.0);
  }
}

// A tonal's mean field stands; about it the rest goes with the sea: ⟨|p − ⟨p⟩|²⟩ is the intensity
// scattered. Eight parts of equal strength, waves of seconds, 12 seas of a minute.
TEST(PassingShip, OverARoughSeaATonalFluctuates) {
  Scenario s = under_a_rough_sea();
  const double f = 500.0;
  s.interferers[0].tonals = {{.frequency = f, .level_db = 160.0}};
  s.pings.samples = Samples::baseband;
  s.pings.carrier = 450.0;
  s.pings.baseband_rate = 400.0;
  s.pings.recording_duration = 60.0;
  constexpr std::size_t n = 24000;
  constexpr int seas = 12;
  double about = 0.0;
  for (int seed = 1; seed <= seas; ++seed) {
    s.seed = static_cast<std::uint64_t>(seed);
    const PingRecord record = received(s, 0, n);
    std::complex<double> mean = 0.0;
    double square = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const std::complex<double> p =
          std::complex<double>(double(record.pressure[2 * i]), double(record.pressure[2 * i + 1])) *
          std::polar(1.0, -2.0 * pi * (f - 450.0) * double(i) / 400.0);
      mean += p / double(n);
      square += std::norm(p) / double(n);
    }
    about += (square - std::norm(mean)) / seas;
  }
  const double peak = 2.0 * std::pow(10.0, 16.0) * 1e-12;
  const double centre = Pulse(pulse_of(s, 0)).centre_frequency();
  EXPECT_NEAR(db_from_power(about / (peak * intensities(s, centre)[1])), 0.0, 1.0);
}

// A ship under a surface and over a bottom, received by paths that come and go, in a stream.
Scenario stream() {
  Scenario s = passing_ship();
  s.environment.bottom = {.depth = 400.0, .material = FluidHalfSpace{}};
  s.propagation.max_surface_bounces = s.propagation.max_bottom_bounces = 1;
  s.interferers[0].level_db = 145.0;
  s.interferers[0].tonals = {{.frequency = 300.0, .level_db = 150.0}};
  s.pings.continuous = true;
  return s;
}

TEST(PassingShip, HasTheSameBitsInWhateverPartsAStreamIsCut) {
  struct Kind {
    Samples samples;
    bool wide, rough;
  };
  for (const auto& [kind, wide, rough] :
       {Kind{Samples::pressure, false, false}, Kind{Samples::baseband, false, false},
        Kind{Samples::pressure, true, false}, Kind{Samples::baseband, false, true},
        Kind{Samples::pressure, true, true}}) {
    Scenario s = stream();
    if (rough) s.environment.surface.roughness.rms_height = 0.5;
    s.pings.samples = kind;
    s.propagation.band = wide ? BandOfLosses::wide : BandOfLosses::narrow;
    const std::size_t n = 9000;
    const PingRecord whole = received(s, 3000, n);
    const std::size_t width = whole.recording.components();
    ASSERT_GE(whole.interference.size(), 3U);
    std::size_t from = 0;
    for (const std::size_t part : {1UL, 1999UL, 4001UL, 2999UL}) {
      const PingRecord some = received(s, 3000 + from, part);
      for (std::size_t phone = 0; phone < 3; ++phone)
        for (std::size_t i = 0; i < part * width; ++i)
          ASSERT_EQ(some.pressure[phone * part * width + i],
                    whole.pressure[(phone * n + from) * width + i])
              << from << ' ' << i;
      from += part;
    }
    EXPECT_EQ(from, n);
  }
}

TEST(PassingShip, HasTheSameBitsForAnyNumberOfThreads) {
  std::vector<std::vector<float>> runs;
  for (const std::size_t threads : {1UL, 2UL, 7UL}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    runs.push_back(received(stream(), 3000, 5000).pressure);
  }
  EXPECT_EQ(runs[0], runs[1]);
  EXPECT_EQ(runs[0], runs[2]);
}

}  // namespace
}  // namespace asdic::detail
