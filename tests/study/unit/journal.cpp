#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "study/journal/journal.h"
#include "study/journal/sqlite.h"
#include "support/synthetic_study.h"

namespace asdic::detail::study {
namespace {

using support::SyntheticStudy;

/// Fills a journal and closes it. \return its path
std::filesystem::path filled(const support::TemporaryDirectory& folder, std::uint64_t count) {
  const SyntheticStudy synthetic{.skips = true, .series_every = 5, .kept_every = 4};
  const auto path = folder / "study.h5.journal";
  Journal journal(path, synthetic.work().fingerprint);
  for (std::uint64_t i = 0; i < count; ++i) journal.append(synthetic.row(i));
  journal.close();
  return path;
}

std::vector<Row> rows_of(const Journal& journal, IndexRange range, bool kept = true) {
  std::vector<Row> rows;
  journal.rows(range, kept, [&](Row&& row) { rows.push_back(std::move(row)); });
  return rows;
}

void expect_same(const Row& a, const Row& b) {
  EXPECT_EQ(a.index, b.index);
  EXPECT_EQ(a.valid, b.valid);
  EXPECT_EQ(a.fault, b.fault);
  ASSERT_EQ(a.values.size(), b.values.size());
  for (std::size_t i = 0; i < a.values.size(); ++i)
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a.values[i]), std::bit_cast<std::uint64_t>(b.values[i]));
  EXPECT_EQ(a.pressure, b.pressure);
  EXPECT_EQ(a.pressure_shape, b.pressure_shape);
  EXPECT_EQ(a.timing, b.timing);
  EXPECT_EQ(a.kept, b.kept);
}

TEST(Journal, GivesBackWhatItTook) {
  const support::TemporaryDirectory folder;
  const SyntheticStudy synthetic{.skips = true, .series_every = 5, .kept_every = 4};
  Journal journal(filled(folder, 40), synthetic.work().fingerprint);
  EXPECT_EQ(journal.done(), IndexSet({0, 40}));
  EXPECT_EQ(journal.damaged(), 0U);
  const std::vector<Row> rows = rows_of(journal, {10, 30});
  ASSERT_EQ(rows.size(), 20U);
  for (const Row& row : rows) expect_same(row, synthetic.row(row.index));
}

// What is not a number has one set of bits, wherever it came from.
TEST(Journal, NanIsNan) {
  const support::TemporaryDirectory folder;
  Journal journal(folder / "j", SyntheticStudy{}.work().fingerprint);
  journal.append({.index = 0, .values = {-std::nan(""), std::nan("7"), 1.0}});
  const Row row = rows_of(journal, {0, 1}).at(0);
  const auto nan = std::bit_cast<std::uint64_t>(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(std::bit_cast<std::uint64_t>(row.values[0]), nan);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(row.values[1]), nan);
}

TEST(Journal, OfAnotherStudyIsRefused) {
  const support::TemporaryDirectory folder;
  const auto path = filled(folder, 3);
  try {
    Journal(path, SyntheticStudy{.identity = "other"}.work().fingerprint);
    FAIL() << "it was taken";
  } catch (const InputError& error) {
    const std::string said = error.what();
    EXPECT_NE(said.find("identity synthetic"), std::string::npos) << said;
    EXPECT_NE(said.find("identity other"), std::string::npos) << said;
    EXPECT_NE(said.find(path.string()), std::string::npos) << said;
  }
}

TEST(Journal, BelongsToOneProcess) {
  const support::TemporaryDirectory folder;
  const Fingerprint fingerprint = SyntheticStudy{}.work().fingerprint;
  const Journal first(folder / "j", fingerprint);
  try {
    const Journal second(folder / "j", fingerprint);
    FAIL() << "two have it";
  } catch (const RunError& error) {
    EXPECT_NE(std::string(error.what()).find("another asdic is at work on this study"),
              std::string::npos);
  }
}

std::string content_with_flipped_bit(const std::filesystem::path& path, std::string_view pattern) {
  std::string bytes = support::content(path);
  const auto at = bytes.find(pattern);
  EXPECT_NE(at, std::string::npos);
  bytes[at] = static_cast<char>(bytes[at] ^ 1);
  return bytes;
}

template <class T>
std::string_view pattern(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

// One flipped bit of a value, and of a time series: that row is as if it had never been made.
TEST(Journal, ADamagedRowIsThrownAway) {
  const support::TemporaryDirectory folder;
  const SyntheticStudy synthetic{.skips = true, .series_every = 5, .kept_every = 4};
  const auto path = filled(folder, 40);
  const double value = synthetic.row(18).values[1];
  static_cast<void>(
      folder.write("study.h5.journal", content_with_flipped_bit(path, pattern(value))));
  Journal journal(path, synthetic.work().fingerprint);
  EXPECT_EQ(journal.damaged(), 1U);
  EXPECT_FALSE(journal.done().contains(18));
  EXPECT_EQ(journal.done().size(), 39U);
}

TEST(Journal, ADamagedTimeSeriesIsToldAndMadeAgain) {
  const support::TemporaryDirectory folder;
  const SyntheticStudy synthetic{.skips = true, .series_every = 5, .kept_every = 4};
  const auto path = filled(folder, 40);
  const std::vector<float> series = synthetic.row(20).pressure;
  static_cast<void>(folder.write(
      "study.h5.journal",
      content_with_flipped_bit(path, {reinterpret_cast<const char*>(series.data()), 16})));
  {
    Journal journal(path, synthetic.work().fingerprint);
    EXPECT_THROW(rows_of(journal, {0, 40}), RunError);
  }
  Journal journal(path, synthetic.work().fingerprint);
  EXPECT_EQ(journal.done().missing({0, 40}), IndexSet({20, 21}));
}

TEST(Journal, ADamagedArrayIsToldAndMadeAgain) {
  const support::TemporaryDirectory folder;
  const SyntheticStudy synthetic{.skips = true, .series_every = 5, .kept_every = 4};
  for (const std::size_t kind : {0U, 1U}) {
    const auto path = filled(folder, 40);
    const std::vector<double> values = synthetic.row(20).kept.at(kind).values;
    ASSERT_GT(values.size(), 2U);
    static_cast<void>(folder.write(
        "study.h5.journal",
        content_with_flipped_bit(path, {reinterpret_cast<const char*>(values.data()), 16})));
    {
      const Journal journal(path, synthetic.work().fingerprint);
      EXPECT_EQ(journal.damaged(), 0U);
      EXPECT_EQ(journal.array(16, kept_kinds()[kind].name), synthetic.row(16).kept.at(kind));
      EXPECT_THROW(static_cast<void>(journal.array(20, kept_kinds()[kind].name)), RunError);
    }
    const Journal journal(path, synthetic.work().fingerprint);
    EXPECT_EQ(journal.done().missing({0, 40}), IndexSet({20, 21}));
    remove_journal(path);
  }
}

// One whose array is gone altogether is seen when the journal is opened.
TEST(Journal, ARowWithoutItsArrayIsThrownAway) {
  const support::TemporaryDirectory folder;
  const SyntheticStudy synthetic{.skips = true, .series_every = 5, .kept_every = 4};
  const auto path = filled(folder, 40);
  sqlite::Database(path).execute("DELETE FROM kept WHERE idx=8 AND name='spectra'");
  // … and one whose row does not know of it any more, by the row's checksum.
  sqlite::Database(path).execute(
      "DELETE FROM kept WHERE idx=12; UPDATE row SET kept=kept%2 WHERE idx=12");
  const Journal journal(path, synthetic.work().fingerprint);
  EXPECT_EQ(journal.damaged(), 2U);
  IndexSet lost({8, 9});
  lost.add(IndexRange{12, 13});
  EXPECT_EQ(journal.done().missing({0, 40}), lost);
}

// Journals of before there were arrays have no table for them, and checksums of their own kind:
// these are the bits that an earlier version wrote of this row.
TEST(Journal, OneOfBeforeThereWereArraysGoesOn) {
  const support::TemporaryDirectory folder;
  const SyntheticStudy before{.skips = true, .series_every = 5},
      now{.skips = true, .series_every = 5, .kept_every = 4};
  const auto path = folder / "study.h5.journal";
  {
    Journal journal(path, before.work().fingerprint);
    journal.append(before.row(0));
    journal.append({.index = 1, .values = {1.0, 2.0, 3.0}});
    journal.close();
  }
  {
    sqlite::Database database(path);
    sqlite::Statement sum(database, "SELECT checksum FROM row WHERE idx=1");
    ASSERT_TRUE(sum.step());
    EXPECT_EQ(sum.text(0), "4e64fa495dc4f6eb");
    sum.reset();
    database.execute("DROP TABLE kept");
  }
  Journal journal(path, now.work().fingerprint);
  EXPECT_EQ(journal.damaged(), 0U);
  EXPECT_EQ(journal.done(), IndexSet({0, 2}));
  journal.append(now.row(4));
  expect_same(rows_of(journal, {0, 1}).at(0), before.row(0));
  expect_same(rows_of(journal, {4, 5}).at(0), now.row(4));
}

// Cut off anywhere, a journal is refused, or has fewer rows: those that it has are right.
TEST(Journal, ATruncatedOneNeverLies) {
  const support::TemporaryDirectory folder;
  const SyntheticStudy synthetic{.skips = true, .series_every = 5, .kept_every = 4};
  const auto path = filled(folder, 400);
  const std::string bytes = support::content(path);
  int refused = 0;
  for (int k = 1; k < 24; ++k) {
    remove_journal(path);
    static_cast<void>(folder.write("study.h5.journal", bytes.substr(0, bytes.size() * k / 24)));
    try {
      const Journal journal(path, synthetic.work().fingerprint);
      for (const IndexRange& range : journal.done().ranges())
        for (const Row& row : rows_of(journal, range)) expect_same(row, synthetic.row(row.index));
    } catch (const InputError& error) {
      ++refused;
      EXPECT_NE(std::string(error.what()).find("expected"), std::string::npos);
    } catch (const RunError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 10);
}

TEST(Journal, WhatIsNoJournalIsRefused) {
  const support::TemporaryDirectory folder;
  const auto path =
      folder.write("j", "this is a text, not a database, and long enough to be seen as one");
  EXPECT_THROW(Journal(path, SyntheticStudy{}.work().fingerprint), InputError);
}

TEST(Journal, ThoseOfAnOutputAreFound) {
  const support::TemporaryDirectory folder;
  for (const char* name : {"a.h5.journal", "a.h5.rank0.journal", "a.h5.rank12.journal",
                           "b.h5.journal", "a.h5.journal-wal", "a.h5", "aa.h5.journal"})
    static_cast<void>(folder.write(name, ""));
  EXPECT_EQ(journals_of(folder / "a.h5"),
            (std::vector<std::filesystem::path>{journal_of(folder / "a.h5"),
                                                journal_of(folder / "a.h5", 0),
                                                journal_of(folder / "a.h5", 12)}));
}

}  // namespace
}  // namespace asdic::detail::study
