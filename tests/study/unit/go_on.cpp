#include <gtest/gtest.h>

#include <atomic>

#include "core/error.h"
#include "study/reader/study_reader.h"
#include "study/runs/run_study.h"
#include "study/runs/study_file.h"
#include "support/plain_sea.h"
#include "support/temporary_directory.h"

// A study that is begun again: after a realisation that failed, after a change, with nothing there.

namespace asdic::detail::study {
namespace {

using support::plain_sea;
using support::TemporaryDirectory;

class GoOn : public testing::Test {
 protected:
  /// A study whose third realisation puts the target below the bottom unless `deepest` is less.
  std::string study(const std::string& on_error, double deepest) {
    return "[study]\nrealisations = 6\non_error = \"" + on_error +
           "\"\n[vary]\n\"target.0.depth\" = { law = \"list\", values = [100, 200, " +
           std::to_string(deepest) + "] }\n[measure]\necho_level = true\n" + plain_sea;
  }

  /// What `asdic study` would say; "written" if nothing.
  std::string said(const std::string& text, bool assemble = false, const Until& until = {}) {
    const Study study = read_study(folder.write("study.toml", text));
    const Realiser realiser(study);
    made = 0;
    const Work work = work_of(study, [&](std::uint64_t index) {
      ++made;
      return realiser.realise(index);
    });
    try {
      const StudyOutcome outcome = run_study(work, {.output = folder / "s.h5",
                                                    .range = {0, study.realisations},
                                                    .until = until,
                                                    .assemble_only = assemble});
      before = outcome.before;
      skipped = outcome.skipped;
      return outcome.written ? "written" : "not written";
    } catch (const InputError& error) {
      return error.what();
    }
  }
  [[nodiscard]] bool there(const std::string& name) const {
    return std::filesystem::exists(folder / name);
  }

  TemporaryDirectory folder;
  std::atomic<int> made = 0;
  std::uint64_t before = 0, skipped = 0;
};

#define EXPECT_SAYS(text, words) EXPECT_NE((text).find(words), std::string::npos) << (text)

// A file that is whole has more rows than --until would leave of it.
TEST_F(GoOn, AWholeStudyIsNotEndedEarlier) {
  const std::string text = study("stop", 60.0);
  EXPECT_EQ(said(text), "written");
  EXPECT_EQ(said(text, false, Until(0.5)),
            (folder / "s.h5").string() +
                ": found the whole study, realisations 0:6, which tells no less than it would with "
                "--until, expected a file that may end earlier: leave --until (or study.until) out "
                "to keep this one, name another output, or --fresh to write over it");
  std::string longer = text;
  longer.replace(longer.find("= 6"), 3, "= 9");
  EXPECT_SAYS(said(longer, false, Until(0.5)), "out to go on from these, name another output");
  EXPECT_EQ(made, 0);
  EXPECT_EQ(said(text), "written");
}

TEST_F(GoOn, AnUnchangedStudyFailsInTheSameWords) {
  const std::string first = said(study("stop", 2000.0));
  EXPECT_SAYS(first, "study.toml:5: target[0].depth: found depth 2000 m");
  EXPECT_SAYS(first, "(realisation 2: depth = 2000)");
  EXPECT_SAYS(first, ", or study.on_error = \"skip\"");
  EXPECT_TRUE(there("s.h5.journal"));
  EXPECT_EQ(said(study("stop", 2000.0)), first);
}

TEST_F(GoOn, SkippingGoesOnWhereItStopped) {
  EXPECT_SAYS(said(study("stop", 2000.0)), "realisation 2");
  EXPECT_EQ(said(study("skip", 2000.0)), "written");
  EXPECT_EQ(before, 2U);
  EXPECT_EQ(made, 4);
  EXPECT_EQ(skipped, 2U);
  EXPECT_EQ(StudyFile(folder / "s.h5").table().valid,
            (std::vector<std::uint8_t>{1, 1, 0, 1, 1, 0}));
  // And back: those that were skipped are made again, and fail; the file stays.
  EXPECT_SAYS(said(study("stop", 2000.0)), "(realisation 2: depth = 2000)");
  EXPECT_TRUE(there("s.h5"));
  EXPECT_EQ(said(study("skip", 2000.0)), "written");
  EXPECT_EQ(before, 4U);
}

TEST_F(GoOn, AMendedStudyIsToldWhatToDo) {
  EXPECT_SAYS(said(study("stop", 2000.0)), "realisation 2");
  const std::string mended = said(study("stop", 900.0));
  EXPECT_SAYS(mended,
              "s.h5.journal: found 2 realisations of another study, or of this one before it "
              "changed (line 5 of the study file) (identity ");
  EXPECT_SAYS(mended, "--fresh throws them away and begins anew, another -o keeps them");
  EXPECT_TRUE(there("s.h5.journal"));
}

TEST_F(GoOn, AJournalWithoutRowsIsInNobodysWay) {
  {
    const Study other = read_study(folder.write("study.toml", study("stop", 800.0)));
    Journal(folder / "s.h5.journal", fingerprint_of(other)).close();
  }
  EXPECT_EQ(said(study("stop", 900.0)), "written");
  EXPECT_FALSE(there("s.h5.journal"));
}

// --assemble with nothing there says so, and leaves nothing behind.
TEST_F(GoOn, NothingIsNotAssembled) {
  const std::string nothing = said(study("skip", 900.0), true);
  EXPECT_SAYS(nothing, "s.h5: found no realisation of what is asked for, to assemble, expected");
  EXPECT_FALSE(there("s.h5"));
  EXPECT_FALSE(there("s.h5.journal"));
  {
    const Study empty = read_study(folder.write("study.toml", study("skip", 900.0)));
    Journal(folder / "s.h5.journal", fingerprint_of(empty)).close();
  }
  EXPECT_EQ(said(study("skip", 900.0), true), nothing);
  EXPECT_FALSE(there("s.h5"));
}

}  // namespace
}  // namespace asdic::detail::study
