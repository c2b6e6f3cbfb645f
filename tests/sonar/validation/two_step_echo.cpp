// Echoes of guides without loss, where pairs of paths are too many to be taken one by one: the
// sound at the target first. Against images of the source and of the phone in surface and bottom,
// summed pair by pair with the pulse itself, and against every pair of eigenrays gridded.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "sonar/echoes/two_step_echo.h"
#include "sonar/ping/ping.h"
#include "sonar/scenario/ping_bounds.h"
#include "sonar/scenario/sampling.h"
#include "sonar/synthesis/sound_synthesis.h"
#include "support/reverberant_sea.h"
#include "support/two_platforms.h"

namespace asdic::detail {
namespace {

constexpr double c = 1500.0;

/// Water over a rigid floor, a target between a source and three phones of another platform.
Scenario guide(double depth) {
  Scenario s = support::two_platforms();
  s.environment.bottom.depth = depth;
  s.environment.absorption = NoAbsorption{};
  s.platforms[0].track.start.position = {0.0, 0.0, 0.3 * depth};
  s.platforms[1].track.start.position = {300.0, -200.0, 0.55 * depth};
  s.targets = {{.name = "boat",
                .track = {.start = {.position = {900.0, 1200.0, 0.62 * depth}}},
                .strength_db = 5.0}};
  s.pulse = {.waveform = Lfm{.start_frequency = 450.0, .end_frequency = 550.0},
             .duration = 0.1,
             .window = PulseWindow::hann};
  s.propagation = {};
  s.propagation.direct_blast = false;
  s.pings.recording_duration = 3.5;
  s.pings.sample_rate = 4000.0;
  return s;
}

/// One path between two places in such a guide.
struct Image {
  double distance = 0.0;  // [m]
  double amplitude = 0.0;
};

/// All that arrive within a distance: the place mirrored about surface and bottom as often as may
/// be, −1 for each time in the surface.
std::vector<Image> images(const Vec3& from, const Vec3& to, double depth, double furthest) {
  std::vector<Image> found;
  const double across = (to - from).head<2>().norm();
  const auto most = static_cast<int>(furthest / (2.0 * depth)) + 2;
  for (int m = -most; m <= most; ++m)
    for (const int side : {1, -1}) {
      const double distance = std::hypot(across, 2.0 * m * depth + side * from.z() - to.z());
      const double sign = ((m % 2 == 0) == (side > 0)) ? 1.0 : -1.0;
      if (distance <= furthest) found.push_back({distance, sign / distance});
    }
  return found;
}

struct Received {
  Baseband sound;
  TargetEchoes echoes;
};

/// The echoes of a scenario's only target at the phones, and nothing else.
Received receive(const Scenario& s, std::size_t most_pairs) {
  const PropagationPaths paths(s.environment, s.transect);
  const Pulse pulse(s.pulse);
  const BeamPattern pattern(
      s.transmitters[0],
      paths.speed_at(s.platforms[0].track.at(0.0).position) / pulse.centre_frequency());
  const PingGeometry geometry(s, {}, 1);
  const EchoContext context{.paths = paths,
                            .geometry = geometry,
                            .pattern = pattern,
                            .frequency = pulse.centre_frequency(),
                            .pulse = &pulse,
                            .most_pairs = most_pairs,
                            .most_curved = std::numeric_limits<std::size_t>::max()};
  const Recording recording = recording_of(s);
  const double max_doppler = doppler_bound(s);
  const Synthesizer synthesizer(pulse, recording, max_doppler);
  const std::vector<Vec3> phones = phones_at(s, 0, 1, 0.0);
  Received received{.sound = {}, .echoes = target_echoes(context, 0)};
  std::vector<EchoPath> gridded = received.echoes.echoes;
  if (!received.echoes.at_phones.empty()) gridded = received.echoes.at_phones;
  gridded.insert(gridded.end(), received.echoes.scattered.begin(), received.echoes.scattered.end());
  if (received.echoes.many) gridded.clear();
  const bool wide = s.propagation.band == BandOfLosses::wide;
  received.sound =
      wide ? wide_band_sound(context, s.transmitters[0], gridded, phones, recording, max_doppler)
           : narrow_band_sound(synthesizer, gridded, phones);
  if (const auto& many = received.echoes.many) {
    TwoStepBand parts;
    if (wide)
      parts = two_step_band(context, s.transmitters[0], received.echoes.echoes, c * many->last,
                            recording, max_doppler);
    SeaDraws draws(s.seed);
    const Baseband more = two_step_echo(context, *many, {phones, many->at_phones}, recording,
                                        max_doppler, draws, parts);
    if (more.channels > 0) add_resampled(more, received.sound);
  }
  return received;
}

/// Root mean square of the difference between two records over that of the first [dB].
double difference_db(const Baseband& a, const Baseband& b) {
  double off = 0.0, all = 0.0;
  for (std::size_t n = 0; n < a.channels; ++n)
    for (std::size_t i = 0; i < a.recorded; ++i) {
      off += std::norm(std::complex<double>(a.channel(n)[i] - b.channel(n)[i]));
      all += std::norm(std::complex<double>(a.channel(n)[i]));
    }
  return db_from_power(off / all);
}

// Every pair of images, pulse by pulse, at every phone. Delays are the eigenrays' own (to 1 ns),
// the synthesis leaves out −90 dB of its loudest sound in either step.
TEST(TwoStepEcho, IsTheSumOfAllPairsOfImages) {
  constexpr double depth = 20.0;
  Scenario s = guide(depth);
  s.pulse.duration = 0.05;
  const PingSimulator simulator(s);
  const PingRecord record = simulator.sound(1);
  ASSERT_EQ(record.many_echoes.size(), 1);
  const Pulse& pulse = simulator.pulse();
  const double furthest = c * s.pings.recording_duration;
  const double scale = std::sqrt(2.0) * 1e-6 * amplitude_from_db(200.0 + 5.0);
  const Vec3 source = s.platforms[0].track.at(0.0).position,
             target = s.targets[0].track.at(0.0).position;
  const std::vector<Image> there = images(source, target, depth, furthest);
  std::size_t pairs = 0;
  const std::size_t samples = record.recording.samples;
  for (std::size_t n = 0; n < record.phones.size(); n += 2) {
    std::vector<double> exact(samples, 0.0);
    for (const Image& in : there)
      for (const Image& home : images(target, record.phones[n], depth, furthest - in.distance)) {
        const double delay = (in.distance + home.distance) / c;
        const auto first = static_cast<std::size_t>(std::ceil(delay * 4000.0));
        ++pairs;
        for (std::size_t i = first; i < samples && double(i) / 4000.0 < delay + pulse.duration();
             ++i)
          exact[i] +=
              (scale * in.amplitude * home.amplitude * pulse.analytic(double(i) / 4000.0 - delay))
                  .real();
      }
    double worst = 0.0, loudest = 0.0, late_off = 0.0, late = 0.0;
    for (std::size_t i = 0; i < samples; ++i) {
      const double off = double(record.pressure[n * samples + i]) - exact[i];
      worst = std::max(worst, std::abs(off));
      loudest = std::max(loudest, std::abs(exact[i]));
      if (i > samples * 3 / 4) late_off += off * off, late += exact[i] * exact[i];
    }
    EXPECT_LT(db_from_amplitude(worst / loudest), -70.0) << "phone " << n;
    EXPECT_LT(db_from_power(late_off / late), -50.0) << "phone " << n;
  }
  EXPECT_GT(pairs, 20'000);
  // What is listed: the loudest, and how many there are.
  EXPECT_LE(record.echoes.size(), 1000);
  EXPECT_NEAR(double(record.summary.at(0).paths), 0.5 * double(pairs), 0.01 * double(pairs));
  EXPECT_NEAR(record.summary.at(0).echo_peak_db, simulator.levels(1).summary.at(0).echo_peak_db,
              1e-9);
}

// Where few are taken in two steps all the same, and nothing moves, both are the same sound.
TEST(TwoStepEcho, IsWhatPairsAreAtRest) {
  Scenario s = guide(100.0);
  s.targets[0].heading = 2.6;
  s.targets[0].highlights = {{.offset = {30.0, 0.0, 0.0}, .strength_db = 3.0},
                             {.offset = {-20.0, 2.0, -5.0}, .strength_db = 6.0},
                             {.offset = {5.0, -4.0, 0.0}, .strength_db = 9.0}};  // hidden
  s.targets[0].hull = Hull{.length = 70.0, .beam = 8.0};
  const Received pairs = receive(s, 1'000'000), steps = receive(s, 0);
  ASSERT_TRUE(steps.echoes.many);
  EXPECT_FALSE(pairs.echoes.many);
  EXPECT_LT(difference_db(pairs.sound, steps.sound), -65.0);
  // The listed ones are among all, to the last bit.
  for (const EchoPath& one : steps.echoes.echoes) {
    bool found = false;
    for (const EchoPath& other : pairs.echoes.echoes)
      found =
          found || (one.outgoing == other.outgoing && one.returning == other.returning &&
                    one.highlight == other.highlight &&
                    one.received.delay == other.received.delay && one.level_db == other.level_db);
    EXPECT_TRUE(found) << one.outgoing << " " << one.returning;
  }
}

Scenario moving() {
  Scenario s = guide(100.0);
  s.platforms[0].track.start.velocity = {3.0, -2.0, 0.0};
  s.platforms[1].track.start.velocity = {-2.0, 4.0, 0.0};
  s.targets[0].track.start.velocity = {-6.0, 3.0, 0.3};
  s.targets[0].highlights = {{.offset = {30.0, 0.0, 0.0}, .strength_db = 3.0},
                             {.offset = {-20.0, 2.0, -5.0}, .strength_db = 6.0}};
  return s;
}

// Everything moves: phases are off by 0.02 rad at most where a segment ends, −34 dB.
TEST(TwoStepEcho, IsWhatPairsAreOnTheMove) {
  const Scenario s = moving();
  EXPECT_LT(difference_db(receive(s, 1'000'000).sound, receive(s, 0).sound), -36.0);
}

TEST(TwoStepEcho, IsWhatPairsAreForALongPulse) {
  Scenario s = moving();
  s.pulse.duration = 1.0;
  EXPECT_LT(difference_db(receive(s, 1'000'000).sound, receive(s, 0).sound), -36.0);
}

/// A pulse of a second on the move by a few hundred pairs, so that their delays curve.
Scenario curved() {
  Scenario s = moving();
  s.pulse.duration = 1.0;
  s.propagation.max_surface_bounces = s.propagation.max_bottom_bounces = 4;
  return s;
}

// Whether that is done depends on the paths alone: not on who listens, nor on how long.
TEST(TwoStepEcho, ServesCurvedPairsWhoeverListens) {
  Scenario s = curved();
  const PingSimulator simulator(s);
  const PingRecord record = simulator.sound(1);
  ASSERT_EQ(record.many_echoes.size(), 1);
  const std::size_t places = s.targets[0].highlights.size();
  EXPECT_GT(record.many_echoes[0].pairs, 128);
  EXPECT_EQ(record.echoes.size(), places * record.many_echoes[0].pairs);  // all are listed
  EXPECT_NEAR(record.summary.at(0).echo_peak_db, simulator.levels(1).summary.at(0).echo_peak_db,
              1e-9);
  s.pings.recording_duration += 1.0;
  const PingRecord longer = PingSimulator(s).sound(1);
  ASSERT_EQ(longer.many_echoes.size(), 1);
  const std::size_t samples = record.recording.samples, more = longer.recording.samples;
  double off = 0.0, all = 0.0;
  for (std::size_t n = 0; n < record.phones.size(); ++n)
    for (std::size_t i = 0; i < samples; ++i) {
      const double x = record.pressure[n * samples + i];
      off += std::pow(double(longer.pressure[n * more + i]) - x, 2), all += x * x;
    }
  EXPECT_LT(db_from_power(off / all), -60.0);
}

// A phone far from the others receives all of its echo, though it begins or ends beside theirs.
TEST(TwoStepEcho, ReachesPhonesFarApart) {
  Scenario s = curved();
  s.pulse.duration = 0.4;
  s.arrays[0].phones = {{-700.0, 0.0, 0.0}, {700.0, 0.0, 0.0}};
  const PingRecord record = PingSimulator(s).sound(1);
  ASSERT_EQ(record.many_echoes.size(), 1);
  const std::size_t samples = record.recording.samples;
  std::array<double, 2> energy{};
  for (std::size_t n = 0; n < 2; ++n)
    for (std::size_t i = 0; i < samples; ++i)
      energy[n] += std::pow(double(record.pressure[n * samples + i]), 2);
  const Baseband whole = receive(s, 0).sound;
  for (std::size_t n = 0; n < 2; ++n) {
    double there = 0.0;
    for (const auto& value : whole.channel(n).first(whole.recorded))
      there += double(std::norm(value));
    // of the analytic signal, over the pulse's peak at 1 m
    const double peak = std::sqrt(2.0) * 1e-6 * amplitude_from_db(200.0);
    const double expected = 0.5 * peak * peak * there / whole.sample_rate;
    EXPECT_NEAR(db_from_power(energy[n] / 4000.0 / expected), 0.0, 0.2) << n;
  }
}

// Absorption that changes by 14 dB over the band along the longest path.
TEST(TwoStepEcho, IsWhatPairsAreAcrossTheBand) {
  Scenario s = guide(100.0);
  s.environment.absorption = Thorp{};
  s.propagation.band = BandOfLosses::wide;
  s.pulse.waveform = Lfm{9000.0, 13000.0};
  s.pulse.duration = 0.02;
  s.pings.sample_rate = 40000.0;
  EXPECT_LT(difference_db(receive(s, 1'000'000).sound, receive(s, 0).sound), -60.0);
}

// The target turns while sound reaches it, and phones receive paths of their own. (It is as wide as
// it was: a pair has the heading of its leading edge, the sound at the target that of every
// moment.)
TEST(TwoStepEcho, IsWhatPairsAreInATurn) {
  Scenario s = moving();
  s.propagation.exact_per_phone = true;
  s.targets[0].heading = 0.5;
  s.targets[0].track.waypoints = {
      {0.0, {900.0, 1200.0, 62.0}}, {1.4, {892.0, 1204.0, 62.0}}, {9.0, {892.0, 1154.0, 62.0}}};
  EXPECT_LT(difference_db(receive(s, 1'000'000).sound, receive(s, 0).sound), -34.0);
}

// Eight phones of a hull at two depths on a shelf in summer, under way: waves differ from depth to
// depth, so the phones need paths of their own, which those at one depth share. Against paths to
// every phone, of which a quarter is asked for.
TEST(TwoStepEcho, PhonesAtOneDepthShareTheirPaths) {
  Scenario s = guide(120.0);
  const std::vector<double> depth = {0.0, 20.0, 35.0, 60.0, 120.0},
                            speed = {1521.0, 1520.0, 1501.0, 1494.0, 1493.0};
  s.environment.water = SoundSpeedProfile::table(depth, speed, Interpolation::pchip);
  s.environment.bottom.material =
      FluidHalfSpace{.speed = 1650.0, .density = 1900.0, .attenuation_db_per_wavelength = 0.8};
  s.platforms[0].track.start = {.position = {0.0, 0.0, 5.0}, .velocity = {0.0, 5.0, 0.0}};
  s.platforms[1].track.start = s.platforms[0].track.start;
  s.targets[0].track.start = {.position = {4330.0, 2500.0, 80.0}, .velocity = {-3.0, 0.0, 0.0}};
  s.pulse = {.waveform = Lfm{.start_frequency = 3450.0, .end_frequency = 3550.0},
             .duration = 0.5,
             .window = PulseWindow::hann};
  s.pings.recording_duration = 8.0;
  s.pings.sample_rate = 8000.0;
  s.propagation.band = BandOfLosses::automatic;
  std::vector<Vec3> positions;
  for (const double below : {0.0, 0.9})
    for (const double bearing : {0.0, 1.5, 3.0, 4.5})
      positions.emplace_back(std::sin(bearing), std::cos(bearing), below);
  s.arrays[0].phones = positions;
  const PingRecord shared = PingSimulator(s).sound(1);
  s.propagation.exact_per_phone = true;
  const PingRecord own = PingSimulator(s).sound(1);
  ASSERT_EQ(shared.many_echoes.size(), 1);
  ASSERT_TRUE(shared.many_echoes[0].at_phones);
  double off = 0.0, all = 0.0;
  for (std::size_t i = 0; i < own.pressure.size(); ++i) {
    off += std::pow(double(own.pressure[i]) - double(shared.pressure[i]), 2);
    all += std::pow(double(own.pressure[i]), 2);
  }
  EXPECT_LT(db_from_power(off / all), -30.0);
  const auto asked_for = [](const PingRecord& record) {
    return record.reuse.legs_searched + record.reuse.legs_reused;
  };
  EXPECT_LT(asked_for(shared), 0.5 * asked_for(own));
}

// A rough sea: mean and scattered intensity of either leg, drawn for each leg by itself. Energies
// alone can be the same; of 24 geometries.
TEST(TwoStepEcho, HasTheEnergyOfPairsUnderARoughSea) {
  double pairs = 0.0, steps = 0.0;
  for (int i = 0; i < 24; ++i) {
    Scenario s = guide(100.0);
    s.environment.surface.roughness = {
        .rms_height = pierson_moskowitz_height(9.0), .sea_wind = 9.0, .floor_db = -300.0};
    s.seed = static_cast<std::uint64_t>(i + 1);
    s.propagation.max_surface_bounces = s.propagation.max_bottom_bounces = 3;
    s.targets[0].track.start.position.x() += 31.0 * i;
    const auto energy = [](const Received& received) {
      double sum = 0.0;
      for (const std::complex<float>& x : received.sound.values)
        sum += std::norm(std::complex<double>(x));
      return sum;
    };
    pairs += energy(receive(s, 1'000'000));
    steps += energy(receive(s, 0));
  }
  EXPECT_NEAR(db_from_power(steps / pairs), 0.0, 1.0);
}

// Ten metres for half a minute: as loud as all images by energy, which a sum in phase is in the
// mean over many modes. 75 Hz lie from one's cut-off to the next: 27 are in the band, each as loud
// as the squares of sines at three depths; pairs of them, with a relative deviation of 1.5 each,
// stray by 4.3·1.5/√(27²) = 0.24 dB; three of that.
TEST(TwoStepEcho, TenMetresForHalfAMinuteAreAsLoudAsTheirImages) {
  constexpr double depth = 10.0;
  Scenario s = guide(depth);
  s.pulse.waveform = Lfm{4000.0, 6000.0};
  s.pulse.duration = 0.02;
  s.pings.recording_duration = 30.0;
  s.pings.sample_rate = 16000.0;
  const PingSimulator simulator(s);
  const PingRecord record = simulator.sound(1);
  ASSERT_EQ(record.many_echoes.size(), 1);
  EXPECT_GT(record.summary.at(0).paths, 1'000'000);
  EXPECT_LE(record.echoes.size(), 1000);
  // Work: sets of eigenrays that were asked for, where each pair asked for one and more.
  EXPECT_LT(record.reuse.legs_searched + record.reuse.legs_reused, 100);

  // Paths of as many bounces as were followed.
  const int most = record.many_echoes[0].followed.bottom;
  const auto followed = [&](const Vec3& from, const Vec3& to) {
    std::vector<Image> found;
    for (const Image& one : images(from, to, depth, 30.0 * c)) {
      const double rise =
          std::sqrt(std::max(0.0, std::pow(one.distance, 2) - (to - from).head<2>().squaredNorm()));
      if (rise <= 2.0 * depth * most) found.push_back(one);
    }
    return found;
  };
  const Vec3 target = s.targets[0].track.at(0.0).position;
  const std::vector<Image> there = followed(s.platforms[0].track.at(0.0).position, target),
                           home = followed(target, record.phones[1]);
  std::vector<double> energy(31, 0.0);  // by seconds
  const double of_pulse = simulator.pulse().energy() * power_from_db(205.0) * 1e-12;
  for (const Image& in : there)
    for (const Image& out : home)
      if (const double t = (in.distance + out.distance) / c; t < 30.0)
        energy[static_cast<std::size_t>(t)] += std::pow(in.amplitude * out.amplitude, 2) * of_pulse;
  const std::size_t samples = record.recording.samples;
  double ratio = 0.0;
  for (std::size_t second = 5; second < 15; ++second) {
    ASSERT_GT(energy[second], 0.0);
    double received = 0.0;
    for (std::size_t i = 16000 * second; i < 16000 * (second + 1); ++i)
      received += std::pow(double(record.pressure[samples + i]), 2) / 16000.0;
    ratio += received / energy[second] / 10.0;
  }
  EXPECT_NEAR(db_from_power(ratio), 0.0, 0.75);
}

}  // namespace
}  // namespace asdic::detail
