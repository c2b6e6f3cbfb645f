// Sounds of one place in shallow water, by as many paths as there are: all of them interfere, and
// at long ranges few modes are left. Truth is the sum over images at every place of the bottom,
// pair by pair in phase. However many bounces are followed beyond those that are received, and
// however the sea is drawn, the level is that.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "support/reverberant_sea.h"

namespace asdic::detail {
namespace {

using support::at;
using Sea = support::ReverberantSea;

constexpr double c = 1500.0, mu_db = -27.0;
constexpr int enough = 16;  // bounces of which anything is left

/// A guide of even water over a bottom of one reflection coefficient, and who pings in it.
struct Guide {
  const char* name;
  double depth, reflection, source_depth, receiver_depth;  // [m]
  double astern;                                           // of the source, the array [m]
  double frequency, duration;                              // of a tone under a Hann window
  std::vector<double> times;                               // [s]
  double latest;                                           // of the record [s]
};

const Guide loses{"Loses", 20, 0.4, 5, 5, 50, 2000, 0.1, {0.283, 0.483, 0.883, 1.283, 1.683}, 2.0};
const Guide keeps{"Keeps", 20, 0.7, 5, 5, 50, 2000, 0.1, {0.283, 0.483, 0.883, 1.283, 1.683}, 2.0};
const Guide one_place{"OnePlace", 20, 0.7, 5, 5, 0, 2000, 0.1, {0.283, 0.483, 0.883, 1.683}, 2.0};
const Guide deeper{"Deeper", 100, 0.6, 6, 40, 150, 500, 0.2, {0.6, 1.0, 1.7, 2.5, 3.5}, 4.0};

struct Image {
  double height, factor;
};
/// Of a source at a depth, as the bottom sees it before it answers itself.
std::vector<Image> images(const Guide& g, double from, int bounces) {
  std::vector<Image> all;
  for (int n = 0; n <= bounces; ++n) {
    const double down = std::pow(-g.reflection, n);
    all.push_back({(2 * n + 1) * g.depth - from, down});
    if (n < bounces) all.push_back({(2 * n + 1) * g.depth + from, -down});
  }
  return all;
}

/// Mean of |Σ_ab p_ab|² at the receiver, per unit source: the sum over places a metre apart, or
/// rings of 0.1 m.
std::vector<double> truth(const Guide& g, bool interference, int bounces) {
  const int bearings = g.astern > 0.0 ? 24 : 1;  // of half the plane: its other half is the same
  const double step = bearings > 1 ? 1.0 : 0.1;
  const std::vector<Image> out = images(g, g.source_depth, bounces),
                           back = images(g, g.receiver_depth, bounces);
  std::vector<double> sum(g.times.size(), 0.0);
  const auto leg = [](const std::vector<Image>& from, double range) {
    struct Arriving {
      double delay, sine, amplitude;
    };
    std::vector<Arriving> found;
    for (const Image& image : from) {
      const double length = std::hypot(range, image.height);
      found.push_back({length / c, image.height / length, image.factor / length});
    }
    return found;
  };
  for (int i = 0; i < bearings; ++i) {
    const double bearing = pi * (i + 0.5) / bearings;
    for (double r = 0.5 * step; r < 0.5 * c * g.latest; r += step) {
      const Vec2 place = r * Vec2(std::cos(bearing), std::sin(bearing));
      const auto to = leg(out, (place - Vec2(0.5 * g.astern, 0.0)).norm()),
                 home = leg(back, (place + Vec2(0.5 * g.astern, 0.0)).norm());
      for (std::size_t t = 0; t < g.times.size(); ++t) {
        std::complex<double> together = 0.0;
        double apart = 0.0;
        for (const auto& a : to)
          for (const auto& b : home) {
            const double delay = a.delay + b.delay, since = g.times[t] - delay;
            if (since <= 0.0 || since >= g.duration) continue;
            const double pressure = (0.5 - 0.5 * std::cos(2.0 * pi * since / g.duration)) *
                                    a.amplitude * b.amplitude *
                                    std::sqrt(power_from_db(mu_db) * a.sine * b.sine);
            together += pressure * std::polar(1.0, -2.0 * pi * g.frequency * delay);
            apart += pressure * pressure;
          }
        sum[t] += 2.0 * pi / bearings * r * step * (interference ? std::norm(together) : apart);
      }
    }
  }
  return sum;
}

Scenario scenario_of(const Guide& g, int bounces, double speed) {
  Scenario s = support::even_sea();
  s.wind_speed = 0.0;
  s.environment.bottom = {
      .depth = g.depth,
      .material = ReflectionTable{{0.0, 0.5 * pi}, {g.reflection, g.reflection}, {0.0, 0.0}}};
  s.platforms[0].track.start = {.position = {0.0, 0.0, g.source_depth},
                                .velocity = {0.0, speed, 0.0}};
  s.arrays[0].offset = {0.0, -g.astern, g.receiver_depth - g.source_depth};
  s.arrays[0].phones = {Vec3::Zero()};
  s.pulse = {.waveform = Cw{.frequency = g.frequency},
             .duration = g.duration,
             .window = PulseWindow::hann};
  s.propagation = {};
  s.propagation.max_surface_bounces = s.propagation.max_bottom_bounces = bounces;
  s.reverberation.surface_scatters = false;
  s.reverberation.bottom = Lambert{.mu_db = mu_db};
  s.reverberation.bottom_field.statistics.coherence_time = 0.0;
  s.pings.recording_duration = g.latest;
  s.pings.sample_rate = 4.0 * g.frequency;
  return s;
}

struct Case {
  Guide guide;
  int bounces;
};

class ReverberationGuide : public ::testing::TestWithParam<Case> {};

TEST_P(ReverberationGuide, ExpectedLevelIsThatOfAllImagesInPhase) {
  const auto& [guide, bounces] = GetParam();
  const std::vector<double> right = truth(guide, true, std::min(bounces, enough)),
                            energy = truth(guide, false, std::min(bounces, enough));
  const Sea sea(scenario_of(guide, bounces, 0.0));
  const PingReverberation ping = sea.ping(1);
  double furthest = 0.0;
  for (std::size_t i = 0; i < right.size(); ++i) {
    const double level = power_from_db(ping.expected_db(guide.times[i]) -
                                       sea.scenario().transmitters[0].source_level_db);
    // Energies stand for what bundles interfere; where little of the energy is left, 2 % of it: the
    // mean over a piece of ground is that of normal phases. Together 0.7 dB.
    EXPECT_NEAR(level / right[i], 1.0, 0.14 + 0.02 * energy[i] / right[i])
        << guide.times[i] << " s, energy alone " << db_from_power(energy[i] / right[i]) << " dB";
    furthest = std::max(furthest, std::abs(db_from_power(energy[i] / right[i])));
  }
  EXPECT_GT(furthest, 1.5);  // energy alone
}

// 400 pings: 4.9 sigma of an exponential's mean are 1.0 dB; and what the expected level may be off.
TEST_P(ReverberationGuide, ReceivedLevelIsThatOfAllImagesInPhase) {
  const auto& [guide, bounces] = GetParam();
  constexpr int pings = 400;
  const std::vector<double> right = truth(guide, true, std::min(bounces, enough));
  for (const ScattererSynthesis how :
       {ScattererSynthesis::streams, ScattererSynthesis::covariance}) {
    const bool by_covariance = how == ScattererSynthesis::covariance;
    if (by_covariance && guide.astern > 0.0) continue;  // source and array in one place, at rest
    Scenario s = scenario_of(guide, bounces, by_covariance ? 0.0 : 2.0);
    s.reverberation.synthesis = how;
    const Sea sea(s);
    std::vector<double> received(right.size(), 0.0);
    for (int ping = 1; ping <= pings; ++ping) {
      const Baseband b = sea.receive(static_cast<std::uint32_t>(ping));
      for (std::size_t i = 0; i < right.size(); ++i)
        received[i] += std::norm(at(b, 0, guide.times[i])) / pings;
    }
    for (std::size_t i = 0; i < right.size(); ++i)
      EXPECT_NEAR(db_from_power(received[i] / right[i]), 0.0, 1.5)
          << guide.times[i] << " s, " << (by_covariance ? "covariance" : "streams");
  }
}

INSTANTIATE_TEST_SUITE_P(Of, ReverberationGuide,
                         ::testing::Values(Case{loses, 5}, Case{loses, 40}, Case{keeps, 5},
                                           Case{keeps, 20}, Case{keeps, 40}, Case{one_place, 40},
                                           Case{deeper, 6}, Case{deeper, 30}),
                         [](const auto& of) {
                           return of.param.guide.name + std::to_string(of.param.bounces);
                         });

}  // namespace
}  // namespace asdic::detail
