#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "core/units.h"
#include "study/reader/study_reader.h"
#include "study/summary/error_ellipse.h"
#include "study/summary/summary.h"
#include "support/deep.h"
#include "support/plain_sea.h"
#include "support/temporary_directory.h"

namespace asdic::detail::study {
namespace {

double value(const Study& study, const Row& row, const std::string& name) {
  const std::vector<Column> all = columns(study);
  for (std::size_t c = 0; c < all.size(); ++c)
    if (all[c].name == name) return row.values.at(c);
  throw std::runtime_error("no column " + name);
}

// The receiver's errors of place against what no receiver can do better in white noise (Cramér and
// Rao): of the matched filter's SNR S, β the pulse's root-mean-square angular bandwidth, a line of
// n phones d apart, and θ the angle from its axis,
//
//   σ_range = c/2 · 1/(β√(2S)),   σ_across = r/sin θ · λ/(2πd) · 1/√(2S(n² − 1)/12)
//
// Of a Hann window of duration T, sin²(πt/T), β² = ∫|s'|²/∫|s|² = (4/3)(π/T)². At 26 dB the
// receiver's interpolated peaks come within 5 % of it. Deviations of n errors scatter by 1/√(2n);
// five of these, and 8 % for the receiver.
TEST(Localisation, EllipseIsThatOfCramerAndRao) {
  const std::uint64_t rows = support::deep() ? 1000 : 100;
  const support::TemporaryDirectory folder;
  const Study study = read_study(
      folder.write("study.toml",
                   "[study]\nrealisations = " + std::to_string(rows) +
                       "\nseed = 3\n[measure]\n"
                       "detection = { by = \"receiver\", false_alarm_probability = 1e-5 }\n"
                       "localisation_error = true\nlocalisation_ellipse = true\n"
                       "[measure.receiver]\ntarget_depth = 100.0\n" +
                       support::plain_sea),
      std::vector<std::string>{"array.phones=16", "target.0.position=[3000.0,1500.0,100.0]"});
  const Realiser realiser(study);
  std::vector<Row> made(rows);
  tbb::parallel_for(std::size_t{0}, made.size(),
                    [&](std::size_t i) { made[i] = realiser.realise(i); });
  std::vector<double> away, across;
  double snr = 0.0;
  for (const Row& row : made) {
    ASSERT_EQ(value(study, row, "detected"), 1.0);
    const double east = value(study, row, "east_error"), north = value(study, row, "north_error");
    EXPECT_NEAR(std::hypot(east, north), value(study, row, "position_error"), 1e-9);
    EXPECT_NEAR(value(study, row, "target_east"), 3000.0, 1e-6);
    EXPECT_NEAR(value(study, row, "target_north"), 1500.0, 1e-6);
    away.push_back(value(study, row, "away_error"));
    across.push_back(value(study, row, "across_error"));
    // Sight to the target is (2, 1)/√5, and right of it (1, −2)/√5.
    EXPECT_NEAR(away.back(), (2.0 * east + north) / std::sqrt(5.0), 1e-9);
    EXPECT_NEAR(across.back(), (east - 2.0 * north) / std::sqrt(5.0), 1e-9);
    snr += power_from_db(value(study, row, "detection_snr_db")) / static_cast<double>(rows);
  }
  snr -= 1.0;  // the peak has its own noise in it
  EXPECT_GT(snr, 300.0);
  const double range = std::hypot(3000.0, 1500.0), sine = 3000.0 / range;  // the line lies north
  const double bandwidth = std::sqrt(4.0 / 3.0) * pi / 0.1;
  const double of_range = 0.5 * 1500.0 / (bandwidth * std::sqrt(2.0 * snr));
  const double of_place =
      range / sine * 1.5 / (2.0 * pi * 0.75) / std::sqrt(2.0 * snr * (16.0 * 16.0 - 1.0) / 12.0);
  const ErrorEllipse found = error_ellipse(across, away, 0.95);
  const double n = static_cast<double>(rows);
  const double radius = std::sqrt((n * n - 1.0) / n * (std::pow(0.05, -2.0 / (n - 2.0)) - 1.0));
  const double tolerance = 0.08 + 5.0 / std::sqrt(2.0 * n);
  EXPECT_NEAR(found.minor / radius / of_range, 1.0, tolerance);
  EXPECT_NEAR(found.major / radius / of_place, 1.0, tolerance);
  // The long axis lies across the line of sight: 90° within five of its deviations.
  EXPECT_NEAR(degrees(found.bearing), 90.0, 5.0 * degrees(of_range / of_place / std::sqrt(n)));
  std::printf("range %.3f m, Cramér and Rao %.3f; across %.2f m, %.2f; SNR %.1f dB\n",
              found.minor / radius, of_range, found.major / radius, of_place, db_from_power(snr));
}

}  // namespace
}  // namespace asdic::detail::study
