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

constexpr double east = 3000.0, north = 1500.0;  // of the target, from the array [m]
const double range = std::hypot(east, north);

/// The receiver's errors of place of a target in white noise, heard by 16 phones that lie north.
struct Places {
  std::vector<double> away, across;  ///< [rows] [m]
  double snr = 0.0;                  ///< of the matched filter, its own noise taken off

  [[nodiscard]] double rows() const { return static_cast<double>(away.size()); }
};

/// \param keys  of the plain sea
Places places(std::vector<std::string> keys) {
  const std::uint64_t rows = support::deep() ? 1000 : 100;
  const support::TemporaryDirectory folder;
  keys.insert(keys.end(), {"array.phones=16", "target.0.position=[3000.0,1500.0,100.0]"});
  const Study study = read_study(
      folder.write("study.toml",
                   "[study]\nrealisations = " + std::to_string(rows) +
                       "\nseed = 3\n[measure]\n"
                       "detection = { by = \"receiver\", false_alarm_probability = 1e-5 }\n"
                       "localisation_error = true\nlocalisation_ellipse = true\n"
                       "[measure.receiver]\ntarget_depth = 100.0\n" +
                       support::plain_sea),
      keys);
  const Realiser realiser(study);
  std::vector<Row> made(rows);
  tbb::parallel_for(std::size_t{0}, made.size(),
                    [&](std::size_t i) { made[i] = realiser.realise(i); });
  Places all;
  for (const Row& row : made) {
    EXPECT_EQ(value(study, row, "detected"), 1.0);
    const double to_east = value(study, row, "east_error"),
                 to_north = value(study, row, "north_error");
    EXPECT_NEAR(std::hypot(to_east, to_north), value(study, row, "position_error"), 1e-9);
    EXPECT_NEAR(value(study, row, "target_east"), east, 1e-6);
    EXPECT_NEAR(value(study, row, "target_north"), north, 1e-6);
    all.away.push_back(value(study, row, "away_error"));
    all.across.push_back(value(study, row, "across_error"));
    // Sight to the target is (2, 1)/√5, and right of it (1, −2)/√5.
    EXPECT_NEAR(all.away.back(), (2.0 * to_east + to_north) / std::sqrt(5.0), 1e-9);
    EXPECT_NEAR(all.across.back(), (to_east - 2.0 * to_north) / std::sqrt(5.0), 1e-9);
    all.snr += power_from_db(value(study, row, "detection_snr_db")) / static_cast<double>(rows);
  }
  all.snr -= 1.0;  // the peak has its own noise in it
  EXPECT_GT(all.snr, 200.0);
  return all;
}

// What no receiver can do better in white noise (Cramér and Rao): of the matched filter's SNR S, β
// the pulse's root-mean-square angular bandwidth, a line of n phones d apart, and θ the angle from
// its axis,
//
//   σ_delay = 1/(β√(2S)),   σ_across = r/sin θ · λ/(2πd) · 1/√(2S(n² − 1)/12)
double across_bound(double snr) {
  const double sine = east / range;  // the line lies north
  return range / sine * 1.5 / (2.0 * pi * 0.75) / std::sqrt(2.0 * snr * (16.0 * 16.0 - 1.0) / 12.0);
}

/// Of a Hann window of duration T, sin²(πt/T): β² = ∫|s'|²/∫|s|² = (4/3)(π/T)².
double delay_bound(double duration, double snr) {
  return 1.0 / (std::sqrt(4.0 / 3.0) * pi / duration * std::sqrt(2.0 * snr));
}

/// Deviations of n errors scatter by 1/√(2n); five of these, and 8 % for the receiver: at 26 dB its
/// interpolated peaks come within 5 % of the bound.
double tolerance(double rows) { return 0.08 + 5.0 / std::sqrt(2.0 * rows); }

TEST(Localisation, EllipseIsThatOfCramerAndRao) {
  const Places found = places({});
  const double of_range = 0.5 * 1500.0 * delay_bound(0.1, found.snr),
               of_place = across_bound(found.snr), n = found.rows();
  const ErrorEllipse ellipse = error_ellipse(found.across, found.away, 0.95);
  const double radius = std::sqrt((n * n - 1.0) / n * (std::pow(0.05, -2.0 / (n - 2.0)) - 1.0));
  EXPECT_NEAR(ellipse.minor / radius / of_range, 1.0, tolerance(n));
  EXPECT_NEAR(ellipse.major / radius / of_place, 1.0, tolerance(n));
  // The long axis lies across the line of sight: 90° within five of its deviations.
  EXPECT_NEAR(degrees(ellipse.bearing), 90.0, 5.0 * degrees(of_range / of_place / std::sqrt(n)));
  std::printf("range %.3f m, Cramér and Rao %.3f; across %.2f m, %.2f; SNR %.1f dB\n",
              ellipse.minor / radius, of_range, ellipse.major / radius, of_place,
              db_from_power(found.snr));
}

/// Mean of the product of two errors, their means taken off.
double covariance(const std::vector<double>& a, const std::vector<double>& b) {
  const double n = static_cast<double>(a.size());
  double of_a = 0.0, of_b = 0.0, product = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) of_a += a[i] / n, of_b += b[i] / n;
  for (std::size_t i = 0; i < a.size(); ++i) product += (a[i] - of_a) * (b[i] - of_b);
  return product / (n - 1.0);
}

// A source that lies 2 km south of the array: with û and ŵ the directions from array and source to
// the target, and t̂ right of û, a delay's error is c·dτ = (1 + û·ŵ) d_away + (t̂·ŵ) d_across. A
// bearing's error goes along the ellipse of the delay, so both errors of place go together.
TEST(Localisation, BistaticErrorsLieAlongTheEllipseOfTheDelay) {
  const Places found =
      places({"platform.position=[0.0,-2000.0,100.0]", "array.offset=[0.0,2000.0,0.0]"});
  const double source = std::hypot(east, north + 2000.0);
  const double along = (east * east + north * (north + 2000.0)) / (range * source),
               beside = (north * east - east * (north + 2000.0)) / (range * source);
  const double of_delay = 1500.0 * delay_bound(0.1, found.snr), a = across_bound(found.snr);
  const double away = std::hypot(of_delay, beside * a) / (1.0 + along),
               correlation = -beside * a / (1.0 + along) / away;
  const double n = found.rows(), across_found = std::sqrt(covariance(found.across, found.across)),
               away_found = std::sqrt(covariance(found.away, found.away)),
               correlation_found =
                   covariance(found.across, found.away) / (across_found * away_found);
  EXPECT_NEAR(across_found / a, 1.0, tolerance(n));
  EXPECT_NEAR(away_found / away, 1.0, tolerance(n));
  EXPECT_GT(correlation, 0.8);
  // Fisher's z of n pairs has the deviation 1/√(n − 3).
  EXPECT_NEAR(std::atanh(correlation_found), std::atanh(correlation),
              0.08 + 5.0 / std::sqrt(n - 3.0));
  std::printf("bistatic: away %.2f m, bound %.2f; across %.2f m, %.2f; correlation %.3f, %.3f\n",
              away_found, away, across_found, a, correlation_found, correlation);
}

// A sweep whose target may go at any speed tells delay and Doppler factor together, and the delay
// goes along the ridge. Its bound with both unknown is that of its window without the sweep,
//
//   J = 2S [κ²v + β², −κv; −κv, v]  ⇒  (J⁻¹)_ττ = 1/(2Sβ²),
//
// κ the sweep's rate, v the mean square of time under the window, β² = ∫|a'|²/∫|a|² of the window
// a. Ten times the error that the sweep's bandwidth alone would tell.
TEST(Localisation, SweepsErrAlongTheirRidge) {
  const Places found =
      places({R"(pulse={kind="lfm", start_frequency=950.0, end_frequency=1050.0, duration=0.5,)"
              R"( window="hann"})",
              "measure.receiver.max_speed=40.0", "pings.recording_duration=7.0",
              "transmitter.source_level_db=193"});
  const double of_range = 0.5 * 1500.0 * delay_bound(0.5, found.snr), n = found.rows();
  const double away = std::sqrt(covariance(found.away, found.away)),
               across = std::sqrt(covariance(found.across, found.across));
  std::printf("sweep: away %.2f m, bound %.2f; across %.2f m, %.2f; SNR %.1f dB\n", away, of_range,
              across, across_bound(found.snr), db_from_power(found.snr));
  EXPECT_NEAR(away / of_range, 1.0, 0.25 + 5.0 / std::sqrt(2.0 * n));
  EXPECT_NEAR(across / across_bound(found.snr), 1.0, tolerance(n));
}

}  // namespace
}  // namespace asdic::detail::study
