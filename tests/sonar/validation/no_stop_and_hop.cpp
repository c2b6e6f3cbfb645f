// An echo in open water whose source, target and phone all move, against s(t − τ(t)) itself: for
// every sample the moment when that sound was sent is solved for from straight rays, iteration by
// iteration, with nothing expanded.
#include <gtest/gtest.h>

#include <cmath>

#include "sonar/ping/ping.h"
#include "support/two_platforms.h"

namespace asdic::detail {
namespace {

constexpr double c = 1500.0;

/// The solution t of t = from + |x(t) − place|/c.
template <class Place>
double met(const Vec3& place, double from, const Place& x) {
  double t = from;
  for (int i = 0; i < 8; ++i) t = from + (x(t) - place).norm() / c;
  return t;
}

struct Motion {
  Scenario scenario;

  [[nodiscard]] double received(double sent, const Vec3& phone, double* struck = nullptr) const {
    const Scenario& s = scenario;
    const auto target = [&](double t) { return s.targets[0].track.at(t).position; };
    const auto array = [&](double t) -> Vec3 { return array_at(s, 0, t).position + phone; };
    const double there = met(transmitter_at(s, 0, sent).position, sent, target);
    if (struck != nullptr) *struck = there;
    return met(target(there), there, array);
  }

  /// Inverse of received() by bisection between two moments of the pulse.
  [[nodiscard]] double sent(double when, const Vec3& phone, double duration) const {
    double low = -0.1 * duration, high = 1.1 * duration;
    for (int i = 0; i < 45; ++i) {
      const double middle = 0.5 * (low + high);
      (received(middle, phone) < when ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
};

/// Largest difference of the record from the direct evaluation over its loudest sample [dB].
/// \param corner  moment of the pulse that meets a turn: samples near it are left out
double error_db(const Motion& motion, bool constant_doppler = false, double corner = infinity) {
  const Scenario& s = motion.scenario;
  const PingSimulator simulator(s);
  const Pulse& pulse = simulator.pulse();
  PingRecord record = simulator.sound(1);
  if (constant_doppler) {  // what was done before: the wrong model
    Returns straight;
    for (const EchoPath& echo : record.echoes) straight.push_back(echo.received);
    const Synthesizer synthesizer(pulse, record.recording, 0.1);
    std::fill(record.pressure.begin(), record.pressure.end(), 0.0F);
    synthesizer.add_samples(synthesizer.baseband(straight, s.arrays[0].phones),
                            std::sqrt(2.0) * 1e-6 * amplitude_from_db(200.0), record.pressure);
  }
  const std::complex<double> amplitude =
      record.echoes.at(0).received.amplitude * std::sqrt(2.0) * 1e-6 * amplitude_from_db(200.0);
  double worst = 0.0, loudest = 0.0;
  const std::size_t n = record.recording.samples;
  for (std::size_t channel = 0; channel < s.arrays[0].phones.size(); ++channel)
    for (std::size_t i = 0; i < n; i += 29) {
      const double t = record.recording.start + double(i) / record.recording.sample_rate;
      const double sent = motion.sent(t, s.arrays[0].phones[channel], pulse.duration());
      if (std::abs(sent - corner) < 0.1) continue;
      const double exact = (amplitude * pulse.analytic(sent)).real();
      loudest = std::max(loudest, std::abs(exact));
      worst = std::max(worst, std::abs(exact - double(record.pressure[channel * n + i])));
    }
  return db_from_amplitude(worst / loudest);
}

Motion fast_crossing() {
  Scenario s = support::two_platforms();
  s.platforms[0].track.start = {.position = {0.0, 0.0, 100.0}, .velocity = {3.0, 4.0, 0.0}};
  s.platforms[1].track.start = {.position = {200.0, -300.0, 120.0}, .velocity = {-2.0, 6.0, 0.0}};
  s.targets = {
      {.name = "torpedo",
       .track = {.start = {.position = {900.0, 500.0, 300.0}, .velocity = {-10.0, 18.0, 1.0}}}}};
  s.propagation.direct_blast = false;
  s.pulse.duration = 1.0;
  s.pings.recording_start = 1.0;
  s.pings.recording_duration = 2.0;
  return {s};
}

// Phases are followed to 1e-3 rad (negligible_phase) and delays to 1e-9 s, 6e-6 rad; the plane wave
// over 0.5 m at 1 km leaves d²/(2rc)·2πf = 5e-4 rad: together below −55 dB. A Hann LFM of 1 s.
TEST(NoStopAndHop, AFastCrossingTargetIsStretchedContinuously) {
  const Motion motion = fast_crossing();
  EXPECT_LT(error_db(motion), -55.0);
  // κ = Σv²/(rc) ≈ 20²/(1000·1500)·2: ½κT²·2πf ≈ 1.7 rad. A constant factor must fail.
  EXPECT_GT(error_db(motion, true), -20.0);
}

TEST(NoStopAndHop, BasebandAndADownSweepDoNotMatter) {
  Motion motion = fast_crossing();
  auto& sweep = std::get<Lfm>(motion.scenario.pulse.waveform);
  std::swap(sweep.start_frequency, sweep.end_frequency);
  EXPECT_LT(error_db(motion), -55.0);
}

// The target turns while the pulse passes it: a corner in the delay, between two cubics. The
// phones' anti-alias filter rounds the step of 20 Hz in frequency within some 20/width of it (width
// 180 Hz).
TEST(NoStopAndHop, ATurnDuringThePulseIsACornerOfTheDelay) {
  Motion motion = fast_crossing();
  double struck = 0.0;
  static_cast<void>(motion.received(0.4, Vec3::Zero(), &struck));
  const Vec3 corner(900.0, 500.0, 300.0);
  motion.scenario.targets[0].track.waypoints = {{struck - 50.0, corner - Vec3(-10, 18, 1) * 50.0},
                                                {struck, corner},
                                                {struck + 50.0, corner + Vec3(15, 5, 0) * 50.0}};
  double low = 0.0, high = 1.0;  // when what strikes the corner was sent
  for (int i = 0; i < 45; ++i) {
    const double middle = 0.5 * (low + high);
    double when = 0.0;
    static_cast<void>(motion.received(middle, Vec3::Zero(), &when));
    (when < struck ? low : high) = middle;
  }
  EXPECT_LT(error_db(motion, false, low), -55.0);
  EXPECT_GT(error_db(motion, true, low), -3.0);
}

// A long tone of a slow vehicle far away needs none of this: the fast synthesis takes it.
TEST(NoStopAndHop, AConstantFactorIsKeptWhereItIsEnough) {
  Motion motion = fast_crossing();
  Scenario& s = motion.scenario;
  s.targets[0].track.start.velocity = {0.02, 0.01, 0.0};
  for (Platform& p : s.platforms) p.track.start.velocity.setZero();
  EXPECT_FALSE(PingSimulator(s).sound(1).echoes.at(0).curve.has_value());
  EXPECT_LT(error_db(motion), -55.0);
  EXPECT_TRUE(PingSimulator(fast_crossing().scenario).sound(1).echoes.at(0).curve.has_value());
}

// The ping itself, between two ships that pass each other 120 m apart.
TEST(NoStopAndHop, TheDirectBlastIsStretchedAsWell) {
  Scenario s = support::two_platforms();
  s.platforms[0].track.start = {.position = {0.0, 0.0, 50.0}, .velocity = {0.0, 10.0, 0.0}};
  s.platforms[1].track.start = {.position = {120.0, 5.0, 50.0}, .velocity = {0.0, -10.0, 0.0}};
  s.pulse.duration = 1.0;
  const PingSimulator simulator(s);
  const PingRecord record = simulator.sound(1);
  const Pulse& pulse = simulator.pulse();
  const double distance = Vec3(120.0, 5.0, 0.0).norm();
  double worst = 0.0, loudest = 0.0;
  for (std::size_t i = 0; i < record.recording.samples; i += 3) {
    const double t = double(i) / record.recording.sample_rate;
    double low = -1.0, high = 2.0;
    for (int k = 0; k < 60; ++k) {
      const double sent = 0.5 * (low + high);
      const Vec3 phone = array_at(s, 0, t).position + s.arrays[0].phones[1];
      (sent + (phone - transmitter_at(s, 0, sent).position).norm() / c < t ? low : high) = sent;
    }
    const double exact = (pulse.analytic(low) * std::sqrt(2.0) * 1e-6 * 1e10 / distance).real();
    loudest = std::max(loudest, std::abs(exact));
    worst =
        std::max(worst, std::abs(exact - double(record.pressure[record.recording.samples + i])));
  }
  // The spreading changes by 20 m/s·5 m/120² a second and is kept at the leading edge's: 1.4 %.
  EXPECT_LT(db_from_amplitude(worst / loudest), -35.0);
}

}  // namespace
}  // namespace asdic::detail
