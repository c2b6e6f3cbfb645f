// Studies of very many rows: journal, file, merge, --until and Saltelli's tables in memory that is
// bounded by a few bytes a row, however many columns there are, and in time that is linear.
//
// ASDIC_SCALE=10000000 property_study --gtest_filter='Scale.*' does it with so many rows, made up
// and not simulated, and prints a table; every day it is done with few.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "study/measures/row_cost.h"
#include "study/pilot/process_memory.h"
#include "study/reader/study_reader.h"
#include "study/runs/merge.h"
#include "study/runs/run_study.h"
#include "study/summary/summary_parts.h"

namespace asdic::detail::study {
namespace {

namespace fs = std::filesystem;

std::uint64_t rows_asked() {
  const char* text = std::getenv("ASDIC_SCALE");
  return text == nullptr ? 10000 : std::strtoull(text, nullptr, 10);
}

/// A number between 0 and 1 of an index and a column.
double number_of(std::uint64_t index, std::uint64_t column) {
  std::uint64_t x = index * 0x9E3779B97F4A7C15ULL + column * 0xD1B54A32D192ED03ULL;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return static_cast<double>((x ^ (x >> 31)) >> 11) * 0x1p-53;
}

Study study_of(std::uint64_t rows, const std::string& design) {
  std::vector<std::string> set{"study.design=" + design, "measure.reverberation_level=true",
                               "measure.echo_to_background=true", "measure.paths=true",
                               "measure.echo_time=true"};
  for (int i = 0; i < 4; ++i)
    set.push_back("vary.x" + std::to_string(i) +
                  R"(={ law = "uniform", low = 0.0, high = 1.0, keys = [] })");
  set.push_back("study.realisations=" + std::to_string(design == "saltelli" ? rows / 7 * 7 : rows));
  return read_study(fs::path(ASDIC_SCENARIOS) / "studies/known_answer.toml", set);
}

/// Rows that nobody simulates.
Work work_of_rows(const Study& study) {
  const std::vector<Column> all = columns(study);
  return work_of(
      study, Realise([all](std::uint64_t index) {
        Row row{.index = index};
        for (std::size_t c = 0; c < all.size(); ++c) {
          const double x = number_of(index, c);
          row.values.push_back(is_proportion(all[c]) ? (x < 0.4 ? 1.0 : 0.0) : 20e3 * (1.0 + x));
        }
        row.reuse.assign(reuse_columns().size(), 1.0);
        return row;
      }));
}

class Scale : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("asdic-scale-" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Does something with `rows` rows of `columns` numbers: says and checks what it took.
  void measured(const char* what, std::uint64_t rows, std::size_t columns,
                const std::function<void()>& work) {
    const double began = processor_seconds();
    const double bytes = taken_by(work);
    const double n = static_cast<double>(rows);
    std::printf("%-22s %9llu rows of %zu: %7.2f us a row, %8.1f MB, %5.1f bytes a row\n", what,
                static_cast<unsigned long long>(rows), columns,
                1e6 * (processor_seconds() - began) / n, bytes / 1e6, bytes / n);
    std::fflush(stdout);
    if (std::isnan(bytes) || rows < 3000000) return;  // below, columns lie in memory
    EXPECT_LT(bytes, 100e6 + 160.0 * n) << what;      // with all columns in memory: 320 a row
  }

  fs::path folder_;
};

StudyRun whole(const fs::path& output, const Study& study) {
  StudyRun run{.output = output, .range = {0, study.realisations}};
  run.session.made = {.program_version = "0", .build = "test", .host = "here"};
  return run;
}

TEST_F(Scale, MemoryIsBoundedAndTimeLinear) {
  const std::uint64_t rows = rows_asked();
  const Study study = study_of(rows, "random");
  const Work work = work_of_rows(study);
  const std::size_t columns = work.fingerprint.columns.size();
  measured("run", rows, columns,
           [&] { EXPECT_TRUE(run_study(work, whole(folder_ / "whole.h5", study)).complete); });
  std::vector<fs::path> parts;
  measured("run in two parts", rows, columns, [&] {
    for (const IndexRange part : {IndexRange{0, rows / 3}, IndexRange{rows / 3, rows}}) {
      StudyRun run = whole(folder_ / ("part" + std::to_string(parts.size()) + ".h5"), study);
      run.range = part;
      parts.push_back(run.output);
      EXPECT_TRUE(run_study(work, run).complete);
    }
  });
  const auto summarise = [&](const Fingerprint&, const Table& table) {
    return summary_of(study, table);
  };
  measured("merge", rows, columns,
           [&] { EXPECT_EQ(merge(parts, folder_ / "catalogue.h5", summarise).rows, rows); });
  measured("merge --copy", rows, columns, [&] {
    EXPECT_EQ(merge(parts, folder_ / "copy.h5", summarise, {.copy = true}).rows, rows);
  });
  const StudyFile one(folder_ / "whole.h5"), other(folder_ / "copy.h5");
  const Table a = one.table(), b = other.table();
  ASSERT_EQ(a.index, b.index);
  for (std::size_t c = 0; c < a.values.size(); ++c)
    EXPECT_TRUE(
        std::equal(a.values[c].begin(), a.values[c].end(), b.values[c].begin(), b.values[c].end()))
        << a.columns[c].name;
}

TEST_F(Scale, UntilOfTables) {
  const std::uint64_t rows = rows_asked();
  const Study study = study_of(rows, "random");
  const Work work = work_of_rows(study);
  measured("run --until a table", rows, work.fingerprint.columns.size(), [&] {
    StudyRun run = whole(folder_ / "until.h5", study);
    run.until = Until(study, {"pd_by_range=1e-9", "paths_by_range=1e-9"});
    EXPECT_FALSE(run_study(work, run).stopped_early);
  });
}

TEST_F(Scale, SaltelliTables) {
  const Study study = study_of(rows_asked(), "saltelli");
  const Work work = work_of_rows(study);
  measured("run of saltelli", study.realisations, work.fingerprint.columns.size(),
           [&] { EXPECT_TRUE(run_study(work, whole(folder_ / "saltelli.h5", study)).complete); });
}

}  // namespace
}  // namespace asdic::detail::study
