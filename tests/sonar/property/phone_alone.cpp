// A phone in an array receives what it receives alone.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <span>

#include "core/units.h"
#include "sonar/ping/ping.h"

namespace asdic::detail {
namespace {

/// A record of one phone held against another.
struct Beside {
  double correlation = 0.0;
  double level_db = 0.0;  // energy over the other's
  double apart_db = 0.0;  // energy of the difference over the other's
};
Beside beside(std::span<const float> one, std::span<const float> other) {
  double both = 0.0, a = 0.0, b = 0.0, off = 0.0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    const double x = one[i], y = other[i];
    both += x * y;
    a += x * x;
    b += y * y;
    off += (x - y) * (x - y);
  }
  return {both / std::sqrt(a * b), db_from_power(a / b), db_from_power(off / b)};
}

std::span<const float> of_phone(const PingRecord& record, std::size_t phone) {
  return std::span(record.pressure)
      .subspan(phone * record.recording.samples, record.recording.samples);
}

/// A ship and a point target of 10 dB, the sound of echoes alone.
Scenario sea_of(SoundSpeedProfile water, double depth) {
  Scenario s;
  s.environment.water = std::move(water);
  s.environment.bottom = {
      .depth = depth,
      .material =
          FluidHalfSpace{.speed = 1600.0, .density = 1800.0, .attenuation_db_per_wavelength = 0.5}};
  s.environment.absorption = Thorp{};
  s.transmitters[0] = {.source_level_db = 200.0, .beam = LineBeam{.taper = Taper::omnidirectional}};
  s.reverberation.enabled = false;
  s.pings.interval = 20.0;
  return s;
}

// Deep water, a towed line 20 m long, a pulse of a millisecond across its band. One of the ways to
// each of two highlights is by waves beyond a caustic, at frequencies of their own on the phones'
// own legs. Fronts are bent by less than a hundredth of a period: 0.063 rad, a correlation of
// 0.998.
TEST(PhoneAlone, OfATowedLineReceivesTheSameOfHighlights) {
  Scenario s = sea_of(SoundSpeedProfile::munk(), 5000.0);
  s.platforms[0].track.start = {.position = {0.0, 0.0, 80.0}, .velocity = {0.0, 3.0, 0.0}};
  s.pulse = {.waveform = Cw{.frequency = 11000.0}, .duration = 1e-3, .window = PulseWindow::hann};
  s.targets = {{.name = "target",
                .track = {.start = {.position = {2400.0, 1800.0, 80.0}}},
                .heading = 0.5,
                .highlights = {{.offset = {20.0, 0.0, 0.0}, .strength_db = 5.0},
                               {.offset = {-15.0, 0.0, 2.0}, .strength_db = 8.0}}}};
  s.propagation.band = BandOfLosses::wide;
  s.propagation.max_surface_bounces = 1;
  s.propagation.max_bottom_bounces = 0;
  s.pings.recording_start = 3.8;
  s.pings.recording_duration = 0.5;
  s.pings.sample_rate = 40000.0;
  s.arrays[0].phones = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  const auto towed = [&](const std::vector<double>& behind) {
    Scenario one = s;
    one.arrays[0].phones.clear();
    one.arrays[0].phones.resize(behind.size(), Vec3::Zero());
    one.arrays[0].towed = TowedLine{.behind = behind};
    return PingSimulator(one).sound(1);
  };
  const std::vector<double> behind = {100.0, 110.0, 120.0};
  const PingRecord line = towed(behind);
  for (std::size_t n = 0; n < behind.size(); ++n) {
    const PingRecord alone = towed({behind[n]});
    const Beside found = beside(of_phone(line, n), of_phone(alone, 0));
    EXPECT_GT(found.correlation, 0.998) << n;
    EXPECT_NEAR(found.level_db, 0.0, 0.1) << n;
  }
}

/// A thermocline of straight lines, a vertical line of 8 phones 0.8 m apart below the ship.
Scenario short_line(std::vector<Vec3> phones) {
  const std::vector<double> depth = {0.0, 15.0, 35.0, 60.0, 100.0},
                            speed = {1522.0, 1521.0, 1496.0, 1492.0, 1491.0};
  Scenario s = sea_of(SoundSpeedProfile::table(depth, speed, Interpolation::c_linear), 100.0);
  s.platforms[0].track.start.position = {0.0, 0.0, 50.0};
  s.arrays[0].phones = std::move(phones);
  s.pulse = {.waveform = Lfm{300.0, 900.0},
             .duration = 0.5,
             .window = PulseWindow::tukey,
             .tukey_fraction = 0.3};
  s.targets = {{.name = "target",
                .track = {.start = {.position = {0.0, 2500.0, 70.0}}},
                .strength_db = 10.0}};
  s.pings.recording_start = 3.2;
  s.pings.recording_duration = 1.25;
  s.pings.sample_rate = 4000.0;
  s.propagation.band = BandOfLosses::narrow;
  return s;
}

// Amplitudes of waves change within wavelengths, also over an array that is short for the bend of
// its fronts. Paths are those of the reference point where all differ by less than −30 dB from what
// the outermost phones receive.
TEST(PhoneAlone, OfAShortLineReceivesTheSameWaves) {
  std::vector<Vec3> phones;
  for (int n = 0; n < 8; ++n) phones.emplace_back(0.0, 0.0, 12.8 - 0.8 * n);
  const PingRecord line = PingSimulator(short_line(phones)).sound(1);
  for (const std::size_t n : {0, 7}) {
    const PingRecord alone = PingSimulator(short_line({phones[n]})).sound(1);
    const Beside found = beside(of_phone(line, n), of_phone(alone, 0));
    EXPECT_LT(found.apart_db, -30.0) << n;
    EXPECT_NEAR(found.level_db, 0.0, 0.1) << n;
  }
}

// Over a slope a bounce moves with the phone, by which plane waves about the middle of a line of
// 0.24 m may be off by a radian at 46 kHz. What is tolerated is 0.063 rad, −24 dB.
TEST(PhoneAlone, OverASlopeReceivesItsOwnBounces) {
  Scenario s = sea_of(SoundSpeedProfile::isovelocity(1500.0), 60.0);
  const std::vector<double> range = {0.0, 200.0, 400.0, 600.0}, depth = {60.0, 35.0, 55.0, 30.0};
  s.environment.bottom.shape = BoundaryShape(range, depth, ShapeInterpolation::piecewise_linear);
  s.platforms[0].track.start.position = {0.0, 0.0, 20.0};
  s.pulse = {.waveform = Cw{.frequency = 46000.0}, .duration = 1e-3, .window = PulseWindow::hann};
  s.arrays[0].phones.clear();
  for (int n = 0; n < 16; ++n) s.arrays[0].phones.emplace_back(0.0, 0.0, 0.016 * (n - 7.5));
  s.targets = {{.name = "target",
                .track = {.start = {.position = {0.0, 350.0, 15.0}}},
                .strength_db = 10.0}};
  s.propagation.max_surface_bounces = 1;
  s.propagation.max_bottom_bounces = 2;
  s.pings.recording_start = 0.45;
  s.pings.recording_duration = 0.15;
  s.pings.sample_rate = 120000.0;
  const PingRecord line = PingSimulator(s).sound(1);
  s.propagation.exact_per_phone = true;
  const PingRecord exact = PingSimulator(s).sound(1);
  for (std::size_t n = 0; n < 16; ++n)
    EXPECT_LT(beside(of_phone(line, n), of_phone(exact, n)).apart_db, -24.0) << n;
}

}  // namespace
}  // namespace asdic::detail
