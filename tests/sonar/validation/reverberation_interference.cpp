// Sounds of one place that come by several paths interfere: under a source close to the surface
// the bottom answers through the lobes of Lloyd's mirror.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "support/reverberant_sea.h"

namespace asdic::detail {
namespace {

using support::at;
using Sea = support::ReverberantSea;

constexpr double c = 1500.0, depth = 100.0, source_depth = 5.0, frequency = 1000.0, duration = 0.12,
                 mu_db = -27.0;
constexpr std::array<double, 9> times = {0.35, 0.5, 0.65, 0.8, 0.95, 1.1, 1.3, 1.5, 1.8};

/// 100 m of water over a bottom that scatters by Lambert's law, no bounces but off the surface.
Scenario mirror(std::vector<Vec3> phones) {
  Scenario s = support::mirrored_floor(
      depth, source_depth, mu_db,
      {.waveform = Cw{.frequency = frequency}, .duration = duration, .window = PulseWindow::hann});
  s.arrays[0].phones = std::move(phones);
  s.reverberation.resolve_azimuth = false;
  s.pings.recording_duration = 2.0;
  s.pings.sample_rate = 4000.0;
  return s;
}

/// A way from a depth to a place on the bottom: by itself, and by the surface, which turns the
/// sign.
struct Way {
  double length, sine, sign;
};
std::array<Way, 2> ways(double from, double range) {
  const auto way = [&](double height, double sign) {
    const double length = std::hypot(range, height);
    return Way{length, height / length, sign};
  };
  return {way(depth - from, 1.0), way(depth + from, -1.0)};
}

/// Mean over time of |Σ_ab p_ab|² at a phone, per unit source: the sum over rings of 5 cm.
/// \param interference  of the sounds of one place; without it a wrong model
std::array<double, times.size()> truth(double phone_depth, bool interference) {
  constexpr double step = 0.05;
  std::array<double, times.size()> sum{};
  for (double r = 0.5 * step; r < 1600.0; r += step) {
    const auto out = ways(source_depth, r), back = ways(phone_depth, r);
    for (std::size_t i = 0; i < times.size(); ++i) {
      std::complex<double> together = 0.0;
      double apart = 0.0;
      for (const Way& a : out)
        for (const Way& b : back) {
          const double delay = (a.length + b.length) / c, since = times[i] - delay;
          if (since <= 0.0 || since >= duration) continue;
          const double window = 0.5 - 0.5 * std::cos(2.0 * pi * since / duration);
          const double pressure = a.sign * b.sign * window / (a.length * b.length) *
                                  std::sqrt(power_from_db(mu_db) * a.sine * b.sine);
          together += pressure * std::polar(1.0, -2.0 * pi * frequency * delay);
          apart += pressure * pressure;
        }
      sum[i] += 2.0 * pi * r * step * (interference ? std::norm(together) : apart);
    }
  }
  return sum;
}

struct Engine {
  ScattererSynthesis how;
  double speed;  // of the vehicle [m/s]
  const char* name;
  bool sectors = false;
};

class PathInterference : public ::testing::TestWithParam<Engine> {
 protected:
  /// Mean over pings and phones of |b|², in every time over that of Lloyd's mirror.
  static void expect_level(const std::vector<Vec3>& phones, int pings, double independent) {
    Scenario s = mirror(phones);
    s.reverberation.synthesis = GetParam().how;
    if (GetParam().sectors) {
      s.reverberation.ground_spacing = 3.0;
      s.reverberation.most_returns = 10'000;
    }
    s.platforms[0].track.start.velocity = {GetParam().speed, 0.0, 0.0};
    std::array<double, times.size()> expected{}, wrong{}, received{};
    for (const Vec3& phone : phones) {
      const auto right = truth(source_depth + phone.z(), true),
                 energy = truth(source_depth + phone.z(), false);
      for (std::size_t i = 0; i < times.size(); ++i) {
        expected[i] += right[i];
        wrong[i] += energy[i];
      }
    }
    // Scatterers lie where they lie: in every sea elsewhere.
    const int seas = GetParam().how == ScattererSynthesis::scatterers ? pings / 5 : 1;
    for (int n = 1; n <= seas; ++n) {
      s.seed = static_cast<std::uint64_t>(n);
      const Sea sea(s);
      for (int ping = 1; ping <= pings / seas; ++ping) {
        const Baseband b = sea.receive(static_cast<std::uint32_t>(ping));
        for (std::size_t i = 0; i < times.size(); ++i)
          for (std::size_t phone = 0; phone < phones.size(); ++phone)
            received[i] += std::norm(at(b, phone, times[i])) / pings;
      }
    }
    const double sigma = 1.0 / std::sqrt(pings * independent);
    double furthest = 0.0;
    for (std::size_t i = 0; i < times.size(); ++i) {
      // The mean over a pulse fills nulls to a thousandth of the energy.
      const double filled = 1e-3 * wrong[i] / expected[i];
      EXPECT_NEAR(received[i] / expected[i], 1.0, 4.9 * sigma + filled) << times[i];
      furthest = std::max(furthest, std::abs(db_from_power(wrong[i] / expected[i])));
    }
    EXPECT_GT(furthest, 5.0);  // energy alone
  }
};
INSTANTIATE_TEST_SUITE_P(
    Synthesis, PathInterference,
    ::testing::Values(Engine{ScattererSynthesis::covariance, 0.0, "covariance"},
                      Engine{ScattererSynthesis::streams, 4.0, "streams"},
                      Engine{ScattererSynthesis::scatterers, 4.0, "scatterers"},
                      Engine{ScattererSynthesis::scatterers, 4.0, "sectors", true}),
    [](const auto& engine) { return engine.param.name; });

// 600 pings: 4.9 sigma of an exponential's mean is 20 %.
TEST_P(PathInterference, BottomIsReceivedThroughTheLobesOfLloydsMirror) {
  expect_level({Vec3::Zero()}, 600, 1.0);
}

// The mean over phones, which receive it in lobes of their own.
TEST_P(PathInterference, MeanOverAVerticalArrayIsThatOfItsPhones) {
  if (GetParam().how == ScattererSynthesis::scatterers)
    return;  // each phone receives what it receives
  expect_level({Vec3(0, 0, -2), Vec3(0, 0, -1), Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(0, 0, 2)}, 600,
               1.0);
}

// The level that is expected, of which no weight is drawn, in nulls 37 dB deep, too.
TEST(PathInterferenceOfLevels, ExpectedLevelIsThatOfLloydsMirror) {
  const Sea sea(mirror({Vec3::Zero()}));
  const PingReverberation ping = sea.ping(1);
  const auto right = truth(source_depth, true);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double level =
        ping.expected_db(times[i]) - sea.scenario().transmitters[0].source_level_db;
    EXPECT_NEAR(level, db_from_power(right[i]), 1.0) << times[i];
  }
}

// Where very many paths are followed, the strong ones still interfere: 5 m deep in 20 m of water,
// where energies alone are up to 6 dB off. Of 5 bounces every pair is looked at.
TEST(PathInterferenceInAGuide, MoreBouncesThanAreReceivedChangeNothing) {
  constexpr int pings = 600;
  constexpr std::array<double, 5> received_at = {0.2, 0.25, 0.3, 0.35, 0.45};
  const auto levels = [&](int bounces) {
    Scenario s = mirror({Vec3::Zero()});
    s.environment.bottom.depth = 20.0;
    s.environment.bottom.material = FluidHalfSpace{.speed = 1600.0, .density = 1800.0};
    s.pulse.duration = 0.1;
    s.propagation.max_surface_bounces = s.propagation.max_bottom_bounces = bounces;
    s.pings.recording_duration = 0.6;
    s.reverberation.synthesis = ScattererSynthesis::covariance;
    const Sea sea(s);
    std::array<double, received_at.size()> mean{};
    for (int ping = 1; ping <= pings; ++ping) {
      const Baseband b = sea.receive(static_cast<std::uint32_t>(ping));
      for (std::size_t i = 0; i < mean.size(); ++i)
        mean[i] += std::norm(at(b, 0, received_at[i])) / pings;
    }
    return mean;
  };
  const auto few = levels(5), many = levels(40);
  for (std::size_t i = 0; i < few.size(); ++i) {
    // 4.9 sigma of the ratio of two means of 600 pings are 1.1 dB; the rest interferes, too.
    EXPECT_NEAR(db_from_power(many[i] / few[i]), 0.0, 2.0) << received_at[i];
  }
}

}  // namespace
}  // namespace asdic::detail
