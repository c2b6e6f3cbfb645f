// Runs of the propagation model in three dimensions.
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "raytrace/propagation.h"

namespace asdic::detail {
namespace {

/// Over a slope of 1 in 25 under uniform water.
PropagationCase slope() {
  PropagationCase run;
  run.frequency = 400.0;
  run.environment.water = SoundSpeedProfile::isovelocity(1500.0);
  run.environment.bottom = {.depth = 200.0, .material = FluidHalfSpace{}};
  run.environment.bottom.shape =
      BoundaryShape(std::vector{-20000.0, 4900.0}, std::vector{1000.0, 4.0},
                    ShapeInterpolation::piecewise_linear);
  run.source_depths = {60.0};
  run.receivers = {.depths = {30.0, 90.0}, .ranges = {800.0, 2000.0}};
  run.box_range = 5000.0;
  run.box_depth = 1100.0;
  run.dimension = 3;
  return run;
}

// Along the transect the strong paths are those of the plane; a field is the sum of the paths.
TEST(VolumeRun, ArrivalsAlongTheTransectAreThePlanes) {
  PropagationCase run = slope();
  run.task = Task::arrivals;
  const PropagationResult volume = asdic::detail::run(run);
  run.dimension = 2;
  const PropagationResult plane = asdic::detail::run(run);
  ASSERT_EQ(volume.arrivals.size(), plane.arrivals.size());
  for (std::size_t i = 0; i < plane.arrivals.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(volume.arrivals[i].at(k).delay, plane.arrivals[i].at(k).delay, 1e-6);
      EXPECT_LT(std::abs(volume.arrivals[i][k].amplitude - plane.arrivals[i][k].amplitude),
                1e-3 * std::abs(plane.arrivals[i][k].amplitude));
    }
}

TEST(VolumeRun, AFieldIsTheSumOfItsPaths) {
  PropagationCase run = slope();
  run.off_transect = 1.2;
  const PropagationResult field = asdic::detail::run(run);
  run.task = Task::arrivals;
  const PropagationResult paths = asdic::detail::run(run);
  ASSERT_EQ(field.field.size(), 4u);
  double turned = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    std::complex<double> sum = 0.0;
    for (const Arrival& a : paths.arrivals[i]) {
      sum += a.amplitude * std::polar(1.0, -2.0 * pi * run.frequency * a.delay);
      turned = std::max(turned, std::abs(a.launch_deflection));
    }
    EXPECT_LT(std::abs(std::complex<double>(field.field[i]) - sum), 1e-5 * std::abs(sum));
  }
  EXPECT_GT(turned, radians(1.0));
}

std::string fault(const PropagationCase& run_case) {
  try {
    static_cast<void>(run(run_case));
  } catch (const InputError& error) {
    return error.fault().where;
  }
  return "good";
}

TEST(VolumeRun, WhatThreeDimensionsDoNotDoIsRefused) {
  PropagationCase run = slope();
  run.task = Task::eigenrays;
  EXPECT_EQ(fault(run), "run.task");
  run = slope();
  run.field = FieldKind::semi_coherent;
  EXPECT_EQ(fault(run), "run.field");
  run = slope();
  run.solver = FieldSolver::waves;
  EXPECT_EQ(fault(run), "run.solver");
  run = slope();
  run.beams.source = SourceKind::line;
  EXPECT_EQ(fault(run), "run.source.kind");
  run = slope();
  run.environment.surface.shape = BoundaryShape(std::vector{0.0, 50.0}, std::vector{0.0, 1.0},
                                                ShapeInterpolation::piecewise_linear);
  EXPECT_EQ(fault(run), "environment.surface.shape");
}

}  // namespace
}  // namespace asdic::detail
