#include "sonar/noise/block_noise.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "sonar/noise/ambient_noise.h"
#include "sonar/noise/noise_spectrum.h"
#include "sonar/scenario/array.h"
#include "sonar/signal/fft.h"
#include "support/thesis.h"

namespace asdic::detail {
namespace {

constexpr double c = 1500.0;
using Spectrum = std::vector<std::complex<double>>;

struct Listener {
  double rate = 4000.0, carrier = 0.0;
  std::vector<Vec3> phones = line_array(4, 0.4, 0.3, 0.0).phones;
  NoiseCoherence coherence = NoiseCoherence::isotropic;
  NoiseDirections directions;
  AnyNoise law = KnudsenNoise{3.0};

  [[nodiscard]] BlockNoise noise() const {
    const NoiseSettings settings{.law = law, .directions = {}};
    return {[settings](double f) { return noise_density(settings, f); },
            rate,
            carrier,
            phones,
            coherence,
            directions,
            c,
            NoiseKey{.seed = 7}};
  }
  [[nodiscard]] std::vector<float> record(std::size_t samples, std::int64_t first = 0) const {
    std::vector<float> rows(phones.size() * samples * (carrier > 0.0 ? 2 : 1), 0.0F);
    noise().add(rows, first, 1);
    return rows;
  }
};

/// Hann-weighted spectra of a row, one after the other: 2^11 samples, about 2 Hz a bin. \return
/// [segments][bins]; complex rows: bin k is the offset k·rate/n, k < n/2 only
std::vector<Spectrum> spectra(const float* row, std::size_t samples, bool complex) {
  constexpr std::size_t n = 2048;
  std::vector<Spectrum> all;
  const ComplexFft<double> fft(n);
  FftBuffer<std::complex<double>> x(n);
  for (std::size_t first = 0; first + n <= samples; first += n) {
    for (std::size_t i = 0; i < n; ++i) {
      const double w = std::sqrt(8.0 / 3.0) * 0.5 * (1.0 - std::cos(2.0 * pi * double(i) / n));
      x[i] = complex ? w * std::complex<double>(row[2 * (first + i)], row[2 * (first + i) + 1])
                     : w * std::complex<double>(row[first + i], 0.0);
    }
    fft.forward(x.data());
    all.emplace_back(x.data(), x.data() + n / 2);
  }
  return all;
}

/// Coherence of two rows in a band of bins, averaged over segments and bins.
std::complex<double> coherence(const std::vector<Spectrum>& a, const std::vector<Spectrum>& b,
                               std::size_t low, std::size_t high) {
  std::complex<double> cross = 0.0;
  double first = 0.0, second = 0.0;
  for (std::size_t s = 0; s < a.size(); ++s) {
    for (std::size_t k = low; k < high; ++k) {
      cross += a[s][k] * std::conj(b[s][k]);
      first += std::norm(a[s][k]);
      second += std::norm(b[s][k]);
    }
  }
  return cross / std::sqrt(first * second);
}

// 200 segments of 2048 samples and bands of 20 bins; Hann correlates neighbouring bins, so about
// 200·20/1.94 independent ones: the mean of that many exponentials strays 5σ = 5/√2060 = 0.48 dB.
TEST(BlockNoise, HasTheLawsSpectrum) {
  Listener l;
  l.phones.resize(1);
  constexpr std::size_t n = 200 * 2048;
  const auto s = spectra(l.record(n).data(), n, false);
  for (std::size_t low = 60; low + 20 < 1000; low += 40) {
    double power = 0.0, expected = 0.0;
    for (std::size_t k = low; k < low + 20; ++k) {
      for (const Spectrum& one : s) power += 2.0 * std::norm(one[k]) / (2048.0 * l.rate);
      expected += double(s.size()) *
                  power_from_db(std::get<KnudsenNoise>(l.law).level_at(double(k) * l.rate / 2048));
    }
    EXPECT_NEAR(db_from_power(power * 1e12 / expected), 0.0, 0.48) << low;
  }
}

// The variance at every place of a block: 2000 realisations of 64 samples at its edge and middle.
// Samples of white noise are independent: 5σ of a variance of 128 000 is 5·√(2/128000) = 2 %.
// What stands in a file as the level of the noise is what its samples have: of a steep spectrum,
// too, whose lowest hertz no block holds (of Wenz's they have more power than all the rest). The
// power is that of about 4 Hz over 262 s and 4 phones: 1/√4200 or 0.07 dB, five times that.
TEST(BlockNoise, TellsThePowerThatItMakes) {
  for (const double carrier : {0.0, 1500.0}) {
    Listener listener{.carrier = carrier, .law = WenzNoise{}};
    listener.coherence = NoiseCoherence::independent;
    if (carrier > 0.0) listener.rate = 1000.0;
    const std::size_t samples = std::size_t{1} << (carrier > 0.0 ? 18 : 20);
    const std::vector<float> rows = listener.record(samples);
    double sum = 0.0;
    for (const double x : rows) sum += x * x;
    // Of baseband the mean of re² and im² is |b|²/2, which is the pressure's mean square.
    const double measured = sum / static_cast<double>(rows.size());
    EXPECT_NEAR(db_from_power(measured / listener.noise().power()), 0.0, 0.35) << carrier;
  }
}

TEST(BlockNoise, HasTheSameVarianceAtEverySampleOfABlock) {
  Listener l;
  l.phones.resize(1);
  l.law = NoiseTable{.frequency = {1.0}, .level_db = {120.0}};
  const BlockNoise noise = l.noise();
  const auto half = static_cast<std::int64_t>(noise.block() / 2);
  for (const std::int64_t first : {half - 32, half / 2, 3 * half / 4, 2 * half}) {
    double power = 0.0;
    for (std::uint32_t ping = 0; ping < 2000; ++ping) {
      std::vector<float> few(64, 0.0F);
      noise.add(few, first, ping);
      for (const float p : few) power += double(p) * double(p);
    }
    EXPECT_NEAR(power / (2000 * 64) / (0.5 * l.rate), 1.0, 0.02 + 2.0 / double(noise.block()));
  }
}

/// Largest deviation of measured from expected coherence over bands up to `highest`.
double worst(const Listener& l, NoiseCoherence kind, const std::vector<float>& rows,
             std::size_t samples, double shift = 0.0) {
  std::vector<std::vector<Spectrum>> s;
  const std::size_t width = l.carrier > 0.0 ? 2 : 1;
  for (std::size_t i = 0; i < l.phones.size(); ++i)
    s.push_back(spectra(rows.data() + i * samples * width, samples, width == 2));
  double most = 0.0;
  for (std::size_t i = 0; i < s.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (std::size_t low = 20; low + 8 < 1000; low += 25) {
        std::complex<double> expected = 0.0;
        for (std::size_t k = low; k < low + 8; ++k)
          expected += noise_coherence(kind, l.directions, l.phones[i] - l.phones[j],
                                      2.0 * pi * (shift + double(k) * l.rate / 2048.0) / c) /
                      8.0;
        most = std::max(most, std::abs(coherence(s[i], s[j], low, low + 8) - expected));
      }
    }
  }
  return most;
}

// Bands of 8 bins × 300 segments, 1240 independent: the complex coherence of independent rows
// strays √(1/1240) = 0.028 rms; of 6 × 40 values none is beyond 5·0.028 = 0.14 (each e^−25).
constexpr std::size_t many = 300 * 2048;
constexpr double limit = 0.14;

TEST(BlockNoise, IsotropicIsSincAndNothingElse) {
  const Listener l;
  const auto rows = l.record(many);
  EXPECT_LT(worst(l, NoiseCoherence::isotropic, rows, many), limit);
  // The wrong models must fail: another field, another spacing.
  EXPECT_GT(worst(l, NoiseCoherence::surface, rows, many), limit);
  Listener wrong = l;
  for (Vec3& phone : wrong.phones) phone *= 1.25;
  EXPECT_GT(worst(wrong, NoiseCoherence::isotropic, rows, many), limit);
}

TEST(BlockNoise, SurfaceSheetOverATiltedArray) {
  Listener l;
  l.coherence = NoiseCoherence::surface;
  l.phones = line_array(4, 0.4, 0.3, 0.7).phones;
  const auto rows = l.record(many);
  EXPECT_LT(worst(l, NoiseCoherence::surface, rows, many), limit);
  EXPECT_GT(worst(l, NoiseCoherence::isotropic, rows, many), limit);
  Listener upside_down = l;  // noise from below: the conjugate
  for (Vec3& phone : upside_down.phones) phone.z() *= -1.0;
  EXPECT_GT(worst(upside_down, NoiseCoherence::surface, rows, many), limit);
}

TEST(BlockNoise, BasebandHasThePressuresSpectrumAndCoherence) {
  Listener l;
  l.coherence = NoiseCoherence::surface;
  l.phones = line_array(4, 0.4, 0.3, 0.7).phones;
  l.carrier = 1500.0;
  l.rate = 1000.0;
  const auto rows = l.record(many);
  EXPECT_LT(worst(l, NoiseCoherence::surface, rows, many, l.carrier), limit);
  EXPECT_GT(worst(l, NoiseCoherence::isotropic, rows, many, l.carrier), limit);
  // E|b|² = 2·∫S df over the band (p = Re{b e^{iωt}} has half of it). The 300·2048 samples are
  // independent to within the law's slope: 5σ = 0.03 dB, and 0.03 dB for that.
  double power = 0.0;
  for (std::size_t i = 0; i < 2 * many; ++i)
    power += double(rows[i]) * double(rows[i]) / double(many);
  const NoiseSettings settings{.law = l.law, .directions = {}};
  EXPECT_NEAR(db_from_power(power / (2.0 * noise_power(settings, 1000.0, 2000.0))), 0.0, 0.06);
}

// An array that is straight in one ping and bent in the next: the noise of each has the coherence
// of its shape. The other shape is a wrong model that must fail.
TEST(AmbientNoise, HasTheCoherenceOfTheShapeInEachPing) {
  Listener l;
  Scenario s = support::thesis(SoundSpeedProfile::isovelocity(c));
  s.noise = {.law = l.law, .coherence = NoiseCoherence::isotropic, .directions = {}};
  s.pings.sample_rate = l.rate;
  const std::vector<Vec3> straight = l.phones, bent = {{0.0, 0.0, 0.0},
                                                       {0.0, -0.4, 0.0},
                                                       {-0.2, -0.3, 0.0},
                                                       {-0.2, 0.05, 0.1}};
  s.arrays[0].phones = straight;
  s.arrays[0].shapes = {straight, bent};
  const PropagationPaths paths(s.environment, s.transect);
  const AmbientNoise noise(s, paths);
  for (const int ping : {1, 2}) {
    PingRecord record;
    record.ping = ping;
    record.recording.sample_rate = l.rate;
    record.recording.samples = many;
    record.phones.resize(4);
    record.pressure.assign(4 * many, 0.0F);
    noise.add(record.samples());
    Listener right = l, wrong = l;
    right.phones = ping == 1 ? straight : bent;
    wrong.phones = ping == 1 ? bent : straight;
    EXPECT_LT(worst(right, NoiseCoherence::isotropic, record.pressure, many), limit);
    EXPECT_GT(worst(wrong, NoiseCoherence::isotropic, record.pressure, many), limit);
  }
}

// A towed line that goes straight on is the same line in every ping, to rounding: its noise has the
// bits of an array that keeps that shape, and its factors are kept, not made again.
TEST(AmbientNoise, KeepsTheFactorsOfALineThatGoesStraightOn) {
  Scenario s = support::thesis(SoundSpeedProfile::isovelocity(c));
  s.noise = {.law = KnudsenNoise{3.0}, .coherence = NoiseCoherence::surface, .directions = {}};
  s.platforms[0].track.start.velocity = {1.234567, 2.345678, 0.0};
  s.arrays[0].towed = TowedLine{.behind = {0.0, 1.1, 2.3}};
  s.arrays[0].phones = phones_at(s, 0, 1, 0.0);
  const PropagationPaths paths(s.environment, s.transect);
  const AmbientNoise noise(s, paths);
  const std::size_t kept = paths.memory().bytes();
  EXPECT_GT(kept, 0U);
  std::vector<std::vector<float>> received;
  for (const double time : {0.0, 17.3}) {
    PingRecord record;
    record.start_time = time;
    record.recording.sample_rate = s.pings.sample_rate;
    record.recording.samples = 2000;
    record.phones.resize(3);
    record.pressure.assign(3 * 2000, 0.0F);
    noise.add(record.samples());
    received.push_back(record.pressure);
  }
  EXPECT_EQ(received[0], received[1]);
  EXPECT_EQ(paths.memory().bytes(), kept);
}

// Cron & Sherman (1962): side by side 2ᵐ m! J_m(kd)/(kd)ᵐ; one above the other, m = 1:
// 2[sin x/x + (cos x − 1)/x²] and as imaginary part −2[−cos x/x + sin x/x²] for the lower phone.
TEST(NoiseCoherence, OfTheSurfaceSheetInClosedForm) {
  for (const double m : {1.0, 2.0, 3.0}) {
    const NoiseDirections sheet{.dipole_exponent = m, .elevation = {}, .level_db = {}};
    for (const double x : {0.3, 2.0, 10.0, 60.0}) {
      const double closed =
          std::pow(2.0, m) * std::tgamma(m + 1.0) * std::cyl_bessel_j(m, x) / std::pow(x, m);
      EXPECT_NEAR(std::abs(noise_coherence(NoiseCoherence::surface, sheet, Vec3(0.6, 0.8, 0.0), x) -
                           closed),
                  0.0, 1e-10);
    }
  }
  const NoiseDirections sheet;
  for (const double x : {0.5, 3.0, 20.0}) {
    const std::complex<double> lower(2.0 * (std::sin(x) / x + (std::cos(x) - 1.0) / (x * x)),
                                     -2.0 * (std::sin(x) / (x * x) - std::cos(x) / x));
    const Vec3 down(0.0, 0.0, 1.0);  // phone i is the deeper: it receives everything later
    EXPECT_LT(std::abs(noise_coherence(NoiseCoherence::surface, sheet, down, x) - lower), 1e-10);
    EXPECT_LT(
        std::abs(noise_coherence(NoiseCoherence::surface, sheet, -down, x) - std::conj(lower)),
        1e-10);
  }
}

TEST(NoiseCoherence, OfALevelProfileIsIsotropic) {
  const NoiseDirections level{.elevation = {radians(-90.0), 0.1, radians(90.0)},
                              .level_db = {3.0, 3.0, 3.0}};
  for (const double k : {0.1, 4.0, 50.0}) {
    const Vec3 apart(0.3, -0.4, 0.7);
    EXPECT_LT(std::abs(noise_coherence(NoiseCoherence::profile, level, apart, k) -
                       std::sin(k * apart.norm()) / (k * apart.norm())),
              1e-10);
  }
}

// The stated error of the interpolation, at all bins and not only where it was looked at; of a
// tilted line, and of phones side by side, whose coherence is tabulated.
class CoherenceFactorsOfALine : public testing::TestWithParam<double> {};

TEST_P(CoherenceFactorsOfALine, AreWithinTheirTolerance) {
  const auto phones = line_array(6, 0.4, 0.3, GetParam()).phones;
  const NoiseDirections sheet;
  const double step = 4.0;
  const CoherenceFactors factors(NoiseCoherence::surface, sheet, phones, c, 0.0, step, 513);
  std::vector<std::vector<float>> re(21, std::vector<float>(513)), im = re;
  for (std::size_t i = 0, pair = 0; i < 6; ++i)
    for (std::size_t j = 0; j <= i; ++j, ++pair) factors.element(i, j, 0, re[pair], im[pair]);
  double worst = 0.0;
  for (std::size_t bin = 0; bin < 513; ++bin) {
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        std::complex<double> product = 0.0;
        for (std::size_t k = 0; k <= j; ++k) {
          const std::size_t a = i * (i + 1) / 2 + k, b = j * (j + 1) / 2 + k;
          product += std::complex<double>(re[a][bin], im[a][bin]) *
                     std::conj(std::complex<double>(re[b][bin], im[b][bin]));
        }
        worst =
            std::max(worst, std::abs(product - noise_coherence(NoiseCoherence::surface, sheet,
                                                               phones[i] - phones[j],
                                                               2.0 * pi * step * double(bin) / c)));
      }
    }
  }
  EXPECT_LT(worst, 1.5 * CoherenceFactors::tolerance) << "the middle is not always the worst place";
  EXPECT_LT(factors.nodes(), 513U);
}

INSTANTIATE_TEST_SUITE_P(Tilt, CoherenceFactorsOfALine, testing::Values(0.7, 0.0));

TEST(BlockNoise, HasTheSameBitsInWhateverPartsItIsAskedFor) {
  for (const double carrier : {0.0, 1500.0}) {
    Listener l;
    l.carrier = carrier;
    const std::size_t n = 10000, width = carrier > 0.0 ? 2 : 1;
    const auto whole = l.record(n, 5000);
    std::size_t from = 0;
    for (const std::size_t part : {1UL, 777UL, 4000UL, 5222UL}) {
      const auto some = l.record(part, 5000 + std::int64_t(from));
      for (std::size_t phone = 0; phone < l.phones.size(); ++phone)
        for (std::size_t i = 0; i < part * width; ++i)
          ASSERT_EQ(some[phone * part * width + i], whole[(phone * n + from) * width + i]);
      from += part;
    }
    EXPECT_EQ(from, n);
  }
}

TEST(BlockNoise, HasTheSameBitsForAnyNumberOfThreads) {
  Listener l;
  l.coherence = NoiseCoherence::surface;
  std::vector<std::vector<float>> runs;
  for (const std::size_t threads : {1UL, 2UL, 7UL}) {
    const tbb::global_control limit_threads(tbb::global_control::max_allowed_parallelism, threads);
    runs.push_back(l.record(20000));
  }
  EXPECT_EQ(runs[0], runs[1]);
  EXPECT_EQ(runs[0], runs[2]);
}

// Two phones side by side that come together within 16 s, from λ to nothing at 1000 Hz: at every
// time the coherence is that of where they are. Segments of 2 s within which kd changes by 0.8
// (its mean over the segment is taken), 100 Hz: 200 samples, 4.9 σ. Where they began, it is 0.
TEST(BlockNoise, FollowsPhonesThatMoveAgainstOneAnother) {
  Listener l;
  l.phones = {Vec3::Zero(), Vec3(1.5, 0.0, 0.0)};
  const std::size_t n = 65536;
  const auto shape_at = [&](double sample) {
    return std::vector<Vec3>{Vec3::Zero(), Vec3(1.5 * (1.0 - sample / double(n)), 0.0, 0.0)};
  };
  std::vector<float> rows(2 * n, 0.0F), stiff(2 * n, 0.0F);
  const BlockNoise noise = l.noise();
  noise.add(rows, 0, 1, [&](std::int64_t sample) { return shape_at(double(sample)); });
  noise.add(stiff, 0, 1);
  const auto sinc = [](double x) { return std::abs(x) < 1e-6 ? 1.0 : std::sin(x) / x; };
  double missed = 0.0;
  for (std::size_t part = 0; part < 8; ++part) {
    const std::size_t first = part * n / 8;
    const auto received = [&](const std::vector<float>& from) {
      return coherence(spectra(from.data() + first, n / 8, false),
                       spectra(from.data() + n + first, n / 8, false), 487, 538)
          .real();
    };
    double expected = 0.0;
    for (int i = 0; i < 32; ++i)
      expected += sinc(2.0 * pi * 1000.0 / c *
                       shape_at(double(first) + (i + 0.5) * double(n) / 256.0)[1].x()) /
                  32.0;
    EXPECT_NEAR(received(rows), expected,
                0.02 + 4.9 * (1.0 - expected * expected) / std::sqrt(200.0))
        << part;
    missed = std::max(missed, std::abs(received(stiff) - expected));
  }
  EXPECT_GT(missed, 0.7);
}

// In whatever parts it is asked for: a block's shape is its own.
TEST(BlockNoise, OfPhonesThatMoveHasTheSameBitsInParts) {
  Listener l;
  const std::size_t n = 10000;
  const auto shape_at = [&](std::int64_t sample) {
    std::vector<Vec3> shape = l.phones;
    shape.back().y() += 1e-4 * double(sample);
    return shape;
  };
  const BlockNoise noise = l.noise();
  std::vector<float> whole(l.phones.size() * n, 0.0F);
  noise.add(whole, 5000, 1, shape_at);
  std::size_t from = 0;
  for (const std::size_t part : {777UL, 4001UL, 5222UL}) {
    std::vector<float> some(l.phones.size() * part, 0.0F);
    noise.add(some, 5000 + std::int64_t(from), 1, shape_at);
    for (std::size_t phone = 0; phone < l.phones.size(); ++phone)
      for (std::size_t i = 0; i < part; ++i)
        ASSERT_EQ(some[phone * part + i], whole[phone * n + from + i]);
    from += part;
  }
}

TEST(BlockNoise, TakesPhonesAtOnePlace) {  // Γ is singular: all ones
  Listener l;
  l.phones = {Vec3::Zero(), Vec3::Zero(), Vec3(0.0, 0.0, 1e-4)};
  const std::size_t n = 5000;
  const auto rows = l.record(n);
  double difference = 0.0, power = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    difference += std::pow(double(rows[i]) - double(rows[n + i]), 2);
    power += double(rows[i]) * double(rows[i]);
  }
  EXPECT_LT(difference, 1e-5 * power);  // 2ε
  EXPECT_GT(power, 0.0);
}

}  // namespace
}  // namespace asdic::detail
