#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <Eigen/Core>

#include "sonar/ping/ping.h"
#include "support/kolmogorov.h"
#include "support/reverberant_sea.h"
#include "support/sound_moments.h"

// Reverberation by its covariance against closed forms, and against the plain sum over scatterers
// by mean, covariance between phones and Doppler spectrum.
namespace asdic::detail {
namespace {

using support::at, support::cross_spectrum;
using Sea = support::ReverberantSea;

constexpr double c = 1500.0, depth = 500.0;

/// A vehicle 500 m below the surface, no bounces: one path out, the same one back.
Scenario shallow_sea() {
  Scenario s = support::even_sea();
  s.platforms[0].track.start.position.z() = depth;
  s.pulse = {.waveform = Cw{.frequency = 1000.0}, .duration = 0.12};
  s.pings.sample_rate = 4000.0;
  s.pings.recording_duration = 12.2;
  s.reverberation.synthesis = ScattererSynthesis::covariance;
  s.arrays[0].phones = {Vec3::Zero(), Vec3(0.3, 0.4, 0.0), Vec3(-0.9, 0.5, 0.0),
                        Vec3(0.2, -0.7, 0.6)};
  return s;
}

/// Intensity over delay, 2π∫σR⁻³dR by dR = c/2 dτ [1/s].
double intensity(const Sea& sea, double delay) {
  const double slant = 0.5 * c * delay, grazing = std::asin(depth / slant);
  const double sigma = scattering_cross_section(
      sea.scenario().reverberation.surface,
      {.grazing_in = grazing, .grazing_out = grazing, .azimuth = pi}, 1000.0);
  return pi * c * sigma / (slant * slant * slant);
}

/// F F^H where a delay lies.
Eigen::MatrixXcd covariance_at(const ReverberationCovariance& of, double delay) {
  const auto bin = static_cast<std::size_t>(delay / of.bin);
  for (const auto& segment : of.segments) {
    if (bin < segment.begin || bin >= segment.end) continue;
    const Eigen::Map<const Eigen::MatrixXcf> f(of.columns.data() + segment.first * of.components,
                                               static_cast<Eigen::Index>(of.components),
                                               static_cast<Eigen::Index>(segment.rank));
    return f.cast<std::complex<double>>() * f.adjoint().cast<std::complex<double>>();
  }
  return {};
}

// A sea lit all round at the elevation θ gives components (k, m) and (l, n) the covariance
// J₀(2π|f_k x_m − f_l x_n| cos θ/c) of their horizontal places, times e^{−i2π(f_k z_m − f_l z_n)
// sin θ/c} of their depths (z down, sound comes from above). Within
// a segment, a sixty-fourth of the delay or two bins of 7.5 ms, cos θ changes by up to tan²θ/128 of
// itself to either side of the mean: at 3 s, sin θ = 0.22, 4e-4 times an argument up to 8; depths
// as much again, 0.005
// in all. The bearings of a segment's circles interleave but for a part of a circle, whose
// seventeen bearings leave an alias J₁₇(8) = 3e-4. Power: the bins' and the table's grid, 1 %.
TEST(ReverberationCovariance, IsABesselFunctionOfPlacesAndTheAnnulusIntegral) {
  Scenario s = shallow_sea();
  s.pulse = {.waveform = Lfm{.start_frequency = 800.0, .end_frequency = 1200.0}, .duration = 0.12};
  const Sea sea(s);
  const PingReverberation ping = sea.ping(1);
  const ReverberationCovariance& found = *ping.covariance();
  const std::vector<double>& f = found.band.frequencies;
  const std::vector<Vec3>& x = s.arrays[0].phones;
  ASSERT_GT(f.size(), 1U);
  ASSERT_EQ(found.components, f.size() * x.size());
  for (const double t : {3.0, 5.5, 9.0, 11.7}) {
    const Eigen::MatrixXcd all = covariance_at(found, t);
    const double sine = depth / (0.5 * c * t), cosine = std::sqrt(1.0 - sine * sine);
    for (std::size_t k = 0; k < f.size(); ++k)
      for (std::size_t l = 0; l < f.size(); ++l)
        for (std::size_t m = 0; m < x.size(); ++m)
          for (std::size_t n = 0; n < x.size(); ++n) {
            const Vec3 apart = f[k] * x[m] - f[l] * x[n];
            const std::complex<double> expected =
                std::cyl_bessel_j(0.0, 2.0 * pi * apart.head<2>().norm() * cosine / c) *
                std::polar(1.0, -2.0 * pi * apart.z() * sine / c);
            const std::complex<double> value =
                all(Eigen::Index(k * x.size() + m), Eigen::Index(l * x.size() + n));
            EXPECT_NEAR(std::abs(value - expected), 0.0, 0.01) << t << " " << k << l << m << n;
          }
    const auto bin = static_cast<std::size_t>(t / found.bin);
    const double middle = (static_cast<double>(bin) + 0.5) * found.bin;
    EXPECT_NEAR(found.intensity[bin] / intensity(sea, middle), 1.0, 0.01) << t;
  }
}

/// What is expected of the first phone's |b|² at a time: the intensity through the pulse.
double expected_power(const ReverberationCovariance& of, const Pulse& pulse, double t) {
  double sum = 0.0;
  for (std::size_t i = 0; i < of.intensity.size(); ++i) {
    constexpr int parts = 8;
    for (int j = 0; j < parts; ++j) {
      const double delay = (static_cast<double>(i) + (j + 0.5) / parts) * of.bin;
      sum += of.intensity[i] * of.bin / parts * std::norm(pulse.analytic(t - delay));
    }
  }
  return sum;
}

/// A bounce off the surface and off a hard bottom: several pairs of paths.
Scenario bouncing_sea() {
  Scenario s = shallow_sea();
  s.propagation.max_surface_bounces = 1;
  s.propagation.max_bottom_bounces = 1;
  s.environment.bottom = {.depth = 1500.0, .material = Rigid{}};
  return s;
}

// With bounces and a beam there are several pairs of paths; those with their reciprocal are
// received at twice the pressure. At the reference point the power is what summaries tell is
// expected of scatterers, which adds the pairs of a place coherently at one place a cell: where two
// are received together their beat is averaged here and sampled there, up to some tenths of a
// decibel; in the mean over times nothing.
TEST(ReverberationCovariance, HasTheExpectedLevelOfAllPairsOfPaths) {
  Scenario s = bouncing_sea();
  s.transmitters[0].beam = LineBeam{.taper = Taper::hann, .beamwidth = radians(30.0)};
  s.transmitters[0].elevation = radians(10.0);
  s.arrays[0].phones = {Vec3::Zero()};
  s.pings.recording_duration = 12.2;
  const Sea sea(s);
  const PingReverberation ping = sea.ping(1);
  double sum = 0.0, count = 0.0;
  for (double t = 2.0; t < 12.0; t += 0.1) {
    const double level = db_from_power(expected_power(*ping.covariance(), sea.pulse(), t));
    const double difference = level + s.transmitters[0].source_level_db - ping.expected_db(t);
    EXPECT_NEAR(difference, 0.0, 1.0) << t;
    sum += difference;
    count += 1.0;
  }
  EXPECT_NEAR(sum / count, 0.0, 0.1);
}

TEST(ReverberationCovariance, HasTheMomentsOfThePlainSum) {
  support::expect_moments_of_the_plain_sum(bouncing_sea());
}

// A broad pulse: at f the coherence of two phones d apart is J₀(2πf d cos θ/c), 1.2 m at 830 and
// 1170 Hz: −0.40 and 0.07 (steered by the centre frequency alone both would be −0.16). Windows of
// 0.25 s of 20 pings, 20·36 = 720 samples: 4.9/√1440 = 0.13.
TEST(ReverberationCovariance, SteersAtEveryFrequencyOfTheBand) {
  Scenario s = shallow_sea();
  s.pulse = {.waveform = Lfm{.start_frequency = 800.0, .end_frequency = 1200.0},
             .duration = 0.12,
             .window = PulseWindow::tukey};
  s.arrays[0].phones = {Vec3::Zero(), Vec3(0.72, 0.96, 0.0)};
  const Sea sea(s);
  std::vector<Baseband> pings;
  for (std::uint32_t ping = 1; ping <= 20; ++ping) pings.push_back(sea.receive(ping));
  for (const double f : {830.0, 1000.0, 1170.0}) {
    const auto spectrum = [&](std::size_t m, std::size_t n) {
      return cross_spectrum(pings, m, n, 3.0, 12.1, 0.25, f - pings[0].carrier);
    };
    const std::complex<double> coherence =
        spectrum(0, 1) / std::sqrt(spectrum(0, 0).real() * spectrum(1, 1).real());
    const double cosine = std::cos(std::asin(depth / (0.5 * c * 7.0)));
    const double expected = std::cyl_bessel_j(0.0, 2.0 * pi * f * 1.2 * cosine / c);
    EXPECT_NEAR(coherence.real(), expected, 0.13) << f;
    EXPECT_NEAR(coherence.imag(), 0.0, 0.13) << f;
  }
}

// What stands still spreads no frequency: the Doppler spectrum of a tone of 1 s is the pulse's own,
// by either synthesis. Windows of 2 s, bins of ½ Hz, 30 pings of 4: 120 exponential samples, of
// which the ratio of two means has √2·9 % rms: 4.9 sigma 63 %, a factor of 1.63 to either side. The
// same sea moving, or received on a sample's wrong grid, would be off by decades.
TEST(ReverberationCovariance, HasTheDopplerSpectrumOfThePlainSum) {
  Scenario s = shallow_sea();
  s.pulse = {.waveform = Cw{.frequency = 1000.0}, .duration = 1.0};
  s.arrays[0].phones = {Vec3::Zero()};
  Scenario plain = s;
  plain.reverberation.synthesis = ScattererSynthesis::scatterers;
  std::vector<Baseband> one, other;
  const Sea by_covariance(s), one_by_one(plain);
  for (std::uint32_t ping = 1; ping <= 30; ++ping) {
    one.push_back(by_covariance.receive(ping));
    other.push_back(one_by_one.receive(ping));
  }
  for (double f = -2.0; f <= 2.0; f += 0.5) {
    const double a = cross_spectrum(one, 0, 0, 3.5, 12.0, 2.0, f).real();
    const double b = cross_spectrum(other, 0, 0, 3.5, 12.0, 2.0, f).real();
    EXPECT_NEAR(std::log(a / b), 0.0, std::log(1.63)) << f;
  }
}

// A Rayleigh envelope, its mean the annulus integral through the pulse: 80 pings of 38 times two
// pulse lengths apart; Kolmogorov–Smirnov at a false-alarm rate of 1e-6, mean 4.9/√3040 = 0.089.
// A Rice envelope of the same mean, nine tenths of it in a constant, must fail.
TEST(ReverberationCovariance, EnvelopeIsRayleighOfTheRightMean) {
  Scenario s = shallow_sea();
  s.arrays[0].phones = {Vec3::Zero()};
  const Sea sea(s);
  std::vector<double> samples, rice;
  double sum = 0.0;
  for (std::uint32_t ping = 1; ping <= 80; ++ping) {
    const Baseband received = sea.receive(ping);
    for (double t = 2.5; t < 12.0; t += 0.25) {
      double mean = 0.0;  // ∫w²(u)·I(t − u) du over the Hann window
      for (int k = 0; k < 48; ++k) {
        const double u = (k + 0.5) / 48.0, w = 0.5 - 0.5 * std::cos(2.0 * pi * u);
        mean += w * w * intensity(sea, t - 0.12 * u) * 0.12 / 48.0;
      }
      const std::complex<double> b = at(received, 0, t) / std::sqrt(mean);
      samples.push_back(std::norm(b));
      rice.push_back(std::norm(b * std::sqrt(0.1) + std::sqrt(0.9)));
      sum += samples.back();
    }
  }
  const double limit = std::sqrt(std::log(2e6) / (2.0 * double(samples.size())));
  EXPECT_LT(support::kolmogorov_distance(samples, support::exponential_law), limit);
  EXPECT_GT(support::kolmogorov_distance(rice, support::exponential_law), limit);
  EXPECT_NEAR(sum / double(samples.size()), 1.0, 4.9 / std::sqrt(double(samples.size())));
}

// Where samples are interpolated from it, the sound has a coarser grid of its own: the same record
// out of the grid of all else to −80 dB of its rms (the interpolator's error, −97 dB of the
// loudest around). Samples of a level's step of 50 ms: two at least.
TEST(ReverberationCovariance, ACoarserGridGivesTheSameRecord) {
  const Scenario s = shallow_sea();
  const Sea sea(s);
  Recording recording = sea.recording();
  recording.sample_rate = 2000.0;
  recording.carrier = 990.0;
  recording.samples = 24400;
  const Synthesizer synthesizer(sea.pulse(), recording, doppler_bound(s));
  const PingReverberation ping = sea.ping(1);
  const CovarianceDraw draw{.seed = 5, .ping = 1};
  const auto record = [&](Baseband grid) {
    synthesizer.add_gaussian(*ping.covariance(), draw, grid);
    std::vector<float> samples(grid.channels * recording.samples * 2, 0.0F);
    synthesizer.add_samples(grid, 1.0, samples);
    return samples;
  };
  const Baseband coarse = synthesizer.silence(*ping.covariance()), fine = synthesizer.silence(4);
  EXPECT_LT(coarse.samples, fine.samples);
  EXPECT_GE(coarse.sample_rate, 50.0);
  const std::vector<float> one = record(coarse), other = record(fine);
  ASSERT_EQ(one.size(), other.size());
  double power = 0.0, error = 0.0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    power += double(other[i]) * double(other[i]);
    error += std::pow(double(one[i]) - double(other[i]), 2);
  }
  EXPECT_LT(error, 1e-8 * power);
}

// It serves what stands still, is received where it is sent and forgets from ping to ping; all else
// is received one scatterer after the other, and so is what has few returns unless it is asked for.
TEST(ReverberationCovariance, ServesStillSeasReceivedByOneArray) {
  const auto used = [](const Scenario& s) { return Sea(s).ping(1).covariance() != nullptr; };
  const Scenario still = shallow_sea();
  EXPECT_TRUE(used(still));
  const auto with = [&](auto&& change) {
    Scenario s = still;
    change(s);
    return used(s);
  };
  EXPECT_FALSE(with([](Scenario& s) { s.platforms[0].track.start.velocity.x() = 0.5; }));
  EXPECT_FALSE(with([](Scenario& s) { s.reverberation.surface_field.motion.current.x() = 0.1; }));
  EXPECT_FALSE(with([](Scenario& s) {
    s.reverberation.surface_field.motion.kind = ScattererMotion::Kind::bragg;
  }));
  EXPECT_FALSE(
      with([](Scenario& s) { s.reverberation.surface_field.statistics.coherence_time = 10.0; }));
  EXPECT_FALSE(with([](Scenario& s) { s.reverberation.surface_field.statistics.k_shape = 1.0; }));
  EXPECT_FALSE(with([](Scenario& s) { s.arrays.push_back(s.arrays[0]); }));
  EXPECT_FALSE(with([](Scenario& s) {
    s.platforms.push_back(s.platforms[0]);
    s.platforms[1].track.start.position.x() += 100.0;
    s.arrays[0].platform = 1;
  }));
  EXPECT_FALSE(
      with([](Scenario& s) { s.reverberation.synthesis = ScattererSynthesis::scatterers; }));
}

// Automatically beyond 20 000 returns: a whole ping of the simulator, in and beyond the limit. A
// frozen bottom beside it is received one by one.
TEST(ReverberationCovariance, TakesOverBeyondTwentyThousandReturns) {
  Scenario s = shallow_sea();
  s.reverberation.synthesis = ScattererSynthesis::automatic;
  s.reverberation.bottom = Lambert{};
  s.reverberation.bottom_field.statistics.coherence_time = 100.0;  // which has to be remembered
  const PropagationPaths paths(s.environment, s.transect);
  const Pulse pulse(s.pulse);
  const BeamPattern pattern(s.transmitters[0], c / 1000.0);
  const auto fields = [&](int azimuths) {
    s.reverberation.azimuths = azimuths;
    const ReverberationModel model(s, paths, pulse);
    const PingReverberation ping = model.ping({.geometry = PingGeometry(s, {}, 1),
                                               .pattern = pattern,
                                               .pulse = pulse,
                                               .latest = 12.2,
                                               .phones = s.arrays[0].phones});
    std::size_t blocks = 0;
    for (std::size_t b = 0; b < ping.blocks(); ++b) blocks += ping.expected(b) > 0 ? 1 : 0;
    EXPECT_GT(blocks, 0U);
    EXPECT_EQ(ping.fields()[1].received_by, ReceivedBy::scatterers);
    return ping.covariance() != nullptr && ping.fields()[0].received_by == ReceivedBy::covariance;
  };
  EXPECT_FALSE(fields(12));
  EXPECT_TRUE(fields(360));
  // Not of so many phones that it is dearer than the scatterers.
  s.arrays[0].phones.assign(129, Vec3::Zero());
  EXPECT_FALSE(fields(360));
}

// One thread or several, propagation known or not: the same bits. Another seed: others.
TEST(ReverberationCovariance, BitsDoNotDependOnThreadsOrOnWhatIsKept) {
  Scenario s = shallow_sea();
  s.pings.samples = Samples::baseband;
  s.pings.carrier = 1000.0;
  s.pings.baseband_rate = 200.0;
  const auto shared = std::make_shared<SharedPropagation>();
  std::vector<float> alone;
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    alone = PingSimulator(s, shared).simulate(1).pressure;
  }
  EXPECT_EQ(PingSimulator(s).simulate(1).pressure, alone);
  EXPECT_EQ(PingSimulator(s, shared).simulate(1).pressure, alone);
  s.seed = 2;
  EXPECT_NE(PingSimulator(s, shared).simulate(1).pressure, alone);
}

}  // namespace
}  // namespace asdic::detail
