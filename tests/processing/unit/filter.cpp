#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numeric>
#include <vector>

#include "core/error.h"
#include "core/normal.h"
#include "core/random.h"
#include "core/units.h"
#include "processing/beams.h"
#include "processing/listening_band.h"
#include "processing/matched_filter.h"
#include "processing/normaliser.h"
#include "processing/replica.h"
#include "sonar/noise/noise.h"
#include "sonar/signal/pulse.h"
#include "sonar/synthesis/direct_synthesis.h"
#include "sonar/synthesis/synthesis.h"

namespace asdic::detail {
namespace {

constexpr double rate = 4000.0;  // of the phones [Hz]

PulseSettings tone() {
  return {.waveform = Cw{.frequency = 1000.0}, .duration = 0.5, .window = PulseWindow::hann};
}
PulseSettings sweep() {
  return {.waveform = Lfm{.start_frequency = 900.0, .end_frequency = 1100.0},
          .duration = 0.5,
          .window = PulseWindow::tukey,
          .tukey_fraction = 0.2};
}
Replica replica_of(const PulseSettings& settings) {
  return Replica(std::span<const float>(replica(Pulse(settings), rate)), rate);
}

/// One phone that receives one echo of amplitude 1.
std::vector<float> echo(const PulseSettings& settings, double delay, double doppler,
                        double duration) {
  const Recording recording{.sample_rate = rate,
                            .samples = static_cast<std::size_t>(duration * rate)};
  const Returns returns{{.delay = delay, .amplitude = 1.0, .doppler = doppler}};
  const std::vector<Vec3> phones{Vec3::Zero()};
  const std::vector<double> p = direct_synthesis(Pulse(settings), recording, returns, phones);
  return {p.begin(), p.end()};
}

struct Filtered {
  MatchedFilterBank bank;
  std::vector<std::vector<std::complex<float>>> out;  // [filters][samples]
};
Filtered filtered(const Replica& pulse, std::span<const float> pressure,
                  const std::vector<double>& dopplers) {
  const ListeningBand band{.centre = pulse.centre_frequency(), .width = 2.0 * pulse.bandwidth()};
  const Baseband b = to_baseband(pressure, 1, rate, 0.0, band, pulse.duration());
  Filtered result{MatchedFilterBank(pulse, dopplers, b), {}};
  const BeamSpectra spectra = channel_spectra(b);
  FftBuffer<std::complex<float>> work(result.bank.work());
  for (std::size_t k = 0; k < dopplers.size(); ++k) {
    result.bank.filter(k, spectra.beam(0), work.data());
    result.out.emplace_back(work.data(), work.data() + result.bank.samples());
  }
  return result;
}
/// Magnitude at the top, between the samples: of the parabola through the logarithm of the power,
/// right to 1 % of a band-limited pulse sampled at twice its band.
double peak_of(const std::vector<std::complex<float>>& y) {
  std::size_t top = 1;
  for (std::size_t i = 1; i + 1 < y.size(); ++i)
    if (std::abs(y[i]) > std::abs(y[top])) top = i;
  const auto log_at = [&](std::size_t i) { return std::log(static_cast<double>(std::abs(y[i]))); };
  const double before = log_at(top - 1), here = log_at(top), after = log_at(top + 1);
  const double offset = 0.5 * (before - after) / (before - 2.0 * here + after);
  return std::exp(here - 0.25 * (before - after) * offset);
}

// ∫|s₊|²dt of a Hann pulse is 3/8 of its duration, of a Tukey pulse 1 − 5/8 of its fraction; the
// samples carry it to the share of energy that wraps at the Nyquist rate, below 1e-4.
TEST(ReceiverReplica, HasThePulsesEnergyAndMiddle) {
  const Replica a = replica_of(tone()), b = replica_of(sweep());
  EXPECT_NEAR(a.energy(), 0.375 * 0.5, 1e-4);
  EXPECT_NEAR(b.energy(), (1.0 - 0.625 * 0.2) * 0.5, 2e-4);
  EXPECT_NEAR(a.centre_frequency(), 1000.0, 0.05);
  EXPECT_NEAR(b.centre_frequency(), 1000.0, 0.05);
}

// S(f/η)/η against the sum over samples of the stretched pulse itself. The stored replica is exact
// to float rounding, 6e-8 a sample; the direct sum errs by what wraps at its rate, 1e-4 of the
// peak.
TEST(ReceiverReplica, StretchedSpectrumIsThatOfTheStretchedPulse) {
  for (const PulseSettings& settings : {tone(), sweep()}) {
    const Pulse pulse(settings);
    const Replica stored = replica_of(settings);
    for (const double doppler : {0.98, 1.0, 1.013}) {
      for (const double f : {930.0, 998.0, 1000.0, 1007.0, 1050.0}) {
        std::complex<double> direct = 0.0;
        const double step = 1.0 / 64000.0;
        for (double t = 0.0; t <= 0.52; t += step)
          direct += pulse.analytic(doppler * t) * std::polar(step, -2.0 * pi * f * t);
        EXPECT_LT(std::abs(stored.spectrum(f, doppler) - direct), 2e-4 * 0.25)
            << doppler << " " << f;
      }
    }
  }
}

// An echo A·s₊(η(t − τ)) gives |y| = A at τ, to the interpolation's 1 % and a sample.
TEST(MatchedFilterBank, EchoPeaksAtItsDelayWithItsAmplitude) {
  for (const PulseSettings& settings : {tone(), sweep()}) {
    const Replica pulse = replica_of(settings);
    const double delay = 1.234, doppler = 1.004;
    const Filtered f = filtered(pulse, echo(settings, delay, doppler, 4.0), {1.0, doppler});
    std::size_t top = 0;
    for (std::size_t i = 0; i < f.out[1].size(); ++i)
      if (std::abs(f.out[1][i]) > std::abs(f.out[1][top])) top = i;
    EXPECT_NEAR(f.bank.time(static_cast<double>(top)), delay, 1.0 / f.bank.sample_rate());
    EXPECT_NEAR(peak_of(f.out[1]), 1.0, 0.01);
  }
}

// White noise of one-sided density N₀ and an echo of energy E: peak²/E|noise|² of the envelope is
// E/N₀, that of the real filter output 2E/N₀ (Turin, IRE Trans. IT 6, 311 (1960)). The noise's mean
// square over 400 s has about 400·B_noise independent values; at 3 Hz (tone) that is 1200, a
// standard deviation of 0.13 dB; the tolerance is 0.3 dB. A filter that forgets the
// window (a rectangle of the same length) must fail.
TEST(MatchedFilterBank, SnrIsTwiceEnergyOverNoiseDensity) {
  for (const PulseSettings& settings : {tone(), sweep()}) {
    const Replica pulse = replica_of(settings);
    const double level_db = 60.0;  // N₀ [dB re 1 µPa²/Hz]
    std::vector<float> noise(static_cast<std::size_t>(400.0 * rate), 0.0F);
    add_white_noise(noise, 1, white_noise_variance(level_db, rate), 7, 1);
    const double density = power_from_db(level_db) * micropascal * micropascal;
    const auto snr = [&](const Replica& used) {
      const Filtered received = filtered(used, echo(settings, 1.0, 1.0, 4.0), {1.0});
      const Filtered hiss = filtered(used, noise, {1.0});
      double envelope = 0.0, real = 0.0;
      for (const auto& y : hiss.out[0]) {
        envelope += static_cast<double>(std::norm(y));
        real += static_cast<double>(y.real()) * static_cast<double>(y.real());
      }
      const auto n = static_cast<double>(hiss.out[0].size());
      // The envelope of power 2 is the sum of two real parts; both ratios are told.
      const double peak = peak_of(received.out[0]) * peak_of(received.out[0]);
      EXPECT_NEAR(db_from_power(envelope / real), db_from_power(2.0), 0.3);
      return peak / (real / n);
    };
    // E of the real echo Re s₊ is half of ∫|s₊|²
    const double expected = 2.0 * 0.5 * pulse.energy() / density;
    EXPECT_NEAR(db_from_power(snr(pulse)), db_from_power(expected), 0.3);
    PulseSettings wrong = settings;
    wrong.window = PulseWindow::none;
    wrong.duration = 2.0 * settings.duration;
    EXPECT_LT(db_from_power(snr(replica_of(wrong))), db_from_power(expected) - 0.3);
  }
}

// Two neighbouring filters lose at most what was asked for, and the bank reaches the span.
TEST(DopplerBank, LosesNoMoreThanAsked) {
  for (const PulseSettings& settings : {tone(), sweep()}) {
    const Replica pulse = replica_of(settings);
    const std::vector<double> bank = doppler_bank(pulse, 0.02, 0.25);
    ASSERT_GE(bank.size(), 3U);
    EXPECT_NEAR(bank.front(), 0.98, 1e-12);
    EXPECT_NEAR(bank.back(), 1.02, 1e-12);
    EXPECT_NEAR(bank[bank.size() / 2], 1.0, 1e-12);
    const double half = 0.5 * (bank[1] - bank[0]);
    EXPECT_GE(2.0 * db_from_power(doppler_answer(pulse, 1.0 + half).response), -0.2501);
  }
}

// A Hann tone is orthogonal to its shift by 2/T cycles only for the window's square; a rectangular
// one's ambiguity along frequency is sinc²(νT): 3.92 dB down at ν = 1/(2T), zero at 1/T.
TEST(Ambiguity, OfARectangularToneIsASincInDoppler) {
  PulseSettings settings = tone();
  settings.window = PulseWindow::none;
  const Replica pulse = replica_of(settings);
  const double frequency = std::get<Cw>(settings.waveform).frequency;
  const double half_bin = 0.5 / (settings.duration * frequency);
  const std::vector<double> delays{0.0, 0.25}, dopplers{1.0, 1.0 + half_bin, 1.0 + 2.0 * half_bin};
  const std::vector<double> surface = ambiguity(pulse, delays, dopplers);
  // The spectrum is cut half a bandwidth beyond its −40 dB points, where 2e-3 of the energy lie.
  EXPECT_NEAR(surface[0], 1.0, 0.01);
  EXPECT_NEAR(surface[1], 0.25, 0.01);  // (1 − |τ|/T)²
  EXPECT_NEAR(surface[2], std::pow(2.0 / pi, 2), 0.01);
  EXPECT_NEAR(surface[4], 0.0, 0.01);
}

// The band of a passband record and that of the same record shifted to a carrier beforehand are one
// signal; both are float transforms of 10⁴ points, 1e-6 of the peak.
TEST(ListeningBandTest, PassbandAndBasebandRecordsAgree) {
  const std::vector<float> p = echo(sweep(), 0.7, 1.003, 2.0);
  const ListeningBand wide{.centre = 1000.0, .width = 700.0},
      narrow{.centre = 1010.0, .width = 300.0};
  const Baseband recorded = to_baseband(p, 1, rate, 0.25, wide, 0.5);
  const Baseband direct = to_baseband(p, 1, rate, 0.25, narrow, 0.5);
  const Baseband again =
      to_baseband(std::span<const std::complex<float>>(recorded.values.data(), recorded.recorded),
                  1, recorded.sample_rate, recorded.carrier, 0.25, narrow, 0.5);
  const double energy_direct =
      std::inner_product(direct.values.begin(), direct.values.end(), direct.values.begin(),
                         std::complex<double>(0.0), std::plus<>(),
                         [](auto a, auto b) { return std::complex<double>(a * std::conj(b)); })
          .real() /
      direct.sample_rate;
  const double energy_again =
      std::inner_product(again.values.begin(), again.values.end(), again.values.begin(),
                         std::complex<double>(0.0), std::plus<>(),
                         [](auto a, auto b) { return std::complex<double>(a * std::conj(b)); })
          .real() /
      again.sample_rate;
  EXPECT_NEAR(energy_again, energy_direct, 2e-3 * energy_direct);
  const Replica pulse = replica_of(sweep());
  for (const Baseband* b : {&direct, &again}) {
    const MatchedFilterBank bank(pulse, std::vector<double>{1.003}, *b);
    FftBuffer<std::complex<float>> work(bank.work());
    bank.filter(0, channel_spectra(*b).beam(0), work.data());
    std::size_t top = 0;
    for (std::size_t i = 0; i < bank.samples(); ++i)
      if (std::abs(work[i]) > std::abs(work[top])) top = i;
    EXPECT_NEAR(bank.time(static_cast<double>(top)), 0.25 + 0.7, 1.0 / bank.sample_rate());
    EXPECT_NEAR(std::abs(work[top]), 1.0, 0.1);
  }
}

TEST(ListeningBandTest, OutsideTheRecordIsAnInputError) {
  const std::vector<float> p(100, 0.0F);
  EXPECT_THROW(
      static_cast<void>(to_baseband(p, 1, rate, 0.0, {.centre = 3000.0, .width = 10.0}, 0.0)),
      InputError);
  EXPECT_THROW(
      static_cast<void>(to_baseband(p, 1, rate, 0.0, {.centre = 1000.0, .width = 0.0}, 0.0)),
      InputError);
}

/// Shares of 3·10⁷ independent exponential cells over the threshold, and over −ln P times the
/// background.
std::pair<double, double> alarm_rates(const NormaliserSettings& settings) {
  const BackgroundEstimator estimator(settings, 1.0);
  const std::size_t n = 100000;
  std::vector<float> normals(2 * n), power(n), background(n), threshold(n);
  BackgroundEstimator::Scratch scratch;
  double alarms = 0.0, naive = 0.0, cells = 0.0;
  for (std::uint32_t run = 0; run < 300; ++run) {
    fill_normal(normals, 5, Draw::ambient_noise, run, 0);
    for (std::size_t i = 0; i < n; ++i)
      power[i] = normals[2 * i] * normals[2 * i] + normals[2 * i + 1] * normals[2 * i + 1];
    estimator(power, background, threshold, scratch);
    const auto flat = static_cast<float>(-std::log(settings.false_alarm_probability));
    for (std::size_t i = 0; i < n; ++i) {
      alarms += power[i] > threshold[i] ? 1.0 : 0.0;
      naive += power[i] > flat * background[i] ? 1.0 : 0.0;
    }
    cells += static_cast<double>(n);
  }
  return {alarms / cells, naive / cells};
}

// α = N(P^(−1/N) − 1) is exact for independent exponential cells. With 3·10⁷ cells at P = 10⁻³ the
// count is 30 000 ± 173: 3 % are 5 standard deviations. A
// threshold that takes the mean of 24 cells for the truth, −ln P, must fail: its rate is 1.58
// times.
TEST(CellAveraging, FalseAlarmRateIsTheOneThatWasSet) {
  const auto [rate_set, naive] = alarm_rates({.method = Normaliser::cell_averaging,
                                              .guard_cells = 2.0,
                                              .reference_cells = 12.0,
                                              .false_alarm_probability = 1e-3});
  EXPECT_NEAR(rate_set, 1e-3, 0.03e-3);
  EXPECT_GT(naive, 1.2e-3);
}

// The split window's mean is not that of exponential cells; its number of them is a measured one.
// It must hold to the 5 % that normaliser.cpp tells; the count's own deviation is 0.6 %.
TEST(SplitWindow, FalseAlarmRateIsNearlyTheOneThatWasSet) {
  const auto [rate_set, naive] = alarm_rates({.method = Normaliser::split_window,
                                              .guard_cells = 2.0,
                                              .reference_cells = 12.0,
                                              .false_alarm_probability = 1e-3});
  EXPECT_NEAR(rate_set, 1e-3, 0.05e-3);
  EXPECT_GT(naive, 1.2e-3);
}

// Noise through a matched filter: cells are no longer independent, but 1/B_noise apart they are;
// the rate of exceedances of samples is still the one that was set within 20 %. 2 000 s
// of a 200 Hz sweep are 3·10⁵ cells; at P = 10⁻² that is 3·10³ ± 54·1.5: 20 % is 7 standard
// deviations.
TEST(CellAveraging, FalseAlarmRateHoldsBehindAMatchedFilter) {
  const Replica pulse = replica_of(sweep());
  const NormaliserSettings settings{.method = Normaliser::cell_averaging,
                                    .guard_cells = 2.0,
                                    .reference_cells = 16.0,
                                    .false_alarm_probability = 1e-2};
  double alarms = 0.0, samples = 0.0;
  for (std::uint32_t run = 1; run <= 5; ++run) {
    std::vector<float> noise(static_cast<std::size_t>(400.0 * rate), 0.0F);
    add_white_noise(noise, 1, white_noise_variance(60.0, rate), 11, run);
    const Filtered f = filtered(pulse, noise, {1.0});
    const BackgroundEstimator estimator(settings, f.bank.sample_rate() / pulse.noise_bandwidth());
    std::vector<float> power, background(f.out[0].size()), threshold(f.out[0].size());
    for (const auto& y : f.out[0]) power.push_back(std::norm(y));
    BackgroundEstimator::Scratch scratch;
    estimator(power, background, threshold, scratch);
    for (std::size_t i = 0; i < power.size(); ++i) alarms += power[i] > threshold[i] ? 1.0 : 0.0;
    samples += static_cast<double>(power.size());
  }
  EXPECT_NEAR(alarms / samples, 1e-2, 0.2e-2);
}

// A loud echo in the reference cells lifts the mean of all, but not that of the second window: the
// background there is µ within its own scatter, 1/√24 = 20 %, times five.
TEST(SplitWindow, LeavesOutWhatStandsOut) {
  const std::size_t n = 2000;
  std::vector<float> power(n, 1.0F), background(n), threshold(n);
  power[1000] = 1000.0F;
  BackgroundEstimator::Scratch scratch;
  const NormaliserSettings averaging{.method = Normaliser::cell_averaging, .reference_cells = 12.0};
  NormaliserSettings split = averaging;
  split.method = Normaliser::split_window;
  BackgroundEstimator(averaging, 1.0)(power, background, threshold, scratch);
  EXPECT_GT(background[1005], 40.0F);
  BackgroundEstimator(split, 1.0)(power, background, threshold, scratch);
  EXPECT_LT(background[1005], 4.0F);
}

// In frequency and single precision, or as a sum in time: at the delays of the bank's own samples
// both say the same, but for the bank's cut at one and a half times the band: what lies outside of
// that has less than 1e-4 of a pulse's energy.
TEST(MatchedFilterAt, SaysWhatTheBankSays) {
  for (const auto& settings : {tone(), sweep()}) {
    const Pulse pulse(settings);
    for (const double doppler : {0.997, 1.0, 1.004}) {
      const std::vector<float> pressure = echo(settings, 0.7331, doppler, 2.0);
      const Filtered bank = filtered(replica_of(settings), pressure, {doppler});
      const Recording whole{.sample_rate = rate, .samples = pressure.size()};
      double most = 0.0;
      for (std::size_t i = 0; i < bank.out[0].size(); ++i) {
        const double delay = bank.bank.time(static_cast<double>(i));
        if (delay < 0.2 || delay > 1.3) continue;
        const MatchedFilterAt plain(whole, pulse, doppler, {{.channel = 0, .delay = delay}});
        const double y = std::sqrt(plain.answer(pressure, whole.samples, 0, 0));
        EXPECT_NEAR(y, std::abs(bank.out[0][i]), 0.01) << delay;
        most = std::max(most, y);
      }
      EXPECT_GT(most, 0.8);
    }
  }
}

}  // namespace
}  // namespace asdic::detail
