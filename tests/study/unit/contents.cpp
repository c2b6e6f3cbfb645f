#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <complex>
#include <thread>

#include "io/hdf5/hdf5_file.h"
#include "study/reader/study_reader.h"
#include "study/runs/merge.h"
#include "study/runs/run_study.h"
#include "support/plain_sea.h"
#include "support/synthetic_study.h"

// What a study leaves on the disk: how its rows were made, time series that can be used, and the
// rows of a process that was killed.

namespace asdic::detail::study {
namespace {

class Contents : public testing::Test {
 protected:
  /// Runs a range of a study of the plain sea. \return its file
  std::filesystem::path run(const std::string& tables, const std::string& name, IndexRange range,
                            const std::vector<std::string>& overrides = {}) {
    const Study study = read_study(
        folder.write("study.toml", "[study]\nrealisations = " + std::to_string(realisations) +
                                       "\n" + tables + support::plain_sea),
        overrides);
    const Realiser realiser(study);
    const Work work = work_of(study, [&](std::uint64_t index) { return realiser.realise(index); });
    run_study(work, {.output = folder / name, .range = range});
    return folder / name;
  }

  support::TemporaryDirectory folder;
  int realisations = 6;
};

double sum(const Hdf5File& file, const std::string& path) {
  double total = 0.0;
  for (const double x : file.read<double>(path)) total += x;
  return total;
}

// Nothing but the noise changes: one realisation searches for the echo's paths, a leg out and a leg
// back, and the others know them (with several threads, more than one may search at once).
TEST_F(Contents, SayWhatWasReused) {
  const Hdf5File file = Hdf5File::open(
      run("[vary]\n\"noise.spectral_level_db\" = { law = \"uniform\", low = 30, high = 40 }\n"
          "[measure]\necho_level = true\n",
          "s.h5", {0, 6}));
  const double searched = sum(file, "run/reuse/legs_searched"),
               reused = sum(file, "run/reuse/legs_reused");
  EXPECT_GT(searched, 0.0);
  EXPECT_GT(reused, 0.0);
  EXPECT_EQ(std::fmod(searched + reused, 6.0), 0.0);  // as many of each realisation
  EXPECT_EQ(file.read<double>("run/reuse/ocean").size(), 6U);
  EXPECT_FALSE(file.has("table/legs_searched"));
}

TEST_F(Contents, WhatWasReusedGoesThroughAMerge) {
  const std::string tables = "[measure]\necho_level = true\n";
  const auto a = run(tables, "a.h5", {0, 4}), b = run(tables, "b.h5", {4, 6});
  merge({a, b}, folder / "all.h5", [](const Fingerprint&, const Table&) { return Summary{}; });
  const double parts = sum(Hdf5File::open(a), "run/reuse/legs_searched") +
                       sum(Hdf5File::open(b), "run/reuse/legs_searched");
  EXPECT_EQ(sum(Hdf5File::open(folder / "all.h5"), "run/reuse/legs_searched"), parts);
}

// Rates differ from row to row. Out of the file alone: the echo of 3 km at 1500 m/s is received 4 s
// after the ping, and the peak of its Hann window of 0.1 s half of that later. At 60 dB over the
// noise the peak is found to some samples: its top is flat to 1 % over 6 % of the pulse.
TEST_F(Contents, TimeSeriesCanBeReadOutOfTheFileAlone) {
  const std::string tables =
      "[vary]\n\"pings.baseband_rate\" = { law = \"list\", values = [300, 500] }\n"
      "\"pings.recording_start\" = { law = \"list\", values = [0.0, 3.5, 1.0] }\n"
      "[measure]\ntime_series = \"all\"\n";
  const std::vector<std::string> loud{"transmitter.source_level_db=240"};
  const auto a = run(tables, "a.h5", {0, 4}, loud), b = run(tables, "b.h5", {4, 6}, loud);
  for (const bool copy : {false, true}) {
    merge({a, b}, folder / "all.h5", [](const Fingerprint&, const Table&) { return Summary{}; },
          {.copy = copy});
    const Hdf5File file = Hdf5File::open(folder / "all.h5");
    const auto rates = file.read<double>("time_series/sample_rate"),
               starts = file.read<double>("time_series/start"),
               carriers = file.read<double>("time_series/carrier");
    ASSERT_EQ(rates.size(), 6U);
    EXPECT_EQ(file.read<double>("time_series/epoch").size(), 6U);
    const auto used = file.read<std::int32_t>("time_series/valid_samples");
    const Shape shape = file.info("time_series/pressure").shape;
    const auto x = file.read<float>("time_series/pressure");
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_GE(rates[k], k % 2 == 0 ? 300.0 : 500.0);
      EXPECT_EQ(starts[k], k % 3 == 0 ? 0.0 : k % 3 == 1 ? 3.5 : 1.0);
      EXPECT_NEAR(carriers[k], 1000.0, 10.0);
      std::size_t peak = 0;
      double most = 0.0;
      for (std::size_t i = 0; i < static_cast<std::size_t>(used[k]); ++i) {
        const float* p = x.data() + (k * shape[1] * shape[2] + i) * 2;
        const double size = std::hypot(double(p[0]), double(p[1]));
        if (size > most) most = size, peak = i;
      }
      EXPECT_NEAR(starts[k] + static_cast<double>(peak) / rates[k], 4.05, 0.006) << k;
    }
    std::filesystem::remove(folder / "all.h5");
  }
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// A process writes rows that say when they were made, until it is killed: all that are older than a
// second are there.
TEST(KilledJournal, LosesAtMostTheLastSecond) {
  const support::TemporaryDirectory folder;
  const Fingerprint fingerprint = support::SyntheticStudy{}.work().fingerprint;
  const pid_t child = fork();
  if (child == 0) {
    Journal journal(folder / "j", fingerprint);
    for (std::uint64_t i = 0;; ++i) {
      journal.append({.index = i, .values = {now(), 0.0, 0.0}});
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }
  ASSERT_GT(child, 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(2300));
  const double killed = now();
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  const Journal journal(folder / "j", fingerprint);
  EXPECT_EQ(journal.damaged(), 0U);
  double first = killed, last = 0.0;
  journal.rows({0, 1'000'000}, false, [&](Row&& row) {
    first = std::min(first, row.values[0]);
    last = std::max(last, row.values[0]);
  });
  EXPECT_LT(first, killed - 1.0);  // it had been at work for longer than it may lose
  EXPECT_GT(last, killed - 1.0);
  EXPECT_EQ(journal.done().ranges().size(), 1U);  // and no row before the last is missing
}

}  // namespace
}  // namespace asdic::detail::study
