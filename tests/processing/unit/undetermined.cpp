// Sweeps so wide that their whole Doppler bank lies within one Doppler cell.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <span>
#include <vector>

#include "core/random.h"
#include "processing/detector.h"
#include "processing/factor_estimate.h"
#include "processing/listening_band.h"
#include "sonar/signal/pulse.h"
#include "sonar/synthesis/direct_synthesis.h"
#include "sonar/synthesis/synthesis.h"

namespace asdic::detail {
namespace {

// 100 Hz and 0.5 s about 500 Hz answer within 3 dB over ±0.044 of η; the bank for 15 m/s is 0.98 …
// 1.02. Two paths of one echo, 3 to 9 ms apart (a cell is 19 ms) and of opposite sign as by way of
// the surface, have a hole in their spectrum that moves the loudest filter at will, often to the
// bank's edge, 0.02·2.5 s = 50 ms along the ridge. Told the bank's middle instead, the time lies on
// the ridge there, 10 ms before that of the echo's own factor, within a cell of the middle of both
// paths, and twice the deviation that tracks are told covers it.
TEST(UndeterminedDoppler, IsToldAsTheBanksMiddle) {
  constexpr double rate = 1600.0, length = 5.0, factor = 1.004;
  const Pulse pulse({.waveform = Lfm{.start_frequency = 450.0, .end_frequency = 550.0},
                     .duration = 0.5,
                     .window = PulseWindow::hann});
  const Replica known(std::span<const float>(replica(pulse, rate)), rate);
  const std::vector<double> bank = doppler_bank(known, 0.02);
  ASSERT_EQ(bank.size(), 3U);
  const Recording recording{.sample_rate = rate, .samples = std::size_t(length * rate)};
  const std::vector<Vec3> phone{Vec3::Zero()};
  int undetermined = 0, at_most_edge = 0;
  for (int i = 0; i < 40; ++i) {
    const double apart = 0.003 + 0.00015 * i;
    Returns paths(2);
    paths[0] = {.delay = 2.0, .amplitude = 1.0, .doppler = factor};
    paths[1] = {.delay = 2.0 + apart, .amplitude = -0.95, .doppler = factor};
    const std::vector<double> p = direct_synthesis(pulse, recording, paths, phone);
    std::vector<float> pressure(p.begin(), p.end());
    RandomStream draw(std::uint32_t(i), Draw::ambient_noise, 0, 0);
    for (float& x : pressure) x += float(0.2 * draw.normal());
    const Baseband baseband =
        to_baseband(pressure, 1, rate, 0.0, {.centre = 500.0, .width = 300.0}, 0.6);
    const DetectorResult found = detect(baseband, phone, 1500.0, known, bank, {});
    ASSERT_GE(found.detections.size(), 1U) << apart;
    const Detection& d = *std::max_element(
        found.detections.begin(), found.detections.end(),
        [](const Detection& a, const Detection& b) { return a.snr_db < b.snr_db; });
    EXPECT_LE(d.doppler_sigma, 0.02 / std::sqrt(3.0) + 1e-12);
    const double off = d.time - 2.0 - 0.5 * apart;
    const double sigma = std::hypot(sigma_of(found.time_cell, power_from_db(d.snr_db)),
                                    found.delay_per_doppler * trusted_sigma(d, found));
    EXPECT_LT(std::abs(off), 2.0 * sigma) << apart;
    if (d.doppler == 1.0) {
      ++undetermined;
      EXPECT_NEAR(d.doppler_sigma, 0.02 / std::sqrt(3.0), 1e-12);
      EXPECT_NEAR(off, found.delay_per_doppler * (1.0 - factor), found.time_cell) << apart;
    }
    if (std::abs(d.doppler - 1.0) > 0.0199) ++at_most_edge;
  }
  EXPECT_GT(undetermined, 5);
  EXPECT_EQ(at_most_edge, 0);
}

// A bank of so small a span has three filters, whatever the ratio of the span to the pulse's cell,
// so the processor time to make it is the same. It used to grow with the square of the number of
// filters in a cell.
TEST(UndeterminedDoppler, NarrowBanksTakeNoLonger) {
  constexpr double rate = 1000.0;
  const Pulse pulse({.waveform = Lfm{.start_frequency = 100.0, .end_frequency = 300.0},
                     .duration = 0.5,
                     .window = PulseWindow::hann});
  const Replica known(std::span<const float>(replica(pulse, rate)), rate);
  const double cell = doppler_cell(known);
  const auto seconds = [&](double span) {
    const std::vector<double> bank = doppler_bank(known, span);
    EXPECT_EQ(bank.size(), 3U);
    const std::clock_t begin = std::clock();
    const FactorFinder finder(known, bank[1] - bank[0], bank.size(), cell, 1);
    EXPECT_TRUE(std::isfinite(finder.late()(1.0, bank[2])));
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  };
  const double plain = seconds(0.1 * cell);
  EXPECT_LT(seconds(1e-3 * cell), 5.0 * plain + 0.05);
}

}  // namespace
}  // namespace asdic::detail
