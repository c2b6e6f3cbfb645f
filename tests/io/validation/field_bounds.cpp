#include <gtest/gtest.h>

#include <algorithm>
#include <complex>
#include <filesystem>
#include <string>
#include <vector>

#include "io/bellhop/case_reader.h"
#include "raytrace/beams/convergence.h"
#include "raytrace/beams/fan.h"
#include "raytrace/runs/field_run.h"

// The error bound of the number of beams on the reference cases (tests/data/bellhop): the truth is
// a fan eight times as dense. docs/theory/fields.md
namespace asdic::detail {
namespace {

class FieldBound : public testing::TestWithParam<const char*> {
 protected:
  const PropagationCase run_case =
      bellhop::read_case(std::filesystem::path(ASDIC_TEST_DATA) / "bellhop" / GetParam() / "case")
          .run_case;
  const RayTracer tracer{run_case.environment, run_case.frequency};
  const bool coherent = run_case.field == FieldKind::coherent;

  [[nodiscard]] FanField field(const BeamFan& fan, const FieldCheck& also) const {
    return field_of_fan(run_case, tracer, run_case.source_depths[0], fan, {}, FieldMethod::fast,
                        also);
  }
  [[nodiscard]] BeamFan even(int beams) const {
    return even_fan(run_case.beams.lowest, run_case.beams.highest, beams);
  }
  void expect_bound(const FanField& f, const std::vector<std::complex<double>>& truth) const {
    EXPECT_LE(level_difference_db(f.field, truth, 0.95),
              bound_db(f.field, f.bound, coherent, 0.95));
    std::size_t beyond = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const double error = coherent ? std::abs(f.field[i] - truth[i])
                                    : std::abs(std::norm(f.field[i]) - std::norm(truth[i]));
      if (error > f.bound[i]) ++beyond;
    }
    EXPECT_LE(static_cast<double>(beyond), 0.05 * static_cast<double>(truth.size()));
  }
};

// Of an even fan; for hats also of that fan divided where its tubes ask for it, which then has an
// error below that of an even fan of as many beams.
TEST_P(FieldBound, HoldsAgainstAFanEightTimesAsDense) {
  const int beams = 1025;
  const FanField coarse = field(even(beams), {.bound = true});
  const auto truth = field(even(8 * (beams - 1) + 1), {}).field;
  expect_bound(coarse, truth);
  if (run_case.beams.kind != BeamKind::hat) return;
  const auto twice = static_cast<std::size_t>(2 * (beams - 1) + 1);
  const FanField graded = field(graded_fan(even(beams), coarse.tube_share, twice), {.bound = true});
  expect_bound(graded, truth);
  EXPECT_LT(level_difference_db(graded.field, truth, 0.95),
            level_difference_db(field(even(static_cast<int>(twice)), {}).field, truth, 0.95));
}

INSTANTIATE_TEST_SUITE_P(Cases, FieldBound,
                         testing::Values("munk-coherent-hat", "munk-incoherent-gauss",
                                         "pekeris-coherent", "grain-semicoherent",
                                         "front-range-dependent", "tables-and-pattern",
                                         "wedge-gauss", "swell-surface", "seamount-curved"));

}  // namespace
}  // namespace asdic::detail
