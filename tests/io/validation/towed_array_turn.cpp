// scenarios/towed_array_turn.toml: a line 94.5 m long towed round a circle of 200 m, by wavelengths
// of 3 m.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "io/scenario/scenario_reader.h"
#include "processing/beams.h"
#include "processing/listening_band.h"
#include "sonar/ping/ping.h"

namespace asdic::detail {
namespace {

constexpr double speed = 1495.0, centre = 500.0, wavelength = speed / centre, spacing = 1.5;

const PingSimulator& simulator() {
  static const PingSimulator quiet(read_scenario(
      ASDIC_SCENARIOS "/towed_array_turn.toml",
      std::vector<std::string>{"noise.spectral_level_db=20", "reverberation.enabled=false"}));
  return quiet;
}

/// The farthest phone's distance from the line through the first and the last [m].
double sag(const std::vector<Vec3>& phones) {
  const Vec3 along = (phones.back() - phones.front()).normalized();
  double farthest = 0.0;
  for (const Vec3& p : phones) {
    const Vec3 off = p - phones.front();
    farthest = std::max(farthest, (off - off.dot(along) * along).norm());
  }
  return farthest;
}

/// What a receiver that knows of no turn believes: a straight line in the direction of the chord.
std::vector<Vec3> straightened(const std::vector<Vec3>& phones) {
  const Vec3 along = (phones.back() - phones.front()).normalized();
  std::vector<Vec3> line;
  for (std::size_t n = 0; n < phones.size(); ++n)
    line.emplace_back(phones.front() + double(n) * spacing * along);
  return line;
}

std::vector<Vec3> azimuthally_symmetric() {
  std::vector<Vec3> looks;
  for (int degree = 0; degree < 720; ++degree) {
    const double bearing = radians(0.5 * degree);
    looks.emplace_back(std::sin(bearing), std::cos(bearing), 0.0);
  }
  return looks;
}

/// Energy of the loudest beam in the time of the first echo.
double loudest_beam(const PingRecord& record, const std::vector<Vec3>& steered) {
  double first = infinity;
  for (const EchoPath& e : record.echoes) first = std::min(first, e.received.delay);
  const Recording& r = record.recording;
  const std::size_t channels = record.phones.size();
  std::vector<std::complex<float>> echo(channels * r.samples);
  for (std::size_t n = 0; n < channels; ++n)
    for (std::size_t i = 0; i < r.samples; ++i) {
      const double t = r.start + double(i) / r.sample_rate - first;
      const float* p = record.pressure.data() + 2 * (n * r.samples + i);
      if (t > -0.1 && t < 0.6) echo[n * r.samples + i] = {p[0], p[1]};
    }
  const Baseband band =
      to_baseband(echo, channels, r.sample_rate, r.carrier, r.start, {centre, 110.0}, 0.5);
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : steered) middle += p / double(channels);
  std::vector<Vec3> relative;
  for (const Vec3& p : steered) relative.emplace_back(p - middle);
  const std::vector<double> weights(channels, 1.0 / double(channels));
  const std::vector<Vec3> looks = azimuthally_symmetric();
  const BeamSpectra beams =
      conventional_beams(channel_spectra(band), band, relative, looks, speed, weights);
  double best = 0.0;
  for (std::size_t b = 0; b < beams.beams; ++b)
    best = std::max(best, std::accumulate(beams.beam(b), beams.beam(b) + beams.bins, 0.0,
                                          [](double sum, std::complex<float> x) {
                                            return sum + double(std::norm(x));
                                          }));
  return best;
}

/// The same for a plane wave of the centre's frequency from `look`, in power re all phones in
/// phase: max over steering of |mean e^{ik(look·x − steered·y)}|².
double plane_wave_gain(const std::vector<Vec3>& phones, const std::vector<Vec3>& believed,
                       const Vec3& look) {
  const double k = 2.0 * pi / wavelength;
  double best = 0.0;
  for (const Vec3& steered : azimuthally_symmetric()) {
    std::complex<double> sum = 0.0;
    for (std::size_t n = 0; n < phones.size(); ++n)
      sum += std::polar(
          1.0, k * (look.dot(phones[n] - phones[0]) - steered.dot(believed[n] - believed[0])));
    best = std::max(best, std::norm(sum / double(phones.size())));
  }
  return best;
}

// An arc of length L of a circle of radius R strays R·(1 − cos(L/2R)) = 5.5 m from its chord, by
// nearly two wavelengths. The ship's circle has a corner every 5°, and its sides lie up to
// R·(1 − cos 2.5°) = 0.19 m within it.
TEST(TowedArrayTurn, TheLineLiesStraightAndThenOnTheCircle) {
  const double arc = 200.0 * (1.0 - std::cos(63 * spacing / 400.0));
  ASSERT_GT(arc, 1.8 * wavelength);
  for (const int ping : {1, 2}) EXPECT_LT(sag(simulator().simulate(ping).phones), 1e-6);
  for (const int ping : {3, 4}) EXPECT_NEAR(sag(simulator().simulate(ping).phones), arc, 0.19);
}

// The loss of beams of a straight line is that of a plane wave at the centre's frequency on these
// phones. The pulse is a fifth as wide as its frequency, and the first echo is two paths, the one
// by the surface 1 to 3 degrees steeper: 1 dB. Phones' errors of 0.5 dB and 4 degrees are the same
// for both.
TEST(TowedArrayTurn, BeamsOfAStraightLineLoseTheirGain) {
  for (const int ping : {2, 3, 4}) {
    const PingRecord record = simulator().simulate(ping);
    // As the line lies in the middle of the first echo.
    const double received = record.start_time + record.echoes.front().received.delay + 0.25;
    const std::vector<Vec3> shape = phones_at(simulator().scenario(), 0, ping, received);
    const std::vector<Vec3> line = straightened(shape);
    const Vec3 look = -record.echoes.front().received.slowness.normalized();
    const double expected = db_from_power(plane_wave_gain(shape, line, look)),
                 found = db_from_power(loudest_beam(record, line) / loudest_beam(record, shape));
    EXPECT_NEAR(found, expected, 1.0) << "ping " << ping;
    if (ping == 2)
      EXPECT_NEAR(found, 0.0, 0.01);
    else
      EXPECT_LT(found, -5.0) << "ping " << ping;
  }
}

TEST(TowedArrayTurn, TheDeadPhoneIsSilent) {
  const PingRecord record = simulator().simulate(1);
  ASSERT_FALSE(record.echoes.empty());
  const auto row = std::ptrdiff_t(record.recording.samples * 2);
  EXPECT_TRUE(std::all_of(record.pressure.begin() + 6 * row, record.pressure.begin() + 7 * row,
                          [](float p) { return p == 0.0F; }));
}

}  // namespace
}  // namespace asdic::detail
