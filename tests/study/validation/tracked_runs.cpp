#include <gtest/gtest.h>

#include <cmath>

#include "study/reader/study_reader.h"
#include "study/summary/axis.h"
#include "study/summary/summary.h"
#include "support/deep.h"
#include "support/plain_sea.h"
#include "support/realised.h"
#include "support/summary_tables.h"
#include "support/temporary_directory.h"

// The receiver's tracker over a run of pings.

namespace asdic::detail::study {
namespace {

/// Six pings, 6 s apart, at a Swerling target that goes north, seen by a line of 16 phones.
/// \param speed  [m/s]
Study passing(double speed, std::uint64_t rows, const std::string& tracker = "true") {
  const support::TemporaryDirectory folder;
  return read_study(
      folder.write("study.toml",
                   "[study]\nrealisations = " + std::to_string(rows) +
                       "\nseed = 3\n[measure]\nlocalisation_error = true\nping = 6\n"
                       "detection = { by = \"receiver\", false_alarm_probability = 1e-5 }\n"
                       "pings = { initiation = [3, 4], tracker = " +
                       tracker +
                       " }\n"
                       "[measure.receiver]\ntarget_depth = 100.0\nmax_speed = 40.0\n" +
                       support::plain_sea),
      std::vector<std::string>{"array.phones=16", "pings.count=6", "pings.interval=6.0",
                               "pings.recording_duration=5.0", "target.0.fluctuation=swerling-1",
                               "target.0.scan_pings=1", "noise.spectral_level_db=52",
                               "target.0.position=[3000.0,0.0,100.0]",
                               "target.0.velocity=[0.0," + std::to_string(speed) + ",0.0]"});
}

double mean(const Table& table, const std::string& name) {
  double sum = 0.0, n = 0.0;
  for (const double x : table.values[column_of(table, name)])
    if (std::isfinite(x)) sum += x, ++n;
  return sum / n;
}

double root_mean_square(const Table& table, const std::string& name) {
  double sum = 0.0, n = 0.0;
  for (const double x : table.values[column_of(table, name)])
    if (std::isfinite(x)) sum += x * x, ++n;
  return std::sqrt(sum / n);
}

// A slow target's hits all fall into the gate: the tracker believes it with the very ping with
// which 3 of 4 pings in a row have hit, but where it begins from another contact. Six pings of its
// own motion place it better than one.
TEST(TrackedRun, ATrackBeginsWithItsHits) {
  const std::uint64_t rows = support::deep() ? 400 : 40;
  const Study study = passing(4.0, rows);
  const Table table = support::realised(study);
  const ColumnValues &tracked = table.values[column_of(table, "track_ping")],
                     &initiated = table.values[column_of(table, "initiation_ping")];
  int same = 0;
  for (std::size_t row = 0; row < table.index.size(); ++row)
    same +=
        tracked[row] == initiated[row] || (std::isnan(tracked[row]) && std::isnan(initiated[row]))
            ? 1
            : 0;
  EXPECT_GT(mean(table, "initiated"), 0.5);
  EXPECT_LT(mean(table, "initiated"), 0.97);
  EXPECT_GE(same, static_cast<int>(0.9 * static_cast<double>(rows)));
  std::printf(
      "initiated %.3f, tracked %.3f, the same ping %d of %d, track %.2f m, ping %.2f m, "
      "false %.3f\n",
      mean(table, "initiated"), mean(table, "tracked"), same, static_cast<int>(rows),
      root_mean_square(table, "track_error"), root_mean_square(table, "position_error"),
      mean(table, "false_tracks"));
  EXPECT_LT(root_mean_square(table, "track_error"), root_mean_square(table, "position_error"));
  const std::vector<SummaryTable> tables = summarise(study, table);
  const SummaryTable& pings = named(tables, "pings");
  EXPECT_NEAR(column(pings, "ptracked").back(), mean(table, "tracked"), 1e-12);
  EXPECT_EQ(column(pings, "ptracked").front(), 0.0);
  EXPECT_EQ(column(pings, "ptracked")[1], 0.0);  // three hits take three pings
}

// What goes faster than the tracker thinks targets go is hit as often, and leaves the gate.
TEST(TrackedRun, HitsOutsideTheGateAreNoTrack) {
  const Study study = passing(35.0, 20, "{ track_max_speed = 2.0, track_acceleration = 0.001 }");
  const Table table = support::realised(study);
  EXPECT_GT(mean(table, "initiated"), 0.5);
  EXPECT_LT(mean(table, "tracked"), 0.1);
}

}  // namespace
}  // namespace asdic::detail::study
