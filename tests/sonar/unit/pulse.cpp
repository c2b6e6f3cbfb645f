#include "sonar/signal/pulse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace asdic::detail {
namespace {

/// Instantaneous frequency by a symmetric difference of the phase [Hz].
double frequency_at(const Pulse& pulse, double t) {
  const double h = 1e-6;
  return std::arg(pulse.analytic(t + h) * std::conj(pulse.analytic(t - h))) / (4.0 * pi * h);
}

std::string fault_of(const PulseSettings& settings) {
  try {
    const Pulse pulse(settings);
  } catch (const InputError& error) {
    return error.fault().where;
  }
  return "nothing";
}

TEST(Pulse, StartsWithPhaseZeroAndTurnsForward) {  // e^{+iωt}
  const Pulse pulse(
      {.waveform = Cw{.frequency = 100.0}, .duration = 1.0, .window = PulseWindow::none});
  EXPECT_NEAR(std::abs(pulse.analytic(0.0) - 1.0), 0.0, 1e-15);
  EXPECT_NEAR(std::abs(pulse.analytic(0.0025) - std::complex<double>(0, 1)), 0.0, 1e-12);
}

TEST(Pulse, IsZeroOutsideItsDuration) {
  for (auto window : {PulseWindow::none, PulseWindow::hann, PulseWindow::tukey}) {
    const Pulse pulse({.duration = 0.5, .window = window});
    for (double t : {-1e-12, 0.5 + 1e-12, -3.0, 1e9, std::nan("")})
      EXPECT_EQ(pulse.analytic(t), 0.0);
  }
}

// Phase differences of step 2e-6 s resolve the frequency to the rounding of arg, 1e-4 Hz.
TEST(Pulse, SweepsGoWhereTheySay) {
  for (auto [from, to] : {std::pair{3000.0, 3500.0}, std::pair{4200.0, 3100.0}}) {
    const double linear = 0.5 * (from + to), hyperbolic = 2.0 / (1.0 / from + 1.0 / to);
    for (const auto& [waveform, middle] : {std::pair{AnyWaveform(Lfm{from, to}), linear},
                                           std::pair{AnyWaveform(Hfm{from, to}), hyperbolic}}) {
      const Pulse pulse({.waveform = waveform, .duration = 0.8, .window = PulseWindow::none});
      EXPECT_NEAR(frequency_at(pulse, 2e-6), from, 0.01);
      EXPECT_NEAR(frequency_at(pulse, 0.8 - 2e-6), to, 0.01);
      EXPECT_NEAR(frequency_at(pulse, 0.4), middle, 0.001);  // HFM: the period is linear in time
    }
  }
}

TEST(Pulse, AHyperbolicSweepToTheSameFrequencyIsATone) {
  const Pulse tone({.waveform = Cw{.frequency = 3000.0}, .duration = 0.5});
  const Pulse sweep(
      {.waveform = Hfm{.start_frequency = 3000.0, .end_frequency = 3000.0}, .duration = 0.5});
  EXPECT_NEAR(std::abs(tone.analytic(0.3) - sweep.analytic(0.3)), 0.0, 1e-9);
}

/// Largest correlation of the pulse with a copy of it stretched by η, over delays, over its energy.
double ambiguity(const Pulse& pulse, double doppler) {
  const double step = 1.0 / 2000.0;  // the product varies slowly where the two agree
  double best = 0.0;
  for (double delay = -0.05; delay <= 0.05; delay += 1e-4) {
    std::complex<double> sum = 0.0;
    for (double t = 0.0; t <= pulse.duration(); t += step)
      sum += std::conj(pulse.analytic(t)) * pulse.analytic(doppler * (t - delay));
    best = std::max(best, std::abs(sum) * step);
  }
  return best / pulse.energy();
}

// What an HFM is for: at η = 1.02 the rates of an LFM of T = 0.5 s, B = 1 kHz differ by 4 %, a
// quadratic phase of φ = π·0.04·(B/T)·(T/2)² = 15.7 rad at the ends, which leaves
// √(π/φ)·½T/energy = 0.60 under a Hann window; an HFM is only shifted.
TEST(Pulse, HyperbolicSweepToleratesDoppler) {
  PulseSettings sweep = {.waveform = Lfm{.start_frequency = 3000.0, .end_frequency = 4000.0},
                         .duration = 0.5};
  const double linear = ambiguity(Pulse(sweep), 1.02);
  sweep.waveform = Hfm{.start_frequency = 3000.0, .end_frequency = 4000.0};
  const double hyperbolic = ambiguity(Pulse(sweep), 1.02);
  EXPECT_GT(hyperbolic, 0.9);
  EXPECT_LT(linear, 0.65);
}

TEST(Pulse, EnergyOfWindows) {  // ∫w²dt: T, 3/8 T, (1 − 5α/8) T; and by adding up samples
  for (auto [window, share] :
       {std::pair{PulseWindow::none, 1.0}, std::pair{PulseWindow::hann, 0.375},
        std::pair{PulseWindow::tukey, 0.875}}) {
    const Pulse pulse({.duration = 0.8, .window = window, .tukey_fraction = 0.2});
    EXPECT_NEAR(pulse.energy(), 0.8 * share, 1e-12);
    double sum = 0.0;
    for (int i = 0; i < 8000; ++i) sum += std::norm(pulse.analytic(1e-4 * (i + 0.5))) * 1e-4;
    EXPECT_NEAR(sum, pulse.energy(), 1e-6);
  }
}

// −40 dB: side lobes of a rectangle reach 1/(πfT) = 0.01 at fT = 31.8, the last peak above it at
// 31.5, which bins 1/(4T) apart may miss by cos(π/8), 8 %; Hann's |sinc(u)/(1 − u²)| stays below
// 0.01 beyond 1.7 (its side lobes peak at 0.027 at 2.36, 0.0084 at 3.4): 2.8. A sweep adds its own
// width.
TEST(Pulse, BandwidthIsThatOfTheSpectrum) {
  EXPECT_NEAR(Pulse({.duration = 0.5, .window = PulseWindow::none}).bandwidth_40db() * 0.5, 63.2,
              5.0);
  EXPECT_NEAR(Pulse({.duration = 0.5}).bandwidth_40db() * 0.5, 5.5, 0.6);
  const double sweep =
      Pulse({.waveform = Lfm{.start_frequency = 3500.0, .end_frequency = 4500.0}}).bandwidth_40db();
  EXPECT_GT(sweep, 900.0);
  EXPECT_LT(sweep, 1100.0);
}

// 99 % of the energy: of a rectangle's sinc²(u) all but 1/(π²u) lies within ±u, 2u = 20.3; of
// Hann's spectrum 2u = 2.9. Bins are 1/(4T) wide, and the width is rounded up by less than a bin
// and a half on either side, 0.75/T. A sweep of 200 Hz and 1 s without a window has −40 dB tails
// out to four times its width, and 99 % of its energy within a few hertz of it.
TEST(Pulse, BandwidthOfItsEnergyLeavesOutSideLobes) {
  EXPECT_NEAR(Pulse({.duration = 0.5, .window = PulseWindow::none}).bandwidth_99() * 0.5, 20.7,
              0.45);
  EXPECT_NEAR(Pulse({.duration = 0.5}).bandwidth_99() * 0.5, 3.25, 0.4);
  const Pulse sweep({.waveform = Lfm{.start_frequency = 3900.0, .end_frequency = 4100.0},
                     .window = PulseWindow::none});
  EXPECT_NEAR(sweep.bandwidth_99(), 200.0, 12.0);
  EXPECT_GT(sweep.bandwidth_40db(), 700.0);
}

TEST(Pulse, FileIsItsAnalyticSignal) {
  const Pulse model({.waveform = Cw{.frequency = 1500.0}, .duration = 0.2});
  SampledPulse sampled{.sample_rate = 8000.0};
  for (int i = 0; i < 1600; ++i) sampled.samples.push_back(0.2 * model.analytic(i / 8000.0).real());
  const Pulse file({.waveform = sampled});
  EXPECT_NEAR(file.centre_frequency(), 1500.0, 0.5);
  EXPECT_NEAR(file.duration(), 0.2, 1e-12);
  EXPECT_NEAR(file.energy(), model.energy(), 1e-3 * model.energy());
  EXPECT_NEAR(file.bandwidth_40db(), model.bandwidth_40db(), 5.0);
  // Unit peak is that of the samples between which the envelope is flat to (π·h/T)², 1e-6.
  for (double t = 0.0; t < 0.2; t += 0.00317)
    EXPECT_NEAR(std::abs(file.analytic(t) - model.analytic(t)), 0.0, 2e-5) << t;
}

TEST(Pulse, ReplicaIsTheRealPartAtTheRate) {
  const Pulse pulse({.duration = 0.01});
  const auto samples = replica(pulse, 16000.0);
  ASSERT_EQ(samples.size(), 161U);
  EXPECT_FLOAT_EQ(samples[50], static_cast<float>(pulse.analytic(50 / 16000.0).real()));
}

TEST(Pulse, FaultsNameTheSetting) {
  EXPECT_EQ(fault_of({.duration = 0.0}), "duration");
  EXPECT_EQ(fault_of({.duration = std::nan("")}), "duration");
  EXPECT_EQ(fault_of({.waveform = Cw{-1.0}}), "frequency");
  EXPECT_EQ(fault_of({.waveform = Lfm{.start_frequency = 0.0}}), "start_frequency");
  EXPECT_EQ(fault_of({.waveform = Hfm{.end_frequency = infinity}}), "end_frequency");
  EXPECT_EQ(fault_of({.waveform = Sfm{.swing = 8001.0}}), "frequency");
  EXPECT_EQ(fault_of({.waveform = Costas{.order = {1, 2, 3}}}), "order");
  EXPECT_EQ(fault_of({.waveform = Costas{.order = {}}}), "order");
  EXPECT_EQ(fault_of({.waveform = Costas{.step = 900.0}}), "frequency");
  EXPECT_EQ(fault_of({.waveform = Ptfm{.sweeps = 1}}), "sweeps");
  EXPECT_EQ(fault_of({.waveform = GeometricComb{.gap_ratio = 1.0}}), "gap_ratio");
  EXPECT_EQ(fault_of({.waveform = GeometricComb{}, .duration = 0.05}), "gap_ratio");
  EXPECT_EQ(fault_of({.waveform = PulseTrain{}, .duration = 0.2}), "pulse_duration");
  EXPECT_EQ(fault_of({.window = PulseWindow::tukey, .tukey_fraction = 1.1}), "tukey_fraction");
  const auto of_samples = [](std::vector<double> samples, double rate) {
    return fault_of({.waveform = SampledPulse{.samples = std::move(samples), .sample_rate = rate}});
  };
  EXPECT_EQ(of_samples({}, 8000.0), "samples");
  EXPECT_EQ(of_samples({0.0, 0.0, 0.0}, 1.0), "samples");
  EXPECT_EQ(of_samples({0.0, std::nan("")}, 1.0), "samples[1]");
  EXPECT_EQ(of_samples({0.0, 1.0}, 0.0), "sample_rate");
}

}  // namespace
}  // namespace asdic::detail
