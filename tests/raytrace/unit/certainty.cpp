#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "raytrace/beams/convergence.h"
#include "raytrace/beams/fan_progress.h"
#include "raytrace/cases/beam_error_text.h"
#include "raytrace/runs/field_run.h"

// How sure a field is of its number of beams, when no more are taken, and what is told meanwhile.
namespace asdic::detail {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

TEST(ShareSure, IsOfReceiversOfWhichItIsKnown) {
  const std::vector<float> errors = {0.1F, unknown, 0.5F, 0.51F, infinite, unknown};
  EXPECT_EQ(share_sure(errors), 0.5);
  EXPECT_TRUE(std::isnan(share_sure(std::vector<float>{unknown})));
  EXPECT_EQ(certainty_text(0.289), "to 0.5 dB at 28 % of the receivers");
}

// (beams so far)/(beams of all fans that double until there are enough), and never less than it
// was.
TEST(FanProgress, RisesFromFanToFan) {
  double told = -1.0;
  FanProgress progress([&](double share) {
    EXPECT_GE(share, told);
    told = share;
    return share < 0.95;
  });
  progress.begin(1000, 8000);  // 1000 of 1000 + 2000 + 4000 + 8000
  EXPECT_TRUE(progress.of_fan()(0.0));
  EXPECT_TRUE(progress.of_fan()(1.0));
  EXPECT_DOUBLE_EQ(told, 1.0 / 15.0);
  progress.begin(2000, 8000);
  EXPECT_TRUE(progress.of_fan()(0.5));
  EXPECT_DOUBLE_EQ(told, 2.0 / 15.0);
  EXPECT_TRUE(progress.of_fan()(1.0));
  progress.begin(4000, 40'000);  // more than was thought: it stands still
  EXPECT_TRUE(progress.of_fan()(1.0));
  EXPECT_DOUBLE_EQ(told, 0.2);
  progress.begin(8000, 8000);
  EXPECT_FALSE(progress.of_fan()(1.0)) << "what the whole says is handed on";
  EXPECT_DOUBLE_EQ(told, 1.0);
  EXPECT_FALSE(FanProgress({}).of_fan());
}

/// A slope: water that beams have bounds in at every column.
PropagationCase slope() {
  PropagationCase run_case;
  run_case.environment.water =
      SoundSpeedProfile::table(std::vector<double>{0.0, 400.0}, std::vector<double>{1500.0, 1490.0},
                               Interpolation::c_linear);
  const std::vector<double> range = {0.0, 5000.0}, depth = {200.0, 60.0};
  run_case.environment.bottom = {.depth = 200.0, .material = FluidHalfSpace{}};
  run_case.environment.bottom.shape =
      BoundaryShape(range, depth, ShapeInterpolation::piecewise_linear);
  run_case.frequency = 200.0;
  run_case.source_depths = {50.0};
  for (int j = 1; j <= 40; ++j) run_case.receivers.ranges.push_back(100.0 * j);
  for (int k = 1; k <= 19; ++k) run_case.receivers.depths.push_back(10.0 * k);
  run_case.beams.lowest = -0.5;
  run_case.beams.highest = 0.5;
  return run_case;
}

/// A field of ones whose bound is what `bound` says of so many beams, for a share of the columns.
template <class Bound>
FieldOfFan field_with_bound(const PropagationCase& run_case, std::size_t& beams, Bound bound) {
  return [&run_case, &beams, bound](const BeamFan& fan, const FieldCheck& also) {
    const std::size_t cells = run_case.receivers.size();
    beams += fan.elevation.size();
    FanField field{.field = std::vector<std::complex<double>>(cells, 1.0),
                   .tube_share = std::vector<double>(fan.elevation.size() - 1, 1.0)};
    if (also.bound)
      for (std::size_t i = 0; i < cells; ++i)
        field.bound.push_back(
            bound(static_cast<double>(fan.elevation.size()), i % run_case.receivers.ranges.size()));
    return field;
  };
}

// A bound that falls with no number of beams: after two doublings nothing more is traced, and the
// note says so. One that falls goes on until it is what is wanted or the most beams are traced.
TEST(ConvergedField, StopsWhereMoreBeamsAreInVain) {
  const PropagationCase run_case = slope();
  std::size_t beams = 0;
  const ConvergedField vain = converged_field(
      run_case,
      field_with_bound(run_case, beams, [](double, std::size_t j) { return j < 10 ? 0.01 : 2.0; }));
  EXPECT_LE(vain.beams, 4 * 289U);  // two doublings of the first fan
  EXPECT_LE(beams, 2 * vain.beams);
  EXPECT_NE(vain.note.find(certainty_text(share_sure(vain.errors))), std::string::npos)
      << vain.note;
  EXPECT_NE(vain.note.find("made it no surer"), std::string::npos) << vain.note;
  EXPECT_NEAR(share_sure(vain.errors), 0.33, 0.01);  // of the water, which gets shallower

  const ConvergedField slow = converged_field(
      run_case, field_with_bound(run_case, beams,
                                 [](double n, std::size_t) { return 200.0 / std::sqrt(n); }));
  EXPECT_GE(slow.beams, std::size_t{most_beams}) << "the bound falls, though none is sure yet";
  EXPECT_EQ(slow.note.find("made it no surer"), std::string::npos) << slow.note;
  EXPECT_EQ(share_sure(slow.errors), 0.0);

  const ConvergedField good = converged_field(
      run_case, field_with_bound(run_case, beams, [](double n, std::size_t) { return 40.0 / n; }));
  EXPECT_LT(good.beams, 2000U);
  EXPECT_EQ(good.note, "");
  EXPECT_EQ(share_sure(good.errors), 1.0);
}

// An estimate, of kinds without a bound: a field that is as far from itself with half the beams
// whatever their number.
TEST(ConvergedField, EstimatesStopInVainToo) {
  PropagationCase run_case = slope();
  run_case.beams.kind = BeamKind::simple_gaussian;
  std::size_t fans = 0;
  const ConvergedField vain = converged_field(run_case, [&](const BeamFan&, const FieldCheck&) {
    ++fans;
    return FanField{.field = std::vector<std::complex<double>>(run_case.receivers.size(), 1.0),
                    .half = std::vector<std::complex<double>>(run_case.receivers.size(), 2.0)};
  });
  EXPECT_EQ(fans, 3U);
  EXPECT_NE(vain.note.find("made it no surer"), std::string::npos) << vain.note;
  EXPECT_EQ(share_sure(vain.errors), 0.0);
}

// What a receiver is sure to holds: against eight times as many beams, all but the few percent
// beside caustics and edges (ErrorBound). Receivers in the bottom have no field to be sure of.
TEST(ReceiverErrors, HoldOverASlopeAndAreOfTheWaterOnly) {
  PropagationCase run_case = slope();
  const PropagationResult result = run_field(run_case);
  const std::size_t columns = run_case.receivers.ranges.size();
  ASSERT_EQ(result.beam_errors.size(), result.field.size());
  run_case.beams.elevations =
      even_fan(run_case.beams.lowest, run_case.beams.highest, 262'145).elevation;
  const PropagationResult dense = run_field(run_case);
  EXPECT_TRUE(dense.beam_errors.empty()) << "elevations as listed are compared with no others";
  std::size_t known = 0, beyond = 0;
  for (std::size_t i = 0; i < result.field.size(); ++i) {
    const double depth = run_case.receivers.depths[i / columns];
    const double floor =
        run_case.environment.bottom.depth_at(run_case.receivers.ranges[i % columns]);
    if (depth > floor + 0.01) {
      EXPECT_TRUE(std::isnan(result.beam_errors[i])) << i;
      continue;
    }
    if (std::isnan(result.beam_errors[i])) continue;
    ++known;
    const double change =
        20.0 * std::abs(std::log10(double{std::abs(result.field[i] / dense.field[i])}));
    beyond += change > static_cast<double>(result.beam_errors[i]) + 1e-3;
  }
  EXPECT_GT(known, 300U);
  EXPECT_LT(static_cast<double>(beyond), 0.05 * static_cast<double>(known));
}

// Two sources share the whole of the progress, and each has its own errors.
TEST(ReceiverErrors, AreOfEachSourceAndProgressIsOfAll) {
  PropagationCase run_case = slope();
  run_case.source_depths = {50.0, 0.0, 20.0};  // the second is on the surface: it sends nothing
  run_case.beams.kind = BeamKind::gaussian;
  std::vector<double> told;
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const PropagationResult result = run_field(run_case, [&](double share) {
    told.push_back(share);
    return true;
  });
  const std::size_t cells = run_case.receivers.size();
  ASSERT_EQ(result.beam_errors.size(), 3 * cells);
  const std::span<const float> all(result.beam_errors);
  EXPECT_GT(share_sure(all.first(cells)), 0.0);
  EXPECT_TRUE(std::isnan(share_sure(all.subspan(cells, cells))));
  EXPECT_GT(share_sure(all.last(cells)), 0.0);
  ASSERT_FALSE(told.empty());
  EXPECT_GT(told.back(), 2.0 / 3.0);
  EXPECT_LE(told.back(), 1.0);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
}

}  // namespace
}  // namespace asdic::detail
