#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <random>

#include "core/error.h"
#include "raytrace/beams/convergence.h"
#include "raytrace/beams/field_run.h"
#include "raytrace/beams/layered_crossings.h"

// Laws of fields: the fast way is the plain way, and the number of threads changes no bit.
namespace asdic {
namespace {

/// A random channel of c-linear layers over a fluid bottom.
PropagationCase random_channel(unsigned seed) {
  std::mt19937 random(seed);
  const auto draw = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  PropagationCase run_case;
  const double bottom = draw(100.0, 4000.0);
  std::vector<double> depth = {0.0}, speed = {draw(1480.0, 1530.0)};
  while (depth.back() < bottom) {
    depth.push_back(depth.back() + bottom * draw(0.02, 0.3));
    speed.push_back(speed.back() +
                    draw(-0.1, 0.1) * std::min(200.0, depth.back() - depth[depth.size() - 2]));
  }
  run_case.environment.water = SoundSpeedProfile::table(depth, speed, Interpolation::c_linear);
  run_case.environment.bottom = {.depth = bottom, .material = FluidHalfSpace{}};
  if (seed % 2 == 1) run_case.environment.absorption = Thorp{};
  run_case.frequency = draw(50.0, 2000.0);
  run_case.source_depths = {seed % 3 == 0 ? depth[1] < bottom ? depth[1] : 0.5 * bottom
                                          : draw(0.1, 0.9) * bottom};
  for (int j = 1; j <= 60; ++j) run_case.receivers.ranges.push_back(j * 5.0 * bottom / 20.0);
  for (int k = 0; k <= 70; ++k)
    run_case.receivers.depths.push_back(bottom * (k + (seed % 4 == 0 ? draw(-0.3, 0.3) : 0.0)) /
                                        70.0);
  for (double& z : run_case.receivers.depths) z = std::clamp(z, 0.0, bottom);
  run_case.beams.lowest = -radians(draw(10.0, 80.0));
  run_case.beams.highest = radians(draw(10.0, 80.0));
  return run_case;
}

// Closed forms against the marching tracer, crossing by crossing. Both are exact; rounding grows
// with each of up to a hundred bounces and knots, most in q near edges of ray families.
TEST(LayeredCrossings, AreTheTracers) {
  for (unsigned seed = 1; seed <= 24; ++seed) {
    const PropagationCase run_case = random_channel(seed);
    const RayTracer tracer(run_case.environment, run_case.frequency);
    const TraceLimits limits = field_limits(run_case);
    const double zs = run_case.source_depths[0];
    const auto layered = LayeredCrossings::make(run_case.environment, run_case.frequency, zs,
                                                run_case.receivers.ranges, limits);
    ASSERT_TRUE(layered);
    LayeredCrossings::Workspace work;
    Crossings fast, plain;
    RayTrajectory ray;
    for (const double elevation :
         even_fan(run_case.beams.lowest, run_case.beams.highest, 37).elevation) {
      if (!layered->find(elevation, work, fast)) continue;
      tracer.trace(0.0, zs, elevation, limits, ray);
      find_crossings(ray, run_case.receivers.ranges, plain);
      ASSERT_EQ(fast.size(), plain.size()) << seed << ' ' << elevation;
      for (std::size_t i = 0; i < fast.size(); ++i) {
        SCOPED_TRACE(testing::Message()
                     << "seed " << seed << " elevation " << elevation << " i " << i);
        ASSERT_EQ(fast.column[i], plain.column[i]);
        ASSERT_NEAR(fast.depth[i], plain.depth[i], 1e-4);
        ASSERT_NEAR(fast.time[i], plain.time[i], 1e-7);
        ASSERT_NEAR(fast.q[i], plain.q[i], 1e-6 * (1.0 + std::abs(plain.q[i])));
        ASSERT_NEAR(fast.sine[i], plain.sine[i], 1e-6);
        ASSERT_NEAR(fast.level[i], plain.level[i], 1e-7);
        ASSERT_NEAR(std::remainder(fast.phase[i] - plain.phase[i], 2.0 * pi), 0.0, 1e-6);
      }
    }
  }
}

// Single precision within a beam, 1e-6 or so of the field; and the plain way's delays are those of
// the quintic above, 5e-8 s at worst and 1e-9 mostly: 1e-5 rad at 2 kHz. A receiver where a
// Gaussian is cut off (at e⁻⁸) may be inside by one way and outside by the other.
TEST(FastFields, AreThePlainOnes) {
  for (unsigned seed = 1; seed <= 12; ++seed)
    for (const BeamKind kind : {BeamKind::hat, BeamKind::gaussian})
      for (const FieldKind field :
           {FieldKind::coherent, FieldKind::incoherent, FieldKind::semi_coherent}) {
        PropagationCase run_case = random_channel(seed);
        run_case.beams.kind = kind;
        run_case.field = field;
        const RayTracer tracer(run_case.environment, run_case.frequency);
        const BeamFan fan = even_fan(run_case.beams.lowest, run_case.beams.highest, 201);
        const double zs = run_case.source_depths[0];
        const auto plain = field_of_fan(run_case, tracer, zs, fan, {}, FieldMethod::plain).field;
        const auto fast = field_of_fan(run_case, tracer, zs, fan, {}, FieldMethod::fast).field;
        double error = 0.0, norm = 0.0;
        for (std::size_t n = 0; n < plain.size(); ++n) {
          error += std::norm(fast[n] - plain[n]);
          norm += std::norm(plain[n]);
        }
        EXPECT_LT(std::sqrt(error / norm), 1e-4)
            << "seed " << seed << " kind " << int(kind) << " field " << int(field);
      }
}

TEST(Fields, HaveTheSameBitsForAnyNumberOfThreads) {
  for (const BeamKind kind : {BeamKind::hat, BeamKind::gaussian, BeamKind::ray_centred_hat}) {
    PropagationCase run_case = random_channel(5);
    run_case.beams.kind = kind;
    run_case.beams.elevations = even_fan(-0.4, 0.4, 3001).elevation;
    std::vector<std::complex<float>> first;
    for (const std::size_t threads : {1, 2, 4}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      const auto field = run_field(run_case).field;
      if (first.empty()) first = field;
      EXPECT_EQ(field, first) << threads;
    }
  }
}

// A field does not depend on the number of beams in the input but for what its own rule allows.
TEST(Fields, DoNotDependOnTheNumberOfBeamsAskedFor) {
  PropagationCase run_case = random_channel(7);
  run_case.field = FieldKind::incoherent;
  run_case.beams.kind = BeamKind::gaussian;
  const PropagationResult few = run_field(run_case);
  run_case.beams.count = 3 * static_cast<int>(few.beams);
  const PropagationResult many = run_field(run_case);
  const auto wide = [](const std::vector<std::complex<float>>& p) {
    return std::vector<std::complex<double>>(p.begin(), p.end());
  };
  EXPECT_LT(few.beam_error_db, wanted_error_db);
  EXPECT_LT(level_difference_db(wide(few.field), wide(many.field), 0.95), wanted_error_db);
}

TEST(Fields, StopWhenTold) {
  const PropagationCase run_case = random_channel(3);
  EXPECT_THROW((void)run_field(run_case, [](double) { return false; }), Interrupted);
}

TEST(Fields, NeedReceiversAndASourceInTheWater) {
  PropagationCase run_case = random_channel(3);
  run_case.source_depths = {-5.0};
  EXPECT_THROW((void)run_field(run_case), InputError);
  run_case = random_channel(3);
  run_case.receivers.ranges.clear();
  EXPECT_THROW((void)run_field(run_case), InputError);
}

}  // namespace
}  // namespace asdic
