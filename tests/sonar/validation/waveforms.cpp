// Generated waveforms against their closed forms: what a table of integrals, a Bessel function or a
// count of chips says of them, and not what the program's spectra say.
#include "sonar/signal/waveforms/waveforms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "core/units.h"
#include "sonar/signal/pulse.h"
#include "sonar/signal/pulse_spectrum.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;

/// s₊ about its centre, at the middles of n even steps over the duration.
std::vector<Complex> envelope(const Pulse& pulse, int n) {
  std::vector<Complex> values;
  for (int i = 0; i < n; ++i) {
    const double t = (i + 0.5) * pulse.duration() / n;
    values.push_back(pulse.analytic(t) * std::polar(1.0, -2.0 * pi * pulse.centre_frequency() * t));
  }
  return values;
}

/// |∫ s(t) s*(t − τ) e^{−i2πνt} dt|/∫|s|² of samples, τ a whole number of them.
double ambiguity(const std::vector<Complex>& s, double duration, int later, double shift) {
  const double step = duration / static_cast<double>(s.size());
  Complex sum = 0.0;
  double energy = 0.0;
  for (int i = 0; i < static_cast<int>(s.size()); ++i) {
    energy += std::norm(s[static_cast<std::size_t>(i)]);
    if (i - later < 0 || i - later >= static_cast<int>(s.size())) continue;
    sum += s[static_cast<std::size_t>(i)] * std::conj(s[static_cast<std::size_t>(i - later)]) *
           std::polar(1.0, -2.0 * pi * shift * (i + 0.5) * step);
  }
  return std::abs(sum) / energy;
}

double sinc(double x) { return x == 0.0 ? 1.0 : std::sin(pi * x) / (pi * x); }

/// ∫ s₊(t) e^{−i2πft} dt by midpoints.
Complex transform(const Pulse& pulse, double f, int n) {
  const double step = pulse.duration() / n;
  Complex sum = 0.0;
  for (int i = 0; i < n; ++i)
    sum += pulse.analytic((i + 0.5) * step) * std::polar(step, -2.0 * pi * f * (i + 0.5) * step);
  return sum;
}

PulseSettings bare(const AnyWaveform& waveform, double duration) {
  return {.waveform = waveform, .duration = duration, .window = PulseWindow::none};
}

// Costas's own statement: displaced by k chips and m steps of N/T, chips meet where the order has
// o_{i+k} − o_i = m, which is once at most; all other chips are orthogonal. Sums of whole cycles
// over 200 midpoints a chip vanish to rounding.
TEST(Waveforms, CostasMeetsItselfInOneChipAtMost) {
  for (const std::vector<double>& order : {Costas{}.order, welch_costas(13), welch_costas(11, 7)}) {
    const auto chips = static_cast<int>(order.size());
    const Pulse pulse(bare(Costas{.frequency = 4000.0, .order = order}, 0.5));
    const std::vector<Complex> s = envelope(pulse, 200 * chips);
    double most = 0.0;
    for (int k = 0; k < chips; ++k)
      for (int m = -chips; m <= chips; ++m) {
        int hits = 0;
        for (int i = 0; i + k < chips; ++i)
          if (order[static_cast<std::size_t>(i + k)] - order[static_cast<std::size_t>(i)] == m)
            ++hits;
        const double found = ambiguity(s, 0.5, 200 * k, m * chips / 0.5);
        EXPECT_NEAR(found, static_cast<double>(hits) / chips, 1e-9) << k << ' ' << m;
        if (k != 0 || m != 0) most = std::max(most, found);
      }
    EXPECT_LE(most, 1.0 / chips + 1e-9);
  }
  // A sweep over the same band and time does meet itself at these cells, on its ridge: 1 − k/10.
  const Pulse sweep(bare(Lfm{3900.0, 4100.0}, 0.5));
  EXPECT_GT(ambiguity(envelope(sweep, 2000), 0.5, 200, 20.0), 0.5);
}

// The two other constants: 4 of 6 orders of 3 are Costas arrays, 12 of 24 of 4, 40 of 120 of 5
// (Drakakis, J. Appl. Math. 2006, table 1).
TEST(Waveforms, CostasArraysAreAsManyAsCounted) {
  const std::vector<int> counted{1, 2, 4, 12, 40, 116};
  for (int n = 2; n <= 6; ++n) {
    std::vector<double> order;
    for (int i = 1; i <= n; ++i) order.push_back(i);
    int taken = 0;
    do {
      try {
        const Pulse pulse(bare(Costas{.frequency = 4000.0, .order = order}, 0.5));
        ++taken;
      } catch (const std::exception&) {
      }
    } while (std::next_permutation(order.begin(), order.end()));
    EXPECT_EQ(taken, counted[static_cast<std::size_t>(n - 1)]) << n;
  }
}

// e^{iβ sin ψ} = Σ J_n(β) e^{inψ}: over whole cycles of the modulation the line at f_c + n f_m has
// the amplitude J_n(β). Midpoint sums of a periodic function are exact to J_{4000}.
TEST(Waveforms, SfmHasLinesOfBesselFunctions) {
  const Sfm sfm{.frequency = 4000.0, .swing = 120.0, .modulation_frequency = 10.0};
  const double beta = 120.0 / 20.0;
  const Pulse pulse(bare(sfm, 0.8));
  for (int n = -12; n <= 12; ++n) {
    const double line = std::abs(transform(pulse, 4000.0 + 10.0 * n, 16384)) / 0.8;
    EXPECT_NEAR(line, std::abs(std::cyl_bessel_j(std::abs(n), beta)), 1e-9) << n;
    const double between = std::abs(transform(pulse, 4000.0 + 10.0 * n + 5.0, 16384)) / 0.8;
    EXPECT_NEAR(between, 0.0, 1e-9) << n;  // 4 cycles: half a cycle more a cycle cancels
  }
}

// The phase of a modulation that sweeps is the integral of f(t) = f_c + ½W cos ψ(t), which
// Fresnel's functions give; by Simpson's rule with 400 steps a cycle its error is
// (2π/400)⁴/180·πW/f_m < 1e-7.
TEST(Waveforms, SfmOfASweptModulationIsTheIntegralOfItsFrequency) {
  struct Case {
    double from, to;
  };
  for (const auto& [from, to] :
       {Case{5.0, 40.0}, Case{40.0, 5.0}, Case{0.3, 30.0}, Case{25.0, 1.0}, Case{10.0, 10.0001},
        Case{10.0, 9.9999}, Case{10.0, 10.0 + 1e-9}}) {
    const Sfm sfm{.frequency = 1000.0,
                  .swing = 60.0,
                  .modulation_frequency = from,
                  .end_modulation_frequency = to};
    constexpr double length = 1.3;
    constexpr int steps = 40000;
    const auto swing = [&](double t) {
      return std::cos(2.0 * pi * t * (from + 0.5 * (to - from) / length * t));
    };
    double sum = 0.0;
    const double h = length / steps;
    for (int i = 0; i < steps; i += 2) {
      sum += h / 3.0 * (swing(i * h) + 4.0 * swing((i + 1) * h) + swing((i + 2) * h));
      if (i % 4000 != 1998) continue;
      const double t = (i + 2) * h;
      EXPECT_NEAR(sfm.phase(t, length), 2.0 * pi * 1000.0 * t + pi * 60.0 * sum, 1e-6)
          << from << " to " << to << " at " << t;
    }
  }
}

// n sweeps keyed out of one oscillator: S(f_c + ν) = S₁(f_c + ν)·Σ_k e^{−i2πνkT/n}, S₁ that of one
// LFM alone. On the lines, n/T apart, the sum is n; half way between them 0.
TEST(Waveforms, PtfmIsAComb) {
  const int n = 8;
  const Pulse train(
      bare(Ptfm{.start_frequency = 3960.0, .end_frequency = 4060.0, .sweeps = n}, 0.8));
  const Pulse one(bare(Lfm{3960.0, 4060.0}, 0.1));
  for (int line = -7; line <= 7; ++line) {
    const double on = 4010.0 + 10.0 * line;
    EXPECT_NEAR(std::abs(transform(train, on, 32000)), n * std::abs(transform(one, on, 4000)),
                1e-9);
    EXPECT_NEAR(std::abs(transform(train, on + 5.0, 32000)), 0.0, 1e-9) << line;
  }
  // Without a jump of the phase: between neighbouring samples it turns as the frequency says.
  for (int k = 1; k < n; ++k) {
    const double at = 0.1 * k;
    const Complex turn = train.analytic(at + 1e-6) * std::conj(train.analytic(at - 1e-6));
    EXPECT_NEAR(std::arg(turn), 2.0 * pi * 1e-6 * (3960.0 + 4060.0), 1e-6);
  }
}

// At no delay an echo of a Doppler shift ν meets each line n in each line m:
// χ = a²T/E Σ_nm e^{i(φ_n − φ_m)} e^{iπδT} sinc(δT), δ = f_n − f_m − ν. Where ν is none of the
// lines' distances that is next to nothing, at one of them 1/N; an even comb has (N − 1)/N there.
TEST(Waveforms, GeometricCombHasNoDopplerAtWhichLinesMeetLines) {
  const GeometricComb comb{
      .start_frequency = 3900.0, .end_frequency = 4100.0, .lines = 7, .gap_ratio = 1.3};
  const std::vector<Tone> tones = comb.tones();
  ASSERT_EQ(tones.size(), 7U);
  EXPECT_DOUBLE_EQ(tones.front().frequency, 3900.0);
  EXPECT_NEAR(tones.back().frequency, 4100.0, 1e-9);
  for (std::size_t n = 2; n < 7; ++n)
    EXPECT_NEAR((tones[n].frequency - tones[n - 1].frequency) /
                    (tones[n - 1].frequency - tones[n - 2].frequency),
                1.3, 1e-9);
  constexpr double length = 2.0;
  const Pulse pulse(bare(comb, length));
  const std::vector<Complex> s = envelope(pulse, 8192);
  const auto closed = [&](double shift) {
    Complex sum = 0.0, energy = 0.0;
    for (const Tone& n : tones)
      for (const Tone& m : tones) {
        const double apart = n.frequency - m.frequency;
        const Complex phases = std::polar(1.0, n.phase - m.phase);
        sum += phases * std::polar(sinc((apart - shift) * length), pi * (apart - shift) * length);
        energy += phases * std::polar(sinc(apart * length), pi * apart * length);
      }
    return std::abs(sum) / energy.real();
  };
  for (double shift = -230.0; shift <= 230.0; shift += 1.37)
    EXPECT_NEAR(ambiguity(s, length, 0, shift), closed(shift), 1e-5) << shift;
  // 42 other sincs, each at most 1/(π·distance·T): together below 0.35/7 here.
  double most = 0.0, gap_of_even = 0.0;
  for (const Tone& n : tones)
    for (const Tone& m : tones)
      if (&n != &m) most = std::max(most, ambiguity(s, length, 0, n.frequency - m.frequency));
  EXPECT_GT(most, 0.9 / 7.0);
  EXPECT_LT(most, 1.5 / 7.0);
  std::vector<Complex> even;  // the wrong comb: seven lines 200/6 Hz apart
  for (int i = 0; i < 8192; ++i) {
    Complex sum = 0.0;
    for (int n = 0; n < 7; ++n)
      sum += std::polar(1.0, 2.0 * pi * 200.0 / 6.0 * n * (i + 0.5) * length / 8192.0);
    even.push_back(sum);
  }
  gap_of_even = ambiguity(even, length, 0, 200.0 / 6.0);
  EXPECT_GT(gap_of_even, 0.8);  // 6/7
}

// Wide band: at a Doppler factor η line n falls on line m where η f_n = f_m. With the default ratio
// no η puts two lines on lines, to half of 1/T, as they would all but one at once if the
// frequencies themselves were in one ratio.
TEST(Waveforms, GeometricCombMeetsItselfInOneLineAtMost) {
  constexpr double length = 1.0;
  const auto most_meeting = [&](const std::vector<double>& lines) {
    int most = 0;
    for (const double from : lines)
      for (const double to : lines) {
        if (from == to) continue;
        int meeting = 0;
        for (const double n : lines)
          for (const double m : lines) meeting += std::abs(to / from * n - m) * length < 0.5;
        most = std::max(most, meeting);
      }
    return most;
  };
  std::vector<double> lines, of_one_ratio;
  for (const Tone& tone : GeometricComb{}.tones()) {
    lines.push_back(tone.frequency);
    of_one_ratio.push_back(
        3900.0 * std::pow(4100.0 / 3900.0, static_cast<double>(of_one_ratio.size()) / 7.0));
  }
  EXPECT_EQ(most_meeting(lines), 1);
  EXPECT_EQ(most_meeting(of_one_ratio), 7);
}

// A bag of nails: |χ(kI + τ', ν)| = (1 − |τ'|/t_p)|sinc(ν(t_p − |τ'|))|·|sin(πν(N − k)I)|/(N|sin
// πνI|) for |τ'| < t_p of a train of tones, 0 between (Rihaczek, ch. 6). Midpoint sums of 100 steps
// a pulse are right to (πν t_p/100)²/24 < 1e-3 of sinc at ν t_p < 2.
TEST(Waveforms, PulseTrainIsABagOfNails) {
  constexpr int n = 6;
  constexpr double one = 0.02, interval = 0.1, length = 5.0 * interval + one;
  const Pulse pulse(bare(
      PulseTrain{
          .start_frequency = 4000.0, .end_frequency = 4000.0, .pulses = n, .pulse_duration = one},
      length));
  EXPECT_NEAR(pulse.energy(), n * one, 1e-12);
  EXPECT_NEAR(pulse.below_a_tone_db(), 10.0 * std::log10(length / (n * one)), 1e-9);
  const std::vector<Complex> s = envelope(pulse, 2600);  // 100 a pulse, 500 an interval
  for (int k = 0; k < n; ++k)
    for (const int later : {-90, -40, 0, 30, 75})
      for (const double shift : {0.0, 2.1, 5.0, 9.7, 10.0, 15.0, 23.0, 60.0}) {
        if (k == 0 && later < 0) continue;
        const double left = one * (1.0 - std::abs(later) / 100.0);
        const double turn = std::sin(pi * shift * interval);
        const double nails = std::abs(turn) < 1e-9
                                 ? n - k
                                 : std::abs(std::sin(pi * shift * (n - k) * interval) / turn);
        EXPECT_NEAR(ambiguity(s, length, 500 * k + later, shift),
                    left / one * std::abs(sinc(shift * left)) * nails / n, 2e-3)
            << k << ' ' << later << ' ' << shift;
      }
  EXPECT_NEAR(ambiguity(s, length, 250, 3.0), 0.0, 1e-12);
}

// What the source level says: the peak is 1 before the window. The comb's is found between the
// samples of any grid; its energy is that of the samples.
TEST(Waveforms, PeakIsOneAndEnergyIsThatOfTheSamples) {
  for (const PulseWindow window : {PulseWindow::none, PulseWindow::hann, PulseWindow::tukey})
    for (const AnyWaveform& waveform :
         {AnyWaveform(Costas{}), AnyWaveform(Sfm{}), AnyWaveform(Ptfm{}),
          AnyWaveform(GeometricComb{}), AnyWaveform(GeometricComb{.lines = 20, .gap_ratio = 1.1}),
          AnyWaveform(PulseTrain{})}) {
      PulseSettings settings = bare(waveform, 1.0);
      const Pulse flat(settings);
      settings.window = window;
      settings.tukey_fraction = 0.3;
      const Pulse pulse(settings);
      constexpr int n = 50000;
      double most = 0.0, sum = 0.0;
      for (int i = 0; i < n; ++i) {
        const double t = (i + 0.5) / n;
        most = std::max(most, std::abs(flat.analytic(t)));
        sum += std::norm(pulse.analytic(t)) / n;
      }
      EXPECT_NEAR(most, 1.0, 1e-4) << name_of(waveform);
      EXPECT_NEAR(sum, pulse.energy(), 1e-4 * pulse.energy()) << name_of(waveform);
    }
  // Eight tones in phase have 10 lg 8 = 9.03 dB; noise of as many independent samples as the comb
  // has (200 Hz in a second) peaks near 10 lg ln 200 = 7.2 dB over its mean.
  const Pulse comb(bare(GeometricComb{}, 1.0));
  EXPECT_NEAR(comb.below_a_tone_db(), 7.2, 1.0);
}

// The spectrum that bands, filters and coherence rest on, against the integral itself. A jump's or
// a kink's alias is below −90 dB of the peak.
TEST(Waveforms, SpectraAreTheIntegrals) {
  for (const PulseWindow window : {PulseWindow::none, PulseWindow::hann})
    for (const AnyWaveform& waveform :
         {AnyWaveform(Costas{}), AnyWaveform(Sfm{}), AnyWaveform(Ptfm{}),
          AnyWaveform(GeometricComb{}), AnyWaveform(PulseTrain{}),
          AnyWaveform(PulseTrain{.start_frequency = 4000.0,
          .end_frequency = 4000.0,
          .pulses = 4,
          .pulse_duration = 0.03})}) {
      PulseSettings settings = bare(waveform, 0.7);
      settings.window = window;
      const Pulse pulse(settings);
      const PulseSpectrum spectrum = pulse_spectrum(pulse, pulse.centre_frequency());
      double peak = 0.0;
      for (const auto& c : spectrum.bins) peak = std::max(peak, std::abs(c));
      for (const int k : {0, 1, 7, 40, 93, 211, 333}) {
        const double f = pulse.centre_frequency() + spectrum.frequency(static_cast<std::size_t>(k));
        const Complex truth =  // its middle at 0, about the centre
            transform(pulse, f, 280000) * std::polar(1.0, pi * 0.7 * f);
        EXPECT_LT(std::abs(spectrum.bins[static_cast<std::size_t>(k)] - truth), 1e-4 * peak)
            << name_of(waveform) << ' ' << k;
      }
    }
}

// Where their energy is. A Costas pulse's is within its chips and a chip's main lobe, 1/t, to
// either side; a train's is that of one of its pulses.
TEST(Waveforms, BandsAreThoseOfTheirParts) {
  EXPECT_NEAR(Pulse(bare(Costas{}, 1.0)).bandwidth_99(), 100.0, 15.0);
  const PulseSettings train{.waveform = PulseTrain{.start_frequency = 4000.0,
                                                   .end_frequency = 4000.0,
                                                   .pulses = 5,
                                                   .pulse_duration = 0.05},
                            .duration = 0.6,
                            .window = PulseWindow::hann};
  // Of Hann's spectrum 99 % lie within 2.9/t, and it is 40 dB down beyond 5.6/t; lines 1/I apart
  // have it to a line on either side.
  const double line = 4.0 / 0.55;
  EXPECT_NEAR(Pulse(train).bandwidth_99(), 2.9 / 0.05, 2.0 * line);
  EXPECT_NEAR(Pulse(train).bandwidth_40db(), 5.6 / 0.05, 2.0 * line);
  EXPECT_FALSE(Pulse(train).jumps_at_its_edges());
  EXPECT_NEAR(Pulse(bare(GeometricComb{}, 1.0)).bandwidth_99(), 200.0, 12.0);
}

}  // namespace
}  // namespace asdic::detail
