#include <gtest/gtest.h>

#include "core/error.h"
#include "io/hdf5/own_files.h"
#include "study/runs/merge.h"
#include "support/left_of.h"
#include "support/synthetic_study.h"

namespace asdic::detail::study {
namespace {

using support::SyntheticStudy;
using support::TemporaryDirectory;

class Merge : public testing::Test {
 protected:
  std::filesystem::path part(const std::string& name, IndexRange range,
                             const SyntheticStudy& synthetic = {.realisations = 90,
                                                                .series_every = 9,
                                                                .kept_every = 5},
                             const std::string& cpu = "one") {
    StudyRun run{.output = folder / name, .range = range};
    run.session.made.cpu = cpu;
    run_study(synthetic.work(), run);
    return folder / name;
  }

  /// What merge() says to these.
  std::string said(const std::vector<std::filesystem::path>& parts,
                   const MergeOptions& options = {}) {
    try {
      OutputFile output(folder / "merged.h5", {.own = own::hdf5});
      report = merge(
          parts, output, [](const Fingerprint&, const Table&) { return Summary{}; }, options);
    } catch (const InputError& error) {
      EXPECT_FALSE(std::filesystem::exists(folder / "merged.h5"));
      EXPECT_EQ(support::left_of(folder / "merged.h5"), "");
      return error.what();
    }
    return "good";
  }

  TemporaryDirectory folder;
  MergeReport report;
};

#define EXPECT_SAYS(text, words) EXPECT_NE((text).find(words), std::string::npos) << (text)

TEST_F(Merge, RefusesAMissingPart) {
  const auto a = part("a.h5", {0, 30}), c = part("c.h5", {60, 90});
  EXPECT_SAYS(said({a, c}),
              "merge: found no part with 30 of 90 realisations: 30:60, expected all of them");
  EXPECT_EQ(said({a, c}, {.allow_gaps = true}), "good");
  EXPECT_EQ(report.rows, 60U);
  EXPECT_EQ(report.missing, IndexSet({30, 60}));
  EXPECT_FALSE(StudyFile(folder / "merged.h5").complete());
}

TEST_F(Merge, RefusesAPartTwice) {
  const auto a = part("a.h5", {0, 60}), b = part("b.h5", {50, 90});
  EXPECT_SAYS(said({a, b}), "b.h5: found realisations 50:60, which are in " + a.string() + " too");
  EXPECT_SAYS(said({a, a}), "found realisations 0:60, which are in");
  EXPECT_SAYS(said({a, b}, {.allow_gaps = true}), "in one part");
}

TEST_F(Merge, RefusesAPartOfAnotherStudy) {
  const auto a = part("a.h5", {0, 60});
  const auto b = part("b.h5", {60, 90}, {.realisations = 90, .identity = "other"});
  EXPECT_SAYS(said({a, b}),
              "b.h5: found a part of another study (identity other), expected one of");
}

TEST_F(Merge, RefusesATruncatedPart) {
  const auto a = part("a.h5", {0, 60}), b = part("b.h5", {60, 90});
  const std::string bytes = support::content(b);
  for (const double share : {0.02, 0.5, 0.9, 0.999}) {
    static_cast<void>(folder.write(
        "b.h5", bytes.substr(0, static_cast<std::size_t>(share * double(bytes.size())))));
    EXPECT_SAYS(said({a, b}), "b.h5: found ") << share;
  }
}

// A flipped bit of a column, of a time series, of a spectrum, and of a detection's time.
TEST_F(Merge, RefusesAPartWhoseDataHaveChanged) {
  const auto a = part("a.h5", {0, 60}), b = part("b.h5", {60, 90});
  const std::string bytes = support::content(b);
  const SyntheticStudy synthetic{.realisations = 90, .series_every = 9, .kept_every = 5};
  const double value = synthetic.row(77).values[0];
  const std::vector<float> series = synthetic.row(81).pressure;
  const std::vector<KeptArray> kept = synthetic.row(70).kept;
  const std::string_view patterns[] = {
      {reinterpret_cast<const char*>(&value), sizeof value},
      {reinterpret_cast<const char*>(series.data()), 12},
      {reinterpret_cast<const char*>(kept[0].values.data()), 16},
      {reinterpret_cast<const char*>(kept[1].values.data()), sizeof(double)}};
  const char* datasets[] = {"b.h5: table/x: ", "b.h5: time_series/pressure: ",
                            "b.h5: spectra/power: ", "b.h5: detections/time: "};
  for (int i = 0; i < 4; ++i) {
    std::string changed = bytes;
    const auto at = changed.find(patterns[i]);
    ASSERT_NE(at, std::string::npos);
    changed[at] = static_cast<char>(changed[at] ^ 4);
    static_cast<void>(folder.write("b.h5", changed));
    EXPECT_SAYS(said({a, b}), datasets[i] + std::string("found data that have changed"));
  }
}

TEST_F(Merge, RefusesWhatIsNoPart) {
  const auto a = part("a.h5", {0, 60});
  EXPECT_SAYS(said({a, folder / "no.h5"}), "no.h5: found no such file");
  EXPECT_SAYS(said({a, folder.write("t.h5", "text")}), "t.h5: found a file that is not HDF5");
  Hdf5File::create(folder / "other.h5").set_attribute("", "filetype", "asdic ping");
  EXPECT_SAYS(said({a, folder / "other.h5"}),
              "found filetype \"asdic ping\", expected filetype \"asdic study\"");
}

TEST_F(Merge, WarnsOfAMixOfProcessors) {
  const auto a = part("a.h5", {0, 60}), b = part("b.h5", {60, 90}, {.realisations = 90}, "two");
  EXPECT_EQ(said({a, part("c.h5", {60, 90}, {.realisations = 90}, "two")}), "good");
  ASSERT_EQ(report.warnings.size(), 1U);
  EXPECT_SAYS(report.warnings[0], "different processors: one; two");
}

// A catalogue says where its rows are by relative names: the folder as a whole can be moved.
TEST_F(Merge, ACatalogueCanBeMovedWithItsParts) {
  std::filesystem::create_directory(folder / "here");
  const auto a = part("here/a.h5", {0, 60}), b = part("here/b.h5", {60, 90});
  merge({a, b}, folder / "here/all.h5", [](const Fingerprint&, const Table&) { return Summary{}; });
  std::filesystem::rename(folder / "here", folder / "there");
  EXPECT_NO_THROW(StudyFile(folder / "there/all.h5").verify());
}

TEST_F(Merge, TheFileTellsItsConfidence) {
  const auto a = part("a.h5", {0, 90});
  const Hdf5File file = Hdf5File::open(a);
  EXPECT_EQ(file.attribute_number("summary", "confidence"), 0.95);
  EXPECT_EQ(file.attribute_text("summary", "proportion_interval"), "wilson");
  EXPECT_TRUE(file.has_attribute("summary", "intervals"));
}

// A catalogue whose parts are not what they were says which of them.
TEST_F(Merge, ACatalogueNamesThePartAtFault) {
  const auto a = part("a.h5", {0, 60}), b = part("b.h5", {60, 90});
  EXPECT_EQ(said({a, b}), "good");
  EXPECT_EQ(StudyFile(folder / "merged.h5").parts(), (std::vector{a, b}));
  const auto found = [&] {
    try {
      StudyFile(folder / "merged.h5").verify();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("good");
  };
  EXPECT_EQ(found(), "good");
  std::filesystem::rename(b, folder / "kept.h5");
  EXPECT_SAYS(found(), "merged.h5: found no " + b.string() + ", in which some of its rows lie");
  part("b.h5", {60, 90}, {.realisations = 90, .skips = true, .identity = "other"});
  EXPECT_SAYS(found(), b.string() + ": found a part of another study (identity other)");
  std::string bytes = support::content(folder / "kept.h5");
  const double value = SyntheticStudy{.realisations = 90, .series_every = 9}.row(77).values[0];
  const auto at = bytes.find(std::string_view(reinterpret_cast<const char*>(&value), sizeof value));
  ASSERT_NE(at, std::string::npos);
  bytes[at] = static_cast<char>(bytes[at] ^ 4);
  static_cast<void>(folder.write("b.h5", bytes));
  EXPECT_SAYS(found(), b.string() + ": table/x: found data that have changed");
  std::filesystem::rename(folder / "kept.h5", b);
  EXPECT_EQ(found(), "good");
}

}  // namespace
}  // namespace asdic::detail::study
