// What the beams of a long array make of an even sea.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/reverberant_sea.h"

namespace asdic::detail {
namespace {

using Sea = support::ReverberantSea;

/// Intensities of beams over their mean: of every beam over times and pings, of every time over
/// beams and pings.
std::vector<double> beams(const Scenario& s) {
  constexpr int beam_count = 31, time_count = 44, pings = 8;
  const Sea sea(s);
  const auto& phones = s.arrays[0].phones;
  const double wavenumber = 2.0 * pi * std::get<Cw>(s.pulse.waveform).frequency / 1500.0;
  std::vector<double> found;
  std::vector<double> of_time(time_count), of_beam(beam_count);
  for (std::uint32_t ping = 1; ping <= pings; ++ping) {
    const Baseband received = sea.receive(ping);
    for (int i = 0; i < time_count; ++i)
      for (int b = 0; b < beam_count; ++b) {
        const double sine = 0.85 * (b - 15) / 15.0;  // 1.8 beam widths apart
        std::complex<double> sum = 0.0;
        for (std::size_t n = 0; n < phones.size(); ++n) {
          const double share = (double(n) + 0.5) / double(phones.size());
          sum += std::polar(0.5 - 0.5 * std::cos(2.0 * pi * share),
                            -wavenumber * sine * phones[n].y()) *
                 support::at(received, n, 6.3 + 0.13 * i);
        }
        found.push_back(std::norm(sum));
        of_time[std::size_t(i)] += std::norm(sum);
      }
  }
  for (std::size_t k = 0; k < found.size(); ++k) {
    found[k] *= double(pings * beam_count) / of_time[k / beam_count % time_count];
    of_beam[k % beam_count] += found[k] / double(pings * time_count);
  }
  for (std::size_t k = 0; k < found.size(); ++k) found[k] /= of_beam[k % beam_count];
  return found;
}

// An even surface under a line of 64 phones half a wavelength apart: many scatterers in every cell
// that beam and pulse resolve, so that a beam's intensity is exponential. ⟨I²⟩/⟨I⟩² is 2, its error
// √(20/N), N = 31 beams · 44 times · 8 pings = 10 912: 4.9 sigma 0.21; what is over ln 10³ times
// the mean is a thousandth, 10.9 ± 3.3 false alarms, below 34 but for one chance in 10⁶. Sectors of
// 10 degrees, five beams, as all arrays had them once: 2.9, and ten times the false alarms.
TEST(ReverberationBeams, AreRayleighInALongLine) {
  Scenario s = support::even_sea();
  s.platforms[0].track.start.position.z() = 500.0;
  s.pulse = {.duration = 0.12};
  s.arrays[0] = line_array(64, 0.1875, 0.0, 0.0);
  s.reverberation.azimuths = 36;
  s.pings.recording_start = 6.0;
  s.pings.recording_duration = 6.2;
  const auto moment = [](std::span<const double> intensities) {
    double sum = 0.0;
    for (const double x : intensities) sum += x * x;
    return sum / double(intensities.size());
  };
  const auto alarms = [](std::span<const double> intensities) {
    return std::count_if(intensities.begin(), intensities.end(),
                         [](double x) { return x > std::log(1e3); });
  };
  const std::vector<double> received = beams(s);
  EXPECT_NEAR(moment(received), 2.0, 4.9 * std::sqrt(20.0 / double(received.size())));
  EXPECT_LT(alarms(received), 34);
  s.reverberation.resolve_azimuth = false;
  const std::vector<double> coarse = beams(s);
  EXPECT_GT(moment(coarse), 2.3);
  EXPECT_GE(alarms(coarse), 34);
}

// As many as are needed: 36 for the few phones that resolve no more, with the same bits as 36
// asked for alone; no more scatterers than twice the most returns.
TEST(ReverberationBeams, SectorsFollowTheArrayTheSpeedAndTheLimit) {
  Scenario s = support::even_sea();
  s.pulse = {.duration = 0.12};
  s.reverberation.azimuths = 36;
  s.pings.recording_duration = 12.0;
  const auto sectors = [](const Scenario& scenario) {
    return Sea(scenario).ping(1).fields().front().grid.azimuths;
  };
  s.arrays[0] = line_array(6, 0.1875, 0.0, 0.0);  // 2π·2L/λ = 31.4
  EXPECT_EQ(sectors(s), 36);
  s.arrays[0] = line_array(64, 0.1875, 0.0, 0.0);
  EXPECT_EQ(sectors(s), 396);  // 2π·2·63/2
  s.reverberation.most_returns = 40'000;
  const Sea few(s);
  const ScattererGrid& grid = few.ping(1).fields().front().grid;
  EXPECT_LE(double(grid.azimuths) * grid.rings, 80'000.0);
  EXPECT_GE(grid.azimuths, 36);
  s.arrays[0] = line_array(2, 0.1875, 0.0, 0.0);
  s.platforms[0].track.start.velocity = {40.0, 0.0, 0.0};
  s.reverberation.most_returns = 4'000'000;
  EXPECT_EQ(sectors(s), 161);  // 2π·2v/λ·T = 160.8
}

}  // namespace
}  // namespace asdic::detail
