#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "raytrace/propagation.h"
#include "raytrace/runs/arrivals_run.h"

// A beach: the sea floor comes up to the surface. In uniform water such a wedge unfolds about its
// edge: the images of a source at an angle θ_s below the surface lie on its circle at 2nβ ± θ_s, β
// the slope, and each that is seen from the receiver within half a turn is one straight path. A
// vacuum above a rigid floor: −1 for every bounce off the surface.
namespace asdic::detail {
namespace {

constexpr double shore = 4000.0, slope = 0.07, speed = 1500.0;

PropagationCase beach(double source_depth) {
  const double behind = -20e3;  // the slope goes on there
  PropagationCase c;
  c.task = Task::arrivals;
  c.frequency = 300.0;
  c.environment.water = SoundSpeedProfile::isovelocity(speed);
  c.environment.bottom = {
      .depth = slope * shore,
      .material = Rigid{},
      .shape = BoundaryShape(std::vector{behind, shore}, std::vector{slope * (shore - behind), 0.0},
                             ShapeInterpolation::piecewise_linear)};
  c.source_depths = {source_depth};
  c.receivers = {.depths = {20.0, 60.0}, .ranges = {1000.0, 1750.0, 2500.0}};
  c.box_range = 4200.0;
  c.box_depth = 320.0;
  return c;
}

struct Path {
  double delay;
  int surface_bounces;
};

/// All straight paths launched forwards, by delay. Polar coordinates about the shore line, angles
/// from the surface down; the source stays where it is, the receiver is unfolded.
std::vector<Path> image_paths(double source_depth, double range, double depth) {
  const double beta = std::atan(slope);
  const double rs = std::hypot(shore, source_depth), as = std::atan2(source_depth, shore);
  const double rr = std::hypot(shore - range, depth), ar = std::atan2(depth, shore - range);
  std::vector<Path> paths;
  for (int n = -100; n <= 100; ++n)
    for (const bool upright : {true, false}) {
      const double angle = 2.0 * n * beta + (upright ? ar : -ar);
      if (std::abs(angle - as) >= pi) continue;                 // behind the shore line
      if (rr * std::cos(angle) >= rs * std::cos(as)) continue;  // launched backwards
      const double length = std::sqrt(rs * rs + rr * rr - 2.0 * rs * rr * std::cos(angle - as));
      const int surface = upright ? std::abs(n) : n >= 1 ? n - 1 : 1 - n;
      paths.push_back({length / speed, surface});
    }
  std::sort(paths.begin(), paths.end(),
            [](const Path& a, const Path& b) { return a.delay < b.delay; });
  return paths;
}

TEST(Beach, ArrivalsAreTheImagesOfAWedge) {
  for (const double source : {40.0, 150.0}) {
    const PropagationCase c = beach(source);
    const auto arrivals = run_arrivals(c).arrivals;
    std::size_t i = 0;
    for (const double depth : c.receivers.depths)
      for (const double range : c.receivers.ranges) {
        const std::vector<Path> expected = image_paths(source, range, depth);
        const Arrivals& found = arrivals[i++];
        ASSERT_EQ(found.size(), expected.size()) << source << ' ' << range << ' ' << depth;
        for (std::size_t k = 0; k < found.size(); ++k) {
          EXPECT_NEAR(found[k].delay, expected[k].delay, 1e-9);
          EXPECT_EQ(found[k].surface_bounces, expected[k].surface_bounces);
        }
      }
  }
}

// The field beside it, which is another solver: its beams and these paths are the same sum.
TEST(Beach, TheFieldIsTheSumOfTheArrivals) {
  PropagationCase c = beach(40.0);
  c.environment.bottom.material =
      FluidHalfSpace{.speed = 1700.0, .density = 1900.0, .attenuation_db_per_wavelength = 0.5};
  const auto arrivals = run_arrivals(c).arrivals;
  c.task = Task::field;
  const auto field = run(c).field;
  for (std::size_t i = 0; i < field.size(); ++i) {
    std::complex<double> sum = 0.0;
    for (const Arrival& a : arrivals[i])
      sum += a.amplitude * std::polar(1.0, -2.0 * pi * c.frequency * a.delay);
    EXPECT_NEAR(20.0 * std::log10(std::abs(sum) / double(std::abs(field[i]))), 0.0, 0.5) << i;
  }
}

}  // namespace
}  // namespace asdic::detail
