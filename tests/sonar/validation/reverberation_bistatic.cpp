// The level of a bistatic pair, and of a fan whatever its rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "support/reverberant_sea.h"

namespace asdic::detail {
namespace {

using support::at;
using Sea = support::ReverberantSea;

constexpr double c = 1500.0, duration = 0.12;
const Vec3 source(0.0, 0.0, 1000.0), receiver(4000.0, 1500.0, 2000.0);

/// Two platforms 4.3 km apart in 3 km of even water, four phones that receive seas of their own.
Scenario pair_of_platforms() {
  Scenario s = support::even_sea();
  s.environment.bottom.depth = 3000.0;
  s.platforms = {{}, {}};
  s.platforms[0].track.start.position = source;
  s.platforms[1].track.start.position = receiver;
  s.arrays[0].platform = 1;
  s.arrays[0].phones = {Vec3::Zero(), Vec3(40, 0, 0), Vec3(0, 40, 0), Vec3(-40, -30, 10)};
  s.pulse = {.duration = duration};
  s.reverberation.azimuths = 72;
  s.reverberation.resolve_azimuth = false;  // no beams here
  s.pings.recording_duration = 7.4;
  return s;
}

/// Cosine of the angle between two ways on the map.
double cosine_of_turn(const Vec3& in, const Vec3& out) {
  const double lengths = in.head<2>().norm() * out.head<2>().norm();
  return lengths > 0.0 ? in.head<2>().dot(out.head<2>()) / lengths : 1.0;
}

/// What a plane at a depth makes of the pulse at times t, per source of unit pressure at 1 m: ∫∫
/// σ(θ_in, θ_out, cos φ)·w²(t − (R_a + R_b)/c)/(R_a²R_b²) dx dy, w a Hann window; sums over squares
/// of 10 m, whose delays differ by a tenth of the window, within which w² is smooth to its second
/// derivative. \param monostatic  a wrong model: both ends in the middle between them
template <class Law, std::size_t n>
std::array<double, n> plane(double depth, const std::array<double, n>& times, Law&& law,
                            bool monostatic = false) {
  const Vec3 middle = 0.5 * (source + receiver);
  const Vec3 a = monostatic ? middle : source, b = monostatic ? middle : receiver;
  const double latest = times.back(), step = 10.0;
  std::array<double, n> sum{};
  for (double x = -3700.0; x < 7700.0; x += step)
    for (double y = -4900.0; y < 6400.0; y += step) {
      const Vec3 place(x, y, depth);
      const double out = (place - a).norm(), back = (place - b).norm(), delay = (out + back) / c;
      if (delay >= latest) continue;
      const double power =
          law(std::asin(std::abs(depth - a.z()) / out), std::asin(std::abs(depth - b.z()) / back),
              cosine_of_turn(place - a, b - place)) *
          step * step / (out * out * back * back);
      for (std::size_t i = 0; i < n; ++i) {
        const double since = times[i] - delay;
        if (since <= 0.0 || since >= duration) continue;
        const double window = 0.5 - 0.5 * std::cos(2.0 * pi * since / duration);
        sum[i] += power * window * window;
      }
    }
  return sum;
}

constexpr std::size_t moments = 24;
std::array<double, moments> times() {
  std::array<double, moments> t{};
  for (std::size_t i = 0; i < moments; ++i) t[i] = 4.0 + 0.135 * double(i);
  return t;
}

/// Mean of |b|²/expected, of 30 pings.
double normalised_mean(const Sea& sea, const std::array<double, moments>& expected) {
  constexpr int pings = 30;
  const std::array<double, moments> t = times();
  double sum = 0.0;
  for (std::uint32_t ping = 1; ping <= pings; ++ping) {
    const Baseband received = sea.receive(ping);
    for (std::size_t i = 0; i < moments; ++i)
      for (std::size_t phone = 0; phone < 4; ++phone)
        sum += std::norm(at(received, phone, t[i])) / expected[i] / (4.0 * pings * moments);
  }
  return sum;
}

// 30 pings of 24 times and 4 phones are 2880 exponentials: their mean to 0.019, 4.9 sigma 0.091 =
// 0.4 dB. The expected level on cell centres, a sum over some 3000 of them in an ellipse's width,
// each off by no more than its delay is: 0.1 dB. A monostatic sonar in the middle is more than that
// 0.4 dB off on the mean.
template <class Law>
void expect_level(const Scenario& s, double depth, Law&& law) {
  const Sea sea(s);
  const std::array<double, moments> t = times(), expected = plane(depth, t, law),
                                    wrong = plane(depth, t, law, true);
  EXPECT_NEAR(normalised_mean(sea, expected), 1.0, 4.9 / std::sqrt(30.0 * moments * 4.0));
  const PingReverberation ping = sea.ping(1);
  double off = 0.0;
  for (std::size_t i = 0; i < moments; ++i) {
    EXPECT_NEAR(ping.expected_db(t[i]), 220.0 + db_from_power(expected[i]), 0.1) << t[i];
    off += wrong[i] / expected[i] / double(moments);
  }
  EXPECT_GT(std::abs(db_from_power(off)), 0.4);
}

/// One by one or as streams.
class BistaticReverberation : public ::testing::TestWithParam<ScattererSynthesis> {
 protected:
  [[nodiscard]] static Scenario pair() {
    Scenario s = pair_of_platforms();
    s.reverberation.synthesis = GetParam();
    // An array so wide has tens of thousands of streams.
    if (GetParam() == ScattererSynthesis::streams)
      for (Vec3& phone : s.arrays[0].phones) phone *= 0.25;
    return s;
  }
};
INSTANTIATE_TEST_SUITE_P(Synthesis, BistaticReverberation,
                         ::testing::Values(ScattererSynthesis::scatterers,
                                           ScattererSynthesis::streams),
                         [](const auto& how) {
                           return how.param == ScattererSynthesis::streams ? "streams"
                                                                           : "scatterers";
                         });

TEST_P(BistaticReverberation, LambertBottomIsTheGroundIntegral) {
  Scenario s = pair();
  s.reverberation.surface_scatters = false;
  s.reverberation.bottom = Lambert{.mu_db = -27.0};
  s.reverberation.bottom_field.statistics.coherence_time = 0.0;
  expect_level(s, 3000.0, [](double in, double out, double) {
    return power_from_db(-27.0) * std::sin(in) * std::sin(out);
  });
}

// Chapman and Harris (1962) by both grazing angles, √(θ_in θ_out): 3.3β log₁₀(θ°/30) − 42.4
// log₁₀ β + 2.6 dB, β = 158 (v f^{1/3})^{−0.58}, v in knots; no more than 0 dB.
TEST_P(BistaticReverberation, ChapmanHarrisSurfaceIsTheGroundIntegral) {
  Scenario s = pair();
  s.wind_speed = 10.0;
  s.reverberation.surface = ChapmanHarris{};
  const double beta = 158.0 * std::pow(10.0 * 3600.0 / 1852.0 * std::cbrt(4000.0), -0.58);
  expect_level(s, 0.0, [beta](double in, double out, double) {
    const double degrees = std::sqrt(in * out) * 180.0 / pi;
    const double db = 3.3 * beta * std::log10(degrees / 30.0) - 42.4 * std::log10(beta) + 2.6;
    return std::min(1.0, power_from_db(db));
  });
}

// Facets of a floor that mirror the source to the receiver (Ellis & Crowe, J. Acoust. Soc. Am. 89,
// 2207, 1991): σ = μ sin θ_in sin θ_out + ν(1 + Δ)² exp(−Δ/2s²), Δ = (cos² θ_in + cos² θ_out −
// 2 cos θ_in cos θ_out cos φ)/(sin θ_in + sin θ_out)². The first of it comes out of a lobe that is
// much narrower than one of eight sectors. Sectors taken as a whole are 4.5 dB off.
TEST_P(BistaticReverberation, FacetsMirrorIntoANarrowLobe) {
  for (const double slope_deg : {1.0, 4.0}) {
    SCOPED_TRACE(slope_deg);
    Scenario s = pair();
    s.reverberation.surface_scatters = false;
    s.reverberation.azimuths = 8;
    s.reverberation.bottom = EllisCrowe{.mu_db = -40.0, .nu_db = 0.0, .slope_deg = slope_deg};
    s.reverberation.bottom_field.statistics.coherence_time = 0.0;
    const auto law = [slope_deg](double in, double out, double cosine) {
      const double slope = std::tan(slope_deg * pi / 180.0), sines = std::sin(in) + std::sin(out);
      const double tilt = (std::pow(std::cos(in), 2) + std::pow(std::cos(out), 2) -
                           2.0 * std::cos(in) * std::cos(out) * cosine) /
                          (sines * sines);
      return 1e-4 * std::sin(in) * std::sin(out) +
             std::pow(1.0 + tilt, 2) * std::exp(-tilt / (2.0 * slope * slope));
    };
    std::array<double, 6> early{};
    for (std::size_t i = 0; i < early.size(); ++i) early[i] = 3.52 + 0.03 * double(i);
    const auto expected = plane(3000.0, early, law);
    const Sea sea(s);
    const PingReverberation ping = sea.ping(1);
    // The pulse's edge is left out: there 1 ms of delay within a piece is 0.7 dB.
    const double faintest = 0.1 * *std::max_element(expected.begin(), expected.end());
    for (std::size_t i = 0; i < early.size(); ++i)
      if (expected[i] > faintest) {
        EXPECT_NEAR(ping.expected_db(early[i]), 220.0 + db_from_power(expected[i]), 0.3)
            << early[i];
      }
    // One by one, few places make the lobe.
    if (GetParam() != ScattererSynthesis::streams) continue;
    constexpr int pings = 30;
    double mean = 0.0;
    for (std::uint32_t n = 1; n <= pings; ++n) {
      const Baseband received = sea.receive(n);
      for (std::size_t i = 0; i < early.size(); ++i)
        for (std::size_t phone = 0; phone < 4; ++phone)
          mean += std::norm(at(received, phone, early[i])) / expected[i] / (4.0 * pings * 6.0);
    }
    // Moments a quarter of a pulse apart: two values of each phone.
    EXPECT_NEAR(mean, 1.0, 4.9 / std::sqrt(2.0 * pings * 4.0));
  }
}

/// The coherence of what two receivers on platforms of their own receive, from 6.3 to 12.1 s of 30
/// pings, weighed for the spreading. \param pairs  adds the number of pairs of samples
double coherence(const Scenario& s, int one, int other, double& pairs) {
  const Sea sea(s);
  std::complex<double> cross = 0.0;
  double first = 0.0, second = 0.0;
  for (std::uint32_t number = 1; number <= 30; ++number) {
    const Baseband received = sea.receive(sea.ping(number, 0.0, one).returns()),
                   there = sea.receive(sea.ping(number, 0.0, other).returns());
    for (double t = 6.3; t < 12.1; t += duration, pairs += 1.0) {
      const auto a = at(received, 0, t), b = at(there, 0, t);
      const double weight = t * t * t;
      cross += weight * std::conj(a) * b;
      first += weight * std::norm(a);
      second += weight * std::norm(b);
    }
  }
  return (cross / std::sqrt(first * second)).real();
}

/// A vehicle at 500 m that sends and receives, and receivers of one phone at places of their own.
Scenario vehicle_and_receivers(const std::vector<Vec3>& places) {
  Scenario s = support::even_sea();
  s.pulse = {.duration = duration};
  s.platforms[0].track.start.position.z() = 500.0;
  for (const Vec3& place : places) {
    s.arrays.push_back(s.arrays[0]);
    s.arrays.back().platform = int(s.platforms.size());
    s.platforms.push_back(s.platforms[0]);
    s.platforms.back().track.start.position += place;
  }
  s.reverberation.azimuths = 36;
  s.pings.recording_start = 6.0;
  s.pings.recording_duration = 6.2;
  return s;
}

/// Van Cittert and Zernike's J₀(kd cos θ) at 4 kHz, 500 m below the surface, 9 s after the ping.
double far_surface(double apart) {
  return std::cyl_bessel_j(
      0.0, 2.0 * pi * 4000.0 / c * apart * std::cos(std::asin(500.0 / (0.5 * c * 9.0))));
}

// Receivers on two platforms a fraction of a wavelength apart receive one sea, as two phones of one
// array do. They are a metre from the vehicle: not in its own place. N = 30·49 samples of two
// Gaussians, 4.9 sigma 0.09; seas of their own would have 0.
TEST(BistaticSeas, TwoPlatformsBesideEachOtherReceiveOneSea) {
  for (const double apart : {0.05, 0.1}) {
    double pairs = 0.0;
    const Scenario s = vehicle_and_receivers({Vec3(1.0, 0.0, 0.0), Vec3(1.0 + apart, 0.0, 0.0)});
    const double found = coherence(s, 1, 2, pairs);
    EXPECT_NEAR(found, far_surface(apart), 4.9 / std::sqrt(2.0 * pairs));
  }
}

// Nor does it matter where they are: these two have the lattice's border between the middles of
// their pairs, half a pitch (an eighth of the field's radius) from the vehicle, and a strip in
// which one sea goes over into the next around them. Seen from them the ground is lit by an ellipse
// of eccentricity e = 1144/(1500·9), uneven over bearing by terms of e, which J₀ does not see, and
// e².
TEST(BistaticSeas, NoBorderIsReceivedBetweenTwoPlatforms) {
  constexpr double pitch = 0.5 * c * 12.2 / 8.0, apart = 0.1;
  const Scenario s = vehicle_and_receivers(
      {Vec3(pitch - 0.5 * apart, 0.0, 0.0), Vec3(pitch + 0.5 * apart, 0.0, 0.0)});
  const Sea sea(s);
  EXPECT_NE(sea.ping(1, 0.0, 1).fields().front().grid.identity,
            sea.ping(1, 0.0, 2).fields().front().grid.identity);
  double pairs = 0.0;
  EXPECT_NEAR(coherence(s, 1, 2, pairs), far_surface(apart), 4.9 / std::sqrt(2.0 * pairs));
}

// Rays are no scatterers: with the fan's edges at 75 and at 62 degrees all rays between them are
// others, and fewer by a sixth; the ground under the sonar alone, which only the steeper fan
// reaches, may tell. Marched over a slope and by the layered table; the vehicle 300 m above a floor
// of some 900 m, from 2 s on, grazing below 25 degrees. Level to 0.05 dB: hundredths of a cell in
// range (`hits_on_cells`).
TEST(BistaticSeas, LevelDoesNotDependOnTheFansRays) {
  for (const bool slope : {false, true}) {
    Scenario s = support::even_sea();
    s.environment.bottom = {.depth = 900.0, .material = Rigid{}};
    if (slope)
      s.environment.bottom.shape =
          BoundaryShape(std::vector{0.0, 12000.0}, std::vector{900.0, 700.0},
                        ShapeInterpolation::piecewise_linear);
    s.platforms[0].track.start.position = {0.0, 0.0, 600.0};
    s.pulse = {.duration = duration};
    s.reverberation.bottom = Lambert{};
    s.pings.recording_duration = 7.0;
    s.propagation.max_launch_angle = radians(75.0);
    const Sea wide(s);
    s.propagation.max_launch_angle = radians(62.0);
    const Sea narrow(s);
    const PingReverberation one = wide.ping(1), other = narrow.ping(1);
    for (double t = 2.5; t < 6.9; t += 0.3)
      EXPECT_NEAR(one.expected_db(t), other.expected_db(t), 0.05) << t << ' ' << slope;
  }
}

}  // namespace
}  // namespace asdic::detail
