#include <gtest/gtest.h>

#include "support/csv.h"
#include "support/reverberant_sea.h"

namespace asdic {
namespace {

using support::Csv;

using Sea = support::ReverberantSea;

/// reverb_isovelocity.csv: 4500 m, 1500 m/s, 4 kHz, U = 10 m/s, rectangular 0.1 s, 220 dB, omni.
/// Rings of 5 m, fifteen to a pulse: the finer ones that the band of so square a pulse asks for
/// would only cost time.
Scenario reference() {
  Scenario s = support::even_sea();
  s.reverberation.ground_spacing = 5.0;
  s.pulse = {.duration = 0.1, .window = PulseWindow::none};
  s.pings.recording_duration = 47.0;
  return s;
}

/// Mean intensity at time t [(re 1 µPa·10^(−SL/20))²]: 2π∫σR⁻³dR over the slant ranges that a
/// rectangular pulse lights up, c(t − T)/2 to ct/2, R dR = r dr; sin θ = h/R. Simpson's rule.
double mean_intensity(const AnySurfaceScattering& model, double t, double duration) {
  const double from = std::max(750.0 * (t - duration), 4500.0 * (1.0 + 1e-12)), to = 750.0 * t;
  if (to <= from) return 0.0;
  constexpr int n = 20;
  double sum = 0.0;
  for (int i = 0; i <= n; ++i) {
    const double slant = from + (to - from) * i / n, grazing = std::asin(4500.0 / slant);
    const double sigma = scattering_cross_section(
        model, {.grazing_in = grazing, .grazing_out = grazing, .azimuth = pi}, 4000.0);
    sum += (i == 0 || i == n ? 1.0 : i % 2 ? 4.0 : 2.0) * sigma / (slant * slant * slant);
  }
  return 2.0 * pi * sum * (to - from) / n / 3.0;
}

// Mean over an ensemble against the closed form and against reverb_isovelocity.csv, ±0.5 dB at each
// of its times. Intensities are divided by the mean at their own time and averaged over ±0.75 s:
// 1.5/0.1 independent samples (a rectangular pulse forgets after its length) of each of 20 pings
// and 8 phones 10 m apart, which hear 12 sectors with other phases: worth 1/(1/8 + 1/12) = 4.8.
// 1450 exponential samples: 0.114 dB rms, 0.5 dB is 4.4 sigma. The first time is 0.5 s after the
// fathometer return: averaged over ±0.3 s only (0.18 dB).
TEST(Reverberation, EnsembleMeanIsTheAnnulusIntegral) {
  const Csv csv("physics-reference/reverb_isovelocity.csv");
  Scenario s = reference();
  s.arrays[0].phones.clear();
  for (int i = 0; i < 8; ++i) s.arrays[0].phones.emplace_back(3.1 * i, 7.3 * (i % 3), 0.0);
  for (Vec3& phone : s.arrays[0].phones) phone -= Vec3(10.85, 7.3, 0.0);
  const Sea sea(s);
  std::vector<double> sum(csv.rows()), count(csv.rows());
  for (std::uint32_t ping = 1; ping <= 20; ++ping) {
    const Baseband heard = sea.hear(ping);
    for (std::size_t row = 0; row < csv.rows(); ++row) {
      const double t = csv["t_s"][row], half = row == 0 ? 0.3 : 0.75;
      for (double u = t - half; u < t + half; u += 0.02) {
        const double mean = mean_intensity(sea.scenario().reverberation.surface, u, 0.1);
        const auto i = static_cast<std::size_t>(std::lround(u * heard.sample_rate));
        for (std::size_t n = 0; n < heard.channels; ++n)
          sum[row] += static_cast<double>(std::norm(heard.channel(n)[i])) / mean;
        count[row] += static_cast<double>(heard.channels);
      }
    }
  }
  double worst = 0.0;
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const double closed = 220.0 + db_from_power(mean_intensity(sea.scenario().reverberation.surface,
                                                               csv["t_s"][row], 0.1));
    EXPECT_NEAR(closed, csv["RL_nrl_dB"][row], 0.01);  // two hands, one integral
    const double level = closed + db_from_power(sum[row] / count[row]);
    EXPECT_NEAR(level, csv["RL_nrl_dB"][row], 0.5) << "at " << csv["t_s"][row] << " s";
    worst = std::max(worst, std::abs(level - csv["RL_nrl_dB"][row]));
  }
  RecordProperty("worst_db", std::to_string(worst));
}

/// Normalised intensities |b|²/E|b|², one per 0.12 s: no scatterer is in two of them. Some 310 a
/// ping.
std::vector<double> independent(const Scenario& s, int pings, std::complex<double> constant = 0.0) {
  const Sea sea(s);
  std::vector<double> samples;
  for (std::uint32_t ping = 1; ping <= std::uint32_t(pings); ++ping) {
    const Baseband heard = sea.hear(ping);
    for (double t = 8.0; t < 46.0; t += 0.12) {
      const auto i = static_cast<std::size_t>(std::lround(t * heard.sample_rate));
      const double exact = double(i) / heard.sample_rate;
      const auto b = std::complex<double>(heard.channel(0)[i]) /
                     std::sqrt(mean_intensity(sea.scenario().reverberation.surface, exact, 0.1));
      samples.push_back(std::norm(b * std::sqrt(1.0 - std::norm(constant)) + constant));
    }
  }
  return samples;
}

// Neither the grid nor the sectors are in the mean: 6 pings of 316 samples, 0.023 rms of the mean
// of an exponential; 4.9 sigma (one in 10⁶) is 0.11 = 0.46 dB.
TEST(Reverberation, NeitherGridNorSectorsChangeTheMean) {
  const Scenario plain = reference();
  Scenario fine = plain, sectors = plain;
  fine.reverberation.ground_spacing = 0.5 * PingSimulator(plain).ground_spacing();
  sectors.reverberation.azimuths = 72;
  fine.seed = 2;
  sectors.seed = 3;
  const auto check = [](const Scenario& s, int pings, const char* what) {
    const auto samples = independent(s, pings);
    double sum = 0.0;
    for (const double x : samples) sum += x;
    const double n = double(samples.size());
    EXPECT_NEAR(sum / n, 1.0, 4.9 / std::sqrt(n)) << what;
  };
  check(plain, 6, "plain");
  check(fine, 3, "grid halved");
  check(sectors, 2, "72 sectors");
}

/// Largest distance of the samples' distribution from 1 − e^(−x).
double distance(std::vector<double> x) {
  std::sort(x.begin(), x.end());
  double worst = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double f = 1.0 - std::exp(-x[i]), n = double(x.size());
    worst = std::max({worst, f - double(i) / n, double(i + 1) / n - f});
  }
  return worst;
}

// A Rayleigh envelope: intensity is exponential. Kolmogorov-Smirnov at a false-alarm rate of 1e-6,
// D < √(ln(2e6)/2n). A Rice envelope of the same mean with half its power in a constant must fail.
TEST(Reverberation, EnvelopeIsRayleigh) {
  const auto samples = independent(reference(), 16);
  const double limit = std::sqrt(std::log(2e6) / (2.0 * double(samples.size())));
  EXPECT_LT(distance(samples), limit);
  EXPECT_GT(distance(independent(reference(), 16, std::sqrt(0.5))), limit);
}

/// How much of the grid is left in the matched filter's output: |⟨(I/Ī) e^{i2πr(t)/Δr}⟩|²·n, an
/// exponential of mean 1 (more or less) for a sea without a grid.
/// \param snap  every return to the delay of the middle of its ring: a sea that is a grid
double fence(const Scenario& s, double spacing, bool snap) {
  const Sea sea(s);
  const Pulse& pulse = sea.pulse();
  double total = 0.0, n = 0.0;
  std::complex<double> tone = 0.0;
  for (std::uint32_t ping = 1; ping <= 6; ++ping) {
    Returns returns = sea.ping(ping).returns();
    if (snap)
      for (Return& r : returns) {
        const double slant = 750.0 * r.delay;
        const double range = std::sqrt(std::max(0.0, slant * slant - 4500.0 * 4500.0));
        r.delay = std::hypot(4500.0, (std::floor(range / spacing) + 0.5) * spacing) / 750.0;
      }
    const Baseband heard = sea.hear(returns);
    const double rate = heard.sample_rate;
    for (double t = 10.0; t < 28.0; t += 0.02) {  // one per 2/B
      std::complex<double> filtered = 0.0;
      const auto first = static_cast<std::size_t>(std::ceil(t * rate));
      for (std::size_t i = first; double(i) / rate < t + pulse.duration(); ++i) {
        const double u = double(i) / rate;
        filtered += std::complex<double>(heard.channel(0)[i]) *
                    std::polar(1.0, 2.0 * pi * heard.carrier * u) *
                    std::conj(pulse.analytic(u - t));
      }
      const double slant = 750.0 * t, grazing = std::asin(4500.0 / slant);
      const double sigma = scattering_cross_section(
          sea.scenario().reverberation.surface,
          {.grazing_in = grazing, .grazing_out = grazing, .azimuth = pi}, 4000.0);
      const double intensity = std::norm(filtered) * slant * slant * slant / sigma;
      total += intensity;
      const double range = std::sqrt(slant * slant - 4500.0 * 4500.0);
      // Cells' centres lie at (i + ½)Δr.
      tone += intensity * std::polar(1.0, 2.0 * pi * range / spacing);
      n += 1.0;
    }
  }
  return std::norm(tone / total) * n;
}

// LFM of 100 Hz: compressed to 10 ms, a grid of coarse cells would stand out as a picket fence.
// Without one, the sum over n independent exponentials with phases is complex Gaussian, E|·|² = 2/n
// of the mean's square (E x² = 2); 2·ln 10⁶ = 27.6. Rings 30 times as wide as the pulse asks for
// (46 ms two-way and more) show nothing either, for scatterers lie anywhere in their ring; with
// all of them in the middle it must stand out.
TEST(Reverberation, LfmShowsNoPicketFence) {
  Scenario s = reference();
  s.pulse = {.kind = PulseKind::lfm, .window = PulseWindow::none};
  s.reverberation.ground_spacing.reset();
  s.pings.recording_duration = 30.0;
  const double spacing = PingSimulator(s).ground_spacing();
  EXPECT_LT(fence(s, spacing, false), 27.6);
  s.reverberation.ground_spacing = 30.0 * spacing;
  EXPECT_LT(fence(s, 30.0 * spacing, false), 27.6);
  EXPECT_GT(fence(s, 30.0 * spacing, true), 27.6);
}

}  // namespace
}  // namespace asdic
