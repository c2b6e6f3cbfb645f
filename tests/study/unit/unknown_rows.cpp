#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "study/measures/realisation.h"
#include "study/reader/study_reader.h"
#include "study/runs/run_study.h"
#include "support/plain_sea.h"
#include "support/temporary_directory.h"

// Rows in which the answer is not known.
namespace asdic::detail::study {
namespace {

const std::string detection =
    "detection = { false_alarm_probability = 1e-3 }\nmatched_filter = { background = \"noise\" }\n";

class UnknownRows : public testing::Test {
 protected:
  Study read(const std::string& measure, const std::vector<std::string>& overrides) {
    return read_study(folder_.write("study.toml", "[study]\nrealisations = 1000\n[measure]\n" +
                                                      measure + support::plain_sea),
                      overrides);
  }
  support::TemporaryDirectory folder_;
};

// The row and the summary give the reason why an answer is not known.
TEST_F(UnknownRows, SaysWhyItIsNotKnown) {
  const auto unknown = [&](const std::string& measure, std::vector<std::string> overrides) {
    const Study study = read(measure, std::move(overrides));
    return Realiser(study).realise(0).unknown;
  };
  EXPECT_THAT(unknown(detection, {}), testing::IsEmpty());
  EXPECT_THAT(unknown(detection, {"pings.recording_duration=3.5"}),
              testing::HasSubstr("the echo comes after 4 s and lasts 0.1 s, the record is from 0 "
                                 "to 3.5 s"));
  EXPECT_THAT(unknown("detection = true\nmatched_filter = { background = \"around\" }\n",
                      {"pings.recording_start=3.99", "pings.recording_duration=0.15"}),
              testing::HasSubstr("fewer than 12 of the cells around the echo are free"));
}

// A study in which no answer is known says so after ten rows and gives the reason.
TEST_F(UnknownRows, TenRowsOfWhichNothingIsKnownAreNotedAtOnce) {
  const auto notes_of = [&](std::vector<std::string> overrides, std::uint64_t rows) {
    const Study study = read(detection, std::move(overrides));
    const Realiser realiser(study);
    std::vector<std::string> notes;
    const Realise realise =
        watched(work_of(study, realiser), [&](const std::string& text) { notes.push_back(text); });
    for (std::uint64_t i = 0; i < rows; ++i) static_cast<void>(realise(i));
    return notes;
  };
  const std::string short_record = "pings.recording_duration=3.5";
  EXPECT_THAT(notes_of({short_record}, 9), testing::IsEmpty());
  EXPECT_THAT(notes_of({short_record}, 30),
              testing::ElementsAre(testing::HasSubstr("pd is not known in any of the first 10 "
                                                      "realisations: the echo comes after 4 s")));
  EXPECT_THAT(notes_of({}, 12), testing::IsEmpty());
}

}  // namespace
}  // namespace asdic::detail::study
