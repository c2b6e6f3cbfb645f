#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "reverb/power/reverberation_streams.h"
#include "sonar/ping/ping.h"
#include "support/reverberant_sea.h"
#include "support/sound_moments.h"

// Reverberation as streams of noise against closed forms, brute force and the plain sum over
// scatterers: power, covariance between phones, Doppler factors, fronts near by.
namespace asdic::detail {
namespace {

using support::cross_spectrum;
using Sea = support::ReverberantSea;

constexpr double c = 1500.0, depth = 500.0, speed = 4.0;

/// A vehicle that makes 4 m/s 500 m below the surface, no bounces.
Scenario under_way() {
  Scenario s = support::even_sea();
  s.platforms[0].track.start = {.position = {0.0, 0.0, depth},
                                .velocity = {0.6 * speed, 0.8 * speed, 0.0}};
  s.pulse = {.waveform = Cw{.frequency = 1000.0}, .duration = 0.12};
  s.pings.sample_rate = 4000.0;
  s.pings.recording_duration = 12.2;
  s.reverberation.synthesis = ScattererSynthesis::streams;
  s.arrays[0].phones = {Vec3::Zero(), Vec3(0.3, 0.4, 0.0), Vec3(-0.9, 0.5, 0.0),
                        Vec3(0.2, -0.7, 0.6)};
  return s;
}

/// What the streams received at a delay say: power [1/s], covariance between phones, moments of the
/// Doppler factors weighted with the power.
struct Said {
  double power = 0.0, doppler = 0.0, doppler2 = 0.0;
  Eigen::MatrixXcd covariance;
};

Said said(const ReverberationStreams& sea, double delay, const std::vector<Vec3>& phones,
          double frequency) {
  const auto n = static_cast<Eigen::Index>(phones.size());
  Said all{.covariance = Eigen::MatrixXcd::Zero(n, n)};
  const auto bin = static_cast<std::size_t>(delay / sea.bin);
  for (const auto& block : sea.blocks) {
    if (bin < block.begin || bin >= block.end) continue;
    for (std::size_t i = block.first; i < block.last; ++i) {
      const ReverberationStreams::Stream& stream = sea.streams[i];
      double before = 0.0;
      for (std::size_t j = 0; j < stream.parts; ++j) {
        const ReverberationStreams::Part& part = sea.parts[stream.first_part + j];
        const double power =
            (part.chance - before) * double(sea.intensity[stream.first + bin - block.begin]);
        before = part.chance;
        for (const auto& weight : part.weight) {
          Eigen::VectorXcd received = Eigen::VectorXcd::Zero(n);
          for (std::size_t wave = 0; wave < 2; ++wave)
            for (Eigen::Index p = 0; p < n; ++p) {
              // A sphere about a point so far away that it is what its curvature says. The mean of
              // slownesses on either side of a line tells how far along the line they point.
              const double radius = 1.0 / std::max(1e-9, part.curvature[wave]);
              const double length = std::max(1e-9, part.length[wave]);
              const Vec3 x = phones[std::size_t(p)];
              const double lag =
                  length *
                  (std::sqrt(radius * radius + 2.0 * radius * part.slowness[wave].dot(x) / length +
                             x.squaredNorm()) -
                   radius);
              received[p] += weight[wave] * std::polar(1.0, -2.0 * pi * frequency * lag);
            }
          all.covariance += power * received * received.adjoint();
        }
        all.power += power;
        all.doppler += power * (part.doppler - 1.0);
        all.doppler2 += power * (part.doppler - 1.0) * (part.doppler - 1.0);
      }
    }
  }
  all.covariance /= all.power;
  all.doppler /= all.power;
  all.doppler2 /= all.power;
  return all;
}

/// Intensity over delay of a vehicle at rest, 2π∫σR⁻³dR by dR = c/2 dτ [1/s].
double intensity(const Sea& sea, double delay) {
  const double slant = 0.5 * c * delay, grazing = std::asin(depth / slant);
  const double sigma = scattering_cross_section(
      sea.scenario().reverberation.surface,
      {.grazing_in = grazing, .grazing_out = grazing, .azimuth = pi}, 1000.0);
  return pi * c * sigma / (slant * slant * slant);
}

// Sound from all bearings at the elevation θ: covariance J₀(kd cos θ) times the phase of depth, as
// for a vehicle at rest but for the way that she makes (4 m/s × 12 s of 9 km: 0.3 % of cos θ, and
// of her own Doppler, 0.5 % of k). η = 1 + 2v cos θ cos φ/c: no mean, variance ½(2v cos θ/c)², less
// what lies within a part, (¼/T)²/12 of 14 Hz². Parts are 0.7 rad wide at the array's ends: of
// e^{iψ} across 1.3 rad between them the mean instead of all is off by 0.07, which neighbours share
// with either sign: 0.03. Power: bins and circles, 3 %. Blocks hold an eighth of their delay, over
// which sin θ of the phases of depth (4 rad × 0.6 m) changes by as much: 0.01.
// A sweep's cells of Doppler factors are wider, its parts still narrow.
void expect_bessel_function_of_places(const AnyWaveform& waveform) {
  Scenario s = under_way();
  s.pulse.waveform = waveform;
  s.pulse.duration = 0.5;
  const Sea sea(s);
  const PingReverberation ping = sea.ping(1);
  ASSERT_NE(ping.streams(), nullptr);
  const std::vector<Vec3>& x = s.arrays[0].phones;
  for (const double t : {3.0, 5.5, 9.0, 11.7}) {
    const Said all = said(*ping.streams(), t, x, 1000.0);
    const double sine = depth / (0.5 * c * t), cosine = std::sqrt(1.0 - sine * sine);
    for (std::size_t m = 0; m < x.size(); ++m)
      for (std::size_t n = 0; n < x.size(); ++n) {
        const Vec3 apart = x[m] - x[n];
        const std::complex<double> expected =
            std::cyl_bessel_j(0.0, 2.0 * pi * 1000.0 * apart.head<2>().norm() * cosine / c) *
            std::polar(1.0, -2.0 * pi * 1000.0 * apart.z() * sine / c);
        EXPECT_NEAR(std::abs(all.covariance(Eigen::Index(m), Eigen::Index(n)) - expected), 0.0,
                    0.04)
            << t << " " << m << n;
      }
    const double middle = (std::floor(t / ping.streams()->bin) + 0.5) * ping.streams()->bin;
    EXPECT_NEAR(all.power / intensity(sea, middle), 1.0, 0.03) << t;
    EXPECT_NEAR(all.doppler / (2.0 * speed / c), 0.0, 0.01) << t;
    const double widest = 2.0 * speed * cosine / c;
    EXPECT_NEAR(all.doppler2 / (0.5 * widest * widest), 1.0, 0.03) << t;
  }
}
TEST(ReverberationStreams, AreABesselFunctionOfPlacesAndTheAnnulusIntegral) {
  expect_bessel_function_of_places(Cw{.frequency = 1000.0});
}
TEST(ReverberationStreams, OfASweepAreABesselFunctionOfPlacesToo) {
  expect_bessel_function_of_places(Lfm{.start_frequency = 950.0, .end_frequency = 1050.0});
}

/// J₀(kd cos θ) of the level distance times the phase of depth, from the surface at a delay.
std::complex<double> azimuthally_symmetric(const Vec3& apart, double delay) {
  const double sine = depth / (0.5 * c * delay), cosine = std::sqrt(1.0 - sine * sine);
  return std::cyl_bessel_j(0.0, 2.0 * pi * 1000.0 * apart.head<2>().norm() * cosine / c) *
         std::polar(1.0, -2.0 * pi * 1000.0 * apart.z() * sine / c);
}

// An array with a shape for each ping: one set of streams holds the covariance of all of them,
// whichever of them asks for it, within the 0.04 of above. Made for one phone it must fail.
TEST(ReverberationStreams, ServeEveryShapeOfAnArray) {
  Scenario s = under_way();
  const std::vector<Vec3> straight = {Vec3(-1.2, 0.0, 0.0), Vec3(0.0, 0.0, 0.0),
                                      Vec3(1.2, 0.0, 0.0)};
  const std::vector<Vec3> bent = {Vec3(-1.0, -0.6, 0.2), Vec3(0.0, 0.0, 0.0),
                                  Vec3(1.0, -0.6, -0.2)};
  s.arrays[0].phones = straight;
  s.arrays[0].shapes = {straight, bent};
  Scenario point = s;
  point.arrays[0].phones = {Vec3::Zero()};
  point.arrays[0].shapes.clear();
  const Sea sea(s), other(point);
  const auto streams = sea.ping(1), of_point = other.ping(1);
  ASSERT_NE(streams.streams(), nullptr);
  ASSERT_NE(of_point.streams(), nullptr);
  for (const double t : {3.0, 5.5, 9.0})
    for (const std::vector<Vec3>& shape : s.arrays[0].shapes) {
      const Said all = said(*streams.streams(), t, shape, 1000.0);
      const Said wrong = said(*of_point.streams(), t, shape, 1000.0);
      double off = 0.0, wrong_by = 0.0;
      for (std::size_t m = 0; m < shape.size(); ++m)
        for (std::size_t n = 0; n < shape.size(); ++n) {
          const std::complex<double> expected = azimuthally_symmetric(shape[m] - shape[n], t);
          const auto i = Eigen::Index(m), j = Eigen::Index(n);
          off = std::max(off, std::abs(all.covariance(i, j) - expected));
          wrong_by = std::max(wrong_by, std::abs(wrong.covariance(i, j) - expected));
        }
      EXPECT_LT(off, 0.04) << t;
      EXPECT_GT(wrong_by, 0.1) << t;
    }
}

// Whatever the shape: vectors at right angles that hold it, no more than a tenth longer than a line
// is (2^(1/8)); lines that differ by a hundredth of a wavelength have one box.
TEST(ReverberationStreams, BoxesHoldTheirArrays) {
  constexpr double frequency = 1000.0;
  for (int turn = 0; turn < 24; ++turn) {
    const double heading = 0.05 + 0.26 * turn;
    const Vec3 along(std::sin(heading), std::cos(heading), 0.3 * std::sin(2.0 * heading));
    std::vector<Vec3> line, bent;
    for (int i = 0; i < 16; ++i) {
      line.push_back(0.75 * i * along);
      bent.push_back(line.back() +
                     Vec3(0.8 * std::sin(0.4 * i), 0.5 * std::cos(0.7 * i), 0.4 * std::cos(i)));
    }
    const std::array<std::vector<Vec3>, 2> shapes{line, bent};
    const auto box = ReverberationStreams::extents_of(shapes, frequency);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(box[i].dot(box[(i + 1) % 3]), 0.0, 1e-12);
      const double length = box[i].norm();
      ASSERT_GT(length, 0.0);
      for (const auto& shape : shapes)
        for (const Vec3& a : shape)
          for (const Vec3& b : shape) EXPECT_LE((a - b).dot(box[i]) / length, length * (1 + 1e-9));
    }
    const double length = (line.back() - line.front()).norm();
    const auto of_line = ReverberationStreams::extents_of({&shapes[0], 1}, frequency);
    EXPECT_GT(of_line[0].norm(), length * std::cos(0.05));
    EXPECT_LT(of_line[0].norm(), length * std::exp2(0.125) * (1 + 1e-9));
    // Askew by ½ rad at most: one cell of directions beside the line.
    for (std::size_t i = 1; i < 3; ++i)
      EXPECT_LT(pi * frequency / 1400.0 * of_line[i].norm(), 0.95);
  }
  std::vector<Vec3> line, shaken;
  for (int i = 0; i < 16; ++i) {
    line.emplace_back(0.75 * i, 0.3 * i, 0.0);
    shaken.push_back(line.back() + 0.015 * Vec3(std::sin(9.0 * i), std::cos(7.0 * i), 0.0));
  }
  const std::array<std::vector<Vec3>, 2> both{line, shaken};
  EXPECT_EQ(ReverberationStreams::extents_of({&both[0], 1}, frequency)[0],
            ReverberationStreams::extents_of({&both[1], 1}, frequency)[0]);
}

// One stream of known intensity, 1/s from 2 s to 3 s, a Doppler factor that is no whole number of
// bins and a slowness: ⟨|p|²⟩ = ∫I(τ)|s₊(t − τ)|²dτ, 3/8·T = 0.1875 within, half of it half a pulse
// from either edge, nothing before; its carrier is 2.3 Hz up, and a phone receives it s·x late.
// 2000 pings: 4.9/√2000 = 0.11 of power.
TEST(ReverberationStreams, AreTheirIntensityThroughThePulse) {
  Scenario s = under_way();
  s.pulse = {.waveform = Cw{.frequency = 1000.0}, .duration = 0.5, .window = PulseWindow::hann};
  const Recording recording{.sample_rate = 4000.0, .start = 0.0, .samples = 16'800};
  const Pulse pulse(s.pulse);
  const Synthesizer synthesizer(pulse, recording, 0.01);
  ReverberationStreams sea({}, {}, {.latest = 0.0});
  sea.bin = 0.05;
  sea.blocks = {{.begin = 37, .end = 65, .first = 0, .last = 1}};  // 1.85 s to 3.25 s
  sea.streams = {{.entity = 7, .first = 0, .first_part = 0, .parts = 1}};
  ReverberationStreams::Part part{.slowness = {Vec3(1.0 / 1500.0, 0.0, 0.0), Vec3::Zero()},
                                  .length = {1.0 / 1500.0, 0.0},
                                  .doppler = 1.0023};
  part.weight[0][0] = 1.0;
  sea.parts = {part};
  for (int bin = 37; bin < 65; ++bin) sea.intensity.push_back(bin >= 40 && bin < 60 ? 1.0F : 0.0F);
  const std::vector<Vec3> phones = {Vec3::Zero(), Vec3(0.3, 0.0, 0.0)};
  const std::array<double, 5> times{1.9, 2.25, 2.8, 3.25, 3.6};
  constexpr double on = 0.05;  // [s]
  std::array<double, 5> power{};
  std::complex<double> turned = 0.0, late = 0.0;
  constexpr int pings = 2000;
  for (std::uint32_t ping = 1; ping <= pings; ++ping) {
    Baseband received = synthesizer.silence(phones.size());
    synthesizer.add_streams(sea, phones, {.seed = 5, .ping = ping}, received);
    for (std::size_t i = 0; i < times.size(); ++i)
      power[i] += std::norm(support::at(received, 0, times[i])) / pings;
    const std::complex<double> now = support::at(received, 0, 2.8);
    turned += std::conj(now) * support::at(received, 0, 2.8 + on);
    late += std::conj(now) * support::at(received, 1, 2.8);
  }
  const std::array<double, 5> expected{0.0, 0.09375, 0.1875, 0.09375, 0.0};
  for (std::size_t i = 0; i < times.size(); ++i)
    EXPECT_NEAR(power[i], expected[i], 0.11 * expected[i] + 1e-5) << times[i];
  // Phases of a mean over 2000 with a coherence above 0.9: 4.9·√(1/ρ² − 1)/√(2·2000) = 0.04.
  EXPECT_NEAR(std::arg(turned), 2.0 * pi * 2.3 * on, 0.04 + 2.0 * pi * 0.06 * on);
  EXPECT_NEAR(std::arg(late), -2.0 * pi * 1002.3 * 0.3 / 1500.0, 0.02);
}

// What is asked of the memory beforehand holds what is kept, and not more than twenty times as
// much: they are sorted from cells that take more.
TEST(ReverberationStreams, TakeNoMoreMemoryThanWasAskedFor) {
  Scenario s = under_way();
  s.pulse.duration = 0.5;
  s.platforms[0].name = "ship";
  for (const double length : {0.5, 4.0, 16.0}) {
    s.arrays[0].phones.clear();
    for (int i = 0; i < 8; ++i) s.arrays[0].phones.emplace_back(length / 7.0 * i, 0.0, 0.0);
    const PingSimulator simulator(s);
    double asked = 0.0;
    const MemoryBudget memory = simulator.memory(1);
    for (const MemoryNeed& need : memory.needs())
      if (need.what.find("streams") != std::string::npos) asked += need.bytes;
    const Sea sea(s);
    const PingReverberation ping = sea.ping(1);
    ASSERT_NE(ping.streams(), nullptr);
    const auto taken = double(ping.streams()->bytes());
    EXPECT_GT(asked, taken) << length;
    EXPECT_LT(asked, 20.0 * taken) << length;
  }
}

TEST(ReverberationStreams, HaveTheMomentsOfThePlainSum) {
  Scenario s = under_way();
  s.propagation.max_surface_bounces = 1;
  s.propagation.max_bottom_bounces = 1;
  s.environment.bottom = {.depth = 1500.0, .material = Rigid{}};
  support::expect_moments_of_the_plain_sum(s);
}

// A tone of 1 s by a vehicle at 4 m/s: ±5.3 Hz. Windows of 2 s of 30 pings, 120 exponential
// samples, as in sonar_reverberation_covariance.cpp: a factor of 1.63 to either side. The same sea
// at rest must fail.
TEST(ReverberationStreams, HaveTheDopplerSpectrumOfThePlainSum) {
  Scenario s = under_way();
  s.pulse = {.waveform = Cw{.frequency = 1000.0}, .duration = 1.0};
  s.arrays[0].phones = {Vec3::Zero()};
  Scenario plain = s, still = s;
  plain.reverberation.synthesis = ScattererSynthesis::scatterers;
  still.platforms[0].track.start.velocity.setZero();
  std::vector<Baseband> one, other, wrong;
  const Sea as_streams(s), one_by_one(plain), at_rest(still);
  for (std::uint32_t ping = 1; ping <= 120; ++ping) {
    one.push_back(as_streams.receive(ping));
    other.push_back(one_by_one.receive(ping));
    wrong.push_back(at_rest.receive(ping));
  }
  double furthest = 0.0;
  for (double f = -6.0; f <= 6.0; f += 0.5) {
    const auto at = [&](const std::vector<Baseband>& received) {
      return cross_spectrum(received, 0, 0, 3.5, 12.0, 2.0, f).real();
    };
    EXPECT_NEAR(std::log(at(one) / at(other)), 0.0, std::log(1.32)) << f;
    furthest = std::max(furthest, std::abs(std::log(at(wrong) / at(other))));
  }
  EXPECT_GT(furthest, std::log(1.32));
}

// A sweep over 100 Hz by a vehicle at 20 m/s: ±27 Hz of Doppler in cells of 2 Hz where a tone of 1
// s has cells of 0.75 Hz, and less than two thirds of its streams. Phones' covariances and the
// spectrum with its edges are those of the plain sum: 160 exponential samples each, 4.9·√(2/160) of
// a logarithm. At rest the edges lie elsewhere, which must fail.
TEST(ReverberationStreams, OfASweepHaveTheMomentsAndTheSpectrumOfThePlainSum) {
  Scenario s = under_way();
  s.platforms[0].track.start.velocity = {0.6 * 20.0, 0.8 * 20.0, 0.0};
  s.pulse = {.waveform = Lfm{.start_frequency = 950.0, .end_frequency = 1050.0}, .duration = 1.0};
  Scenario tone = s;
  tone.pulse.waveform = Cw{.frequency = 1050.0};
  const std::size_t of_tone = Sea(tone).ping(1).streams()->streams.size();
  EXPECT_LT(3 * Sea(s).ping(1).streams()->streams.size(), 2 * of_tone);
  support::expect_moments_of_the_plain_sum(s);
  s.arrays[0].phones = {Vec3::Zero()};
  Scenario plain = s, still = s;
  plain.reverberation.synthesis = ScattererSynthesis::scatterers;
  still.platforms[0].track.start.velocity.setZero();
  std::vector<Baseband> one, other, wrong;
  const Sea as_streams(s), one_by_one(plain), at_rest(still);
  for (std::uint32_t ping = 1; ping <= 40; ++ping) {
    one.push_back(as_streams.receive(ping));
    other.push_back(one_by_one.receive(ping));
    wrong.push_back(at_rest.receive(ping));
  }
  const double allowed = 4.9 * std::sqrt(2.0 / 160.0);
  double furthest = 0.0;
  for (double f = -70.0; f <= 70.0; f += 4.0) {
    const auto at = [&](const std::vector<Baseband>& received) {
      return cross_spectrum(received, 0, 0, 3.5, 12.0, 2.0, f).real();
    };
    EXPECT_NEAR(std::log(at(one) / at(other)), 0.0, allowed) << f;
    furthest = std::max(furthest, std::abs(std::log(at(wrong) / at(other))));
  }
  EXPECT_GT(furthest, allowed);
}

// Phones up to 40 m apart, scatterers from 525 m away: fronts are spheres, whose ends lie
// k·x²/8R up to 1.6 rad behind. Against the sum over the surface, each place with its own distance
// to either phone. The mean over a part 1.3 rad wide between the ends is off by 0.07 of it. Plane
// waves must fail.
TEST(ReverberationStreams, FrontsNearByAreSpheres) {
  Scenario s = under_way();
  s.platforms[0].track.start.velocity.setZero();
  s.arrays[0].phones = {Vec3::Zero(), Vec3(16.0, -12.0, 3.0), Vec3(-16.0, 12.0, 0.0)};
  s.pings.recording_duration = 4.0;
  const Sea sea(s);
  const PingReverberation ping = sea.ping(1);
  ASSERT_NE(ping.streams(), nullptr);
  ReverberationStreams flat = *ping.streams();
  for (auto& part : flat.parts) part.curvature = {0.0, 0.0};
  const std::vector<Vec3>& x = s.arrays[0].phones;
  double most = 0.0;
  for (const double t : {0.70, 0.74, 0.8, 1.0}) {
    const double bin = ping.streams()->bin, from = std::floor(t / bin) * bin;
    Eigen::MatrixXcd sum = Eigen::MatrixXcd::Zero(3, 3);
    double power = 0.0;
    constexpr int parts = 60, bearings = 1440;
    for (int i = 0; i < parts; ++i) {
      const double slant = 0.5 * c * (from + (i + 0.5) / parts * bin);
      const double level = std::sqrt(slant * slant - depth * depth);
      for (int j = 0; j < bearings; ++j) {
        const double towards = 2.0 * pi * j / bearings;
        const Vec3 place(level * std::sin(towards), level * std::cos(towards), -depth);
        Eigen::VectorXcd received(3);
        for (Eigen::Index p = 0; p < 3; ++p)
          received[p] = std::polar(
              1.0, -2.0 * pi * 1000.0 / c * ((place - x[std::size_t(p)]).norm() - slant));
        sum += received * received.adjoint();
        power += 1.0;
      }
    }
    const auto off = [&](const ReverberationStreams& streams) {
      return (said(streams, t, x, 1000.0).covariance - sum / power).cwiseAbs().maxCoeff();
    };
    EXPECT_LT(off(*ping.streams()), 0.07) << t;
    most = std::max(most, off(flat));
  }
  EXPECT_GT(most, 0.12);
}

// Waves that come and go: shares of the power above and below the sound's own frequency.
TEST(ReverberationStreams, BraggLinesHaveTheirShares) {
  Scenario s = under_way();
  s.platforms[0].track.start.velocity.setZero();
  s.pulse.duration = 1.0;  // the lines are 1.4 Hz off
  s.reverberation.surface_field.motion = {.kind = ScattererMotion::Kind::bragg,
                                          .receding_share = 0.2};
  const Sea sea(s);
  const PingReverberation ping = sea.ping(1);
  ASSERT_NE(ping.streams(), nullptr);
  const double frequency = sea.pulse().centre_frequency();
  double low = 0.0, all = 0.0;
  for (const auto& block : ping.streams()->blocks)
    for (std::size_t i = block.first; i < block.last; ++i)
      for (std::size_t bin = block.begin; bin < block.end; ++bin) {
        const auto& stream = ping.streams()->streams[i];
        const double power = double(ping.streams()->intensity[stream.first + bin - block.begin]);
        const double shift = (ping.streams()->parts[stream.first_part].doppler - 1.0) * frequency;
        if (std::abs(shift) < 1.0) continue;  // from overhead, where the lines are one
        all += power;
        if (shift < 0.0) low += power;
      }
  EXPECT_NEAR(low / all, 0.2, 1e-3);
}

// They serve whoever moves and receives where the sea forgets from ping to ping; what it remembers
// is received one scatterer after the other.
TEST(ReverberationStreams, ServeSeasThatForget) {
  const auto with = [](auto&& change) {
    Scenario s = under_way();
    change(s);
    return Sea(s).ping(1).streams() != nullptr;
  };
  EXPECT_TRUE(with([](Scenario&) {}));
  EXPECT_TRUE(with([](Scenario& s) { s.reverberation.surface_field.motion.current.x() = 0.1; }));
  EXPECT_TRUE(with([](Scenario& s) {
    s.platforms.push_back(s.platforms[0]);
    s.platforms[1].track.start.position.x() += 100.0;
    s.arrays[0].platform = 1;
  }));
  EXPECT_FALSE(
      with([](Scenario& s) { s.reverberation.surface_field.statistics.coherence_time = 10.0; }));
  const auto frozen = [](Scenario& s) {
    s.reverberation.surface_field.statistics.coherence_time = infinity;
  };
  EXPECT_FALSE(with(frozen));
  EXPECT_TRUE(with([&](Scenario& s) {
    frozen(s);
    s.platforms[0].track.start.velocity.setZero();
  }));
  EXPECT_FALSE(with([](Scenario& s) { s.reverberation.surface_field.statistics.k_shape = 1.0; }));
  EXPECT_FALSE(with([](Scenario& s) {
    s.reverberation.surface_field.motion = {.kind = ScattererMotion::Kind::spread,
                                            .speed_rms = 0.5};
  }));
  EXPECT_FALSE(with([](Scenario& s) { s.arrays.push_back(s.arrays[0]); }));
  EXPECT_FALSE(
      with([](Scenario& s) { s.reverberation.synthesis = ScattererSynthesis::scatterers; }));
}

// Whoever receives one ping of a sea cannot tell whether it will change: it is drawn as one that
// does, to the last bit. Where several pings or arrays receive it, or it has a texture, it stays
// what it is.
TEST(ReverberationStreams, AFrozenSeaThatIsReceivedOnceIsAFreshOne) {
  Scenario fresh = under_way();
  fresh.pings.recording_duration = 3.0;
  Scenario frozen = fresh;
  frozen.reverberation.surface_field.statistics.coherence_time = infinity;
  const auto received = [](const Scenario& s, bool once) {
    PingSimulator simulator(s);
    if (once) simulator.receives_one_ping();
    return simulator.simulate(1).pressure;
  };
  const std::vector<float> expected = received(fresh, false);
  EXPECT_EQ(received(frozen, true), expected);
  EXPECT_EQ(received(fresh, true), expected);
  EXPECT_NE(received(frozen, false), expected);
  frozen.reverberation.synthesis = ScattererSynthesis::scatterers;
  EXPECT_EQ(received(frozen, true), received(frozen, false));
  frozen.reverberation.synthesis = ScattererSynthesis::streams;
  frozen.arrays.push_back(frozen.arrays[0]);
  EXPECT_EQ(received(frozen, true), received(frozen, false));
}

// A sonar at rest receives the same sums of a frozen sea with every ping: the noise of streams
// stays. Beside a surface that does not stay, pings differ by what the surface alone does, to the
// streams of 1e-5 of the power that are left out.
TEST(ReverberationStreams, AFrozenSeaStaysWhereNobodyMoves) {
  Scenario s = under_way();
  s.platforms[0].track.start.velocity.setZero();
  s.environment.bottom.depth = 900.0;
  s.pings.recording_duration = 3.0;
  s.pings.count = 2;
  s.reverberation.bottom = Lambert{.mu_db = -10.0};
  s.reverberation.bottom_field.statistics.coherence_time = infinity;
  const auto change = [](const Scenario& of) -> Eigen::VectorXf {
    const PingSimulator simulator(of);
    const std::vector<float> first = simulator.simulate(1).pressure,
                             second = simulator.simulate(2).pressure;
    const auto n = static_cast<Eigen::Index>(first.size());
    const Eigen::Map<const Eigen::VectorXf> a(first.data(), n), b(second.data(), n);
    EXPECT_GT(a.norm(), 0.0F);
    return b - a;
  };
  Scenario both = s, surface = s, fresh = s;
  both.reverberation.surface_field.statistics.coherence_time = infinity;
  surface.reverberation.bottom.reset();
  fresh.reverberation.bottom_field.statistics.coherence_time = 0.0;
  EXPECT_EQ(change(both).norm(), 0.0F);
  const Eigen::VectorXf of_surface = change(surface);
  EXPECT_LT((change(s) - of_surface).norm(), 0.02F * of_surface.norm());
  EXPECT_GT((change(fresh) - of_surface).norm(), 0.02F * of_surface.norm());
}

// A frozen sea of too many scatterers for one by one, of which a sonar that goes on receives other
// sums with every ping, is a fresh one too, and says so. One that lies still keeps its weights, and
// so does a sea of few, one with a texture and one that several arrays compare.
TEST(ReverberationStreams, AFrozenSeaOfTooManyIsDrawnAnewUnderWay) {
  Scenario frozen = under_way();
  frozen.pings.recording_duration = 3.0;
  frozen.reverberation.most_returns = 1000;
  frozen.reverberation.azimuths = 144;
  frozen.reverberation.synthesis = ScattererSynthesis::automatic;
  Scenario fresh = frozen;
  frozen.reverberation.surface_field.statistics.coherence_time = infinity;
  const auto ping = [](const Scenario& s) { return PingSimulator(s).simulate(1); };
  const PingRecord anew = ping(frozen), drawn = ping(fresh);
  EXPECT_TRUE(anew.sea_drawn_anew);
  EXPECT_EQ(anew.pressure, drawn.pressure);
  EXPECT_FALSE(drawn.sea_drawn_anew);
  const auto keeps = [&](auto&& change) {
    Scenario s = frozen;
    change(s);
    const PingRecord kept = ping(s);
    return !kept.sea_drawn_anew && kept.pressure != drawn.pressure;
  };
  EXPECT_TRUE(keeps([](Scenario& s) { s.platforms[0].track.start.velocity.setZero(); }));
  EXPECT_TRUE(keeps([](Scenario& s) { s.pings.interval = 0.01; }));
  EXPECT_TRUE(keeps([](Scenario& s) { s.reverberation.most_returns = 100'000'000; }));
  EXPECT_TRUE(keeps([](Scenario& s) { s.reverberation.surface_field.statistics.k_shape = 1.0; }));
  EXPECT_TRUE(keeps([](Scenario& s) { s.arrays.push_back(s.arrays[0]); }));
  EXPECT_TRUE(
      keeps([](Scenario& s) { s.reverberation.synthesis = ScattererSynthesis::scatterers; }));
  Scenario often = frozen;
  often.transmitters[0].interval = 0.01;
  EXPECT_FALSE(ping(often).sea_drawn_anew);
}

// Blocks of delays that were over before the record begins are not in it, and take nothing: 60
// pings of 6 times and 2 phones, whose mean is known to 4.9 sigma = 26 %.
TEST(ReverberationStreams, ARecordMayBeginLate) {
  Scenario s = under_way();
  const double end = s.pings.recording_start + s.pings.recording_duration;
  const auto power = [&](double start) {
    s.pings.recording_start = start;
    s.pings.recording_duration = end - start;
    const Sea sea(s);
    double sum = 0.0;
    for (std::uint32_t ping = 1; ping <= 60; ++ping) {
      const Baseband received = sea.receive(ping);
      for (int i = 1; i <= 6; ++i)
        for (const std::size_t phone : {std::size_t{0}, s.arrays[0].phones.size() - 1})
          sum += std::norm(support::at(received, phone, end - 0.12 * i));
    }
    return sum;
  };
  EXPECT_NEAR(power(end - 0.9) / power(0.0), 1.0, 4.9 * std::sqrt(2.0 / (60.0 * 6.0 * 2.0)));
}

// One thread or several, propagation known or not: the same bits. Another ping, another seed:
// others.
TEST(ReverberationStreams, BitsDoNotDependOnThreadsOrOnWhatIsKept) {
  Scenario s = under_way();
  s.pings.count = 2;
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
  EXPECT_NE(PingSimulator(s, shared).simulate(2).pressure, alone);
  s.seed = 2;
  EXPECT_NE(PingSimulator(s, shared).simulate(1).pressure, alone);
}

}  // namespace
}  // namespace asdic::detail
