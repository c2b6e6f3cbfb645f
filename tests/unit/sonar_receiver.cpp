#include <gtest/gtest.h>

#include <cmath>

#include "sonar/fft.h"
#include "sonar/ping.h"
#include "sonar/receiver_electronics.h"
#include "support/two_platforms.h"

namespace asdic {
namespace {

using support::two_platforms;

TEST(Butterworth, IsThreeDecibelsDownAtItsEdges) {
  const Electronics::BandPass filter{.order = 4, .low = 900.0, .high = 1100.0};
  for (const double f : {900.0, 1100.0}) EXPECT_NEAR(magnitude(filter, f), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(magnitude(filter, std::sqrt(900.0 * 1100.0)), 1.0, 1e-12);
  // (2000² − 990000)/(200·2000) = 7.525; to the fourth 3206.6
  EXPECT_NEAR(magnitude(filter, 2000.0), 1.0 / 3206.6, 1e-6);
}

TEST(Electronics, GainsPhasesAndDeadPhonesAreHeard) {
  Scenario s = two_platforms();
  const PingRecord plain = PingSimulator(s).simulate(1);
  s.arrays[0].electronics = {.gain_db = {0.0, 6.0, 0.0}, .phase = {0.0, 0.0, pi}, .dead = {0}};
  const PingRecord record = PingSimulator(s).simulate(1);
  const std::size_t n = plain.recording.samples;
  const double gain = amplitude_from_db(6.0);
  double loudest = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    loudest = std::max(loudest, std::abs(double(plain.pressure[i])));
    EXPECT_EQ(record.pressure[i], 0.0F);
    ASSERT_NEAR(record.pressure[n + i], gain * double(plain.pressure[n + i]), 1e-4);
    ASSERT_NEAR(record.pressure[2 * n + i], -plain.pressure[2 * n + i], 1e-4);
  }
  EXPECT_GT(loudest, 1.0) << "the blast is 6.7 Pa rms: 1e-4 is −80 dB";
}

// N = 2·3000 draws: the mean of the gains errs by σ/√N, their standard deviation by σ/√(2N).
TEST(Electronics, DrawnErrorsHaveTheirStandardDeviation) {
  Scenario s = two_platforms();
  s.arrays[0] = line_array(3000, 0.5, 0.0, 0.0);
  s.arrays[0].electronics = {.gain_std_db = 0.5, .phase_std = 0.1};
  const ReceiverElectronics receivers(s);
  EXPECT_FALSE(receivers.is_flat());
  double sum = 0.0, squares = 0.0, turns = 0.0, turn_squares = 0.0;
  for (std::size_t i = 0; i < 3000; ++i) {
    const auto g = receivers.response(i, 1000.0);
    const double db = db_from_amplitude(std::abs(g));
    sum += db, squares += db * db, turns += std::arg(g), turn_squares += std::norm(std::arg(g));
  }
  const double root = std::sqrt(3000.0);
  EXPECT_NEAR(sum / 3000.0, 0.0, 5.0 * 0.5 / root);
  EXPECT_NEAR(std::sqrt(squares / 3000.0), 0.5, 5.0 * 0.5 / root / std::sqrt(2.0));
  EXPECT_NEAR(turns / 3000.0, 0.0, 5.0 * 0.1 / root);
  EXPECT_NEAR(std::sqrt(turn_squares / 3000.0), 0.1, 5.0 * 0.1 / root / std::sqrt(2.0));
}

// The sound of a record by itself, multiplied in the frequency domain, is the truth; the record's
// ends lie in silence. −80 dB of its peak is the synthesis' bound.
TEST(BandPass, FiltersTheSound) {
  Scenario s = two_platforms();
  s.arrays[0] = line_array(1, 0.5, 0.0, 0.0);
  s.arrays[0].platform = 1;
  const PingRecord plain = PingSimulator(s).sound(1);
  const Electronics::BandPass filter{.order = 3, .low = 980.0, .high = 1010.0};
  s.arrays[0].electronics.band_pass = filter;
  const PingRecord record = PingSimulator(s).sound(1);
  const std::size_t n = plain.pressure.size();
  const RealFft<double> fft(n);
  FftBuffer<double> x(n);
  FftBuffer<std::complex<double>> bins(fft.bins());
  std::copy(plain.pressure.begin(), plain.pressure.end(), x.data());
  fft.forward(x.data(), bins.data());
  bins[0] = 0.0;
  for (std::size_t k = 1; k < fft.bins(); ++k)
    bins[k] *= magnitude(filter, double(k) * 8000.0 / double(n)) / double(n);
  fft.inverse(bins.data(), x.data());
  double worst = 0.0, peak = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    worst = std::max(worst, std::abs(x[i] - double(record.pressure[i])));
    peak = std::max(peak, std::abs(x[i]));
  }
  EXPECT_GT(peak, 0.0);
  EXPECT_LT(db_from_amplitude(worst / peak), -75.0);
}

/// Mean-square of what lies outside of 1000 ± 400 Hz over the whole.
double outside(const std::vector<float>& row) {
  const std::size_t n = row.size() / 2 * 2;
  const RealFft<double> fft(n);
  FftBuffer<double> x(n);
  FftBuffer<std::complex<double>> bins(fft.bins());
  for (std::size_t i = 0; i < n; ++i)
    x[i] = double(row[i]) * (0.5 - 0.5 * std::cos(2.0 * pi * double(i) / double(n)));
  fft.forward(x.data(), bins.data());
  double all = 0.0, out = 0.0;
  for (std::size_t k = 0; k < fft.bins(); ++k) {
    const double f = double(k) * 8000.0 / double(n);
    all += std::norm(bins[k]);
    if (std::abs(f - 1000.0) > 400.0) out += std::norm(bins[k]);
  }
  return out / all;
}

// White noise through an eighth-order filter 50 Hz wide has next to nothing 400 Hz off: |H|² there
// is (400/25)^−16 = 5e-20 about, single precision leaves 1e-12. Where parts of a stream did not
// join, each edge would be a click: parts filtered by themselves (the wrong model) show it.
TEST(BandPass, SeesNoGapsBetweenThePartsOfAStream) {
  Scenario s = two_platforms();
  s.transmitters[0].source_level_db = -200.0;
  s.noise.spectral_level_db = 80.0;
  s.arrays[0].electronics.band_pass = Electronics::BandPass{.order = 8, .low = 975, .high = 1025};
  s.pings.count = 6;
  s.pings.interval = 0.7;
  s.pings.recording_duration = 1.0;
  s.pings.continuous = true;
  const PingSimulator simulator(s);
  std::vector<float> joined, apart;
  run_pings(simulator, [&](PingRecord&& record) {
    joined.insert(joined.end(), record.pressure.begin(),
                  record.pressure.begin() + std::ptrdiff_t(record.recording.samples));
    PingRecord alone = simulator.sound(record.ping);
    simulator.complete(alone);
    apart.insert(apart.end(), alone.pressure.begin(), alone.pressure.begin() + 5600);
  });
  EXPECT_LT(outside(joined), 1e-9);
  EXPECT_GT(outside(apart), 1e-6);
  // Level: 80 dB in 50 Hz·π/16/sin(π/16) = 50.3 Hz: 97.0 dB. 4.5 s·50 Hz·2 = 450 degrees of freedom
  // of the mean square: 10·log₁₀(1 + √(2/450)) = 0.28 dB rms, five sigma.
  double power = 0.0;
  for (const float p : joined) power += double(p) * double(p) / double(joined.size());
  EXPECT_NEAR(db_from_power(power) + 120.0, 97.0, 1.4);
}

// Ships and coherent noise come through a band-pass when they come without one: the whole record's
// spectrum times the magnitude is the truth away from its ends, where the filter has died away to
// 1e-5 within 11.5/(π·60·sin(π/6)) = 0.12 s; single precision leaves 1e-6. Late by that memory, or
// with the record's own end before its beginning, they would be off by as much as there is.
TEST(BandPass, DoesNotDelayShipsAndNoise) {
  for (const Samples kind : {Samples::pressure, Samples::baseband}) {
    Scenario s = two_platforms();
    s.transmitters[0].source_level_db = -200.0;
    s.pings.samples = kind;
    s.pings.carrier = 1000.0;
    s.pings.baseband_rate = 1000.0;
    s.pings.recording_duration = 4.0;
    s.pings.count = 1;
    s.noise = {.spectral_level_db = {},
               .law = KnudsenNoise{3.0},
               .coherence = NoiseCoherence::isotropic,
               .directions = {}};
    s.interferers.push_back({.name = "ship", .level_db = 120.0});
    s.interferers[0].track.start = {.position = {800.0, 700.0, 10.0}, .velocity = {2.0, -9.0, 0.0}};
    s.interferers[0].tonals = {{.frequency = 1003.0, .level_db = 140.0}};
    const PingRecord plain = PingSimulator(s).simulate(1);
    const Electronics::BandPass filter{.order = 3, .low = 980.0, .high = 1040.0};
    s.arrays[0].electronics.band_pass = filter;
    const PingRecord record = PingSimulator(s).simulate(1);
    const std::size_t n = plain.recording.samples, width = plain.recording.components();
    const double rate = plain.recording.sample_rate;
    const auto value = [&](const PingRecord& of, std::size_t i) {
      return std::complex<double>(of.pressure[width * i],
                                  width == 2 ? double(of.pressure[width * i + 1]) : 0.0);
    };
    const ComplexFft<double> fft(n);
    FftBuffer<std::complex<double>> x(n);
    for (std::size_t i = 0; i < n; ++i) x[i] = value(plain, i);
    fft.forward(x.data());
    for (std::size_t k = 0; k < n; ++k) {
      const double beside = (2 * k < n ? double(k) : double(k) - double(n)) * rate / double(n);
      const double f = std::abs((width == 2 ? 1000.0 : 0.0) + beside);
      x[k] *= f > 0.0 ? magnitude(filter, f) / double(n) : 0.0;
    }
    fft.inverse(x.data());
    double worst = 0.0, peak = 0.0;
    for (auto i = std::size_t(0.5 * rate); i < n - std::size_t(0.5 * rate); ++i) {
      worst = std::max(worst, std::abs(x[i] - value(record, i)));
      peak = std::max(peak, std::abs(x[i]));
    }
    EXPECT_GT(peak, 0.0);
    EXPECT_LT(worst / peak, 1e-4);
    // How a ship is heard is told of the record's own first sample.
    ASSERT_EQ(record.interference.size(), plain.interference.size());
    EXPECT_EQ(record.interference[0].delay, plain.interference[0].delay);
  }
}

// A gain alone is exact at every sample, the first and the last included: nothing is cut there.
TEST(Electronics, AGainAloneChangesNoSampleOfAShipButItsSize) {
  Scenario s = two_platforms();
  s.transmitters[0].source_level_db = -200.0;
  s.interferers.push_back({.name = "ship", .level_db = 120.0});
  s.interferers[0].track.start.position = {800.0, 700.0, 10.0};
  const PingRecord plain = PingSimulator(s).simulate(1);
  for (ReceiverArray& array : s.arrays) array.electronics.gain_db.assign(array.phones.size(), 20.0);
  const PingRecord record = PingSimulator(s).simulate(1);
  double worst = 0.0, peak = 0.0;
  for (std::size_t i = 0; i < plain.pressure.size(); ++i) {
    worst =
        std::max(worst, std::abs(double(record.pressure[i]) - 10.0 * double(plain.pressure[i])));
    peak = std::max(peak, std::abs(double(record.pressure[i])));
  }
  EXPECT_GT(peak, 0.0);
  EXPECT_LT(worst / peak, 1e-5);
}

TEST(Converter, RoundsAndClips) {
  Scenario s = two_platforms();
  s.arrays[0].electronics.converter = Electronics::Converter{.bits = 8, .full_scale = 4.0};
  PingRecord record = PingSimulator(s).simulate(1);
  const double step = 4.0 / 128.0;
  float highest = 0.0F, lowest = 0.0F;
  for (const float p : record.pressure) {
    highest = std::max(highest, p);
    lowest = std::min(lowest, p);
    const double steps = double(p) / step;
    ASSERT_NEAR(steps, std::round(steps), 1e-4);
  }
  EXPECT_FLOAT_EQ(highest, float(4.0 - step)) << "the blast of 9.4 Pa is clipped";
  EXPECT_FLOAT_EQ(lowest, -4.0F);
}

TEST(Shapes, AreThoseOfEachPingInTurn) {
  Scenario s = two_platforms();
  s.arrays[0].shapes = {{{0, 0, 0}, {0, 1, 0}, {0, 2, 0}}, {{0, 0, 0}, {1, 1, 0}, {1, 2, 0}}};
  EXPECT_EQ(phones_at(s, 0, 1, 0.0)[1], Vec3(0, 1, 0));
  EXPECT_EQ(phones_at(s, 0, 4, 9.0)[1], Vec3(1, 1, 0));
  s.pings.count = 2;
  const PingRecord record = PingSimulator(s).simulate(2);
  EXPECT_EQ(record.phones[2], s.platforms[1].track.at(2.0).position + Vec3(1, 2, 0));
}

// East for 100 s at 2 m/s, then north: 60 m after the corner, phones 40, 80 and 300 m behind lie on
// the second leg, on the first, and on the first's straight continuation.
TEST(TowedLine, LiesOnThePathOfItsTowPoint) {
  Scenario s = two_platforms();
  s.platforms[1].track.waypoints = {
      {0.0, {0, 0, 50}}, {100.0, {200, 0, 50}}, {200.0, {200, 200, 50}}};
  s.arrays[0].towed = TowedLine{.behind = {40.0, 80.0, 300.0}};
  const Vec3 tow(200, 60, 50);
  const std::vector<Vec3> phones = phones_at(s, 0, 1, 130.0);
  EXPECT_LT((tow + phones[0] - Vec3(200, 20, 50)).norm(), 1e-9);
  EXPECT_LT((tow + phones[1] - Vec3(180, 0, 50)).norm(), 1e-9);
  EXPECT_LT((tow + phones[2] - Vec3(-40, 0, 50)).norm(), 1e-9);
  s.platforms[1].track = {};
  s.platforms[1].track.start.velocity = {0.0, 3.0, 0.0};
  EXPECT_LT((phones_at(s, 0, 1, 7.0)[1] - Vec3(0, -80, 0)).norm(), 1e-9);
  s.platforms[1].track.start.velocity.setZero();
  s.arrays[0].towed->heading = radians(90.0);
  EXPECT_LT((phones_at(s, 0, 1, 7.0)[1] - Vec3(-80, 0, 0)).norm(), 1e-9);
}

// Eigenrays to every phone: in open water straight lines, 0.1 µs.
TEST(ExactPerPhone, HearsEveryPhonesOwnPath) {
  Scenario s = two_platforms();
  s.arrays[0] = line_array(2, 40.0, radians(30.0), 0.0);
  s.arrays[0].platform = 1;
  s.propagation.exact_per_phone = true;
  s.pulse = {.kind = PulseKind::cw, .frequency = 1000.0, .duration = 0.05};
  const PingSimulator simulator(s);
  const PingRecord record = simulator.sound(1);
  const Vec3 source(0, 0, 100);
  const std::size_t n = record.recording.samples;
  for (std::size_t channel = 0; channel < 2; ++channel) {
    const double distance = (record.phones[channel] - source).norm();
    const double scale = std::sqrt(2.0) * 1e-6 * 1e10 / distance;
    double worst = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const auto exact =
          scale * simulator.pulse().analytic(double(i) / 8000.0 - distance / 1500.0).real();
      worst = std::max(worst, std::abs(exact - double(record.pressure[channel * n + i])));
    }
    EXPECT_LT(worst / scale, 1e-3);
  }
}

}  // namespace
}  // namespace asdic
