#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/error.h"
#include "raytrace/beams/convergence.h"
#include "raytrace/beams/layered_crossings.h"
#include "raytrace/propagation.h"
#include "raytrace/runs/field_run.h"
#include "support/deep.h"

// Laws of fields: the fast way is the plain way, and the number of threads changes no bit.
namespace asdic::detail {
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
      find_crossings({}, ray, run_case.receivers.ranges, plain);
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

/// A fan whose tubes differ in width at random.
BeamFan random_fan(const PropagationCase& run_case, unsigned seed) {
  std::mt19937 random(seed);
  const BeamFan even = even_fan(run_case.beams.lowest, run_case.beams.highest, 101);
  std::vector<double> share(even.elevation.size() - 1);
  for (double& s : share) s = std::exponential_distribution<double>()(random);
  return graded_fan(even, share, 220);
}

double relative_difference(const std::vector<std::complex<double>>& a,
                           const std::vector<std::complex<double>>& b) {
  double error = 0.0, norm = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n)
    error += std::norm(a[n] - b[n]), norm += std::norm(b[n]);
  return std::sqrt(error / norm);
}

// Hats with two unequal halves. As above; and a receiver within rounding of a ray may be counted to
// the other half, whose weight there is the same.
TEST(GradedFans, AreThePlainOnes) {
  for (unsigned seed = 1; seed <= 12; ++seed)
    for (const FieldKind field : {FieldKind::coherent, FieldKind::incoherent}) {
      PropagationCase run_case = random_channel(seed);
      run_case.field = field;
      const RayTracer tracer(run_case.environment, run_case.frequency);
      const BeamFan fan = random_fan(run_case, seed);
      const double zs = run_case.source_depths[0];
      const auto plain = field_of_fan(run_case, tracer, zs, fan, {}, FieldMethod::plain).field;
      const auto fast = field_of_fan(run_case, tracer, zs, fan).field;
      EXPECT_LT(relative_difference(fast, plain), 1e-4) << "seed " << seed << ' ' << int(field);
    }
}

// Two halves of the same width are the hat. Those of single precision differ by rounding.
TEST(GradedFans, AreEvenOnesIfTheirTubesAre) {
  const PropagationCase run_case = random_channel(4);
  const RayTracer tracer(run_case.environment, run_case.frequency);
  BeamFan fan = even_fan(run_case.beams.lowest, run_case.beams.highest, 301);
  const double zs = run_case.source_depths[0];
  const auto even = field_of_fan(run_case, tracer, zs, fan).field;
  fan.graded = true;
  EXPECT_LT(relative_difference(field_of_fan(run_case, tracer, zs, fan).field, even), 1e-6);
}

TEST(GradedFans, DivideWhereTheErrorIs) {
  const BeamFan even = even_fan(-1.0, 1.0, 5);
  const BeamFan fan = graded_fan(even, {0.0, 1.0, 4.0, 0.0}, 11);
  EXPECT_EQ(fan.elevation.size(), 12U);  // 1, 3, 6, 1 parts: as √S; 1, 2, 5, 1 were too few
  for (const double e : even.elevation)
    EXPECT_NE(std::find(fan.elevation.begin(), fan.elevation.end(), e), fan.elevation.end());
  EXPECT_TRUE(std::is_sorted(fan.elevation.begin(), fan.elevation.end()));
  EXPECT_DOUBLE_EQ(fan.elevation[1], -0.5);
  EXPECT_DOUBLE_EQ(fan.elevation[5], 0.5 / 6.0);
}

/// How a field's bound stands against a fan eight times as dense.
struct Held {
  double error_db, bound_db, beyond;  ///< both at 95 %; share of receivers with an error above it
};
Held held(const PropagationCase& run_case, const BeamFan& fan, const BeamFan& denser) {
  const RayTracer tracer(run_case.environment, run_case.frequency);
  const double zs = run_case.source_depths[0];
  const bool coherent = run_case.field == FieldKind::coherent;
  const FanField f =
      field_of_fan(run_case, tracer, zs, fan, {}, FieldMethod::fast, {.bound = true});
  const auto truth = field_of_fan(run_case, tracer, zs, denser).field;
  double beyond = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double error = coherent ? std::abs(f.field[i] - truth[i])
                                  : std::abs(std::norm(f.field[i]) - std::norm(truth[i]));
    beyond += error > f.bound[i] + 1e-5 * std::abs(truth[i]) * (coherent ? 1 : std::abs(truth[i]));
  }
  return {level_difference_db(f.field, truth, 0.95), bound_db(f.field, f.bound, coherent, 0.95),
          beyond / double(truth.size())};
}

// Of some columns only, the bound is what it is there of all of them.
TEST(ErrorBound, IsTheSameOfFewerColumns) {
  for (unsigned seed = 1; seed <= 8; ++seed)
    for (const BeamKind kind : {BeamKind::hat, BeamKind::gaussian}) {
      PropagationCase run_case = random_channel(seed);
      run_case.beams.kind = kind;
      const RayTracer tracer(run_case.environment, run_case.frequency);
      const BeamFan fan = even_fan(run_case.beams.lowest, run_case.beams.highest, 201);
      const std::size_t columns = run_case.receivers.ranges.size();
      const auto field = [&](std::size_t every) {
        return field_of_fan(run_case, tracer, run_case.source_depths[0], fan, {}, FieldMethod::fast,
                            {.bound = true, .looked_at = {.every = every}});
      };
      const FanField all = field(1);
      for (const std::size_t every : {2, 3, 7, 60}) {
        SCOPED_TRACE(testing::Message() << seed << ' ' << int(kind) << ' ' << every);
        const ColumnSample sample{.every = every};
        const FanField some = field(every);
        EXPECT_EQ(some.field, all.field);
        const std::size_t count = sample.count(columns);
        ASSERT_EQ(some.bound.size(), count * run_case.receivers.depths.size());
        for (std::size_t i = 0; i < some.bound.size(); ++i)
          ASSERT_EQ(some.bound[i], all.bound[i / count * columns + sample.column(i % count)]) << i;
      }
    }
}

// Rays are not traced to be thrown away: where the bound will not be what is wanted with the most
// beams there may be, these come next; where it will, all fans before the last are fewer than its
// beams together.
TEST(NumberOfBeams, IsFoundWithFewOthers) {
  for (const BeamKind kind : {BeamKind::hat, BeamKind::gaussian})
    for (unsigned seed = 1; seed <= (support::deep() ? 9U : 5U); ++seed) {
      PropagationCase run_case = random_channel(seed);
      run_case.beams.kind = kind;
      run_case.beams.count = 1001;
      const RayTracer tracer(run_case.environment, run_case.frequency);
      std::size_t beams = 0;
      const ConvergedField answer =
          converged_field(run_case, [&](const BeamFan& fan, const FieldCheck& also) {
            beams += fan.elevation.size();
            return field_of_fan(run_case, tracer, run_case.source_depths[0], fan, {},
                                FieldMethod::fast, also);
          });
      SCOPED_TRACE(testing::Message() << seed << " kind " << int(kind) << ", " << answer.beams
                                      << " beams, " << beams << " in all");
      if (kind == BeamKind::gaussian && answer.beams == std::size_t{most_beams} &&
          std::isinf(answer.error_db)) {
        EXPECT_LE(double(beams), 1.3 * double(answer.beams));
      }
      EXPECT_LE(double(beams), 2.5 * double(answer.beams));
    }
}

// The bound is one: at 95 % of the receivers for every ocean, kind of beam and of sum, and receiver
// by receiver but for those beside a caustic or an edge inside a torn tube, where rays do not end
// where their neighbours do: less than the 5 % that a figure at 95 % leaves out.
TEST(ErrorBound, HoldsOverRandomOceans) {
  for (unsigned seed = 1; seed <= (support::deep() ? 30U : 8U); ++seed)
    for (const BeamKind kind : {BeamKind::hat, BeamKind::gaussian})
      for (const FieldKind field : {FieldKind::coherent, FieldKind::incoherent}) {
        PropagationCase run_case = random_channel(seed);
        run_case.beams.kind = kind;
        run_case.field = field;
        for (const int beams : {301, 1201}) {
          const auto even = [&](int n) {
            return even_fan(run_case.beams.lowest, run_case.beams.highest, n);
          };
          const Held h = held(run_case, even(beams), even(8 * (beams - 1) + 1));
          SCOPED_TRACE(testing::Message() << "seed " << seed << " kind " << int(kind) << " field "
                                          << int(field) << " beams " << beams);
          EXPECT_LE(h.error_db, h.bound_db);
          EXPECT_LE(h.beyond, 0.05);
        }
      }
}

TEST(Fields, HaveTheSameBitsForAnyNumberOfThreads) {
  for (const BeamKind kind : {BeamKind::hat, BeamKind::gaussian, BeamKind::ray_centred_hat}) {
    PropagationCase run_case = random_channel(5);
    run_case.beams.kind = kind;
    if (kind != BeamKind::hat) run_case.beams.elevations = even_fan(-0.4, 0.4, 3001).elevation;
    std::vector<std::complex<float>> first;
    for (const std::size_t threads : {1, 2, 4}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      const auto field = run_field(run_case).field;
      if (first.empty()) first = field;
      EXPECT_EQ(field, first) << threads;
    }
  }
}

// A field does not depend on the number of beams in the input but for what its own rule allows: two
// of them are no further apart than the bounds of both.
TEST(Fields, DoNotDependOnTheNumberOfBeamsAskedFor) {
  for (const unsigned seed : support::deep() ? std::vector{2U, 7U, 9U} : std::vector{2U})
    for (const BeamKind kind : {BeamKind::hat, BeamKind::gaussian})
      for (const FieldKind field : {FieldKind::coherent, FieldKind::incoherent}) {
        PropagationCase run_case = random_channel(seed);
        run_case.field = field;
        run_case.beams.kind = kind;
        const RayTracer tracer(run_case.environment, run_case.frequency);
        const auto run = [&] {
          return converged_field(run_case, [&](const BeamFan& fan, const FieldCheck& also) {
            return field_of_fan(run_case, tracer, run_case.source_depths[0], fan, {},
                                FieldMethod::fast, also);
          });
        };
        const ConvergedField few = run();
        SCOPED_TRACE(testing::Message() << "seed " << seed << " kind " << int(kind) << " field "
                                        << int(field) << " beams " << few.beams);
        EXPECT_TRUE(few.bounded);
        EXPECT_TRUE(!few.note.empty() || few.error_db <= wanted_bound_db);
        for (const double factor : {0.3, 1.0, 1.7}) {
          run_case.beams.count = static_cast<int>(factor * double(few.beams));
          const ConvergedField other = run();
          EXPECT_LE(level_difference_db(few.field, other.field, 0.95),
                    few.error_db + other.error_db);
        }
      }
}

// Beams that are what they are whatever their number are added up, none of them twice: the sum is
// that of the last fan traced at once, and no more beams were traced than it has.
TEST(NumberOfBeams, IsFoundWithNoOthersWhereBeamsAreNested) {
  for (const BeamKind kind : {BeamKind::cerveny_cartesian, BeamKind::cerveny_ray_centred})
    for (const bool circle : {false, true}) {
      PropagationCase run_case = random_channel(6);
      run_case.frequency = 60.0;
      run_case.receivers.ranges.resize(12);
      run_case.receivers.depths = {0.3 * run_case.environment.bottom.depth,
                                   0.6 * run_case.environment.bottom.depth};
      run_case.beams.kind = kind;
      run_case.beams.cerveny = CervenyBeams{.width = CervenyBeams::Width::minimum,
                                            .loop_range = run_case.receivers.ranges.back(),
                                            .images = 2};
      run_case.beams.lowest = circle ? -pi : radians(-30.0);
      run_case.beams.highest = circle ? pi : radians(30.0);
      const RayTracer tracer(run_case.environment, run_case.frequency);
      const auto field = [&](const BeamFan& fan) {
        return field_of_fan(run_case, tracer, run_case.source_depths[0], fan);
      };
      std::size_t beams = 0;
      const ConvergedField answer =
          converged_field(run_case, [&](const BeamFan& fan, const FieldCheck&) {
            beams += fan.elevation.size();
            return field(fan);
          });
      EXPECT_EQ(beams, answer.beams);
      EXPECT_LE(answer.error_db, wanted_error_db);
      const BeamFan all =
          even_fan(run_case.beams.lowest, run_case.beams.highest, static_cast<int>(answer.beams));
      EXPECT_LT(relative_difference(answer.field, field(all).field), 1e-9)
          << int(kind) << ' ' << circle << ", " << beams << " beams";
    }
}

// Cerveny beams follow from row to row where these are evenly spaced: so they do where one is not.
TEST(CervenyBeams, AreTheSameOnEvenRowsAndOnOthers) {
  for (const unsigned seed : {2U, 6U, 7U})
    for (const FieldKind kind : {FieldKind::coherent, FieldKind::incoherent}) {
      PropagationCase run_case = random_channel(seed);
      run_case.field = kind;
      run_case.beams.kind = BeamKind::cerveny_cartesian;
      run_case.beams.cerveny = CervenyBeams{.images = 3};
      const RayTracer tracer(run_case.environment, run_case.frequency);
      const BeamFan fan = even_fan(radians(-20.0), radians(20.0), 101);
      const auto field = [&] {
        return field_of_fan(run_case, tracer, run_case.source_depths[0], fan).field;
      };
      const auto even = field();
      auto& depths = run_case.receivers.depths;
      const std::size_t columns = run_case.receivers.ranges.size(), apart = depths.size() / 2;
      depths.insert(depths.begin() + std::ptrdiff_t(apart), depths[apart] - 0.01);
      auto uneven = field();
      uneven.erase(uneven.begin() + std::ptrdiff_t(apart * columns),
                   uneven.begin() + std::ptrdiff_t((apart + 1) * columns));
      EXPECT_LT(relative_difference(even, uneven), 1e-9) << seed << ' ' << int(kind);
    }
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
}  // namespace asdic::detail
