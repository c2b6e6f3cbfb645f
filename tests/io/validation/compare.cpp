#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "io/compare/arrivals.h"
#include "io/compare/fields.h"
#include "io/compare/rays.h"

// BELLHOP's default runs against its converged ones (tests/data/bellhop): the figures that another
// comparison program, written in Python, found and that stand in each meta.json.

namespace asdic::detail::compare {
namespace {

using nlohmann::json;

const std::filesystem::path data = ASDIC_TEST_DATA "/bellhop";

json figures(const std::string& name) {
  std::ifstream file(data / name / "meta.json");
  return json::parse(file)["figures"]["default"];
}

/// Figures are printed with five digits: half a unit of the last, and a hair for the rounding of
/// one half.
double printed(double value) {
  return value == 0.0 ? 1e-12
                      : 0.501 * std::pow(10.0, std::floor(std::log10(std::abs(value))) - 4.0);
}

void expect(const json& figures, const std::string& key, double value, double extra = 0.0) {
  if (!figures.contains(key)) return;  // not every figure is told of every case
  const double expected = figures[key];
  EXPECT_NEAR(value, expected, printed(expected) + extra) << key;
}

class Fields : public ::testing::TestWithParam<std::string> {};

TEST_P(Fields, FiguresAreThoseOfAnotherProgram) {
  const auto folder = data / GetParam();
  const json expected = figures(GetParam());
  const FieldDifference d = compare_fields(bellhop::read_shade_file(folder / "case.shd"),
                                           bellhop::read_shade_file(folder / "converged/case.shd"));
  EXPECT_EQ(d.compared, expected["cells_compared"].get<std::size_t>());
  expect(expected, "one_sided_pct", d.one_sided_pct);
  expect(expected, "dtl_median", d.tl_db.median);
  expect(expected, "dtl_p90", d.tl_db.p90);
  expect(expected, "dtl_p95", d.tl_db.p95);
  expect(expected, "dtl_p99", d.tl_db.p99);
  expect(expected, "dtl_max", d.tl_db.max);
  expect(expected, "within_0.5dB_pct", d.within_pct[2]);
  expect(expected, "within_1dB_pct", d.within_pct[3]);
  expect(expected, "tl_corr", d.tl_correlation);
  expect(expected, "coh_rel_err", d.relative_error);
  expect(expected, "coh_corr", d.complex_correlation);
  expect(expected, "phase_err_median_deg", d.phase_deg.median);
  expect(expected, "phase_err_p95_deg", d.phase_deg.p95);
}

INSTANTIATE_TEST_SUITE_P(ReferenceCases, Fields,
                         ::testing::Values("cerveny-cartesian", "cerveny-raycentred",
                                           "front-range-dependent", "grain-semicoherent",
                                           "munk-coherent-hat", "munk-incoherent-gauss",
                                           "pekeris-coherent", "seamount-curved", "swell-surface",
                                           "tables-and-pattern", "wedge-gauss"));

// The other program stops pairing at the first path that is already taken, so it misses pairs (473
// of 484 here). Its figures that do not depend on the pairs are those of meta.json; those that do
// come from the same program with that one line repaired (a `break` that should be `continue`).
struct Paths {
  std::string name;
  std::size_t matched;
  double matched_energy_pct, amplitude_mean, amplitude_median, amplitude_p95, amplitude_max;
  double delay_mean, delay_median, delay_p95, delay_max;
  double phase_p95, launch_p95, arrival_median, arrival_p95;
};

void PrintTo(const Paths& paths, std::ostream* out) { *out << paths.name; }

class PathsOfArrivals : public ::testing::TestWithParam<Paths> {};

TEST_P(PathsOfArrivals, FiguresAreThoseOfAnotherProgram) {
  const Paths& e = GetParam();
  const json told = figures(e.name);
  const ArrivalDifference d =
      compare_arrivals(bellhop::read_arrivals_file(data / e.name / "case.arr"),
                       bellhop::read_arrivals_file(data / e.name / "converged/case.arr"));
  EXPECT_EQ(d.receivers, told["receivers"].get<std::size_t>());
  EXPECT_EQ(d.paths_a, told["arrivals_a"].get<std::size_t>());
  EXPECT_EQ(d.paths_b, told["arrivals_b"].get<std::size_t>());
  expect(told, "energy_a_over_b_db", d.energy_db);
  expect(told, "sum_dtl_median", d.sum_db.median);
  expect(told, "sum_dtl_p95", d.sum_db.p95);
  EXPECT_GE(d.matched, told["matched"].get<std::size_t>());

  EXPECT_EQ(d.matched, e.matched);
  const auto near = [](double value, double expected) {
    EXPECT_NEAR(value, expected, printed(expected));
  };
  near(d.energy_matched_pct, e.matched_energy_pct);
  near(d.amplitude_db.mean, e.amplitude_mean);
  near(d.amplitude_db.median, e.amplitude_median);
  near(d.amplitude_db.p95, e.amplitude_p95);
  near(d.amplitude_db.max, e.amplitude_max);
  near(d.delay_us.mean, e.delay_mean);
  near(d.delay_us.median, e.delay_median);
  near(d.delay_us.p95, e.delay_p95);
  near(d.delay_us.max, e.delay_max);
  near(d.phase_deg.p95, e.phase_p95);
  near(d.launch_deg.p95, e.launch_p95);
  near(d.arrival_deg.median, e.arrival_median);
  near(d.arrival_deg.p95, e.arrival_p95);
}

INSTANTIATE_TEST_SUITE_P(ReferenceCases, PathsOfArrivals,
                         ::testing::Values(Paths{"deep-source-arrivals", 484, 99.999, -0.92956,
                                                 0.016737, 4.5772, 33.959, -76.758, 43.900, 272.19,
                                                 801.10, 0.30886, 0.014753, 0.0029434, 0.017701},
                                           Paths{"deep-source-arrivals-pchip", 398, 98.154, -1.9934,
                                                 1.0828, 11.584, 51.934, -241.44, 162.70, 542.86,
                                                 774.40, 90.051, 0.015511, 0.053617, 0.24345},
                                           Paths{"elastic-arrivals", 3592, 99.997, -0.16010,
                                                 0.074658, 0.56929, 19.405, -1.9031, 1.6700, 3.3300,
                                                 260.11, 1.3039, 0.0017166, 0.0063442, 0.048602}));

class RaySets : public ::testing::TestWithParam<std::string> {};

TEST_P(RaySets, FiguresAreThoseOfAnotherProgram) {
  const auto folder = data / GetParam();
  const json expected = figures(GetParam());
  const RayDifference d = compare_rays(bellhop::read_ray_file(folder / "case.ray"),
                                       bellhop::read_ray_file(folder / "converged/case.ray"));
  EXPECT_EQ(d.rays_a, expected["rays_a"].get<std::size_t>());
  EXPECT_EQ(d.rays_b, expected["rays_b"].get<std::size_t>());
  EXPECT_EQ(d.points_a, expected["points_a"].get<std::size_t>());
  EXPECT_EQ(d.points_b, expected["points_b"].get<std::size_t>());
  EXPECT_EQ(d.paired, expected["paired"].get<std::size_t>());
  constexpr double stored = 1e-3;  // the converged points are kept rounded to 1 mm
  expect(expected, "path_m_median", d.path_m.median, stored);
  expect(expected, "path_m_p95", d.path_m.p95, stored);
  expect(expected, "path_m_max", d.path_m.max, stored);
  expect(expected, "end_m_median", d.end_m.median, stored);
  expect(expected, "end_m_max", d.end_m.max, stored);
}

INSTANTIATE_TEST_SUITE_P(ReferenceCases, RaySets,
                         ::testing::Values("eigenrays-channel", "rays-upslope"));

}  // namespace
}  // namespace asdic::detail::compare
