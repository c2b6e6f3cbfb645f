#include "processing/coverage/turned_sum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/units.h"
#include "processing/coverage/echo_mean.h"

namespace asdic::detail {
namespace {

using Sound = TurnedSum::Sound;

/// Levels over 40 dB, any phase, at places even over a field of phases.
std::vector<Sound> sounds_over(double along, double across, std::size_t n) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<Sound> sounds(n);
  for (Sound& s : sounds) {
    s.pressure = std::polar(std::pow(10.0, -2.0 * share(random)), 2.0 * pi * share(random));
    s.open = s.pressure * std::polar(0.2 + share(random), share(random));
    s.along = along * share(random) - 3.0;
    s.across = across * share(random) + 100.0;
    s.power = std::norm(s.pressure);
  }
  return sounds;
}

/// Every pair, as the header's formulae say.
TurnedSum::Sums plain(const std::vector<Sound>& sounds) {
  TurnedSum::Sums sums;
  for (const Sound& a : sounds)
    for (const Sound& b : sounds) {
      const double x = a.along - b.along, y = a.across - b.across,
                   kept = std::exp(-0.5 * (x * x + y * y));
      sums.power += kept * std::real(a.pressure * std::conj(b.pressure));
      sums.open += kept * std::real(a.open * std::conj(b.open));
      sums.kept += kept * kept * a.power * b.power;
    }
  return sums;
}

struct Field {
  double along, across;  // [rad]
  bool in_step;          // all pressures alike: they add up in phase
};

class TurnedSumOver : public testing::TestWithParam<Field> {};

/// Of powers the error is that of one sound by itself, where they cancel, too.
TEST_P(TurnedSumOver, IsThePlainSum) {
  const Field field = GetParam();
  std::vector<Sound> sounds = sounds_over(field.along, field.across, 900);
  if (field.in_step)
    for (Sound& s : sounds) s.pressure = s.open = 1.0, s.power = 1.0;
  double alone = 0.0, open_alone = 0.0;
  for (const Sound& s : sounds) alone += s.power, open_alone += std::norm(s.open);
  const TurnedSum::Sums truth = plain(sounds);
  const auto agree = [&](const TurnedSum::Sums& found, double tolerance) {
    EXPECT_NEAR(found.power, truth.power, tolerance * std::max(alone, truth.power));
    EXPECT_NEAR(found.open, truth.open, tolerance * std::max(open_alone, truth.open));
    EXPECT_NEAR(found.kept, truth.kept, 10.0 * tolerance * truth.kept);
  };
  TurnedSum sum;
  // 3/128·h⁴·f⁗, f⁗ = 3 of the Gaussian and 12 of its square, for both of a pair and both phases:
  // 1.1·10⁻³ and 4.4·10⁻³ where all lie in the middle between two nodes.
  agree(sum.on_grid(sounds), 1.2e-3);
  agree(sum.on_grid(sounds), 1.2e-3);          // its memory is used again
  agree(TurnedSum::one_by_one(sounds), 2e-4);  // e⁻⁹ of each pair of 900 at random
  agree(sum(sounds), 1.2e-3);
}

INSTANTIATE_TEST_SUITE_P(Fields, TurnedSumOver,
                         testing::Values(Field{0.0, 0.0, false}, Field{0.4, 0.3, true},
                                         Field{4.0, 17.0, false}, Field{17.0, 4.0, true},
                                         Field{300.0, 6.0, false}, Field{900.0, 40.0, false}));

/// A leg in two halves sounds as the whole: 400 pairs, which are added up one by one, against 800.
TEST(EchoMeans, ManyPairsSoundAsFew) {
  const PulseCoherence pulse(0.1, 0.0005, [] {
    std::vector<std::complex<float>> samples;
    for (int i = 0; i <= 201; ++i) {  // of a sweep of 100 Hz
      const double later = 0.0005 * i, x = pi * 100.0 * later;
      samples.emplace_back(
          static_cast<float>(i == 0 ? 1.0 : std::sin(x * (1.0 - later / 0.1)) / x));
    }
    samples[200] = samples[201] = 0.0F;
    return samples;
  }());
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const auto legs = [&](double bearing) {
    std::vector<EchoLeg> made(20);
    for (EchoLeg& leg : made) {
      leg.amplitude = std::polar(1e-3 * (0.05 + share(random)), 2.0 * pi * share(random));
      leg.sent = 0.3 + share(random);
      leg.delay = 4.0 + 0.08 * share(random);
      leg.slowness =
          Vec2(std::sin(bearing), std::cos(bearing)) * (0.9 + 0.1 * share(random)) / 1500.0;
      leg.elevation = share(random);
    }
    return made;
  };
  for (int trial = 0; trial < 10; ++trial) {
    const std::vector<EchoLeg> out = legs(0.4), back = legs(0.0);
    std::vector<EchoLeg> halves = out;
    halves.insert(halves.end(), out.begin(), out.end());
    for (EchoLeg& leg : halves) leg.amplitude *= 0.5;
    EchoMeans means(1000.0, pulse, 100.0);
    const EchoCell cell{.outward = Vec2(0.0, 1.0), .length = 60.0, .width = 120.0, .falls_db = 0.0};
    const EchoMean few = means(out, back, cell), many = means(halves, back, cell);
    EXPECT_NEAR(db_from_power(many.power / few.power), 0.0, 0.02) << trial;
    EXPECT_NEAR(db_from_power(many.open_power / few.open_power), 0.0, 0.02) << trial;
    EXPECT_NEAR(many.delay, few.delay, 0.005) << trial;
  }
}

}  // namespace
}  // namespace asdic::detail
