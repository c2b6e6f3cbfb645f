// Reverberation as a ship receives it that changes her velocity between the ping and its return.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/received_spectrum.h"
#include "support/reverberant_sea.h"

namespace asdic::detail {
namespace {

using support::ridge, support::spectrum;
using Sea = support::ReverberantSea;

constexpr double c = 1500.0, speed = 6.0, depth = 300.0;  // m/s, m/s, m

Scenario ship(double frequency) {
  Scenario s = support::even_sea();
  s.pulse = {.waveform = Cw{.frequency = frequency}, .duration = 1.0};
  s.pings.sample_rate = 8000.0;
  s.pings.recording_duration = 11.0;
  return s;
}

/// At rest until `start`, then to the east.
Track starting(double start) {
  const Vec3 here(0.0, 0.0, depth);
  return {.start = {},
          .waypoints = {{.time = 0.0, .position = here},
                        {.time = start, .position = here},
                        {.time = start + 20.0, .position = here + Vec3(20.0 * speed, 0.0, 0.0)}}};
}

constexpr double rate_of_turn = 4.0 * pi / 180.0;  // [rad/s], to port

/// From the east to the north on a circle, in steps of a quarter of a second.
Track turning() {
  const double radius = speed / rate_of_turn;
  Track track;
  for (double t = 0.0; t < 20.0; t += 0.25)
    track.waypoints.push_back({.time = t,
                               .position = {radius * std::sin(rate_of_turn * t),
                                            radius * (1.0 - std::cos(rate_of_turn * t)), depth}});
  return track;
}

// A ship at rest while she sends, then under way: what she receives before she moves has no
// Doppler, what she receives afterwards v·sin(beam)·cos θ/λ, once, for only the receiver moves: 4.8
// Hz where the velocity of the ping would say 0. A line of 32 phones along her way, windows of 1 s:
// one bin.
TEST(ReverberationTurning, AShipThatStartsToMoveReceivesTheRidgeOfHerWay) {
  Scenario s = ship(1500.0);
  s.platforms[0].track = starting(4.0);
  s.arrays[0] = line_array(32, 0.5, 0.5 * pi, 0.0);
  const Sea sea(s);
  EXPECT_FALSE(ReverberationCovariance::serves(sea.ping(1).fields().front()));
  std::vector<double> frequencies;
  for (double f = -10.0; f <= 10.0; f += 0.25) frequencies.push_back(f);
  const auto ridge_of = [&](double sine, double from, double to) {
    std::vector<std::complex<double>> beam;
    for (std::size_t n = 0; n < 32; ++n)
      beam.push_back(std::polar(0.5 - 0.5 * std::cos(2.0 * pi * (double(n) + 0.5) / 32.0),
                                -2.0 * pi * sine * s.arrays[0].phones[n].x()));
    std::vector<double> power(frequencies.size());
    for (std::uint32_t ping = 1; ping <= 4; ++ping) {
      const Baseband received = sea.receive(ping);
      for (double t = from; t < to; t += 1.0) {
        const auto more = spectrum(received, beam, t, t + 1.0, frequencies);
        for (std::size_t k = 0; k < more.size(); ++k) power[k] += more[k] * t * t * t;
      }
    }
    return ridge(power, frequencies);
  };
  for (const double sine : {0.8, 0.0, -0.8}) {
    EXPECT_NEAR(ridge_of(sine, 1.9, 3.0), 0.0, 1.0) << sine;
    EXPECT_NEAR(ridge_of(sine, 5.5, 9.0), speed * sine, 1.0) << sine;  // λ = 1 m
  }
}

// A ship in a turn who speaks to the north alone: v·(sin ωt + sin ωT/2)/λ, the ping's middle and
// what she makes good to the north when she receives it. In 3 degrees to either side her way to the
// east spreads that by 2v/λ·sin 3° = ±1.3 Hz, of 12 pings' mean 0.2 Hz. A bin of 1 Hz; her first
// course says 0.
TEST(ReverberationTurning, ATurningShipReceivesTheRidgeTurn) {
  Scenario s = ship(3000.0);
  s.platforms[0].track = turning();
  s.reverberation.azimuths = 120;
  const Sea sea(s, std::make_unique<support::Sector>(radians(3.0)));
  std::vector<double> frequencies;
  for (double f = -14.0; f <= 14.0; f += 0.25) frequencies.push_back(f);
  const std::complex<double> one = 1.0;
  for (const double from : {2.0, 4.0, 6.0, 8.0}) {
    std::vector<double> power(frequencies.size());
    for (std::uint32_t ping = 1; ping <= 12; ++ping) {
      const auto more = spectrum(sea.receive(ping), {&one, 1}, from, from + 1.0, frequencies);
      for (std::size_t k = 0; k < more.size(); ++k) power[k] += more[k];
    }
    const double middle = from + 0.5;
    const double level = std::cos(std::asin(depth / (0.5 * c * (middle - 0.5))));
    const double north = std::sin(rate_of_turn * middle) + std::sin(rate_of_turn * 0.5);
    EXPECT_NEAR(ridge(power, frequencies), speed * north * level / 0.5, 1.0) << from;
  }
}

// Return by return: the place on the surface that each comes from, along its direction from where
// the way of its middle, drawn back, has the ship when it begins, is where the pulse's middle was
// scattered: |S − p| + |p − R| is c times what has passed, with her places at T/2 and when the
// middle is received, and its Doppler factor is that of her two velocities there.
// Directions are read where she is 63 m/c = 0.04 s off the right time, 0.25 m, perhaps on the next
// leg of a turn, 0.05 m, and in the middle of rings of 0.2 m: 0.4 m out and back, 0.54 ms; the
// ping's own velocity would be 40 ms off. Doppler: v/c = 0.004 times 3 m/1000 m at either end, what
// she makes in T/2.
TEST(ReverberationTurning, EveryReturnHasTheDelayAndDopplerOfItsOwnTime) {
  for (const Track& track : {starting(4.0), turning()}) {
    Scenario s = ship(1500.0);
    s.platforms[0].track = track;
    s.reverberation.ground_spacing = 0.2;
    s.reverberation.azimuths = 3;
    s.reverberation.resolve_azimuth = false;
    const Sea sea(s);
    const PingReverberation ping = sea.ping(1);
    const std::vector<DopplerSpan> spans = ping.dopplers();
    const double half = 0.5 * s.pulse.duration;
    const Kinematics source = track.at(half);
    double worst_delay = 0.0, worst_doppler = 0.0;
    std::size_t count = 0;
    for (const Return& r : ping.returns()) {
      const double middle = r.delay + half / r.doppler;
      const auto turns_then = [&](const Waypoint& w) { return std::abs(w.time - middle) < 0.01; };
      if (std::any_of(track.waypoints.begin(), track.waypoints.end(), turns_then)) continue;
      const Kinematics receiver = track.at(middle);
      const Vec3 towards = -c * r.slowness;
      const Vec3 begun = receiver.position - half / r.doppler * receiver.velocity;
      const Vec3 place = begun - depth / towards.z() * towards;
      if ((place - receiver.position).norm() < 1000.0) continue;
      const Vec3 out = place - source.position;
      const double received = half + (out.norm() + (place - receiver.position).norm()) / c;
      worst_delay = std::max(worst_delay, std::abs(received - middle));
      const double doppler = (1.0 - receiver.velocity.dot(r.slowness)) /
                             (1.0 - source.velocity.dot(out) / (c * out.norm()));
      worst_doppler = std::max(worst_doppler, std::abs(doppler - r.doppler));
      EXPECT_TRUE(std::any_of(spans.begin(), spans.end(), [&](const DopplerSpan& span) {
        return r.doppler >= span.lowest && r.doppler <= span.highest;
      }));
      ++count;
    }
    EXPECT_GT(count, 1000U);
    EXPECT_LT(worst_delay, 5.4e-4);
    EXPECT_LT(worst_doppler, 2.4e-5);
  }
}

}  // namespace
}  // namespace asdic::detail
