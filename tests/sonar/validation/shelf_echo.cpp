// Echoes on a continental shelf, sample by sample, against wavenumber integration that shares
// nothing with the program (tests/data/shelf/README.md): thermoclines, sand and mud.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "sonar/ping/ping.h"
#include "sonar/signal/fft.h"
#include "support/csv.h"

namespace asdic::detail {
namespace {

using support::Csv;

/// A ship on a shelf, a vertical line of phones 9 m apart about it, and a point target of 10 dB.
struct Shelf {
  std::string data;
  Environment sea;
  double ship, target, range;     // depths and distance [m]
  double deepest_phone;           // [m]
  int phones;                     // of the line
  std::array<int, 2> with_truth;  // of these
  Lfm sweep;
  double start, duration, rate;  // of the record
};

Environment sea_of(SoundSpeedProfile water, double depth, BoundaryMaterial floor) {
  Environment sea;
  sea.water = std::move(water);
  sea.water_density = 1000.0;
  sea.bottom = {.depth = depth, .material = std::move(floor)};
  sea.absorption = Thorp{};
  return sea;
}

const FluidHalfSpace sand{.speed = 1600.0, .density = 1800.0, .attenuation_db_per_wavelength = 0.5};

/// A thermocline of straight lines, and one that is smooth with a target above it.
Shelf summer() {
  const std::vector<double> depth = {0.0, 15.0, 35.0, 60.0, 100.0},
                            speed = {1522.0, 1521.0, 1496.0, 1492.0, 1491.0};
  return {"summer",
          sea_of(SoundSpeedProfile::table(depth, speed, Interpolation::c_linear), 100.0, sand),
          50.0,
          70.0,
          2500.0,
          83.0,
          8,
          {0, 4},
          {300.0, 900.0},
          3.2,
          1.25,
          4000.0};
}
Shelf across() {
  const std::vector<double> depth = {0.0, 10.0, 28.0, 55.0, 100.0},
                            speed = {1524.0, 1522.0, 1495.0, 1491.0, 1490.0};
  return {"across",
          sea_of(SoundSpeedProfile::table(depth, speed, Interpolation::pchip), 100.0, sand),
          60.0,
          6.0,
          2500.0,
          83.0,
          8,
          {0, 4},
          {300.0, 900.0},
          3.2,
          1.25,
          4000.0};
}
/// Water of one speed at low frequency, over sand and over six metres of mud on it.
Shelf pekeris() {
  return {"pekeris",
          sea_of(SoundSpeedProfile::isovelocity(1500.0), 100.0, sand),
          40.0,
          65.0,
          5000.0,
          83.0,
          8,
          {0, 4},
          {80.0, 160.0},
          6.5,
          2.5,
          2000.0};
}
Shelf mud() {
  const LayeredFloor floor{
      .layers = {{.thickness = 6.0,
                  .speed = 1440.0,
                  .density = 1300.0,
                  .attenuation_db_per_wavelength = 0.1}},
      .below = {.speed = 1700.0, .density = 1900.0, .attenuation_db_per_wavelength = 0.5}};
  return {"mud",
          sea_of(SoundSpeedProfile::isovelocity(1500.0), 80.0, floor),
          40.0,
          65.0,
          5000.0,
          65.0,
          6,
          {0, 3},
          {250.0, 350.0},
          6.5,
          2.0,
          4000.0};
}
/// \param phones  numbers of the line's phones that the array has
Scenario scenario_of(const Shelf& shelf, std::span<const int> phones) {
  Scenario s;
  s.environment = shelf.sea;
  s.platforms[0].track.start.position = {0.0, 0.0, shelf.ship};
  s.transmitters[0] = {.source_level_db = 200.0, .beam = LineBeam{.taper = Taper::omnidirectional}};
  s.arrays[0].phones.clear();
  for (const int n : phones)
    s.arrays[0].phones.emplace_back(0.0, 0.0, shelf.deepest_phone - 9.0 * n - shelf.ship);
  s.pulse = {.waveform = shelf.sweep,
             .duration = 0.5,
             .window = PulseWindow::tukey,
             .tukey_fraction = 0.3};
  s.targets = {{.name = "target",
                .track = {.start = {.position = {0.0, shelf.range, shelf.target}}},
                .strength_db = 10.0}};
  s.reverberation.enabled = false;
  s.pings.interval = 20.0;
  s.pings.recording_start = shelf.start;
  s.pings.recording_duration = shelf.duration;
  s.pings.sample_rate = shelf.rate;
  return s;
}
std::vector<int> all_of(const Shelf& shelf) {
  std::vector<int> phones;
  for (int n = 0; n < shelf.phones; ++n) phones.push_back(n);
  return phones;
}

std::span<const float> of_phone(const PingRecord& record, int phone) {
  return std::span(record.pressure)
      .subspan(std::size_t(phone) * record.recording.samples, record.recording.samples);
}

/// Comparison of what is received with the truth, in the sweep's band and 25 Hz on either side.
struct Beside {
  double correlation, energy_db;
};
Beside beside(std::span<const float> received, const Csv& truth, int phone) {
  const std::size_t n = received.size();
  FftBuffer<std::complex<double>> x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = 2.0 / double(n) * double(received[i]);
  const ComplexFft<double> fft(n);
  fft.forward(x.data());
  const std::string name = "phone" + std::to_string(phone);
  double both = 0.0, got = 0.0, is = 0.0;
  for (std::size_t row = 0; row < truth.rows(); ++row) {
    const std::complex<double> here = x[std::size_t(truth["bin"][row])],
                               there(truth[name + "_re"][row], truth[name + "_im"][row]);
    both += (here * std::conj(there)).real();
    got += std::norm(here);
    is += std::norm(there);
  }
  return {both / std::sqrt(got * is), db_from_power(got / is)};
}

/// 0.98 is −14 dB of what differs, 11° of a constant phase: what a matched filter, a beam former or
/// a correlator of phones no longer notices. One amplitude for the whole band has 0.75 to 0.97.
void expect_truth(const Shelf& shelf, BandOfLosses band, double least = 0.98) {
  Scenario s = scenario_of(shelf, all_of(shelf));
  s.propagation.band = band;
  const PingRecord record = PingSimulator(s).sound(1);
  const Csv truth("shelf/" + shelf.data + ".csv");
  for (const int phone : shelf.with_truth) {
    const Beside found = beside(of_phone(record, phone), truth, phone);
    EXPECT_GT(found.correlation, least) << shelf.data << ", phone " << phone;
    EXPECT_NEAR(found.energy_db, 0.0, 0.5) << shelf.data << ", phone " << phone;
  }
}

TEST(ShelfEcho, OfAThermoclineIsTheWavesInAWideBand) { expect_truth(summer(), BandOfLosses::wide); }
TEST(ShelfEcho, OfAThermoclineIsTheWavesByDefault) {
  expect_truth(summer(), BandOfLosses::automatic);
}
TEST(ShelfEcho, AcrossASmoothLayerIsTheWavesByDefault) {
  expect_truth(across(), BandOfLosses::automatic);
}
// With the floor's reflection at the angles of rays these have 0.944 and 0.74.
TEST(ShelfEcho, OffSandIsTheWavesByDefault) { expect_truth(pekeris(), BandOfLosses::automatic); }
TEST(ShelfEcho, OffMudIsTheWavesByDefault) { expect_truth(mud(), BandOfLosses::automatic); }
// A gradient in which flat rays turn leaves the floor's reflection at the angles of rays: the echo
// correlates 0.73 with an integral over wavenumbers. So does a floor that varies by centimetres.
TEST(ShelfEcho, OffMudWhereItIsThatOfPlaneWavesIsWarnedOf) {
  using testing::Contains, testing::HasSubstr, testing::Not;
  Shelf shelf = mud();
  const std::array phones = {0};
  const auto warnings = [&] {
    Scenario s = scenario_of(shelf, phones);
    s.propagation.band = BandOfLosses::automatic;
    return PingSimulator(s).judge_paths().warnings;
  };
  EXPECT_THAT(warnings(), Not(Contains(HasSubstr("plane waves"))));
  const std::vector<double> depth = {0.0, 80.0}, speed = {1500.0, 1501.6};
  shelf.sea.water = SoundSpeedProfile::table(depth, speed, Interpolation::c_linear);
  EXPECT_THAT(warnings(), Contains(HasSubstr("plane waves")));
  shelf = mud();
  const std::vector<double> range = {0.0, 3000.0, 12000.0}, floor = {80.0, 80.05, 80.0};
  shelf.sea.bottom.shape = BoundaryShape(range, floor, ShapeInterpolation::piecewise_linear);
  EXPECT_THAT(warnings(), Contains(HasSubstr("plane waves")));
}

/// Largest energy of the difference between phones of the line and the same phones alone [dB].
double beside_alone_db(const Shelf& shelf, BandOfLosses band, std::span<const int> phones) {
  Scenario s = scenario_of(shelf, phones);
  s.propagation.band = band;
  const PingRecord line = PingSimulator(s).sound(1);
  double worst = -infinity;
  for (std::size_t i = 0; i < phones.size(); ++i) {
    Scenario one = scenario_of(shelf, phones.subspan(i, 1));
    one.propagation.band = band;
    const PingRecord alone = PingSimulator(one).sound(1);
    double off = 0.0, all = 0.0;
    for (std::size_t k = 0; k < alone.pressure.size(); ++k) {
      const double p = alone.pressure[k];
      off += std::pow(double(of_phone(line, int(i))[k]) - p, 2);
      all += p * p;
    }
    worst = std::max(worst, db_from_power(off / all));
  }
  return worst;
}

// Every phone has paths of its own there, each with the waves at every frequency.
TEST(ShelfEcho, APhoneOfALineReceivesWhatItReceivesAlone) {
  EXPECT_LT(beside_alone_db(summer(), BandOfLosses::wide, std::array{0, 4, 7}), -30.0);
}

}  // namespace
}  // namespace asdic::detail
