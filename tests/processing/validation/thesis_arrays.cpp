#include <gtest/gtest.h>

#include "core/geometry.h"
#include "processing/beams.h"
#include "support/csv.h"
#include "support/listen.h"
#include "support/thesis.h"

namespace asdic::detail {
namespace {

using support::Csv;

/// The sine of the direction in which a line of phones receives most, its first axis component
/// scanned by `look(sine)`, refined by a parabola.
template <class Look>
double loudest_sine(const Baseband& received, std::span<const Vec3> phones, double c, double from,
                    double to, Look look) {
  constexpr double step = 0.005;
  std::vector<Vec3> looks;
  for (int i = -199; i <= 199; ++i) looks.push_back(look(i * step));
  const std::vector<double> even(phones.size(), 1.0 / double(phones.size()));
  BeamSpectra beams =
      conventional_beams(channel_spectra(received), received, phones, looks, c, even);
  const ComplexFft<float> fft(beams.bins);
  std::vector<double> energy(beams.beams);
  for (std::size_t b = 0; b < beams.beams; ++b) {
    fft.inverse(beams.beam(b));
    for (std::size_t i = 0; i < received.recorded; ++i) {
      const double t = received.start + double(i) / received.sample_rate;
      if (t >= from && t <= to) energy[b] += static_cast<double>(std::norm(beams.beam(b)[i]));
    }
  }
  const auto best = std::max_element(energy.begin(), energy.end()) - energy.begin();
  const auto i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(best, 1, 397));
  const double a = energy[i - 1], b = energy[i], e = energy[i + 1];
  return (double(i) - 199.0 + 0.5 * (a - e) / (a - 2.0 * b + e)) * step;
}

Scenario table_5_5(double bearing) {
  Scenario s = support::thesis(SoundSpeedProfile::munk());
  s.targets = {
      support::target({25000.0 * std::cos(bearing), 25000.0 * std::sin(bearing), 125.0}, 30.0)};
  s.pulse.duration = 0.2;
  s.pings.recording_start = 33.5;  // two-way 33.8 s
  s.pings.recording_duration = 1.5;
  return s;
}

class ThesisHorizontalArray : public testing::TestWithParam<double> {};

// Table 5.5. The line's response depends on sin(app) = sin(az)·cos(el) alone; its −3 dB width there
// is 0.886 λ/(N d) = 0.886·(1543/4000)/3.0 = 0.114. One path, no noise: the peak of a symmetric
// pattern, found by a parabola over steps of 0.005 (4 % of the width: its error is of fourth order,
// below 1e-5). Tolerance 0.4 % of the width, 5e-4. With the plain bearing, el forgotten, 75° would
// be 1.8e-3 away: the test resolves them.
TEST_P(ThesisHorizontalArray, PeakIsWhereSinAzTimesCosElSays) {
  const double bearing = radians(GetParam());
  const Scenario s = table_5_5(bearing);
  const PingSimulator simulator(s);
  const PingRecord record = simulator.simulate(1);
  const Arrivals back = simulator.ocean().find(125.0, 4500.0, 25000.0, 4000.0, {0, 0});
  ASSERT_EQ(back.size(), 1U);
  const double expected = std::sin(bearing) * std::cos(back[0].arrival_elevation);
  const double c = s.environment.water.at(4500.0).c;
  const double sine =
      loudest_sine(support::demodulate(record, 4000.0, 60.0), s.arrays[0].phones, c, 33.5, 35.0,
                   [](double u) { return direction(0.5 * pi - std::asin(u), 0.0); });
  EXPECT_NEAR(sine, expected, 5e-4);
  RecordProperty("error_in_sine", std::to_string(sine - expected));
  if (GetParam() == 75.0) {
    EXPECT_GT(std::abs(std::sin(bearing) - expected), 1.5e-3);
  }
}

// With the surface's paths as well (two elevations, 3.5° and 5.4°, and 6 % of −3 dB width apart at
// most in the sine): a sum of two beams so close peaks between them or, when they nearly cancel,
// outside by less than a tenth of the width.
TEST_P(ThesisHorizontalArray, TheSurfaceMovesThePeakLittle) {
  const double bearing = radians(GetParam());
  Scenario s = table_5_5(bearing);
  s.propagation.max_surface_bounces = 1;
  s.transmitters[0] = {.source_level_db = 230.0, .elevation = radians(2.0)};  // 6°, Hann
  s.noise.law = WhiteNoise{40.0};
  const PingRecord record = PingSimulator(s).simulate(1);
  const double sine = loudest_sine(support::demodulate(record, 4000.0, 60.0), s.arrays[0].phones,
                                   s.environment.water.at(4500.0).c, 33.5, 35.0, [](double u) {
                                     return direction(0.5 * pi - std::asin(u), 0.0);
                                   });
  EXPECT_NEAR(sine, std::sin(bearing) * std::cos(radians(4.5)), 0.0114);
}

INSTANTIATE_TEST_SUITE_P(Table55, ThesisHorizontalArray,
                         testing::Values(0.0, 10.0, 30.0, 75.0, -20.0, -40.0));

struct Row {
  double range;                  // [m]
  std::vector<double> incoming;  // [°] surface, direct, bottom, as printed in Table 5.6
};
class ThesisVerticalArray : public testing::TestWithParam<Row> {};

// Table 5.6: every printed angle is that of an eigenray within 1.5° (whole degrees, and a profile
// that is Munk's only nearly); water of 4620 m is inferred from its bottom bounces. At 31 km, "all
// 0", the direct path (−0.5°) answers; the path that turns under the surface comes at 1.57° and the
// bottom's at −3.3°, beyond 1.5° of the printed 0.
TEST_P(ThesisVerticalArray, PrintedAnglesAreEigenrays) {
  Environment ocean{.water = SoundSpeedProfile::munk(), .bottom = {.depth = 4620.0}};
  const EigenraySolver solver(ocean);
  const Arrivals back = solver.find(125.0, 4500.0, GetParam().range, 4000.0);
  for (const double printed : GetParam().incoming) {
    double nearest = infinity;
    for (const Arrival& a : back)
      nearest = std::min(nearest, std::abs(degrees(-a.arrival_elevation) - printed));
    EXPECT_LT(nearest, 1.5) << printed;
  }
  // Every eigenray of the reference (launch within ±80°), out and back: 0.1° and, as both are
  // integrated to 1e-8, far better: 1e-6°.
  const Csv csv("physics-reference/rays_munk_eigenrays.csv");
  const Arrivals out = solver.find(4500.0, 125.0, GetParam().range, 4000.0);
  int compared = 0;
  for (std::size_t i = 0; i < csv.rows(); ++i) {
    if (csv["water_depth_m"][i] != 4620.0 || csv["range_m"][i] != GetParam().range) continue;
    double there = infinity, home = infinity;
    for (const Arrival& a : out)
      there = std::min(there, std::abs(degrees(a.launch_elevation) - csv["launch_elev_deg_up"][i]));
    for (const Arrival& a : back)  // reciprocity: it comes from where the other went
      home = std::min(home, std::abs(degrees(-a.arrival_elevation) - csv["launch_elev_deg_up"][i]));
    EXPECT_LT(there, 1e-6);
    EXPECT_LT(home, 1e-6);
    ++compared;
  }
  EXPECT_EQ(compared, 7);
}

// The simulated ping, pulse 2 ms: shorter than the time between any two of the paths at 5 to 22 km
// (2.4 ms one way). An echo that went and came by one path i is received alone at its middle ± 0.2
// ms if no other pair is nearer than half a pulse and 0.2 ms, and the time sound takes over half
// the array between two such directions, 1.425 m·2 sin(el)/c. The vertical array of 20 phones at
// 0.15 m then peaks at that path's angle within half of 0.886 λ/(N d) = 0.114 in the sine.
// (Omnidirectional: the thesis's beam of 6° would leave the bottom's paths to its side lobes.)
TEST_P(ThesisVerticalArray, BeamsOfThePingPeakAtTheEigenrays) {
  Scenario s = support::thesis(SoundSpeedProfile::munk());
  s.environment.bottom.depth = 4620.0;
  s.propagation.max_surface_bounces = 1;
  s.propagation.max_bottom_bounces = 1;
  s.arrays[0] = line_array(20, 0.15, 0.0, 0.5 * pi);
  s.pulse.duration = 0.002;
  s.transmitters[0].source_level_db = 240.0;
  s.targets = {support::target({0.0, GetParam().range, 125.0}, 40.0)};
  const PathLimits limits{.max_surface_bounces = 1, .max_bottom_bounces = 1};
  const EigenraySolver solver(s.environment);
  const Arrivals back = solver.find(125.0, 4500.0, GetParam().range, 4000.0, limits);
  ASSERT_GE(back.size(), 3U);
  s.pings.recording_start = 2.0 * back[0].delay - 0.05;
  s.pings.recording_duration = 0.6;
  const PingRecord record = PingSimulator(s).simulate(1);
  const Baseband received = support::demodulate(record, 4000.0, 1600.0);
  const double c = s.environment.water.at(4500.0).c;
  int checked = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double time = 2.0 * back[i].delay;
    double gap = infinity;
    for (std::size_t j = 0; j < back.size(); ++j)
      for (std::size_t k = 0; k < back.size(); ++k)
        if (j != i || k != i) gap = std::min(gap, std::abs(back[j].delay + back[k].delay - time));
    const double moveout = 2.0 * 1.425 * std::abs(std::sin(back[i].arrival_elevation)) / c;
    if (gap < 0.0012 + moveout) continue;
    const double sine = loudest_sine(received, s.arrays[0].phones, c, time + 0.0008, time + 0.0012,
                                     [](double u) { return direction(0.0, std::asin(u)); });
    EXPECT_NEAR(sine, std::sin(-back[i].arrival_elevation), 0.057) << "path " << i;
    ++checked;
  }
  EXPECT_GE(checked, GetParam().range > 30000.0 ? 1 : 2);
}

INSTANTIATE_TEST_SUITE_P(Table56, ThesisVerticalArray,
                         testing::Values(Row{31000, {0}}, Row{22000, {6, 5, -7}},
                                         Row{17000, {11, 10, -11}}, Row{9000, {25, 24, -25}},
                                         Row{7000, {32, 30, -32}}, Row{5000, {41, 40, -42}}));

}  // namespace
}  // namespace asdic::detail
