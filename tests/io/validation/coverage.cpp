// The picture of the area against closed forms, sums done here, and pings' own levels.
#include "processing/coverage/coverage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/geometry.h"
#include "io/scenario/scenario_reader.h"
#include "processing/coverage/coverage_of_scenario.h"
#include "processing/detection_threshold.h"
#include "raytrace/paths/boundary_paths.h"
#include "sonar/noise/noise_spectrum.h"
#include "sonar/signal/pulse_coherence.h"

namespace asdic::detail {
namespace {

/// Straight rays without bounces in water 2000 m deep, over a bottom of Lambert's law.
constexpr const char* straight = R"(
[environment]
wind_speed = 5.0
[environment.sound_speed]
kind = "isovelocity"
speed = 1500.0
[environment.bottom]
depth = 2000.0
kind = "fluid"
[environment.absorption]
kind = "none"
[platform]
position = [100.0, -50.0, 200.0]
[transmitter]
source_level_db = 220.0
taper = "omnidirectional"
[pulse]
kind = "lfm"
start_frequency = 1450.0
end_frequency = 1550.0
duration = 0.1
window = "none"
[array]
kind = "horizontal"
phones = 1
spacing = 0.5
[noise]
spectral_level_db = 50.0
[reverberation]
[reverberation.surface]
enabled = false
[reverberation.bottom]
kind = "lambert"
mu_db = -27.0
[propagation]
max_surface_bounces = 0
max_bottom_bounces = 0
[pings]
recording_duration = 20.0
sample_rate = 8000.0
)";

Scenario scenario(const std::string& text, std::vector<std::string> changes = {}) {
  return parse_scenario(text, "area.toml", changes);
}

CoverageSettings small(double depth, double reach, int ranges, int bearings = 12) {
  return {.bearings = bearings, .ranges = ranges, .reach = reach, .depths = {depth}};
}

// EL = SL + TS − 40 lg R; RL of the ring that sends back at the same delay t = 2R/c, straight down
// H below: dA/dt = 2πR·c/2, each square metre μ·sin²θ/R⁴ with sin θ = H/R, times ∫|s|²dt.
TEST(Coverage, OfStraightRaysOverALambertBottom) {
  const PingSimulator simulator(scenario(straight));
  const Coverage found = coverage(simulator, small(200.0, 12e3, 60));
  const CoverageLayer& layer = found.layers.front();
  const Pulse& pulse = simulator.pulse();
  const double noise =
      noise_band_db(simulator.scenario().noise, pulse.centre_frequency(), pulse.bandwidth_40db());
  constexpr double height = 1800.0, speed = 1500.0;
  for (std::size_t i = 2; i < found.ranges.size(); ++i)
    for (const std::size_t j : {0U, 7U}) {
      const std::size_t cell = j * found.ranges.size() + i;
      const double range = found.ranges[i];
      EXPECT_NEAR(double(layer.echo_db[cell]), 220.0 + 10.0 - 40.0 * std::log10(range), 0.05)
          << range;
      EXPECT_NEAR(double(layer.two_way_loss_db[cell]), 40.0 * std::log10(range), 0.05) << range;
      EXPECT_NEAR(double(layer.delay[cell]), 2.0 * range / speed, 1e-5 * range) << range;
      EXPECT_NEAR(double(layer.noise_db[cell]), noise, 1e-3);
      if (range < 1.3 * height) continue;  // within a pulse of the first reverberation
      const double sine = height / range;
      const double density = pi * speed * power_from_db(-27.0) * sine * sine / std::pow(range, 3);
      // Over the bins of delay and the pulse, on a curve that falls as R⁻⁵.
      EXPECT_NEAR(double(layer.reverberation_db[cell]),
                  220.0 + db_from_power(density * pulse.energy()), 0.1)
          << range;
      // One formula of the levels.
      const double background = db_from_power(
          power_from_db(double(layer.reverberation_db[cell]) - found.gain.reverberation_db) +
          power_from_db(double(layer.noise_db[cell]) - found.gain.noise_db));
      const double snr = double(layer.echo_db[cell]) - background;
      EXPECT_NEAR(double(layer.signal_excess_db[cell]), snr - found.threshold_db, 1e-3);
      EXPECT_NEAR(double(layer.detection_probability[cell]),
                  detection_probability(power_from_db(snr), 1e-4, 24.0), 1e-3);
      EXPECT_EQ(layer.certainty[cell], std::int8_t(CoverageCertainty::sure));
      EXPECT_NEAR(double(found.bottom_depth[cell]), 2000.0, 1e-3);
    }
}

/// ∫|S(f + ½ν)|²|S(f − ½ν)|²g(f)df over ∫|S|⁴df: what the matched filter of a pulse passes of even
/// sound that is shifted by ν against its replica, g(f) what a beam hears at f from the centre.
class FilterOf {
 public:
  explicit FilterOf(const Pulse& pulse) : pulse_(pulse) {
    for (int k = 0; k < lines; ++k) {
      at_[std::size_t(k)] = (k + 0.5 - lines / 2) * step();
      power_[std::size_t(k)] = power(at_[std::size_t(k)]);
      whole_ += power_[std::size_t(k)] * power_[std::size_t(k)];
    }
  }
  template <class Heard>
  [[nodiscard]] double passes(double shift, const Heard& heard) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < lines; ++k)
      sum += (shift == 0.0 ? power_[k] * power_[k]
                           : power(at_[k] + 0.5 * shift) * power(at_[k] - 0.5 * shift)) *
             heard(at_[k]);
    return sum / whole_;
  }

 private:
  static constexpr int lines = 64;
  [[nodiscard]] double step() const { return 1.2 * pulse_.bandwidth_99() / lines; }
  /// |S|² by its definition.
  [[nodiscard]] double power(double from_centre) const {
    std::complex<double> sum = 0.0;
    const int steps = std::max(64, int(6.0 * pulse_.bandwidth_99() * pulse_.duration()));
    for (int i = 0; i < steps; ++i) {
      const double t = (i + 0.5) / steps * pulse_.duration();
      sum += pulse_.analytic(t) *
             std::polar(1.0, -2.0 * pi * (pulse_.centre_frequency() + from_centre) * t);
    }
    return std::norm(sum / double(steps));
  }

  const Pulse& pulse_;
  std::array<double, lines> at_ = {}, power_ = {};
  double whole_ = 0.0;
};

/// |w·e|² of phones half a wavelength apart at 1500 Hz, over the difference of cosines.
double lobe_of(int phones, double difference, double from_centre) {
  const double half = 0.25 * 2.0 * pi * difference * (1500.0 + from_centre) / 1500.0;
  const double x =
      std::abs(std::sin(half)) < 1e-9 ? 1.0 : std::sin(phones * half) / (phones * std::sin(half));
  return x * x;
}

// What a line receives of sound that comes from all bearings alike under one angle is the mean of
// its beam over them: left and right together. Noise alike from phone to phone: 10 lg n.
TEST(Coverage, ABeamOfALineHearsBothItsSides) {
  const PingSimulator simulator(
      scenario(straight, {"array.phones=12", "array.spacing=0.5", "array.heading_deg=20"}));
  const PingSimulator one(scenario(straight));
  const CoverageSettings settings = small(200.0, 12e3, 24, 36);
  const Coverage found = coverage(simulator, settings), open = coverage(one, settings);
  const Vec3 axis = direction(radians(20.0), 0.0);
  const FilterOf filter(simulator.pulse());
  double loudest = -infinity, quietest = infinity;
  for (std::size_t j = 0; j < found.bearings.size(); ++j)
    for (const std::size_t i : {10U, 16U, 23U}) {
      const std::size_t cell = j * found.ranges.size() + i;
      const double elevation = -std::asin(1800.0 / found.ranges[i]);
      double mean = 0.0;
      constexpr int steps = 500;
      for (int k = 0; k < steps; ++k) {
        const double off = axis.dot(direction(2.0 * pi * (k + 0.5) / steps, elevation) -
                                    direction(found.bearings[j], 0.0));
        mean += filter.passes(0.0, [&](double f) { return lobe_of(12, off, f); }) / steps;
      }
      const double gained = double(found.layers[0].reverberation_db[cell]) -
                            double(open.layers[0].reverberation_db[cell]);
      // Elevations lie between nodes some degrees apart.
      EXPECT_NEAR(gained, db_from_power(mean), 0.3) << j << ' ' << i;
      EXPECT_NEAR(double(found.layers[0].noise_db[cell]),
                  double(open.layers[0].noise_db[cell]) - db_from_power(12.0), 1e-3);
      loudest = std::max(loudest, gained);
      quietest = std::min(quietest, gained);
    }
  // At endfire the main lobe is wide: another beam hears more.
  EXPECT_GT(loudest, quietest + 2.0);
}

// A long line looks along itself at a target in its own depth. The bottom's sound comes from below
// and behind: in the sidelobes. Half a wavelength apart at the middle of the sweep, phones hear
// what is behind in the upper half of it as if it came from ahead.
TEST(Coverage, ALongLineHearsTheBottomInItsSidelobes) {
  const PingSimulator simulator(scenario(straight, {"array.phones=96", "array.spacing=0.5"}));
  const PingSimulator one(scenario(straight));
  const CoverageSettings settings = small(200.0, 12e3, 60, 36);
  const Coverage found = coverage(simulator, settings), open = coverage(one, settings);
  const FilterOf filter(simulator.pulse());
  double most = 0.0;
  for (const std::size_t i : {20U, 24U, 28U, 36U, 44U, 54U}) {
    const double cosine = std::sqrt(1.0 - std::pow(1800.0 / found.ranges[i], 2));
    const double looks = std::cos(found.bearings[0]);
    double mean = 0.0, at_centre = 0.0;
    constexpr int steps = 4000;
    for (int k = 0; k < steps; ++k) {
      const double off = std::cos(2.0 * pi * k / steps) * cosine - looks;
      mean += filter.passes(0.0, [&](double f) { return lobe_of(96, off, f); }) / steps;
      at_centre += lobe_of(96, off, 0.0) / steps;
    }
    const double gained =
        double(found.layers[0].reverberation_db[i]) - double(open.layers[0].reverberation_db[i]);
    // Two elevations in a lobe, straight between them: that is told.
    EXPECT_NEAR(gained, db_from_power(mean), 1.0) << found.ranges[i];
    EXPECT_GT(double(found.layers[0].reverberation_uncertainty_db[i]), 0.75) << found.ranges[i];
    most = std::max(most, db_from_power(mean / at_centre));
  }
  EXPECT_GT(most, 4.0);  // the beam at the centre alone must fail
}

// Under way the replica is that of what rests where the beam looks: of other directions a part
// passes. A tone's filter and one phone; a sweep, and a line ahead, abeam and astern.
TEST(Coverage, AShipUnderWayHearsWhatItsFilterPasses) {
  constexpr double speed = 8.0, height = 1800.0;
  const auto differs = [&](const std::vector<std::string>& changes, int phones, double tolerance) {
    std::vector<std::string> under_way = changes;
    under_way.emplace_back("platform.velocity=[0,8,0]");
    const CoverageSettings settings = small(200.0, 12e3, 60, 36);
    const PingSimulator simulator(scenario(straight, under_way));
    const Coverage found = coverage(simulator, settings);
    const Coverage rest = coverage(PingSimulator(scenario(straight, changes)), settings);
    const FilterOf filter(simulator.pulse());
    constexpr int bearings = 180;
    double most = 0.0;
    for (const std::size_t j : {0U, 9U, 18U})
      for (const std::size_t i : {20U, 44U}) {
        const double cosine = std::sqrt(1.0 - std::pow(height / found.ranges[i], 2));
        const double looks = std::cos(found.bearings[j]);
        double now = 0.0, before = 0.0;
        for (int k = 0; k < bearings; ++k) {
          const double off = std::cos(2.0 * pi * (k + 0.5) / bearings) * cosine - looks;
          const auto heard = [&](double f) { return phones > 1 ? lobe_of(phones, off, f) : 1.0; };
          now += filter.passes(2.0 * speed / 1500.0 * 1500.0 * off, heard);
          before += filter.passes(0.0, heard);
        }
        const double truth = db_from_power(now / before);
        const std::size_t cell = j * found.ranges.size() + i;
        EXPECT_NEAR(double(found.layers[0].reverberation_db[cell]) -
                        double(rest.layers[0].reverberation_db[cell]),
                    truth, tolerance)
            << j << ' ' << i;
        most = std::max(most, std::abs(truth));
      }
    return most;
  };
  const std::string tone = R"(pulse={kind="cw",frequency=1500.0,duration=0.5,window="hann"})";
  EXPECT_GT(differs({tone}, 1, 0.5), 5.0);
  EXPECT_GT(differs({"array.phones=32"}, 32, 0.4), 0.7);
}

// Direct and by the surface, out and back: the two orders are in phase. Ahead they turn while the
// ship goes on, by k·vt·(cos a − cos b), and abeam they do not: no bearing stands for all.
TEST(Coverage, WhatComesBackByTwoWaysTurnsWithTheShipsWay) {
  constexpr double speed = 8.0;
  const auto lost = [&](double heading, std::size_t j, std::size_t i) {
    const std::vector<std::string> rests = {
        "array.phones=32", "array.heading_deg=" + std::to_string(heading),
        "environment.wind_speed=0.0", "propagation.max_surface_bounces=1"};
    std::vector<std::string> goes = rests;  // towards bearing 5°
    goes.emplace_back("platform.velocity=[0.697246,7.969558,0.0]");
    const CoverageSettings settings = small(200.0, 12e3, 60, 36);
    const Coverage before = coverage(PingSimulator(scenario(straight, rests)), settings),
                   now = coverage(PingSimulator(scenario(straight, goes)), settings);
    const std::size_t cell = j * before.ranges.size() + i;
    return double(before.layers[0].reverberation_db[cell]) -
           double(now.layers[0].reverberation_db[cell]);
  };
  const PingSimulator simulator(scenario(straight));
  const FilterOf filter(simulator.pulse());
  for (const std::size_t i : {24U, 36U, 48U}) {
    EXPECT_NEAR(lost(5.0, 9, i), 0.0, 0.3) << i;
    // A line across the way looks ahead, and hears astern: that is shifted.
    const double range = (double(i) + 0.5) * 200.0, delay = 2.0 * range / 1500.0;
    const double one = range - (2200.0 * 2200.0 - 1800.0 * 1800.0) / (4.0 * range);
    const double other = 2.0 * range - one, level = std::sqrt(one * one - 1800.0 * 1800.0);
    const double turned = 2.0 * pi * speed * delay * (level / one - level / other);
    const auto power = [&](double a, double b) {  // of a pair, by Lambert's law
      return (a == one ? 1800.0 : 2200.0) * (b == one ? 1800.0 : 2200.0) / (a * a * b * b * a * b);
    };
    const double alone = power(one, one) + power(other, other), both = power(one, other);
    const double passes = filter.passes(4.0 * speed * level / range, [](double) { return 1.0; });
    const double truth =
        db_from_power((alone + 4.0 * both) / (alone + 2.0 * both * (1.0 + std::cos(turned)))) -
        db_from_power(0.5 * (1.0 + passes));
    EXPECT_NEAR(lost(95.0, 0, i), truth, 0.6) << i;
  }
}

// Before the bottom answers at all a sweep's filter receives the sidelobes of what comes later, and
// not what its length overlaps with: R = sin(πBτ(1 − |τ|/T))/(πBτ) of a sweep without a window.
TEST(Coverage, ReverberationIsWhatTheFilterReceives) {
  const PingSimulator simulator(scenario(straight, {"pulse.duration=0.5"}));
  const Coverage found = coverage(simulator, small(200.0, 3e3, 150));
  const Pulse& pulse = simulator.pulse();
  constexpr double height = 1800.0, speed = 1500.0, duration = 0.5, band = 100.0, cell = 40.0;
  const double factor = pulse.energy() * noise_bandwidth(pulse);
  for (const std::size_t i : {76U, 80U, 84U, 88U, 92U, 100U, 120U}) {
    const double middle = 2.0 * found.ranges[i] / speed;
    double received = 0.0;
    constexpr double step = 5e-4;
    for (double t = 2.0 * height / speed + 0.5 * step; t < middle + 1.0; t += step) {
      const double range = 0.5 * speed * t, sine = height / range;
      for (int k = 0; k < 16; ++k) {  // over the cell
        const double later = t - middle - ((k + 0.5) / 16 - 0.5) * cell / speed;
        if (std::abs(later) >= duration) continue;
        const double x = pi * band * later, share = 1.0 - std::abs(later) / duration;
        const double answer = std::abs(x) < 1e-9 ? share : std::sin(x * share) / x;
        received += step / 16 * pi * speed * power_from_db(-27.0) * sine * sine /
                    std::pow(range, 3) * answer * answer;
      }
    }
    // Bins of 31 ms at an edge of 50 dB.
    EXPECT_NEAR(double(found.layers[0].reverberation_db[i]),
                220.0 + db_from_power(factor * received),
                found.ranges[i] < height - 60.0 || found.ranges[i] > height + 60.0 ? 1.0 : 4.0)
        << found.ranges[i];
  }
}

// A target as deep as the sonar, over a floor that slopes: rays to it leave within a thousandth of
// the horizontal. The direct path and that by the surface, both ways, over the cell.
TEST(Coverage, ATargetInTheSonarsOwnDepthIsReached) {
  const PingSimulator simulator(scenario(
      straight,
      {"environment.bottom={kind=\"fluid\",shape={range=[-20e3,20e3],depth=[1900.0,2100.0]}}",
       "propagation.max_surface_bounces=1", "reverberation.enabled=false",
       "pulse={kind=\"cw\",frequency=1500.0,duration=2.0}"}));
  const Coverage found = coverage(simulator, small(200.0, 12e3, 60, 4));
  for (const std::size_t i : {10U, 20U, 30U, 40U, 55U}) {
    double mean = 0.0;
    constexpr int places = 400;
    for (int k = 0; k < places; ++k) {
      const double range = found.ranges[i] + ((k + 0.5) / places - 0.5) * 200.0;
      const double far = std::hypot(range, 400.0), wavenumber = 2.0 * pi * 1500.0 / 1500.0;
      // All four overlap but for a hundredth of the tone.
      const std::complex<double> way =
          std::polar(1.0 / range, -wavenumber * range) - std::polar(1.0 / far, -wavenumber * far);
      mean += std::norm(way * way) / places;
    }
    EXPECT_NEAR(double(found.layers[0].echo_db[i]), 230.0 + db_from_power(mean), 0.5)
        << found.ranges[i];
  }
}

/// What the matched filter answers to a target in the middle of a part of a cell: the greatest sum
/// of its echoes at the delay of one of them.
double answer_to(const Scenario& scenario, const Vec3& place, double strength_db) {
  Scenario with = scenario;
  with.reverberation.enabled = false;
  Target target;
  target.strength_db = strength_db;
  target.track.start = {place, Vec3::Zero()};
  with.targets = {target};
  const PingSimulator simulator(with);
  const PingRecord record = simulator.levels(1);
  const auto coherence = pulse_coherence(simulator.pulse());
  double most = 0.0;
  for (const EchoPath& at : record.echoes) {
    std::complex<double> sum = 0.0;
    for (const EchoPath& echo : record.echoes)
      sum += echo.received.amplitude *
             std::polar(1.0, -2.0 * pi * simulator.pulse().centre_frequency() *
                                 (echo.received.delay - at.received.delay)) *
             (*coherence)(at.received.delay - echo.received.delay);
    most = std::max(most, std::norm(sum));
  }
  return most;
}

/// How far the picture may be from pings [dB]: in a cell, and as a mean over those looked at.
struct Tolerance {
  double cell = 0.0, mean = 0.0;
};

/// The picture of a scenario against pings at targets in some of its cells.
void hold_against_pings(const Scenario& whole, double depth, double reach, int points,
                        const Tolerance& echo, const Tolerance& reverberation) {
  constexpr int ranges = 200, bearings = 36, j = 3;
  constexpr std::array cells = {30, 50, 75, 101, 130, 160};
  const Coverage found = coverage(PingSimulator(whole), small(depth, reach, ranges, bearings));
  const double step = reach / ranges, bearing = found.bearings[std::size_t(j)];
  double echoes = 0.0, reverberations = 0.0;
  for (const int i : cells) {
    const auto cell = static_cast<std::size_t>(j * ranges + i);
    const auto place = [&](double r) {
      return Vec3(found.receiver.x() + r * std::sin(bearing),
                  found.receiver.y() + r * std::cos(bearing), depth);
    };
    const double range = found.ranges[std::size_t(i)];
    double mean = 0.0;
    for (int k = 0; k < points; ++k)
      mean += answer_to(whole, place(range + ((k + 0.5) / points - 0.5) * step), 10.0) / points;
    const double off =
        double(found.layers[0].echo_db[cell]) - (found.source_level_db + db_from_power(mean));
    EXPECT_LT(std::abs(off), echo.cell) << i;
    echoes += off / cells.size();
    Scenario with = whole;
    Target target;
    target.track.start = {place(range), Vec3::Zero()};
    with.targets = {target};
    const TargetSummary truth = PingSimulator(with).levels(1).summary.front();
    const double noisy = double(found.layers[0].reverberation_db[cell]) - truth.reverberation_db;
    EXPECT_LT(std::abs(noisy), reverberation.cell) << i;
    reverberations += noisy / cells.size();
  }
  EXPECT_LT(std::abs(echoes), echo.mean);
  EXPECT_LT(std::abs(reverberations), reverberation.mean);
}

// Single phones, so that a level is that of all bearings, as a ping tells it. Where paths interfere
// n points of a cell are a mean to 4.3/√n dB, and the filter, which the picture asks at some
// delays, answers louder somewhere between them: by less than a decibel in the mean. A ping's
// expected reverberation is that of rings some metres apart: in shallow water some 30 of them fall
// into a pulse, each with a pattern of paths of its own, which is ±0.8 dB.
TEST(Coverage, OfADeepOceanIsThatOfPings) {
  hold_against_pings(read_scenario(std::string(ASDIC_SCENARIOS) + "/deep_ocean.toml",
                                   std::vector<std::string>{"array.phones=1"}),
                     150.0, 30e3, 25, {2.5, 0.8}, {0.3, 0.15});
}

constexpr const char* shallow = R"(
[environment]
wind_speed = 5.0
[environment.sound_speed]
kind = "isovelocity"
speed = 1500.0
[environment.bottom]
depth = 100.0
kind = "fluid"
speed = 1700.0
density = 1900.0
attenuation_db_per_wavelength = 0.8
[environment.absorption]
kind = "thorp"
[platform]
position = [0.0, 0.0, 8.0]
[transmitter]
source_level_db = 215.0
beamwidth_deg = 20.0
[pulse]
kind = "lfm"
start_frequency = 3800.0
end_frequency = 4200.0
duration = 0.2
[array]
kind = "horizontal"
phones = 1
spacing = 0.5
[noise]
spectral_level_db = 50.0
[reverberation.bottom]
kind = "lambert"
mu_db = -27.0
[propagation]
max_surface_bounces = 6
max_bottom_bounces = 6
[pings]
recording_duration = 8.0
sample_rate = 16000.0
)";

TEST(Coverage, OfShallowWaterIsThatOfPings) {
  hold_against_pings(scenario(shallow), 40.0, 4e3, 5, {3.0, 1.2}, {2.0, 0.6});
}

// Up the flank of a seamount, over its facets: energy over some kilometres by one fan of few rays
// is that of fans that are split until they tell each path.
TEST(Coverage, FewRaysOfAPlaneHoldTheEnergyOfMany) {
  const PingSimulator simulator(
      read_scenario(std::string(ASDIC_SCENARIOS) + "/seamount_ping.toml"));
  const PropagationPaths& paths = simulator.paths();
  const Vec3 place = simulator.geometry(1).source().position;
  const auto solver = paths.solver(paths.plane(place, radians(20.0), 24e3));
  const PathLimits limits{.max_surface_bounces = 2, .max_bottom_bounces = 2};
  constexpr double spacing = 100.0, reach = 24e3;
  const std::array<GroundLevel, 2> levels = {GroundLevel(150.0), GroundLevel(BoundaryKind::bottom)};
  const std::vector<BoundaryPaths> few =
      mean_paths(*solver, place.z(), levels, spacing, reach, 3500.0, limits, 128);
  for (std::size_t level = 0; level < levels.size(); ++level) {
    const BoundaryPaths many =
        boundary_paths(*solver, place.z(), levels[level], spacing, reach, 3500.0, limits);
    for (std::size_t first = 20; first + 40 <= many.cells(); first += 40) {
      const auto energy = [&](const BoundaryPaths& all) {
        double sum = 0.0;
        for (std::size_t cell = first; cell < first + 40; ++cell)
          for (const BoundaryPath& path : all.paths(cell)) sum += std::norm(path.amplitude);
        return db_from_power(sum);
      };
      EXPECT_NEAR(energy(few[level]), energy(many), 0.5) << level << ' ' << first;
    }
  }
}

TEST(Coverage, SaysWhereADepthIsNoWaterAndWhereNoRayComes) {
  const Coverage found = coverage(PingSimulator(scenario(straight)), small(2500.0, 5e3, 10));
  for (const std::int8_t certainty : found.layers[0].certainty)
    EXPECT_EQ(certainty, std::int8_t(CoverageCertainty::no_water));
  // A shadow: sound speed falls with depth, the source is shallow.
  const PingSimulator shadow(scenario(
      straight, {"environment.sound_speed={kind=\"table\",depth=[0,2000],speed=[1520,1420]}",
                 "propagation.diffraction=false"}));
  const Coverage dark = coverage(shadow, small(20.0, 40e3, 50));
  EXPECT_EQ(dark.layers[0].certainty[2], std::int8_t(CoverageCertainty::sure));
  EXPECT_EQ(dark.layers[0].certainty[49], std::int8_t(CoverageCertainty::no_path));
  EXPECT_TRUE(std::isinf(dark.layers[0].uncertainty_db[49]));
  EXPECT_NEAR(double(dark.layers[0].detection_probability[49]), 1e-4, 1e-6);
}

TEST(Coverage, NamesTheOptionThatIsWrong) {
  const Scenario sea = scenario(straight);
  const auto fault = [&](const AreaWishes& wishes) {
    try {
      static_cast<void>(coverage(PingSimulator(sea), coverage_settings(sea, wishes)));
    } catch (const InputError& error) {
      return error.fault().where;
    }
    return std::string("none");
  };
  EXPECT_EQ(fault({}), "--depth");
  EXPECT_EQ(fault({.depths = {100.0}, .array = "bow"}), "--array");
  EXPECT_EQ(fault({.depths = {-5.0}}), "--depth");
  EXPECT_EQ(fault({.depths = {100.0}, .reach = -1.0}), "--reach");
  EXPECT_EQ(fault({.depths = {100.0}, .ping = 9}), "--ping");
  EXPECT_EQ(fault({.depths = {100.0}, .fluctuation = "often"}), "--fluctuation");
}

}  // namespace
}  // namespace asdic::detail
