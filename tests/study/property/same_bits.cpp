#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <thread>

#include "core/error.h"
#include "study/runs/merge.h"
#include "support/same_study_file.h"
#include "support/synthetic_study.h"

// A study's file is a function of the study alone: of no number of threads, parts or restarts.
namespace asdic::detail::study {
namespace {

using support::expect_same_study;
using support::SyntheticStudy;
using support::TemporaryDirectory;

StudyRun run_of(const std::filesystem::path& output, IndexRange range, std::size_t threads = 2) {
  StudyRun run{.output = output, .range = range};
  run.session.made.host = output.filename().string();  // /run may differ, and does
  run.session.made.build = "b";
  run.session.made.threads = static_cast<int>(threads);
  return run;
}

StudyOutcome make(const SyntheticStudy& synthetic, StudyRun run, std::size_t threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  return run_study(synthetic.work(), run);
}

SummariseFingerprint summary_of(const SyntheticStudy& synthetic) {
  return [work = synthetic.work()](const Fingerprint&, const Table& table) {
    return work.summarise(table);
  };
}

const SyntheticStudy some{.realisations = 311, .skips = true, .series_every = 10, .kept_every = 6};

TEST(SameBits, ForAnyNumberOfThreads) {
  const TemporaryDirectory folder;
  for (const std::size_t threads : {1U, 2U, 7U}) {
    const auto path = folder / (std::to_string(threads) + ".h5");
    const StudyOutcome outcome = make(some, run_of(path, {0, 311}, threads), threads);
    EXPECT_TRUE(outcome.complete);
    EXPECT_TRUE(journals_of(path).empty());
    expect_same_study(folder / "1.h5", path);
  }
}

TEST(SameBits, ForPartsCopiedOrReferredTo) {
  const TemporaryDirectory folder;
  make(some, run_of(folder / "whole.h5", {0, 311}), 2);
  std::vector<std::filesystem::path> parts;
  for (const IndexRange range : {IndexRange{104, 250}, {0, 104}, {250, 311}}) {
    parts.push_back(folder / ("part" + std::to_string(parts.size()) + ".h5"));
    make(some, run_of(parts.back(), range), 3);
  }
  for (const bool copy : {true, false}) {
    const auto merged = folder / (copy ? "copy.h5" : "catalogue.h5");
    const MergeReport report = merge(parts, merged, summary_of(some), {.copy = copy});
    EXPECT_EQ(report.rows, 311U);
    EXPECT_TRUE(report.warnings.empty());
    expect_same_study(folder / "whole.h5", merged);
    EXPECT_NO_THROW(StudyFile(merged).verify());
  }
  // A catalogue is a part like any other: of parts, a merged file again.
  merge({folder / "catalogue.h5"}, folder / "again.h5", summary_of(some), {.copy = true});
  expect_same_study(folder / "whole.h5", folder / "again.h5");
}

// A part may hold rows on either side of another's: then those of one file are shown in two pieces.
TEST(SameBits, ForPartsThatLieWithinOneAnother) {
  const TemporaryDirectory folder;
  const SyntheticStudy few{.realisations = 60, .skips = true, .series_every = 5, .kept_every = 4};
  make(few, run_of(folder / "whole.h5", {0, 60}), 2);
  for (const IndexRange range : {IndexRange{0, 22}, {22, 41}, {41, 60}})
    make(few, run_of(folder / (std::to_string(range.first) + ".h5"), range), 2);
  merge({folder / "0.h5", folder / "41.h5"}, folder / "around.h5", summary_of(few),
        {.copy = true, .allow_gaps = true});
  for (const bool copy : {true, false}) {
    const auto merged = folder / (copy ? "copy.h5" : "catalogue.h5");
    merge({folder / "around.h5", folder / "22.h5"}, merged, summary_of(few), {.copy = copy});
    expect_same_study(folder / "whole.h5", merged);
    EXPECT_NO_THROW(StudyFile(merged).verify());
  }
}

/// Stops after some rows.
StudyOutcome make_some(const SyntheticStudy& synthetic, StudyRun run, std::uint64_t rows) {
  std::stop_source stop;
  Work work = synthetic.work();
  work.realise = [&, realise = work.realise](std::uint64_t index) {
    if (index >= rows) stop.request_stop();
    return realise(index);
  };
  run.stop = stop.get_token();
  return run_study(work, run);
}

TEST(SameBits, WhenInterruptedAndTakenUpAgain) {
  const TemporaryDirectory folder;
  make(some, run_of(folder / "whole.h5", {0, 311}), 2);
  const auto path = folder / "resumed.h5";
  const auto in_hand = 4 * static_cast<std::uint64_t>(tbb::info::default_concurrency());
  std::uint64_t there = 0;
  for (const std::uint64_t rows : {50U, 51U, 200U}) {
    const StudyOutcome outcome = make_some(some, run_of(path, {0, 311}), rows);
    EXPECT_FALSE(outcome.written);
    EXPECT_FALSE(std::filesystem::exists(path));
    EXPECT_EQ(outcome.before, there);
    // those in hand are left
    EXPECT_GE(outcome.before + outcome.made + in_hand, rows);
    there = outcome.before + outcome.made;
  }
  const StudyOutcome last = make(some, run_of(path, {0, 311}), 7);
  EXPECT_EQ(last.before, there);
  EXPECT_EQ(last.made, 311 - there);
  expect_same_study(folder / "whole.h5", path);
}

TEST(SameBits, WhenAFileOfFewerIsContinued) {
  const TemporaryDirectory folder;
  make(some, run_of(folder / "whole.h5", {0, 311}), 2);
  SyntheticStudy fewer = some;
  fewer.realisations = 120;
  const auto path = folder / "grown.h5";
  make(fewer, run_of(path, {0, 120}), 2);
  const StudyOutcome outcome = make(some, run_of(path, {0, 311}), 2);
  EXPECT_EQ(outcome.before, 120U);
  EXPECT_EQ(outcome.made, 191U);
  expect_same_study(folder / "whole.h5", path);
}

TEST(Study, ACompleteFileIsNotMadeAgain) {
  const TemporaryDirectory folder;
  const auto path = folder / "a.h5";
  make(some, run_of(path, {0, 311}), 2);
  const std::string before = support::content(path);
  const StudyOutcome again = make(some, run_of(path, {0, 311}), 2);
  EXPECT_TRUE(again.was_complete);
  EXPECT_EQ(again.made, 0U);
  EXPECT_EQ(support::content(path), before);
}

TEST(Study, SomebodyElsesFileIsNotWrittenOver) {
  const TemporaryDirectory folder;
  const auto path = folder / "a.h5";
  make(some, run_of(path, {0, 311}), 2);
  SyntheticStudy other = some;
  other.identity = "other";
  EXPECT_THROW(make(other, run_of(path, {0, 311}), 2), InputError);
  const auto text = folder.write("b.h5", "a text");
  EXPECT_THROW(make(other, run_of(text, {0, 311}), 2), InputError);
  EXPECT_EQ(support::content(text), "a text");
  StudyRun fresh = run_of(path, {0, 311});
  fresh.fresh = true;
  EXPECT_TRUE(make(other, fresh, 2).complete);
}

TEST(Study, WhatIsThereCanBeLookedAtOnDemand) {
  const TemporaryDirectory folder;
  const auto path = folder / "a.h5";
  make_some(some, run_of(path, {0, 311}), 50);
  StudyRun look = run_of(path, {0, 311});
  look.assemble_only = true;
  const StudyOutcome outcome = make(some, look, 2);
  EXPECT_TRUE(outcome.written);
  EXPECT_FALSE(outcome.complete);
  EXPECT_EQ(StudyFile(path).index().size(), outcome.before);
  EXPECT_FALSE(StudyFile(path).complete());
  make(some, run_of(path, {0, 311}), 2);  // and the run goes on
  make(some, run_of(folder / "whole.h5", {0, 311}), 2);
  expect_same_study(folder / "whole.h5", path);
}

// --until stops at the same realisation with one thread and with seven, at once and in two goes.
TEST(Until, DoesNotDependOnScheduling) {
  const TemporaryDirectory folder;
  const SyntheticStudy many{.realisations = 20000};
  std::vector<std::uint64_t> ends;
  for (const std::size_t threads : {1U, 7U, 3U}) {
    const auto path = folder / (std::to_string(threads) + ".h5");
    StudyRun run = run_of(path, {0, 20000}, threads);
    run.until = 0.02;  // y is uniform on (0, 1) + noise: σ ≈ 0.31, 1.96σ/√n ≤ 0.02 from n ≈ 900 on
    if (threads == 3) make_some(many, run, 333);
    const StudyOutcome outcome = make(many, run, threads);
    EXPECT_TRUE(outcome.stopped_early);
    EXPECT_TRUE(outcome.complete);
    ends.push_back(outcome.range.end);
    expect_same_study(folder / "1.h5", path);
  }
  EXPECT_EQ(ends, std::vector<std::uint64_t>(3, ends[0]));
  EXPECT_TRUE(ends[0] == 900 || ends[0] == 1000) << ends[0];
}

}  // namespace
}  // namespace asdic::detail::study
