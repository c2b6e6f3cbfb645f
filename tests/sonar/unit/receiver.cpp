#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "sonar/paths/plane_wave.h"
#include "sonar/ping/ping.h"
#include "sonar/ping/receiver_electronics.h"
#include "sonar/ping/run_pings.h"
#include "sonar/scenario/carried.h"
#include "sonar/signal/fft.h"
#include "support/two_platforms.h"

namespace asdic::detail {
namespace {

using support::two_platforms;

TEST(Butterworth, IsThreeDecibelsDownAtItsEdges) {
  const Electronics::BandPass filter{.order = 4, .low = 900.0, .high = 1100.0};
  for (const double f : {900.0, 1100.0}) EXPECT_NEAR(magnitude(filter, f), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(magnitude(filter, std::sqrt(900.0 * 1100.0)), 1.0, 1e-12);
  // (2000² − 990000)/(200·2000) = 7.525; to the fourth 3206.6
  EXPECT_NEAR(magnitude(filter, 2000.0), 1.0 / 3206.6, 1e-6);
}

TEST(Electronics, GainsPhasesAndDeadPhonesAreReceived) {
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
  s.noise.law = WhiteNoise{80.0};
  s.arrays[0].electronics.band_pass = Electronics::BandPass{.order = 8, .low = 975, .high = 1025};
  s.pings.count = 6;
  s.pings.interval = 0.7;
  s.pings.recording_duration = 1.0;
  s.pings.continuous = true;
  const PingSimulator simulator(s);
  Scenario parted = s;  // each ping by itself
  parted.pings.continuous = false;
  const PingSimulator separate(parted);
  std::vector<float> joined, apart;
  run_pings(simulator, [&](PingRecord&& record) {
    joined.insert(joined.end(), record.pressure.begin(),
                  record.pressure.begin() + std::ptrdiff_t(record.recording.samples));
    const PingRecord alone = separate.simulate(record.ping);
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
    s.noise = {.law = KnudsenNoise{3.0}, .coherence = NoiseCoherence::isotropic, .directions = {}};
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
    // How a ship is received is told of the record's own first sample.
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

/// Where a phone is [m].
Vec3 place_of(const Scenario& s, std::size_t phone, int ping, double time) {
  return array_at(s, 0, time).position + phones_at(s, 0, ping, time)[phone];
}

TEST(Shapes, AreThoseOfEachPingInTurn) {
  Scenario s = two_platforms();
  s.arrays[0].shapes = {{{0, 0, 0}, {0, 1, 0}, {0, 2, 0}}, {{0, 0, 0}, {1, 1, 0}, {1, 2, 0}}};
  const Vec3 buoy = s.platforms[1].track.at(0.0).position;
  EXPECT_LT((place_of(s, 1, 1, 0.0) - buoy - Vec3(0, 1, 0)).norm(), 1e-9);
  EXPECT_LT((place_of(s, 1, 4, 9.0) - buoy - Vec3(1, 1, 0)).norm(), 1e-9);
  s.pings.count = 2;
  const PingRecord record = PingSimulator(s).simulate(2);
  EXPECT_LT((record.phones[2] - buoy - Vec3(1, 2, 0)).norm(), 1e-9);
}

// Plane waves are received about the middle of the phones, wherever the array hangs: 300 m off
// here. A centred line's is where it hangs, to the bit.
TEST(ReferencePoint, IsTheMiddleOfThePhones) {
  Scenario s = two_platforms();
  const Vec3 buoy = s.platforms[1].track.at(0.0).position;
  EXPECT_EQ(array_at(s, 0, 0.0).position, buoy);
  EXPECT_EQ(phones_at(s, 0, 1, 0.0), s.arrays[0].phones);
  s.arrays[0].phones = {{-310, 0, 0}, {-300, 0, 0}, {-290, 0, 0}};
  s.arrays[0].offset = {0, 0, 7};
  EXPECT_LT((array_at(s, 0, 0.0).position - buoy - Vec3(-300, 0, 7)).norm(), 1e-9);
  EXPECT_LT((phones_at(s, 0, 1, 0.0)[0] - Vec3(-10, 0, 0)).norm(), 1e-9);
  s.arrays[0].towed = TowedLine{.behind = {290.0, 300.0, 310.0}, .heading = radians(90.0)};
  EXPECT_LT((array_at(s, 0, 0.0).position - buoy - Vec3(-300, 0, 7)).norm(), 1e-9);
}

// East for 100 s at 2 m/s, then north: 60 m after the corner, phones 40, 80 and 300 m behind lie on
// the second leg, on the first, and on the first's straight continuation.
Scenario turning_line() {
  Scenario s = two_platforms();
  s.platforms[1].track.waypoints = {
      {0.0, {0, 0, 50}}, {100.0, {200, 0, 50}}, {200.0, {200, 200, 50}}};
  s.arrays[0].towed = TowedLine{.behind = {40.0, 80.0, 300.0}};
  return s;
}

TEST(TowedLine, LiesOnThePathOfItsTowPoint) {
  Scenario s = turning_line();
  EXPECT_LT((place_of(s, 0, 1, 130.0) - Vec3(200, 20, 50)).norm(), 1e-9);
  EXPECT_LT((place_of(s, 1, 1, 130.0) - Vec3(180, 0, 50)).norm(), 1e-9);
  EXPECT_LT((place_of(s, 2, 1, 130.0) - Vec3(-40, 0, 50)).norm(), 1e-9);
  s.platforms[1].track = {};
  s.platforms[1].track.start.velocity = {0.0, 3.0, 0.0};
  EXPECT_LT((place_of(s, 1, 1, 7.0) - Vec3(0, 21 - 80, 0)).norm(), 1e-9);
  s.platforms[1].track.start.velocity.setZero();
  s.arrays[0].towed->heading = radians(90.0);
  EXPECT_LT((place_of(s, 1, 1, 7.0) - Vec3(-80, 0, 0)).norm(), 1e-9);
}

// Each goes where the path goes at its own place; all rest when the ship does. 80 m behind, the
// corner is passed 40 s after the tow point has passed it.
TEST(TowedLine, EachPhoneHasItsOwnVelocity) {
  const Scenario s = turning_line();
  const ArrayMotion line(s, 0);
  const auto velocity = [&](int phone, double time) {
    return line.phone(1, phone).at(time).velocity;
  };
  EXPECT_LT((velocity(0, 130.0) - Vec3(0, 2, 0)).norm(), 1e-9);
  EXPECT_LT((velocity(1, 130.0) - Vec3(2, 0, 0)).norm(), 1e-9);
  EXPECT_LT((velocity(1, 139.99) - Vec3(2, 0, 0)).norm(), 1e-9);
  EXPECT_LT((velocity(1, 140.01) - Vec3(0, 2, 0)).norm(), 1e-9);
  EXPECT_TRUE(velocity(2, 200.1).isZero());
  for (int phone = 0; phone < 3; ++phone)
    for (double time = 0.5; time < 210.0; time += 7.3)
      EXPECT_LT((line.phone(1, phone).at(time).position - place_of(s, std::size_t(phone), 1, time))
                    .norm(),
                1e-9)
          << phone << " at " << time;
  EXPECT_TRUE(line.deforms());
  const Scenario straight = two_platforms();
  EXPECT_FALSE(ArrayMotion(straight, 0).deforms());
}

/// Largest difference of a record from a ping that goes straight from the first platform, at rest,
/// to each phone, over its peak: what is received at t left at t − |x(t) − x_s|/c.
double worst_of_straight(const Scenario& s) {
  const PingSimulator simulator(s);
  const PingRecord record = simulator.sound(1);
  const Vec3 source = s.platforms[0].track.at(0.0).position;
  const std::size_t n = record.recording.samples;
  const ArrayMotion motion(s, 0);
  double worst = 0.0;
  for (std::size_t phone = 0; phone < record.phones.size(); ++phone) {
    const Carried own = motion.phone(1, static_cast<int>(phone));
    const auto lag = [&](double t) { return (own.at(t).position - source).norm() / 1500.0; };
    double first = 0.0;
    for (int i = 0; i < 50; ++i) first = lag(first);
    const double scale = std::sqrt(2.0) * 1e-6 * 1e10 / (1500.0 * first);
    for (std::size_t i = 0; i < n; ++i) {
      const double t = double(i) / record.recording.sample_rate;
      const double exact = scale * simulator.pulse().analytic(t - lag(t)).real();
      worst = std::max(worst, std::abs(exact - double(record.pressure[phone * n + i])) / scale);
    }
  }
  return worst;
}

// 64 phones 300 m astern of a ship under way, the sound from abeam of her and near the line: paths
// of each phone's own, since fronts are curved.
TEST(TowedLine, ReceivesWhereItsPhonesAre) {
  Scenario s = two_platforms();
  TowedLine line;
  for (int n = 0; n < 64; ++n) line.behind.push_back(300.0 + 0.75 * n);
  s.arrays[0].towed = line;
  s.arrays[0].phones.resize(64);
  s.platforms[1].track.start.velocity = {3.0, 0.0, 0.0};
  for (const Vec3& ship : {Vec3(0, 700, 100), Vec3(340, 200, 60), Vec3(0, -500, 40)}) {
    s.platforms[1].track.start.position = ship;
    EXPECT_LT(worst_of_straight(s), 2e-3) << ship.transpose();
  }
  s.platforms[1].track.start.velocity.setZero();
  s.arrays[0].towed->heading = radians(30.0);
  EXPECT_LT(worst_of_straight(s), 2e-3) << "at rest";
  // Ahead of the line the front is flat, and the middle's loudness stands for all: 23.6 m of 576 m.
  s.platforms[1].track.start.position = {900, 0, 100};
  s.arrays[0].towed->heading = radians(90.0);
  EXPECT_LT(worst_of_straight(s), 1.05 * 23.6 / 553.0) << "endfire";
}

// The ship turns by a right angle before and while her line listens.
TEST(TowedLine, ReceivesEveryPhonesDopplerInATurn) {
  Scenario s = two_platforms();
  s.pulse = {.waveform = Cw{.frequency = 1000.0}, .duration = 0.5, .window = PulseWindow::hann};
  s.arrays[0].towed = TowedLine{.behind = {20.0, 45.0, 60.0, 100.0, 170.0}};
  s.arrays[0].phones.resize(5);
  s.platforms[1].track.waypoints = {
      {-60.0, {600, 400, 100}}, {-10.0, {900, 400, 100}}, {60.0, {900, 820, 100}}};
  EXPECT_LT(worst_of_straight(s), 5e-3);
}

// |x − r| is convex: the bound is above the difference, and less than a twentieth more far away.
TEST(PlaneWave, ErrorIsThatOfACurvedFront) {
  Scenario s = two_platforms();
  s.arrays[0] = line_array(2, 40.0, 0.0, 0.0);
  s.arrays[0].platform = 1;
  for (const double off_broadside : {0.0, 30.0, 60.0}) {
    constexpr double range = 1000.0;
    const Vec3 away =
        range * Vec3(std::cos(radians(off_broadside)), std::sin(radians(off_broadside)), 0.0);
    const Front front{.slowness = -away / range / 1500.0, .length = range};
    const double said = plane_wave_error({.scenario = s, .motion = ArrayMotion(s, 0)}, front);
    double worst = 0.0;
    for (const double x : {-20.0, 20.0}) {
      const Vec3 phone(0.0, x, 0.0);
      worst = std::max(worst, std::abs((away - phone).norm() / 1500.0 - range / 1500.0 -
                                       front.slowness.dot(phone)));
    }
    EXPECT_NEAR(said / worst, 1.0, 0.05);
  }
}

// A ship close by that hums at 900 Hz, at rest: to each phone straight, as far as it is.
TEST(InterfererNearALine, IsReceivedByEveryPhonesOwnPath) {
  Scenario s = two_platforms();
  s.propagation.direct_blast = false;
  s.arrays[0].towed = TowedLine{.behind = {100.0, 160.0, 220.0}, .heading = radians(90.0)};
  s.interferers.resize(1);
  s.interferers[0].tonals = {{.frequency = 900.0, .level_db = 160.0}};
  s.interferers[0].track.start.position = s.platforms[1].track.start.position + Vec3(-160, 200, 0);
  const PingRecord record = PingSimulator(s).simulate(1);
  std::vector<std::complex<double>> tone;
  const std::size_t n = record.recording.samples;
  for (std::size_t phone = 0; phone < 3; ++phone) {
    const double lag =
        (record.phones[phone] - s.interferers[0].track.start.position).norm() / 1500.0;
    std::complex<double> sum = 0.0;
    for (std::size_t i = 8000; i < 16000; ++i)
      sum += double(record.pressure[phone * n + i]) *
             std::polar(1.0, -2.0 * pi * 900.0 * (double(i) / 8000.0 - lag)) * lag;
    tone.push_back(sum);
  }
  for (std::size_t phone : {1U, 2U})
    EXPECT_LT(std::abs(tone[phone] / tone[0] - 1.0), 2e-3) << phone;
}

/// Largest |p| of a phone before a time, over that of its record.
double early(const PingRecord& record, std::size_t phone, double before) {
  const std::size_t n = record.recording.samples;
  double first = 0.0, all = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double p = std::abs(double(record.pressure[phone * n + i]));
    all = std::max(all, p);
    if (double(i) / record.recording.sample_rate < before) first = std::max(first, p);
  }
  EXPECT_GT(all, 0.0);
  return first / all;
}

// Sender at 100 m, sea floor at 400 m: a phone 300 m away on its level receives nothing of the
// floor before sqrt(300² + 600²)/c = 0.4472 s, where right below the sender it is back at 0.4 s.
TEST(TowedReverberation, IsNotReceivedBeforeSoundCanBeThere) {
  Scenario s = two_platforms();
  s.environment.bottom.depth = 400.0;
  s.arrays[0].platform = 0;
  s.arrays[0].towed = TowedLine{.behind = {300.0}, .heading = radians(90.0)};
  s.arrays[0].phones.resize(1);
  s.reverberation.enabled = true;
  s.reverberation.surface_scatters = false;
  s.reverberation.bottom = Lambert{};
  s.pulse = {.waveform = Cw{.frequency = 1000.0}, .duration = 0.05, .window = PulseWindow::hann};
  s.pings.recording_duration = 1.5;
  EXPECT_LT(early(PingSimulator(s).simulate(1), 0, 0.445), 1e-3);
  // A line whose middle is at the sender: its ends receive the floor by themselves.
  s.arrays[0].towed.reset();
  s.arrays[0].phones = {{-300, 0, 0}, {300, 0, 0}};
  const PingRecord both = PingSimulator(s).simulate(1);
  for (std::size_t phone : {0U, 1U}) EXPECT_LT(early(both, phone, 0.445), 1e-3) << phone;
  // Out of its covariance they receive it together, and the record says how wrong that is.
  s.reverberation.synthesis = ScattererSynthesis::covariance;
  s.reverberation.bottom_field.statistics.coherence_time = 0.0;
  const PingRecord together = PingSimulator(s).simulate(1);
  EXPECT_GT(early(together, 0, 0.445), 1e-2);
  const Pulse pulse(s.pulse);
  const double highest = pulse.centre_frequency() + 0.5 * pulse.bandwidth_40db();
  EXPECT_NEAR(together.plane_waves.error, 300.0 * 300.0 / (2.0 * 300.0 * 1500.0) * highest, 1e-6);
}

// Two phones a thirtieth of a wavelength apart receive the same scatterers: nearly the same sound.
TEST(ExactPerPhone, ReverberationIsCoherentBetweenNeighbours) {
  Scenario s = two_platforms();
  s.environment.bottom.depth = 400.0;
  s.arrays[0] = line_array(2, 0.05, radians(90.0), 0.0);
  s.reverberation.enabled = true;
  s.reverberation.surface_scatters = false;
  s.reverberation.bottom = Lambert{};
  s.pings.recording_duration = 2.0;
  s.propagation.exact_per_phone = true;
  const PingRecord record = PingSimulator(s).simulate(1);
  const std::size_t n = record.recording.samples;
  double difference = 0.0, power = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double a = double(record.pressure[i]), b = double(record.pressure[n + i]);
    difference += (a - b) * (a - b);
    power += a * a;
  }
  EXPECT_GT(power, 0.0);
  // 2πfd/c = 0.21 rad at most, at the grazing angles and bearings received 0.12 rms or less.
  EXPECT_LT(difference / power, 0.21 * 0.21);
}

// Eigenrays to every phone: in open water straight lines, 0.1 µs.
TEST(ExactPerPhone, ReceivesEveryPhonesOwnPath) {
  Scenario s = two_platforms();
  s.arrays[0] = line_array(2, 40.0, radians(30.0), 0.0);
  s.arrays[0].platform = 1;
  s.propagation.exact_per_phone = true;
  s.pulse = {.waveform = Cw{.frequency = 1000.0}, .duration = 0.05};
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

// A phone receives by its own paths what it receives as the only one: the echo and the direct sound
// with what a rough sea scatters about them, which comes from other directions than its path does.
// Synthesis is linear up to rounding, 1e-6 of the peak.
TEST(ExactPerPhone, ReceivesWhatIsScatteredAsAPhoneAlone) {
  Scenario s = two_platforms();
  s.environment.bottom.depth = 200.0;
  s.environment.surface.roughness.rms_height = 0.5;
  s.propagation.max_surface_bounces = 1;
  s.propagation.exact_per_phone = true;
  s.targets = {{.name = "target", .track = {.start = {.position = {300.0, 900.0, 60.0}}}}};
  s.platforms[1].track.start.position = {150.0, 200.0, 100.0};
  s.arrays[0].phones = {{-20.0, 0.0, 0.0}, {20.0, 10.0, 0.0}};
  const std::vector<float> both = PingSimulator(s).sound(1).pressure;
  const std::size_t n = both.size() / 2;
  for (std::size_t phone : {0U, 1U}) {
    Scenario alone = s;
    alone.arrays[0].phones = {s.arrays[0].phones[phone]};
    const std::vector<float> own = PingSimulator(alone).sound(1).pressure;
    ASSERT_EQ(own.size(), n);
    double off = 0.0, peak = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      off = std::max(off, std::abs(double(both[phone * n + i]) - double(own[i])));
      peak = std::max(peak, std::abs(double(own[i])));
    }
    EXPECT_GT(peak, 0.0);
    EXPECT_LT(off, 1e-5 * peak) << phone;
  }
}

}  // namespace
}  // namespace asdic::detail
