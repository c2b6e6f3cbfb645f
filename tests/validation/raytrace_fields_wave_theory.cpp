#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <string>
#include <vector>

#include "raytrace/beams/fan.h"
#include "raytrace/beams/field_run.h"
#include "support/csv.h"

// Fields beside wave theory (tests/data/physics-reference; complex fields there are for e^(−iωt)).
// docs/theory/fields.md has the table of all kinds of beams.
namespace asdic {
namespace {

/// A column of a reference file: the truth over range, e^(+iωt).
std::vector<std::complex<double>> truth(const support::Csv& csv, const std::string& receiver) {
  std::vector<std::complex<double>> p;
  for (std::size_t i = 0; i < csv.rows(); ++i)
    p.emplace_back(csv[receiver + "_re"][i], -csv[receiver + "_im"][i]);
  return p;
}

/// |p| of the truth averaged over nine receivers: a null is where it is less than half of that.
std::vector<bool> away_from_nulls(const std::vector<std::complex<double>>& p) {
  std::vector<bool> result(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    double sum = 0.0;
    int n = 0;
    for (std::size_t j = i < 4 ? 0 : i - 4; j < std::min(p.size(), i + 5); ++j, ++n)
      sum += std::norm(p[j]);
    result[i] = std::norm(p[i]) > 0.25 * sum / n;
  }
  return result;
}

double level_error_db(std::complex<float> ours, std::complex<double> theirs) {
  return 20.0 * std::log10(std::abs(std::complex<double>(ours)) / std::abs(theirs));
}

PropagationCase start(const support::Csv& csv, double frequency) {
  PropagationCase run_case;
  run_case.frequency = frequency;
  const auto ranges = csv["range_m"];
  run_case.receivers.ranges.assign(ranges.begin(), ranges.end());
  return run_case;
}

void fan(PropagationCase& run_case, double steepest_deg, int beams) {
  run_case.beams.elevations =
      even_fan(-radians(steepest_deg), radians(steepest_deg), beams).elevation;
}

// Two paths, both exact for rays. The sum of hats is off by the bend of the wavefront between two
// rays, k(RΔα)²/8R ≤ 1e-4 rad: the level everywhere to 0.01 dB.
TEST(WaveTheory, LloydMirror) {
  const support::Csv csv("physics-reference/field_lloyd_mirror_150Hz.csv");
  PropagationCase run_case = start(csv, 150.0);
  run_case.environment.bottom.depth = 20e3;
  run_case.box_range = 6e3;
  run_case.box_depth = 15e3;
  run_case.source_depths = {25.0};
  run_case.receivers.depths = {200.0};
  fan(run_case, 89.0, 8001);
  const auto field = run_field(run_case).field;
  const auto wave = truth(csv, "p");
  for (std::size_t i = 0; i < wave.size(); ++i)
    EXPECT_NEAR(level_error_db(field[i], wave[i]), 0.0, 0.01) << csv["range_m"][i];
}

// Perfect walls: the images are exact, so rays are valid everywhere; what is missing is beyond the
// fan. A fan to θ leaves out images farther than r/cos θ, whose alternating sum is half the first
// one left out: cos θ/2r = 0.026/r at 87°, 0.01 to 0.02 of the field (0.6/√(rD)… ≥ 1.3/r here) or
// 0.17 dB. Hats are right while a beam is narrower than the guide, rΔα/cos²θ < D: r < 1.8 km for 64
// 001 beams.
TEST(WaveTheory, IdealWaveguide) {
  const support::Csv csv("physics-reference/field_ideal_waveguide_20Hz.csv");
  PropagationCase run_case = start(csv, 20.0);
  run_case.environment.bottom = {.depth = 100.0, .material = Rigid{}};
  run_case.source_depths = {36.0};
  run_case.receivers.depths = {50.0, 80.0};
  auto& ranges = run_case.receivers.ranges;
  ranges.erase(std::upper_bound(ranges.begin(), ranges.end(), 1800.0), ranges.end());
  fan(run_case, 87.0, 64'001);
  const auto field = run_field(run_case).field;
  for (const std::size_t row : {0, 1}) {
    const auto wave = truth(csv, row == 0 ? "zr50" : "zr80");
    const auto clear = away_from_nulls(wave);
    std::vector<double> errors;
    for (std::size_t i = 0; i < ranges.size(); ++i)
      if (clear[i])
        errors.push_back(std::abs(level_error_db(field[row * ranges.size() + i], wave[i])));
    std::sort(errors.begin(), errors.end());
    EXPECT_LT(errors[errors.size() * 95 / 100], 0.2);
  }
}

}  // namespace
}  // namespace asdic
