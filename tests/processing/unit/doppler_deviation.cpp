// The deviation that a detection's Doppler factor is told with, counted.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include "core/random.h"
#include "core/units.h"
#include "processing/detector.h"
#include "processing/factor_estimate.h"
#include "processing/listening_band.h"
#include "sonar/noise/noise.h"
#include "sonar/signal/pulse.h"
#include "sonar/synthesis/direct_synthesis.h"
#include "sonar/synthesis/synthesis.h"
#include "support/deep.h"

namespace asdic::detail {
namespace {

constexpr double rate = 3000.0;
constexpr int echoes = 20;

/// Errors of the factor over what is told, and over what a tenth of a cell at least would tell.
struct Errors {
  double told = 0.0, floored = 0.0, sum = 0.0;
  int counted = 0, lost = 0;
  int twice = 0;  ///< detections beside an echo's own, no more than 10 dB below it

  void add(double error, double sigma, double floor) {
    told += std::pow(error / sigma, 2.0);
    floored += std::pow(error / floor, 2.0);
    sum += error / sigma;
    ++counted;
  }
  void add(const Errors& other) {
    told += other.told, floored += other.floored, sum += other.sum;
    counted += other.counted, lost += other.lost, twice += other.twice;
  }
};

/// Echoes of any factor between the filters and any delay between the samples, in white noise.
///
/// \param snr_db  of the whole pulse   \param sub_bands  that the receiver cuts it into
Errors counted(const PulseSettings& settings, int sub_bands, double snr_db, std::uint32_t run) {
  const Pulse pulse(settings);
  const Replica known(std::span<const float>(replica(pulse, rate)), rate);
  const double cell = doppler_cell(known, sub_bands), span = std::min(4.0 * cell, 0.06);
  const std::vector<double> bank = doppler_bank(known, span, 0.25, sub_bands);
  const double gap = std::max(40.0 * sub_bands / known.noise_bandwidth(), 2.5 * pulse.duration());
  const Recording recording{.sample_rate = rate, .samples = std::size_t(gap * (echoes + 1) * rate)};
  const double variance = white_noise_variance(60.0, rate), density = variance / (0.5 * rate);
  // SNR = |A|²E/(2N₀)
  const double amplitude = std::sqrt(power_from_db(snr_db) * 2.0 * density / known.energy());
  RandomStream draw(run, Draw::scatterer_place, 0, 0);
  Returns returns;
  for (int i = 0; i < echoes; ++i)
    returns.push_back({.delay = gap * (i + 0.5) + 0.1 * draw.uniform(),
                       .amplitude = std::polar(amplitude, 2.0 * pi * draw.uniform()),
                       .doppler = 1.0 + (draw.uniform() - 0.5) * span});
  const std::vector<Vec3> phone{Vec3::Zero()};
  const std::vector<double> p = direct_synthesis(pulse, recording, returns, phone);
  std::vector<float> pressure(p.begin(), p.end());
  add_white_noise(pressure, 1, variance, 77, run);
  const ListeningBand band{.centre = known.centre_frequency(),
                           .width = 1.6 * known.bandwidth() + 2000.0 * span};
  const Baseband baseband = to_baseband(pressure, 1, rate, 0.0, band, 1.1 * pulse.duration());
  DetectorSettings receiver;
  receiver.normaliser.false_alarm_probability = 1e-3;
  receiver.sub_bands = sub_bands;
  const DetectorResult found = detect(baseband, phone, 1500.0, known, bank, receiver);
  Errors errors;
  for (const Return& echo : returns) {
    const Detection* best = nullptr;
    for (const Detection& d : found.detections) {
      const double along = found.delay_per_doppler * (d.doppler - echo.doppler);
      if (std::abs(d.time - echo.delay - along) < 3.0 * found.time_cell &&
          std::abs(d.doppler - echo.doppler) < cell &&
          (best == nullptr || d.level_db > best->level_db))
        best = &d;
    }
    if (best == nullptr) {
      ++errors.lost;
      continue;
    }
    for (const Detection& d : found.detections)
      if (&d != best && std::abs(d.time - echo.delay) < 0.4 * gap &&
          d.level_db > best->level_db - 10.0)
        ++errors.twice;
    errors.add(best->doppler - echo.doppler, best->doppler_sigma,
               sigma_of(2.0 * cell, power_from_db(best->snr_db)));
  }
  return errors;
}

struct Case {
  PulseSettings pulse;
  int sub_bands = 1;
};

PulseSettings lfm(double from, double to, double duration, PulseWindow window) {
  return {.waveform = Lfm{.start_frequency = from, .end_frequency = to},
          .duration = duration,
          .window = window};
}
PulseSettings hfm(double from, double to, double duration, PulseWindow window) {
  return {.waveform = Hfm{.start_frequency = from, .end_frequency = to},
          .duration = duration,
          .window = window};
}
PulseSettings tone(double duration, PulseWindow window) {
  return {.waveform = Cw{.frequency = 1000.0}, .duration = duration, .window = window};
}

// 40 echoes each of 13, 20 and 30 dB: the deviation of such a deviation is 6 %. What is at another
// maximum of the noise, a cell or more off, is counted by itself: a few of 13 dB, and of sub-bands
// more, whose SNR each is lower. A tenth of the 3 dB span, whatever the SNR, is three to seven
// times what scatters at 30 dB.
//
// \param slow  of the full form alone
void expect_as_told(std::vector<Case> cases, const std::vector<Case>& slow) {
  const std::uint32_t runs = support::deep() ? 10 : 2;
  if (support::deep()) cases.insert(cases.end(), slow.begin(), slow.end());
  std::uint32_t seed = 0;
  for (const Case& the : cases) {
    SCOPED_TRACE("case " + std::to_string(&the - cases.data()));
    Errors all;
    for (const double snr_db : {13.0, 20.0, 30.0}) {
      Errors errors;
      for (std::uint32_t run = 0; run < runs; ++run)
        errors.add(counted(the.pulse, the.sub_bands, snr_db, ++seed));
      EXPECT_LE(errors.lost, snr_db < 14.0 ? 2 * int(runs) : 0) << snr_db;
      const double n = errors.counted;
      const double spread = std::sqrt(errors.told / n);
      EXPECT_GT(spread, 1.0 / 1.45) << snr_db;  // 11 % of chance beside
      EXPECT_LT(spread, 1.45) << snr_db;
      EXPECT_LT(std::abs(errors.sum / n), 0.5) << snr_db;
      if (snr_db > 25.0) {
        if (!std::holds_alternative<Cw>(the.pulse.waveform)) {  // whose side lobes are −13 dB
          EXPECT_LE(errors.twice, 0.02 * n);
        }
        EXPECT_LT(std::sqrt(errors.floored / n), 0.4);  // told too much
      }
      all.add(errors);
    }
    const double spread = std::sqrt(all.told / all.counted);
    EXPECT_GT(spread, 1.0 / 1.3);
    EXPECT_LT(spread, 1.3);
  }
}

TEST(DopplerDeviation, IsTheScatterOfTonesAndSweeps) {
  using W = PulseWindow;
  const std::vector<Case> quick{
      {tone(0.1, W::hann)},
      {tone(0.4, W::none)},
      {lfm(900.0, 1100.0, 0.5, W::hann)},
      {lfm(900.0, 1100.0, 0.5, W::tukey)},
      {lfm(975.0, 1025.0, 0.5, W::hann)},
      {lfm(1025.0, 975.0, 0.5, W::none)},
  };
  const std::vector<Case> slow{
      {tone(1.0, W::hann)},
      {{.waveform = Hfm{.start_frequency = 975.0, .end_frequency = 1025.0}, .duration = 1.0}},
  };
  expect_as_told(quick, slow);
}

// Noise lifts other filters of edged sweeps, the ridge of a hyperbolic one bends, and sub-bands of
// neighbouring filters share noise.
TEST(DopplerDeviation, IsTheScatterOfWideSweepsAndSubBands) {
  using W = PulseWindow;
  const std::vector<Case> quick{
      {lfm(800.0, 1200.0, 0.3, W::none)},
      {hfm(900.0, 1100.0, 0.4, W::tukey)},
      {lfm(900.0, 1100.0, 0.5, W::hann), 4},
  };
  const std::vector<Case> slow{
      {lfm(900.0, 1100.0, 0.5, W::none)},    {lfm(800.0, 1200.0, 1.0, W::none)},
      {lfm(800.0, 1200.0, 2.0, W::none)},    {lfm(800.0, 1200.0, 1.0, W::tukey)},
      {lfm(900.0, 1100.0, 2.0, W::tukey)},   {hfm(900.0, 1100.0, 1.0, W::tukey)},
      {hfm(800.0, 1200.0, 1.0, W::tukey)},   {hfm(975.0, 1025.0, 1.0, W::tukey)},
      {lfm(800.0, 1200.0, 1.0, W::hann), 2}, {lfm(900.0, 1100.0, 1.0, W::tukey), 4},
      {lfm(800.0, 1200.0, 1.0, W::none), 4}, {hfm(900.0, 1100.0, 1.0, W::hann), 4},
  };
  expect_as_told(quick, slow);
}

// A tone without a window has |χ| = sin(πfTδ)/(πfTδ), β = πfT/√3. Filters a twentieth of a cycle
// apart are as good as the bound.
TEST(DopplerDeviation, IsTheCramerRaoBoundOfATone) {
  const Pulse pulse(
      {.waveform = Cw{.frequency = 1000.0}, .duration = 0.5, .window = PulseWindow::none});
  const Replica known(std::span<const float>(replica(pulse, rate)), rate);
  const FactorEstimate estimate(known, 0.2 / 1000.0, 1e-9, 1);
  const double beta = pi * 500.0 / std::sqrt(3.0), bound = 1.0 / (beta * std::sqrt(2.0 * 1e4));
  EXPECT_NEAR(estimate.sigma(1e4 + 1.0), bound, 0.02 * bound);
}

}  // namespace
}  // namespace asdic::detail
