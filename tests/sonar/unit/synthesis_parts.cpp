#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/units.h"
#include "sonar/paths/delay_curve.h"
#include "sonar/signal/fft.h"
#include "sonar/signal/sampled_signal.h"
#include "sonar/synthesis/delay_kernel.h"
#include "sonar/synthesis/delay_windows.h"
#include "sonar/synthesis/doppler_expansion.h"
#include "sonar/synthesis/doppler_ridge.h"
#include "sonar/synthesis/place_weights.h"

namespace asdic::detail {
namespace {

TEST(Fft, FastLengthsHaveSmallPrimes) {
  EXPECT_EQ(fast_fft_length(0), 1U);
  EXPECT_EQ(fast_fft_length(11), 12U);
  EXPECT_EQ(fast_fft_length(2401), 2401U);  // 7⁴
  EXPECT_EQ(fast_fft_length(10007), 10080U);
}

// A tone in bin 5 of 60: X₅ = 60 with the forward sign −; both precisions; inverse gives N·x back.
template <class Real>
void check_transforms(Real tolerance) {
  constexpr std::size_t n = 60;
  FftBuffer<std::complex<Real>> x(n), bins(n / 2 + 1);
  FftBuffer<Real> real(n);
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = std::polar(Real(1), Real(2.0 * pi * 5.0 * double(i) / n));
    real[i] = x[i].real();
  }
  const ComplexFft<Real> fft(n);
  fft.forward(x.data());
  for (std::size_t k = 0; k < n; ++k)
    EXPECT_NEAR(std::abs(x[k] - Real(k == 5 ? n : 0)), Real(0), tolerance);
  fft.inverse(x.data());
  EXPECT_NEAR(x[0].real(), Real(n), tolerance);
  const RealFft<Real> real_fft(n);
  real_fft.forward(real.data(), bins.data());
  EXPECT_NEAR(bins[5].real(), Real(n) / 2, tolerance);
  real_fft.inverse(bins.data(), real.data());
  EXPECT_NEAR(real[0], Real(n), tolerance);
}
TEST(Fft, BothPrecisionsBothWays) {
  check_transforms<float>(2e-4F);
  check_transforms<double>(1e-12);
}

// Σ_j φ(j − x) e^{−i2πξj} = φ̂(ξ) e^{−i2πξx} + images. The same sums with the exact bump, in double
// precision (numpy), give −94.1 dB up to the band's edge and −107.6 dB over its inner three
// quarters; what is left of the tolerance is for the polynomials and float.
TEST(DelayKernel, PlacesImpulsesBetweenSamples) {
  const DelayKernel kernel;
  double worst = 0.0, inside = 0.0;
  const double edge = 0.5 / DelayKernel::oversampling;
  for (double xi = -edge; xi <= edge; xi += edge / 24.0)
    for (float fraction = 0.0F; fraction < 1.0F; fraction += 0.0625F) {
      const auto taps = kernel.weights(fraction);
      std::complex<double> sum = 0.0;
      for (int j = 0; j < DelayKernel::taps; ++j)
        sum += double(taps(2 * j)) *
               std::polar(1.0, -2.0 * pi * xi * (j - DelayKernel::before - double(fraction)));
      const double error = std::abs(sum / kernel.spectrum(xi) - 1.0);
      worst = std::max(worst, error);
      if (std::abs(xi) <= 0.75 * edge) inside = std::max(inside, error);
    }
  EXPECT_LT(db_from_amplitude(worst), -92.0);
  EXPECT_LT(db_from_amplitude(inside), -105.0);
}

TEST(SampledSignal, InterpolatesUpToAQuarterOfTheRate) {
  std::vector<std::complex<double>> samples;
  for (int i = 0; i < 200; ++i) samples.push_back(std::polar(1.0, 2.0 * pi * 0.245 * i));
  const SampledSignal signal(samples, -1.0, 100.0);  // 24.5 Hz at 100 Hz, from −1 s
  for (double t = -0.5; t < 0.5; t += 0.00137) {
    const auto exact = std::polar(1.0, 2.0 * pi * 24.5 * (t + 1.0));
    EXPECT_LT(db_from_amplitude(std::abs(signal.at(t) - exact)), -100.0);
  }
  EXPECT_EQ(signal.at(5.0), 0.0);
  EXPECT_EQ(signal.at(std::nan("")), 0.0);
}

// Many times at once, two by two: the same numbers, of a time outside between two inside as well.
TEST(SampledSignal, ManyTimesAreOneByOne) {
  std::vector<std::complex<double>> samples;
  for (int i = 0; i < 200; ++i) samples.push_back(std::polar(1.0, 2.0 * pi * 0.245 * i));
  const SampledSignal signal(samples, -1.0, 100.0);
  std::vector<double> t = {-7.0, 0.1234, 5.0};
  for (int i = 0; i < 40; ++i) t.push_back(-1.1 + 0.0571 * i);
  std::vector<double> real(t.size()), imaginary(t.size());
  signal.at(t, real, imaginary);
  for (std::size_t i = 0; i < t.size(); ++i)
    EXPECT_LT(std::abs(signal.at(t[i]) - std::complex<double>(real[i], imaginary[i])), 1e-14);
}

// Before, in, between and after two segments.
TEST(DelayCurve, ManyTimesAreOneByOne) {
  const DelayCurve curve({{.received = {1.0, 1.1, 1.3, 1.4}, .sent = {0.0, 0.11, 0.29, 0.4}},
                          {.received = {1.4, 1.5, 1.7, 1.8}, .sent = {0.4, 0.48, 0.72, 0.8}}});
  std::vector<double> received, sent(20);
  for (int i = 0; i < 20; ++i) received.push_back(0.9 + 0.05 * i);
  received[10] = 1.4;
  curve.sent_at(received, sent);
  for (std::size_t i = 0; i < sent.size(); ++i)
    EXPECT_NEAR(sent[i], curve.sent_at(received[i], Vec3::Zero()), 1e-15) << received[i];
}

// Windows are designed for −97 dB at the band's edge (place_weights.h), by a formula that is right
// to a few dB; 12 taps at 1.35 times, the wrong ones, leave −20. Places come again after 245
// samples, or are too many to be kept.
template <int n_taps>
double worst_of_places(double oversampling, std::size_t from, std::size_t to) {
  const PlaceWeights<n_taps> weights(from, to);
  typename PlaceWeights<n_taps>::Weights own;
  const double f = 0.5 / oversampling;  // cycles per sample
  auto place = weights.place(1000);
  double worst = 0.0;
  for (std::size_t i = 1000; i < 4000; ++i, weights.next(place)) {
    EXPECT_EQ(place.below, i * from / to);
    const float* w = weights.at(place, own);
    std::complex<double> sum = 0.0;
    for (int k = 0; k < n_taps; ++k)
      sum +=
          double(w[k]) * std::polar(1.0, 2.0 * pi * f * (double(place.below) + k - weights.before));
    const double exact = double(i) * double(from) / double(to);
    worst = std::max(worst, std::abs(sum - std::polar(1.0, 2.0 * pi * f * exact)));
  }
  return db_from_amplitude(worst);
}
TEST(PlaceWeights, InterpolateUpToTheBandsEdge) {
  EXPECT_LT(worst_of_places<12>(oversampling_for_12_taps, 4800, 24500), -92.0);
  EXPECT_LT(worst_of_places<12>(oversampling_for_12_taps, 4801, 24500), -92.0);
  EXPECT_LT(worst_of_places<24>(1.35, 16800, 24500), -92.0);
  EXPECT_LT(worst_of_places<24>(1.35, 29400, 24500), -92.0);  // finer than the record
  EXPECT_GT(worst_of_places<12>(1.35, 16800, 24500), -60.0);
}

class Expansion : public testing::Test {
 protected:
  Pulse pulse{PulseSettings{.waveform = Cw{.frequency = 4000.0}, .duration = 1.0}};
  BandLimitedPulse filtered{pulse, 16000.0};
  DopplerExpansion expansion{filtered};
};

// A 1 s tone over ±14 Hz fills a time-bandwidth product of 28; Chebyshev needs up to π/2 times that
// and a few: between 28 and 60 nodes.
TEST_F(Expansion, NodesFollowTheTimeBandwidthProduct) {
  EXPECT_EQ(expansion.nodes_needed(0.0), 1U);
  EXPECT_GT(expansion.nodes_needed(0.007), 28U);
  EXPECT_LT(expansion.nodes_needed(0.007), 60U);
}

// The expansion itself, away from the grid: every η of the span, every time, within 1e-4.
TEST_F(Expansion, ReproducesTheStretchedPulse) {
  std::vector<double> dopplers(1001);
  for (std::size_t i = 0; i < dopplers.size(); ++i) dopplers[i] = 0.9965 + 7e-6 * double(i);
  const auto bands = expansion.bands(dopplers);
  ASSERT_EQ(bands.size(), 1U);
  const auto sound = [&](double eta, double u) {
    return filtered.at(eta * u) * std::polar(1.0, 2.0 * pi * 4000.0 * eta * u);
  };
  std::vector<float> weights(bands[0].nodes.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < dopplers.size(); i += 37) {
    bands[0].weights(dopplers[i], weights);
    for (double u = -0.5; u <= 0.5; u += 0.013) {
      std::complex<double> sum = 0.0;
      for (std::size_t m = 0; m < weights.size(); ++m)
        sum += double(weights[m]) * sound(bands[0].nodes[m], u);
      worst = std::max(worst, std::abs(sum - sound(dopplers[i], u)));
    }
  }
  EXPECT_LT(db_from_amplitude(worst), -85.0);
}

TEST_F(Expansion, AFewFactorsGetANodeEachAndGapsAreSkipped) {
  const auto few = expansion.bands({1.0, 0.99, 1.01, 1.0, 0.99});
  ASSERT_EQ(few.size(), 3U);
  EXPECT_EQ(few[0].nodes, std::vector<double>{0.99});
  EXPECT_EQ(few[2].nodes, std::vector<double>{1.01});
  std::vector<double> sea(500);
  for (std::size_t i = 0; i < sea.size(); ++i) sea[i] = 1.0 + 1e-6 * double(i);
  sea.push_back(1.02);  // one fast target
  const auto bands = expansion.bands(sea);
  ASSERT_EQ(bands.size(), 2U);
  EXPECT_EQ(bands[1].nodes, std::vector<double>{1.02});
  EXPECT_LE(bands[0].nodes.size(), expansion.nodes_needed(5e-4));
  EXPECT_TRUE(expansion.bands({}).empty());
}

/// A second of it, a twentieth of which is a cosine on either side if no other window is asked for.
PulseSettings second_of_sweep(double from, double to, PulseWindow window = PulseWindow::tukey) {
  return {.waveform = Lfm{.start_frequency = from, .end_frequency = to},
          .duration = 1.0,
          .window = window,
          .tukey_fraction = 0.1};
}

// A sweep of f_c by B/T is received f_c·T/B·(η − 1) earlier, one downwards later, a tone neither:
// to what the envelope's ends do, a percent of its length.
TEST(DopplerRidge, IsThatOfTheSweep) {
  const auto slope = [](const PulseSettings& settings) {
    const BandLimitedPulse pulse(Pulse(settings), 16000.0);
    return DopplerRidge(pulse).slope();
  };
  EXPECT_NEAR(slope(second_of_sweep(3800.0, 4200.0)), -10.0, 0.1);
  EXPECT_NEAR(slope(second_of_sweep(4050.0, 3950.0, PulseWindow::hann)), 40.0, 0.4);
  EXPECT_NEAR(slope({.waveform = Cw{.frequency = 4000.0}, .duration = 1.0}), 0.0, 1e-6);
}

// The expansion of moved pulses, away from the grid: r.m.s. over factors and times, −80 dB. The
// bands of ±1.7 m/s take less than half the nodes that they would without their ridge.
TEST(DopplerRidge, TakesFewerNodesForTheMovedPulse) {
  for (const PulseSettings& settings :
       {second_of_sweep(3800.0, 4200.0), second_of_sweep(4050.0, 3950.0, PulseWindow::hann)}) {
    const BandLimitedPulse pulse(Pulse(settings), 16000.0);
    const DopplerExpansion expansion(pulse);
    const DopplerRidge ridge(pulse);
    const auto bands = expansion.cut(expansion.bands_over({{1.0177, 1.0223}}), 3e6, 3e5, &ridge);
    ASSERT_GT(bands.size(), 1U);
    for (const DopplerBand& band : {bands.front(), bands.back()}) {
      EXPECT_EQ(band.ridge, ridge.slope());
      EXPECT_LT(2 * band.nodes.size(), expansion.nodes_needed(band.highest - band.lowest));
      const auto moved = [&](double eta, double t) {  // (3a) about the pulse's carrier
        const double u = t + band.late(eta);
        return pulse.at(eta * u) *
               std::polar(1.0, 2.0 * pi * (4000.0 * (eta - 1.0) * u - band.rotation(eta, 4000.0)));
      };
      std::vector<float> weights(band.nodes.size());
      double error = 0.0, all = 0.0;
      for (double share = 0.01; share < 1.0; share += 0.049) {
        const double eta = band.lowest + share * (band.highest - band.lowest);
        band.weights(eta, weights);
        for (double t = -0.53; t <= 0.53; t += 0.0013) {
          std::complex<double> sum = 0.0;
          for (std::size_t m = 0; m < weights.size(); ++m)
            sum += double(weights[m]) * moved(band.nodes[m], t);
          error += std::norm(sum - moved(eta, t));
          all += std::norm(moved(eta, t));
        }
      }
      EXPECT_LT(db_from_power(error / all), -80.0);
    }
  }
}

// Edges that jump have no smooth expansion but in their own time, a tone has no ridge, and no pulse
// is moved by more than a sixteenth of it.
TEST(DopplerRidge, IsRefusedWherePulsesDifferTooMuch) {
  const BandLimitedPulse hard(Pulse(second_of_sweep(3950.0, 4050.0, PulseWindow::none)), 16000.0);
  EXPECT_EQ(DopplerRidge(hard).nodes_needed(0.001), DopplerRidge::too_many);
  const BandLimitedPulse tone(Pulse({.waveform = Cw{.frequency = 4000.0}, .duration = 1.0}),
                              16000.0);
  EXPECT_EQ(DopplerRidge(tone).nodes_needed(0.0001), DopplerRidge::too_many);
  const BandLimitedPulse soft(Pulse(second_of_sweep(3800.0, 4200.0)), 16000.0);
  EXPECT_LT(DopplerRidge(soft).nodes_needed(0.004), DopplerRidge::too_many);
  EXPECT_EQ(DopplerRidge(soft).nodes_needed(0.02), DopplerRidge::too_many);
}

// Rings received along two paths, in 1/16 of the grid each: windows of all lengths hold every
// sample with room beside, and their FFTs are some 2·(1/16)·(1 + ½…2) of the grid's: below 0.4.
TEST(DelayWindows, TransformWhatHoldsReturnsAndNoMore) {
  const std::size_t whole = 100'000, margin = 1200;
  std::vector<std::size_t> samples;
  for (std::size_t i = 0; i < whole / 16; i += 3) samples.push_back(20'000 + i);
  for (std::size_t i = 0; i < whole / 16; i += 3) samples.push_back(71'000 + i);
  DelayWindows windows;
  ASSERT_TRUE(windows.fit(samples, margin, whole));
  EXPECT_LT(windows.begins.size() * windows.length, 2 * whole / 5);
  const auto all_held = [&] {
    return std::all_of(samples.begin(), samples.end(), [&](std::size_t sample) {
      return std::any_of(windows.begins.begin(), windows.begins.end(), [&](std::size_t begin) {
        return sample >= begin && sample < begin + windows.width();
      });
    });
  };
  EXPECT_TRUE(all_held());
  EXPECT_EQ(windows.length, windows.width() + 2 * margin);

  // Another batch keeps the length, and more room beside is had from the width, or a longer window.
  const std::size_t length = windows.length;
  for (std::size_t& sample : samples) sample += 7'000;
  EXPECT_TRUE(windows.fit(samples, margin + 50, whole));
  EXPECT_EQ(windows.length, length);
  EXPECT_EQ(windows.width(), length - 2 * (margin + 50));
  EXPECT_TRUE(all_held());
  EXPECT_TRUE(windows.fit(samples, 3 * length, whole));
  EXPECT_GT(windows.length, 6 * length);
  EXPECT_TRUE(all_held());
}

// Returns all over the grid, or a pulse as long as the record: the grid's own FFT is cheaper.
TEST(DelayWindows, AreRefusedWhereTheGridIsCheaper) {
  std::vector<std::size_t> everywhere(10'000);
  for (std::size_t i = 0; i < everywhere.size(); ++i) everywhere[i] = 10 * i;
  DelayWindows windows;
  EXPECT_FALSE(windows.fit(everywhere, 12'000, 100'000));
  EXPECT_FALSE(windows.fit(std::vector<std::size_t>{5'000}, 40'000, 100'000));
  EXPECT_TRUE(windows.fit(std::vector<std::size_t>{5'000}, 1'000, 100'000));
}

}  // namespace
}  // namespace asdic::detail
