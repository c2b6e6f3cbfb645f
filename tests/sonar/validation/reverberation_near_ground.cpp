// A source and its receiver a few metres over a scattering floor, in deep water: what is sent back
// close by, and what scatters there after or before a way up to the surface and down again. Truth
// is the sum over images, ring by ring, in phase.
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

constexpr double c = 1500.0, depth = 3000.0, mu_db = -27.0, frequency = 2000.0, duration = 0.1;

struct Near {
  double height;  // of source and receiver over the floor [m]
  std::vector<double> times;
};

/// Mean of |Σ_ab p_ab|², per unit source: by the floor alone and by the surface, once each way.
double truth(const Near& near, double time) {
  double sum = 0.0;
  // Finer where it is near: the ring's width is a fortieth of its distance.
  for (double r = 0.0, step = 0.0; r < 0.6 * c * time; r += step) {
    step = std::min(0.5, std::hypot(r, near.height) / 40.0);
    const double range = r + 0.5 * step;
    struct Way {
      double length, sine, sign;
    };
    const auto way = [&](double height, double sign) {
      const double length = std::hypot(range, height);
      return Way{length, height / length, sign};
    };
    const std::array<Way, 2> ways = {way(near.height, 1.0), way(2.0 * depth - near.height, -1.0)};
    std::complex<double> together = 0.0;
    for (const Way& a : ways)
      for (const Way& b : ways) {
        const double delay = (a.length + b.length) / c, since = time - delay;
        if (since <= 0.0 || since >= duration) continue;
        const double window = 0.5 - 0.5 * std::cos(2.0 * pi * since / duration);
        together += a.sign * b.sign * window / (a.length * b.length) *
                    std::sqrt(power_from_db(mu_db) * a.sine * b.sine) *
                    std::polar(1.0, -2.0 * pi * frequency * std::fmod(delay, 1.0));
      }
    sum += 2.0 * pi * range * step * std::norm(together);
  }
  return sum;
}

Scenario scenario_of(const Near& near) {
  Scenario s = support::mirrored_floor(
      depth, depth - near.height, mu_db,
      {.waveform = Cw{.frequency = frequency}, .duration = duration, .window = PulseWindow::hann});
  s.environment.bottom.material = ReflectionTable{{0.0, 0.5 * pi}, {0.0, 0.0}, {0.0, 0.0}};
  s.pings.recording_duration = near.times.back() + 0.3;
  s.pings.sample_rate = 8000.0;
  return s;
}

class ReverberationNearGround : public ::testing::TestWithParam<Near> {};

TEST_P(ReverberationNearGround, ExpectedLevelIsThatOfTheImages) {
  const Near& near = GetParam();
  const Sea sea(scenario_of(near));
  const PingReverberation ping = sea.ping(1);
  for (const double t : near.times) {
    const double level = ping.expected_db(t) - sea.scenario().transmitters[0].source_level_db;
    EXPECT_NEAR(level, db_from_power(truth(near, t)), 0.5) << t;
  }
}

// 400 pings: 4.9 sigma of an exponential's mean are 1.0 dB; of few scatterers, more.
TEST_P(ReverberationNearGround, ReceivedLevelIsThatOfTheImages) {
  constexpr int pings = 400;
  const Near& near = GetParam();
  for (const ScattererSynthesis how : {ScattererSynthesis::streams, ScattererSynthesis::covariance,
                                       ScattererSynthesis::scatterers}) {
    Scenario s = scenario_of(near);
    s.reverberation.synthesis = how;
    if (how == ScattererSynthesis::scatterers) s.pings.recording_duration = 0.4;
    std::vector<double> received(near.times.size(), 0.0);
    const int seas = how == ScattererSynthesis::scatterers ? 40 : 1;
    for (int n = 1; n <= seas; ++n) {
      s.seed = static_cast<std::uint64_t>(n);
      const Sea sea(s);
      for (int ping = 1; ping <= pings / seas; ++ping) {
        const Baseband b = sea.receive(static_cast<std::uint32_t>(ping));
        for (std::size_t i = 0; i < received.size(); ++i)
          if (near.times[i] < s.pings.recording_duration)
            received[i] += std::norm(at(b, 0, near.times[i])) / pings;
      }
    }
    for (std::size_t i = 0; i < received.size(); ++i) {
      if (near.times[i] > s.pings.recording_duration) continue;
      EXPECT_NEAR(db_from_power(received[i] / truth(near, near.times[i])), 0.0, 1.5)
          << near.times[i] << " s, synthesis " << static_cast<int>(how);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Over, ReverberationNearGround,
                         ::testing::Values(Near{5.0, {0.04, 0.06, 0.09, 0.12, 0.2, 0.35, 4.05}},
                                           Near{20.0, {0.06, 0.09, 0.13, 0.2, 0.35, 4.05}},
                                           Near{60.0, {0.12, 0.15, 0.2, 0.35, 4.05}}),
                         [](const auto& over) {
                           return std::to_string(static_cast<int>(over.param.height)) + "metres";
                         });

}  // namespace
}  // namespace asdic::detail
