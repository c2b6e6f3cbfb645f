#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "core/error.h"
#include "core/geometry.h"
#include "core/random.h"
#include "core/units.h"
#include "processing/array_shape.h"
#include "processing/beams.h"
#include "processing/mvdr.h"
#include "sonar/scenario/array.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;
constexpr double c = 1500.0, frequency = 1500.0, wavelength = 1.0, wavenumber = 2.0 * pi;

std::vector<Vec3> ball() {  // a volume: phones on two circles and the poles
  std::vector<Vec3> phones{{0, 0, -0.5}, {0, 0, 0.5}};
  for (int i = 0; i < 8; ++i)
    for (const double z : {-0.25, 0.25})
      phones.emplace_back(0.5 * std::sin(i * pi / 4.0), 0.5 * std::cos(i * pi / 4.0), z);
  return phones;
}

/// A plane wave of broad band, exp(i2πf(t + look·x/c)) at a few frequencies, at each phone.
Baseband plane_wave(std::span<const Vec3> phones, const Vec3& look) {
  Baseband b{.carrier = frequency,
             .sample_rate = 400.0,
             .channels = phones.size(),
             .samples = 400,
             .recorded = 400};
  for (const Vec3& x : phones)
    for (std::size_t i = 0; i < b.samples; ++i) {
      Complex sum = 0.0;
      for (const double f : {-120.0, -7.0, 0.0, 55.0, 150.0})
        sum += std::polar(0.2, 2.0 * pi *
                                   (f * static_cast<double>(i) / b.sample_rate +
                                    (frequency + f) * look.dot(x) / c));
      b.values.emplace_back(sum);
    }
  return b;
}

double energy(const BeamSpectra& spectra, std::size_t beam) {
  double sum = 0.0;
  for (std::size_t k = 0; k < spectra.bins; ++k)
    sum += static_cast<double>(std::norm(spectra.beam(beam)[k]));
  return sum / (static_cast<double>(spectra.bins) * static_cast<double>(spectra.bins));
}

TEST(ArrayShapeTest, TellsLinesPlanesAndVolumes) {
  const auto line = line_array(16, 0.5, radians(30.0), 0.0).phones;
  const ArrayShape shape = shape_of(line, wavelength);
  EXPECT_EQ(shape.kind, ArrayKind::line);
  EXPECT_FALSE(shape.upright());
  EXPECT_NEAR(std::atan2(shape.axis.x(), shape.axis.y()), radians(30.0), 1e-9);
  EXPECT_NEAR(shape.length, 7.5, 1e-9);
  const auto upright = line_array(4, 0.5, 0.0, radians(90.0)).phones;
  EXPECT_TRUE(shape_of(upright, wavelength).upright());
  EXPECT_NEAR(shape_of(upright, wavelength).axis.z(), -1.0, 1e-9);  // from the deepest upwards
  std::vector<Vec3> ring;
  for (int i = 0; i < 8; ++i) ring.emplace_back(std::sin(i * pi / 4), std::cos(i * pi / 4), 0.0);
  EXPECT_EQ(shape_of(ring, wavelength).kind, ArrayKind::plane);
  EXPECT_NEAR(std::abs(shape_of(ring, wavelength).normal.z()), 1.0, 1e-9);
  EXPECT_EQ(shape_of(ball(), wavelength).kind, ArrayKind::volume);
  EXPECT_EQ(shape_of(std::vector<Vec3>{Vec3::Zero()}, wavelength).kind, ArrayKind::point);
  // A line bent by less than an eighth of a wavelength is still a line.
  auto bent = line;
  bent[8].z() += 0.1;
  EXPECT_EQ(shape_of(bent, wavelength).kind, ArrayKind::line);
}

// A plane wave looked at gives its own power, whatever its band; from elsewhere the pattern of each
// frequency, summed. Float sums over 400 bins: 1e-5.
TEST(ConventionalBeams, PassAPlaneWaveAndFollowThePattern) {
  for (const auto& phones : {line_array(16, 0.5, 0.4, 0.0).phones, ball()}) {
    const Vec3 from = direction(radians(75.0), radians(20.0)),
               other = direction(radians(60.0), radians(-5.0));
    const Baseband b = plane_wave(phones, from);
    const std::vector<double> weights = shading(phones, true);
    const std::vector<Vec3> looks{from, other};
    const BeamSpectra beams = conventional_beams(channel_spectra(b), b, phones, looks, c, weights);
    EXPECT_NEAR(energy(beams, 0), 5 * 0.04, 1e-5);
    double expected = 0.0;
    for (const double f : {-120.0, -7.0, 0.0, 55.0, 150.0})
      expected += 0.04 * beam_pattern(phones, weights, other, from, 2.0 * pi * (frequency + f) / c);
    EXPECT_NEAR(energy(beams, 1), expected, 1e-5);
  }
}

TEST(ConventionalBeams, WantAPhoneAndAWeightForEveryChannel) {
  const auto phones = line_array(4, 0.5, 0.0, 0.0).phones;
  const std::vector<Vec3> looks{Vec3::UnitX()};
  const Baseband b = plane_wave(phones, looks[0]);
  const std::vector<double> weights(4, 0.25);
  const auto beams = [&](std::size_t of_phones, std::size_t of_weights) {
    return conventional_beams(channel_spectra(b), b, std::span(phones).first(of_phones), looks, c,
                              std::span(weights).first(of_weights));
  };
  EXPECT_EQ(beams(4, 4).beams, 1U);
  EXPECT_THROW((void)beams(3, 4), InputError);
  EXPECT_THROW((void)beams(4, 3), InputError);
}

// n phones half a wavelength apart: |sin(nψ/2)/(n sin(ψ/2))|², ψ = π(cos − cos₀).
TEST(BeamPatternTest, OfALineIsTheClosedForm) {
  const auto phones = line_array(16, 0.5, 0.0, 0.0).phones;
  const std::vector<double> weights = shading(phones, false);
  const Vec3 axis = Vec3::UnitY();
  for (const double u : {-0.9, -0.3, 0.05, 0.4}) {
    const double psi = pi * (u - 0.2);
    const double closed = std::pow(std::sin(8.0 * psi) / (16.0 * std::sin(0.5 * psi)), 2);
    EXPECT_NEAR(beam_pattern(phones, weights, on_cone(axis, 0.2), on_cone(axis, u), wavenumber),
                closed, 1e-12);
  }
}

// White noise of power 1 in each phone leaves Σw² in a beam: 1/n, the array gain n.
TEST(ConventionalBeams, GainOverWhiteNoiseIsTheNumberOfPhones) {
  const auto phones = line_array(16, 0.5, 0.0, 0.0).phones;
  const std::size_t n = 40000;
  Baseband b{
      .carrier = frequency, .sample_rate = 400.0, .channels = 16, .samples = n, .recorded = n};
  for (std::uint32_t ch = 0; ch < 16; ++ch) {
    RandomStream stream(1, Draw::ambient_noise, 1, ch);
    for (std::size_t i = 0; i < n; ++i) b.values.emplace_back(stream.complex_normal());
  }
  const std::vector<Vec3> looks{direction(0.3, 0.0), direction(1.5, 0.0)};
  const BeamSpectra beams =
      conventional_beams(channel_spectra(b), b, phones, looks, c, shading(phones, false));
  // 40 000 independent exponentials: 0.5 % a standard deviation, 2.5 % are five.
  EXPECT_NEAR(energy(beams, 0) * 16.0, 1.0, 0.025);
  EXPECT_NEAR(energy(beams, 1) * 16.0, 1.0, 0.025);
}

// Half a step off, λ/(4·extent), the beam of 16 phones loses |sin(16x)/(16 sin x)|² at x = π/60:
// 1.04 dB; beams with steps in two angles twice that, at most.
TEST(BeamGridTest, NoDirectionIsFarFromABeam) {
  RandomStream draw(3, Draw::ambient_noise, 0, 0);
  for (const auto& phones : {line_array(16, 0.5, 0.3, 0.0).phones, ball()}) {
    const ArrayShape shape = shape_of(phones, wavelength);
    const BeamGrid grid = beam_grid(shape, wavelength);
    const std::vector<double> weights = shading(phones, false);
    for (int i = 0; i < 300; ++i) {
      const Vec3 from = direction(2.0 * pi * draw.uniform(), std::asin(2.0 * draw.uniform() - 1.0));
      double best = 0.0;
      for (const Vec3& look : grid.looks)
        best = std::max(best, beam_pattern(phones, weights, look, from, wavenumber));
      EXPECT_GT(db_from_power(best), shape.kind == ArrayKind::line ? -1.05 : -2.1)
          << from.transpose();
    }
  }
}

// The direction that fits a noiseless snapshot is the wave's: to 1e-4, where the search ends.
TEST(RefineDirection, FindsThePlaneWave) {
  RandomStream draw(4, Draw::ambient_noise, 0, 0);
  for (const auto& phones : {line_array(16, 0.5, 0.3, 0.0).phones, ball()}) {
    const ArrayShape shape = shape_of(phones, wavelength);
    const BeamGrid grid = beam_grid(shape, wavelength);
    const std::vector<double> weights = shading(phones, false);
    for (int i = 0; i < 100; ++i) {
      const Vec3 from = direction(2.0 * pi * draw.uniform(), 1.2 * (draw.uniform() - 0.5));
      // Half a wavelength apart, a line receives its two ends alike.
      if (shape.kind == ArrayKind::line && std::abs(from.dot(shape.axis)) > 0.9) continue;
      const auto snapshot = steering_vector(phones, shape.centre, from, wavenumber);
      std::size_t nearest = 0;
      for (std::size_t b = 0; b < grid.looks.size(); ++b)
        if (beam_pattern(phones, weights, grid.looks[b], from, wavenumber) >
            beam_pattern(phones, weights, grid.looks[nearest], from, wavenumber))
          nearest = b;
      const Vec3 found = refine_direction(snapshot, phones, shape, weights, grid.looks[nearest],
                                          grid.spacing, wavenumber);
      if (shape.kind == ArrayKind::line)
        EXPECT_NEAR(found.dot(shape.axis), from.dot(shape.axis), 1e-4);
      else
        EXPECT_LT((found - from).norm(), 1e-3);
    }
  }
}

// One interferer of power P in white noise σ², R = σ²I + P·b bᴴ, by Sherman and Morrison:
//   aᴴR⁻¹a = (N − P|aᴴb|²/(σ² + PN))/σ², and the beam lets |wᴴb|² = |aᴴb|²σ⁴/(σ² + PN)²/(aᴴR⁻¹a
//   σ²)²
// through. The loading δ·tr(R)/N = δ(σ² + P) adds to σ².
TEST(Mvdr, MatchesTheClosedFormForOneInterferer) {
  const auto phones = line_array(12, 0.5, 0.0, 0.0).phones;
  const auto a = steering_vector(phones, Vec3::Zero(), direction(radians(80.0), 0.0), wavenumber);
  const auto b = steering_vector(phones, Vec3::Zero(), direction(radians(63.0), 0.0), wavenumber);
  const double noise = 1.0, power = 300.0, loading = 0.01, n = 12.0;
  std::vector<Complex> covariance;
  for (std::size_t i = 0; i < 12; ++i)
    for (std::size_t j = 0; j < 12; ++j)
      covariance.push_back(power * b[i] * std::conj(b[j]) + (i == j ? noise : 0.0));
  const auto w = mvdr_weights(covariance, a, loading);
  Complex ab = 0.0, gain = 0.0, through = 0.0;
  double white = 0.0;
  for (std::size_t i = 0; i < 12; ++i) {
    ab += std::conj(a[i]) * b[i];
    gain += std::conj(w[i]) * a[i];
    through += std::conj(w[i]) * b[i];
    white += std::norm(w[i]);
  }
  const double s = noise + loading * (noise + power);
  const double capon = (n - power * std::norm(ab) / (s + power * n)) / s;  // aᴴR⁻¹a
  EXPECT_NEAR(std::abs(gain - 1.0), 0.0, 1e-12);
  EXPECT_NEAR(std::norm(through), std::norm(ab) / std::pow(s + power * n, 2) / std::pow(capon, 2),
              1e-12);
  // Output power wᴴ(R + loading)w = 1/(aᴴR⁻¹a).
  EXPECT_NEAR(s * white + power * std::norm(through), 1.0 / capon, 1e-10);
  EXPECT_LT(std::norm(through),
            0.01 * std::norm(ab) / (n * n));  // a conventional beam lets more in
}

// Without anything but noise the blocks add up to the record again and a plane wave passes whole.
TEST(Mvdr, BeamPassesItsPlaneWaveAndRejectsAnother) {
  const auto phones = line_array(8, 0.5, 0.0, 0.0).phones;
  const Vec3 from = direction(radians(90.0), 0.0), noisy = direction(radians(50.0), 0.0);
  const std::size_t n = 4000;
  Baseband b{
      .carrier = frequency, .sample_rate = 400.0, .channels = 8, .samples = n, .recorded = n};
  b.values.resize(8 * n);
  RandomStream loud(9, Draw::ambient_noise, 0, 100);
  std::vector<Complex> interferer(n);
  for (auto& x : interferer) x = 30.0 * loud.complex_normal();
  for (std::size_t ch = 0; ch < 8; ++ch) {
    RandomStream stream(2, Draw::ambient_noise, 1, ch);
    for (std::size_t i = 0; i < n; ++i) {
      // narrow in the array's transit time, so that phases are those of the carrier
      const Complex slow = i >= 2000 && i < 2200 ? 10.0 : 0.0;
      b.values[ch * n + i] = std::complex<float>(
          stream.complex_normal() + slow * std::polar(1.0, wavenumber * from.dot(phones[ch])) +
          interferer[i / 20 * 20] * std::polar(1.0, wavenumber * noisy.dot(phones[ch])));
    }
  }
  const std::vector<Vec3> looks{from};
  const auto row = [&](BeamSpectra beams) {
    ComplexFft<float>(n).inverse(beams.beam(0));
    return std::vector<std::complex<float>>(beams.beam(0), beams.beam(0) + n);
  };
  const auto adaptive = row(mvdr_beams(b, phones, looks, c, {.loading_db = -30.0}));
  const auto plain =
      row(conventional_beams(channel_spectra(b), b, phones, looks, c, shading(phones, false)));
  const auto mean = [&](const auto& y, std::size_t first, std::size_t last) {
    double sum = 0.0;
    for (std::size_t i = first; i < last; ++i) sum += std::norm(Complex(y[i]) / double(n));
    return sum / static_cast<double>(last - first);
  };
  // Outside the pulse: the interferer's 900 at −13 dB or so in the plain beam, next to nothing in
  // the adaptive one; inside, the pulse's 100 within a decibel.
  EXPECT_GT(mean(plain, 200, 1800), 20.0 * mean(adaptive, 200, 1800));
  EXPECT_NEAR(db_from_power(mean(adaptive, 2020, 2180)), 20.0, 1.0);
}

}  // namespace
}  // namespace asdic::detail
