#include <gtest/gtest.h>

#include <array>

#include "support/csv.h"
#include "support/kolmogorov.h"
#include "support/reverberant_sea.h"

namespace asdic::detail {
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
// 1.5/0.1 independent samples (a rectangular pulse forgets after its length) of each of 96 pings.
// 1440 exponential samples: 0.114 dB rms, 0.5 dB is 4.4 sigma. The first time is 0.5 s after the
// fathometer return: averaged over ±0.3 s only (0.18 dB). One phone and four sectors: eight phones
// would receive the same scatterers, at eight times the cost, for less than eight times the
// samples.
TEST(Reverberation, EnsembleMeanIsTheAnnulusIntegral) {
  const Csv csv("physics-reference/reverb_isovelocity.csv");
  Scenario s = reference();
  s.reverberation.azimuths = 4;
  const Sea sea(s);
  std::vector<double> sum(csv.rows()), count(csv.rows());
  for (std::uint32_t ping = 1; ping <= 96; ++ping) {
    const Baseband received = sea.receive(ping);
    for (std::size_t row = 0; row < csv.rows(); ++row) {
      const double t = csv["t_s"][row], half = row == 0 ? 0.3 : 0.75;
      for (double u = t - half; u < t + half; u += 0.02) {
        const double mean = mean_intensity(sea.scenario().reverberation.surface, u, 0.1);
        const auto i = static_cast<std::size_t>(std::lround(u * received.sample_rate));
        sum[row] += static_cast<double>(std::norm(received.channel(0)[i])) / mean;
        count[row] += 1.0;
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
    const Baseband received = sea.receive(ping);
    for (double t = 8.0; t < 46.0; t += 0.12) {
      const auto i = static_cast<std::size_t>(std::lround(t * received.sample_rate));
      const double exact = double(i) / received.sample_rate;
      const auto b = std::complex<double>(received.channel(0)[i]) /
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

// A Rayleigh envelope: intensity is exponential. Kolmogorov-Smirnov at a false-alarm rate of 1e-6,
// D < √(ln(2e6)/2n). A Rice envelope of the same mean with half its power in a constant must fail.
TEST(Reverberation, EnvelopeIsRayleigh) {
  const auto samples = independent(reference(), 16);
  const double limit = std::sqrt(std::log(2e6) / (2.0 * double(samples.size())));
  EXPECT_LT(support::kolmogorov_distance(samples, support::exponential_law), limit);
  const auto rice = independent(reference(), 16, std::sqrt(0.5));
  EXPECT_GT(support::kolmogorov_distance(rice, support::exponential_law), limit);
}

// The level of a long sweep, whose scatterers are metres apart: its paths are traced to cells as
// far apart as a sixteenth of the pulse, and the level is the annulus integral still.
TEST(Reverberation, ALongSweepHasTheLevelOfTheAnnulus) {
  for (const double duration : {0.5, 1.0, 4.0}) {
    Scenario s = reference();
    s.reverberation.ground_spacing = std::nullopt;
    s.pulse = {.waveform = Lfm{.start_frequency = 3900.0, .end_frequency = 4100.0},
               .duration = duration,
               .window = PulseWindow::none};
    const Sea sea(s);
    ASSERT_LT(sea.spacing(), 5.0);
    const PingReverberation ping = sea.ping(1);
    for (const double since : {6.3, 8.3, 12.7, 20.0, 31.0, 40.0}) {
      const double t = duration + since;  // beyond the first return
      // Places are a 32nd of the pulse apart, or less: over a quarter of it, many enter and leave.
      double closed = 0.0, found = 0.0;
      constexpr int n = 64;
      for (int i = 0; i < n; ++i) {
        const double u = t + 0.25 * duration * i / n;
        closed += mean_intensity(sea.scenario().reverberation.surface, u, duration) / n;
        found += power_from_db(ping.expected_db(u) - 220.0) / n;
      }
      EXPECT_NEAR(db_from_power(found / closed), 0.0, 0.05) << duration << " s, at " << t << " s";
    }
  }
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
    const Baseband received = sea.receive(returns);
    const double rate = received.sample_rate;
    for (double t = 10.0; t < 28.0; t += 0.02) {  // one per 2/B
      std::complex<double> filtered = 0.0;
      const auto first = static_cast<std::size_t>(std::ceil(t * rate));
      for (std::size_t i = first; double(i) / rate < t + pulse.duration(); ++i) {
        const double u = double(i) / rate;
        filtered += std::complex<double>(received.channel(0)[i]) *
                    std::polar(1.0, 2.0 * pi * received.carrier * u) *
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
  s.pulse = {.waveform = Lfm{}, .window = PulseWindow::none};
  s.reverberation.ground_spacing.reset();
  s.pings.recording_duration = 30.0;
  const double spacing = PingSimulator(s).ground_spacing();
  EXPECT_LT(fence(s, spacing, false), 27.6);
  s.reverberation.ground_spacing = 30.0 * spacing;
  EXPECT_LT(fence(s, 30.0 * spacing, false), 27.6);
  EXPECT_GT(fence(s, 30.0 * spacing, true), 27.6);
}

/// J₀ by its integral.
double bessel_j0(double x) {
  double sum = 0.0;
  constexpr int n = 64;
  for (int i = 0; i < n; ++i) sum += std::cos(x * std::sin(2.0 * pi * i / n)) / n;
  return sum;
}

// A ring of 16 phones, all bearings formed at all times. A sea lit all round at the elevation θ
// gives two phones the covariance I·J₀(k a_mn cos θ), and steering all round averages e^{ik u·(x_m
// − x_n)} to the same J₀: over all bearings the mean of a conventional beam's power is I·Σ_mn
// J₀²/N². Divided by that it is the one-dimensional reference again. And no bearing is silent: its
// mean over time and pings is the mean over bearings. Times are 0.2 s apart, independent; 12 pings
// of 110 times. The mean over bearings at one time is that of more than ten independent ones (the
// ring's 2ka cos θ + 1 modes), 1320·10 samples would be 0.04 dB; at a single bearing 1320
// exponential samples are 2.75 % rms, 4.9 sigma 13.5 %. For the mean over bearings the ±0.5 dB of
// the reference.
TEST(Reverberation, BeamsShowItAtEveryBearingAndTheRingsMeanIsTheReference) {
  const Csv csv("physics-reference/reverb_isovelocity.csv");
  constexpr int phones = 16, bearings = 36;
  constexpr double radius = 0.4, wavenumber = 2.0 * pi * 4000.0 / 1500.0;
  Scenario s = reference();
  s.pings.recording_duration = 31.0;
  s.reverberation.azimuths = 36;
  s.arrays[0].phones.clear();
  for (int n = 0; n < phones; ++n)
    s.arrays[0].phones.emplace_back(radius * std::sin(2.0 * pi * n / phones),
                                    radius * std::cos(2.0 * pi * n / phones), 0.0);
  const Sea sea(s);
  const auto ring_gain = [&](double level) {  // cos θ
    double sum = 0.0;
    for (const Vec3& a : s.arrays[0].phones)
      for (const Vec3& b : s.arrays[0].phones)
        sum += std::pow(bessel_j0(wavenumber * (a - b).norm() * level), 2) / (phones * phones);
    return sum;
  };
  std::array<double, bearings> of_bearing{};
  std::vector<double> of_row(csv.rows()), count(csv.rows());
  double all = 0.0;
  for (std::uint32_t ping = 1; ping <= 12; ++ping) {
    const Baseband received = sea.receive(ping);
    for (double t = 8.0; t < 30.0; t += 0.2) {
      const auto i = static_cast<std::size_t>(std::lround(t * received.sample_rate));
      const double now = double(i) / received.sample_rate;
      const double level = std::sqrt(1.0 - std::pow(4500.0 / (750.0 * (now - 0.05)), 2));
      const double mean =
          mean_intensity(sea.scenario().reverberation.surface, now, 0.1) * ring_gain(level);
      double ring = 0.0;
      for (std::size_t b = 0; b < bearings; ++b) {
        const double bearing = 2.0 * pi * double(b) / bearings;
        const Vec3 look(std::sin(bearing), std::cos(bearing), 0.0);
        std::complex<double> beam = 0.0;
        for (std::size_t n = 0; n < phones; ++n)
          beam += std::complex<double>(received.channel(n)[i]) *
                  std::polar(1.0 / phones, -wavenumber * level * look.dot(s.arrays[0].phones[n]));
        of_bearing[b] += std::norm(beam) / mean;
        ring += std::norm(beam) / mean / bearings;
      }
      all += 1.0;
      for (std::size_t row = 0; row < csv.rows(); ++row)
        if (std::abs(csv["t_s"][row] - now) <= 1.5) of_row[row] += ring, count[row] += 1.0;
    }
  }
  for (std::size_t b = 0; b < bearings; ++b)
    EXPECT_NEAR(of_bearing[b] / all, 1.0, 4.9 / std::sqrt(all)) << 10 * b;
  int compared = 0;
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    if (count[row] < 12 * 12) continue;
    const double t = csv["t_s"][row];
    const double closed =
        220.0 + db_from_power(mean_intensity(sea.scenario().reverberation.surface, t, 0.1));
    EXPECT_NEAR(closed + db_from_power(of_row[row] / count[row]), csv["RL_nrl_dB"][row], 0.5) << t;
    ++compared;
  }
  EXPECT_GE(compared, 2);
}

// A vehicle under way. The field's anchor stays while she is within a sixteenth of the field's
// radius of it, then moves by an eighth: never further off than that on either axis. While it stays
// a scatterer is the same one, place and all; when it moves all are new; and what is expected to be
// received does not care (the fans' and samples' grids leave 0.1 dB).
TEST(Reverberation, TheAnchorMovesInStepsAndIsNotReceived) {
  Scenario s = reference();
  s.pings.recording_duration = 12.0;
  s.platforms[0].track.start.velocity = {3.0, 4.0, 0.0};
  const Sea sea(s);
  const double radius = 0.5 * 1500.0 * 12.0, pitch = radius / 8.0;
  std::vector<std::uint64_t> identities;
  double level = 0.0;
  for (std::uint32_t ping = 1; ping <= 20; ++ping) {
    const double time = 30.0 * (ping - 1);
    const PingReverberation received = sea.ping(ping, time);
    const ScattererGrid& grid = received.fields()[0].grid;
    const Vec2 off = time * Vec2(3.0, 4.0) - grid.anchor;
    EXPECT_LE(off.cwiseAbs().maxCoeff(), 0.5 * pitch + 1e-6) << time;
    const double steps = grid.anchor.x() / pitch;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
    if (identities.empty() || identities.back() != grid.identity)
      identities.push_back(grid.identity);
    const double now = received.expected_db(9.0);
    if (ping > 1) {
      EXPECT_NEAR(now, level, 0.1) << time;
    }
    level = now;
  }
  // 570 s: 1710 m east and 2280 m north, in pitches of 1125 m: 2 steps on either axis.
  EXPECT_EQ(identities.size(), 5U);
  const Scatterer a = place_scatterer({.identity = identities[0]}, {.ring = 7},
                                      ScattererKey{.ring = 7}.entity(identities[0]), 1),
                  b = place_scatterer({.identity = identities[1]}, {.ring = 7},
                                      ScattererKey{.ring = 7}.entity(identities[1]), 1);
  EXPECT_NE(a.place, b.place);
}

// As many sectors as resolve what the array and the Doppler shift resolve: λ/(2L) for an
// array of length L (twice that where the first phone is at its end), and 2v/λ·Δφ ≤ 1/T.
TEST(Reverberation, ResolvedSectorsFollowArrayAndDoppler) {
  Scenario s = reference();
  s.pings.recording_duration = 8.0;
  s.arrays[0] = line_array(33, 0.1875, 0.0, 0.0);  // 6 m: λ/(2L) = 1/32
  const auto sectors = [](const Scenario& scenario) {
    return Sea(scenario).ping(1).fields()[0].grid.azimuths;
  };
  s.reverberation.resolve_azimuth = false;
  EXPECT_EQ(sectors(s), 12);
  s.reverberation.resolve_azimuth = true;
  const int by_array = sectors(s);
  EXPECT_GE(by_array, int(2.0 * pi * 32.0));
  EXPECT_LE(by_array, int(2.0 * pi * 64.0) + 1);
  s.arrays[0].phones = {Vec3::Zero()};
  EXPECT_EQ(sectors(s), 12);
  s.pulse.duration = 2.0;
  s.platforms[0].track.start.velocity = {6.0, 0.0, 0.0};
  EXPECT_EQ(sectors(s), int(std::ceil(2.0 * pi * 2.0 * 6.0 / 0.375 * 2.0)));
}

}  // namespace
}  // namespace asdic::detail
