#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "core/units.h"
#include "raytrace/layered/leg_series.h"
#include "raytrace/layered/simd_column.h"
#include "raytrace/layered/simd_reflection.h"
#include "raytrace/paths/eigenrays.h"
#include "support/deep.h"
#include "support/fan_intervals.h"
#include "support/test_id.h"

// The fast search (rays in vector lanes, series of legs, batches of roots) against the plain sums
// of raytrace/layered/column.h, ray by ray.
namespace asdic::detail {
namespace {

struct RandomOcean {
  Environment environment;
  double source = 0.0, receiver = 0.0;
};

/// A rule for tables, or none: Munk's analytic law.
using Law = std::optional<Interpolation>;

/// 4 to 30 samples of speeds that go up and down, in 200 to 5000 m of water.
RandomOcean random_ocean(std::mt19937& random, const Law& rule) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const double depth = 200.0 * std::pow(25.0, share(random));
  const int samples = 4 + static_cast<int>(26.0 * share(random));
  std::vector<double> z = {0.0}, c = {1480.0 + 40.0 * share(random)};
  for (int i = 1; i < samples; ++i) {
    z.push_back(z.back() + 0.2 + share(random));
    c.push_back(c.back() + 8.0 * (share(random) - 0.5));
  }
  for (double& depth_of_sample : z) depth_of_sample *= depth / z.back();
  RandomOcean ocean{.environment = {.water = rule ? SoundSpeedProfile::table(z, c, *rule)
                                                  : SoundSpeedProfile::munk()}};
  ocean.environment.bottom = {.depth = depth, .material = FluidHalfSpace{.speed = 1600.0}};
  ocean.source = depth * (0.02 + 0.96 * share(random));
  ocean.receiver = depth * (0.02 + 0.96 * share(random));
  return ocean;
}

constexpr Law rules[] = {Interpolation::c_linear, Interpolation::n2_linear, Interpolation::spline,
                         Interpolation::pchip, std::nullopt};

class EveryRule : public testing::TestWithParam<Law> {};
INSTANTIATE_TEST_SUITE_P(Layered, EveryRule, testing::ValuesIn(rules), [](const auto& test) {
  return support::test_id(test.param ? std::string(name(*test.param)) : "munk");
});

struct PlainRange {
  double range, slope;
};
PlainRange plain(const Column& column, const Branch& branch, const RayParameter& ray) {
  const ColumnSums s = column.sums(ray);
  const BranchWeights w = weights(branch, column.source_is_upper());
  return {w.of(s.up.range, s.middle.range, s.down.range),
          w.of(s.up.d_range, s.middle.d_range, s.down.d_range) * ray.slowness_per_sigma()};
}

// Recall and precision over random oceans. Every change of side of a dense fan, by the plain sums,
// has an eigenray of that history between its two launch angles; every eigenray passes the receiver
// by the plain sums, at its delay: a root is right to 0.01 mm, a launch angle θ to 1e-16/θ. A gap:
// the quadratures of one ray told by two reference speeds differ by 1e-10, but beside a smooth
// maximum of c by up to 3e-8 (0.7 mm at 27 km, 0.4 µs; found in one of these 50 oceans), so that a
// millimetre and 1 µs is what is asked of smooth laws.
TEST_P(EveryRule, FastSearchIsThePlainSearch) {
  std::mt19937 random(20261121);
  const bool closed_form =
      GetParam() == Law(Interpolation::c_linear) || GetParam() == Law(Interpolation::n2_linear);
  std::size_t brackets = 0, roots = 0;
  const int trials = support::deep() ? 25 : 10;
  for (int trial = 0; trial < trials; ++trial) {
    const RandomOcean ocean = random_ocean(random, GetParam());
    const EigenraySolver solver(ocean.environment);
    const PathLimits limits{
        .max_surface_bounces = 6, .max_bottom_bounces = 6, .max_launch_angle = 1.5};
    const auto shared = solver.table(ocean.source, ocean.receiver, limits);
    const BranchTable& table = *shared;
    const Column& column = table.column();
    std::uniform_real_distribution<double> km(0.3, 30.0);
    std::vector<double> ranges;
    const int receivers = trial % 3 == 0 ? 1 : 40;
    for (int i = 0; i < receivers; ++i) ranges.push_back(1000.0 * km(random));
    const auto found = solver.find(ocean.source, ocean.receiver, ranges, 1000.0, limits);

    constexpr int rays = 1500;
    struct Ray {
      double angle;
      ColumnSums sums;
    };
    std::vector<Ray> fan;
    for (int i = 0; i < rays; ++i) {
      const double angle = 1.4999 * (i + 0.37) / rays;
      const RayParameter ray(column.source_speed(), std::sin(angle));
      if (ray.sine2(column.barrier_speed()) > 1e-12) fan.push_back({angle, column.sums(ray)});
    }
    for (std::size_t receiver = 0; receiver < ranges.size(); ++receiver) {
      const double range = ranges[receiver];
      for (const bool up : {true, false})
        for (int k = 0; k <= 12; ++k) {
          const Branch branch{.starts_up = up, .vertices = k};
          if (k == 0 && up == column.source_is_upper()) continue;
          const BranchWeights w = weights(branch, column.source_is_upper());
          for (std::size_t i = 0; i + 1 < fan.size(); ++i) {
            const ColumnSums &a = fan[i].sums, &b = fan[i + 1].sums;
            if (a.turns_above != b.turns_above || a.turns_below != b.turns_below) continue;
            if (!a.turns_above && branch.top_vertices() > 6) continue;
            if (!a.turns_below && branch.bottom_vertices() > 6) continue;
            const double miss_a = w.of(a.up.range, a.middle.range, a.down.range) - range,
                         miss_b = w.of(b.up.range, b.middle.range, b.down.range) - range;
            if (!std::isfinite(miss_a) || !std::isfinite(miss_b)) continue;
            if ((miss_a > 0.0) == (miss_b > 0.0)) continue;
            // r jumps where a local maximum of c is passed: a root is where halving leads to one.
            double low = fan[i].angle, high = fan[i + 1].angle;
            PlainRange middle{};
            for (int halving = 0; halving < 50; ++halving) {
              const double angle = 0.5 * (low + high);
              middle = plain(column, branch, RayParameter(column.source_speed(), std::sin(angle)));
              ((middle.range > range) == (miss_a > 0.0) ? low : high) = angle;
            }
            if (!(std::abs(middle.range - range) < 1.0)) continue;
            ++brackets;
            const auto between = [&](const Arrival& x) {
              const double angle = up ? x.launch_elevation : -x.launch_elevation;
              return angle > fan[i].angle - 1e-9 && angle < fan[i + 1].angle + 1e-9 &&
                     x.surface_bounces + x.bottom_bounces + x.upper_turns + x.lower_turns == k;
            };
            EXPECT_TRUE(std::any_of(found[receiver].begin(), found[receiver].end(), between))
                << "trial " << trial << " range " << range << " up " << up << " vertices " << k
                << " between " << degrees(fan[i].angle) << " and " << degrees(fan[i + 1].angle);
          }
        }
      for (const Arrival& x : found[receiver]) {
        ++roots;
        const Branch branch{
            .starts_up = x.launch_elevation > 0.0,
            .vertices = x.surface_bounces + x.bottom_bounces + x.upper_turns + x.lower_turns};
        const double sine = std::sin(std::abs(x.launch_elevation));
        const RayParameter ray(column.source_speed(), sine);
        const PlainRange here = plain(column, branch, ray);
        const double rounding = std::abs(here.slope) * (1e-14 + 1e-16 / sine);
        if (rounding > 1.0 || std::abs(x.q) > 1e3 * range) continue;  // lingering next to a maximum
        EXPECT_NEAR(here.range, range, closed_form ? 1e-5 + rounding : 1e-3 + rounding)
            << "trial " << trial;
        const ColumnDetails d = column.details(ray);
        const BranchWeights w = weights(branch, column.source_is_upper());
        EXPECT_NEAR(w.of(d.up.time, d.middle.time, d.down.time), x.delay,
                    (closed_form ? 1e-8 : 1e-6) + rounding / column.source_speed());
      }
    }
  }
  EXPECT_GT(brackets, 1000U);
  EXPECT_GT(roots, 1000U);
}

// Lanes and series give what the plain sums give. Closed forms: rounding; quadratures of either:
// 1e-10 of r (1e-8 of its slope). The series says itself when it holds to a micrometre and 3e-8.
// Next to a smooth maximum of c rounding of ξ, 2e-16 of it, is felt as |dr/dξ| times as much.
// Munk's quadratures step by up to 1 ns, in range c times as much, where the next cut of the column
// holds the turn; a series goes through the middle. Both know the turning depth to the rounding
// δ = 2e-13 m/s of c over its gradient g, some 0.01/s, which the way ℓ = cs/g from a cut to a turn
// beyond it knows to δ/(gs) = δc/(g²ℓ). They take s² for a difference of two speeds, each rounded
// to 2e-16: at the first of eight nodes beside the turn s² is 4e-4 of σ², its weight 0.05, so that
// a leg is known to 64·2e-16/σ² of itself, and two to twice that (3 ns of a level leg of 17 m).
TEST_P(EveryRule, LanesAndSeriesAreThePlainSums) {
  const double time_error = GetParam() ? 1e-11 : 1e-9;
  std::mt19937 random(7);
  int widths_checked = 0, series_checked = 0;
  for (int trial = 0; trial < 12; ++trial) {
    const RandomOcean ocean = random_ocean(random, GetParam());
    const EigenraySolver solver(ocean.environment);
    const auto shared = solver.table(ocean.source, ocean.receiver, {.max_launch_angle = 1.55});
    const BranchTable& table = *shared;
    const Column& column = table.column();
    for (const FanInterval* const fan : support::fan_intervals(table, 50e3)) {
      const double c_ref = fan->reference_speed;
      for (std::size_t cell = 0; cell + 1 < fan->sigma.size(); ++cell) {
        const double low = fan->sigma[cell], high = fan->sigma[cell + 1];
        const LegSeries series(column, c_ref, low, high);
        constexpr std::size_t rays_a_cell = 4;  // whatever the width of the lanes
        const Rays sigma([&](auto i) {
          return low + (high - low) * (double(i % rays_a_cell) + 0.3) / double(rays_a_cell);
        });
        const SimdRays rays(c_ref, sigma);
        const SimdColumn walk = walk_all(column, rays), fit = series.all(rays);
        for (std::size_t i = 0; i < rays_at_once; ++i) {
          const RayParameter ray(c_ref, sigma[i]);
          const auto [sums, details] = column.all(ray);
          // Next to a smooth maximum of c a ray lingers without end, and either sum is a guess.
          if (!(sums.up.range + sums.middle.range + sums.down.range < 50e3)) continue;
          const auto expect = [&](const SimdLegs& leg, const Pass& pass, const PassDetail& detail,
                                  double range_error, double slope_error) {
            SCOPED_TRACE(range_error > 1e-6 ? "series" : "walk");
            const double rounding = std::abs(pass.d_range) * ray.slowness * 2e-16;
            range_error += rounding;
            double leg_error = time_error;
            if (!GetParam()) {
              leg_error += 128.0 * 2e-16 / (sigma[i] * sigma[i]) * detail.time;
              range_error += 2e-13 * 1500.0 / (1e-4 * std::max(detail.length, 1e-3)) +
                             leg_error * column.source_speed();
            }
            EXPECT_NEAR(ray.slowness * leg.per_slowness[i], pass.range,
                        range_error + 1e-9 * pass.range);
            EXPECT_NEAR(leg.d_range[i], pass.d_range,
                        slope_error * (std::abs(pass.d_range) +
                                       pass.range / (ray.slowness * sigma[i] * sigma[i])));
            EXPECT_NEAR(leg.intercept[i] + ray.slowness * ray.slowness * leg.per_slowness[i],
                        detail.time, leg_error + rounding * ray.slowness + 1e-9 * detail.time);
            EXPECT_NEAR(leg.length[i], detail.length, range_error + 1e-9 * detail.length);
          };
          expect(walk.up, sums.up, details.up, 1e-8, 1e-7);
          expect(walk.middle, sums.middle, details.middle, 1e-8, 1e-7);
          expect(walk.down, sums.down, details.down, 1e-8, 1e-7);
          ++widths_checked;
          if (!series.good()) continue;
          expect(fit.up, sums.up, details.up, 3e-6, 2e-7);
          expect(fit.middle, sums.middle, details.middle, 3e-6, 2e-7);
          expect(fit.down, sums.down, details.down, 3e-6, 2e-7);
          ++series_checked;
        }
      }
    }
  }
  EXPECT_GT(widths_checked, 500);
  EXPECT_GT(series_checked, 300);
}

// Legs out of what the ocean keeps, from a cut beside either depth, give what the plain sums give.
// Their series hold to 2 µm, 1 ps and 5e-8 of the slope's size in the last terms; three legs make
// ten times that, of a slope that may be half of its size on the piece 1e-6. A leg beyond a depth
// is a difference: quadratures of a whole layer and of its part differ by up to 3e-9 of the ray's
// range (0.1 mm at 30 km), those of τ − ξr, which is of second order there, by 1e-11 of the time.
TEST_P(EveryRule, KeptSeriesAreThePlainSums) {
  std::mt19937 random(11);
  int checked = 0, kept = 0;
  for (int trial = 0; trial < 12; ++trial) {
    const RandomOcean ocean = random_ocean(random, GetParam());
    const EigenraySolver solver(ocean.environment);
    const auto shared = solver.table(ocean.source, ocean.receiver, {.max_launch_angle = 1.55});
    const BranchTable& table = *shared;
    const OceanLegs* const series = table.kept();
    if (series == nullptr) continue;
    ++kept;
    const Column& column = table.column();
    for (const FanInterval* const fan : support::fan_intervals(table, 50e3)) {
      const double c_ref = fan->reference_speed;
      for (std::size_t cell = 0; cell + 1 < fan->sigma.size(); ++cell)
        for (const double share : {0.1, 0.5, 0.8}) {
          const double sigma = fan->sigma[cell] + share * (fan->sigma[cell + 1] - fan->sigma[cell]);
          const OceanSeries::Found found = series->find(c_ref, sigma);
          if (found.piece == nullptr) continue;
          const SimdColumn legs = series->all(column, found, SimdRays(c_ref, sigma));
          EXPECT_EQ(legs.turns_above, fan->turns_above);
          EXPECT_EQ(legs.turns_below, fan->turns_below);
          const RayParameter ray(c_ref, sigma);
          const auto [sums, details] = column.all(ray);
          const double range = sums.up.range + sums.middle.range + sums.down.range,
                       time = details.up.time + details.middle.time + details.down.time;
          if (!(range < 50e3)) continue;
          ++checked;
          const double slope = std::abs(sums.up.d_range) + std::abs(sums.middle.d_range) +
                               std::abs(sums.down.d_range) + range / (ray.slowness * sigma * sigma);
          const auto expect = [&](const SimdLegs& leg, const Pass& pass, const PassDetail& detail) {
            EXPECT_NEAR(ray.slowness * leg.per_slowness[0], pass.range, 2e-5 + 3e-9 * range);
            EXPECT_NEAR(leg.d_range[0], pass.d_range, 1e-6 * slope);
            EXPECT_NEAR(leg.intercept[0], detail.time - ray.slowness * pass.range,
                        1e-11 + 1e-11 * time);
            EXPECT_NEAR(leg.length[0], detail.length, 2e-5 + 3e-9 * range);
          };
          SCOPED_TRACE(testing::Message() << "trial " << trial << " c " << c_ref << " sine "
                                          << sigma << " piece of " << found.piece->reference_speed()
                                          << " m/s about " << found.piece->extent().middle);
          expect(legs.up, sums.up, details.up);
          expect(legs.middle, sums.middle, details.middle);
          expect(legs.down, sums.down, details.down);
        }
    }
  }
  const bool smooth =
      GetParam() != Law(Interpolation::c_linear) && GetParam() != Law(Interpolation::n2_linear);
  EXPECT_EQ(kept > 6, smooth) << kept;
  EXPECT_EQ(checked > 500, smooth) << checked;
}

// A PCHIP layer at the end of a table may have three times its secant's slope at one edge and an
// extremum at the other: c = c_e + Δ(1 − t)³, flat to the third order, where the slope at the edge
// (rounding, or zero) says nothing of the way to the turn. Truth: r = ∫ ξc/s dz = ∫ 2uξc/s du by
// the midpoint rule in u = √|z − z_t|, right to 3e-7 at 2000 points (beside the turn c is rounded).
TEST(Turn, FromAnEdgeFlatToTheThirdOrder) {
  const std::vector<double> depths = {0.0, 20.0, 30.0, 50.0},
                            speeds = {1487.8, 1484.6, 1487.8, 1484.5};
  const auto water = SoundSpeedProfile::table(depths, speeds, Interpolation::pchip);
  const std::vector<Layer> layers = make_layers(water, 0.0, 50.0);
  const Layer& layer = layers.front();
  ASSERT_NEAR(layer.slope_top / ((layer.c_top - layer.c_bottom) / layer.thickness()), -3.0, 1e-9);
  ASSERT_NEAR(layer.slope_bottom, 0.0, 1e-12);
  for (const double sine : {1e-3, 0.01, 0.03, 0.06}) {
    const RayParameter ray(layer.c_bottom, sine);
    const double target = 1.0 / ray.slowness,
                 t = std::cbrt((target - layer.c_bottom) / (layer.c_top - layer.c_bottom)),
                 way = t * layer.thickness(), turn_z = layer.bottom - way;
    double range = 0.0;
    const int n = 2000;
    for (int i = 0; i < n; ++i) {
      const double u = std::sqrt(way) * (i + 0.5) / n, c = layer.at(turn_z + u * u).c;
      range += 2.0 * u * ray.slowness * c / std::sqrt(ray.sine2(c)) * std::sqrt(way) / n;
    }
    EXPECT_NEAR(turn(layer, ray, sine).range, range, 1e-6 * range) << sine;
    SimdLegs leg;
    const SimdRays rays(layer.c_bottom, sine);
    turn_in_layer<false>(layer, rays, Rays(sine), leg);
    EXPECT_NEAR(ray.slowness * leg.per_slowness[0], range, 1e-6 * range) << sine;
  }
}

// To a power of up to 20, rounding is below 20 × 1e-15.
TEST(SimdReflections, AreTheReflectionCoefficient) {
  const WaterAtBoundary water{.speed = 1540.0, .density = 1030.0};
  const BoundaryMaterial materials[] = {
      Vacuum{},
      Rigid{},
      FluidHalfSpace{},
      ElasticHalfSpace{},
      FluidHalfSpace{.speed = 1450.0, .density = 1200.0, .attenuation_db_per_wavelength = 0.0},
      FluidHalfSpace{.speed = 1800.0, .attenuation_db_per_wavelength = 0.0}};
  for (const BoundaryMaterial& material : materials)
    for (int step = 0; step <= 90; ++step) {
      const double grazing = radians(step);
      for (const int bounces : {0, 1, 2, 7, 20}) {
        std::array<int, rays_at_once> n{};
        n.fill(bounces);
        const SimdComplex several =
            reflections_of(material, water, std::sin(grazing), std::cos(grazing), grazing, n);
        const std::complex<double> one = reflection_coefficient(material, grazing, water);
        std::complex<double> expected = 1.0;
        for (int i = 0; i < bounces; ++i) expected *= one;
        EXPECT_NEAR(several.real[0], expected.real(), 1e-13);
        EXPECT_NEAR(several.imag[0], expected.imag(), 1e-13);
      }
    }
}

}  // namespace
}  // namespace asdic::detail
