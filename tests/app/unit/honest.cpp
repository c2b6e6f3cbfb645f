#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "io/hdf5/hdf5_file.h"
#include "support/program.h"

// What commands say of numbers that are not to be trusted, and where it stands beside them.

namespace asdic::detail {
namespace {

using support::asdic;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr const char* half_profile =
    "--set 'environment.sound_speed={kind=\"table\", depth=[300.0, 400.0], speed=[1500.0, "
    "1500.5]}'";
constexpr const char* told = "environment.sound_speed: levels from 300 to 400 m";

class Honest : public testing::Test {
 protected:
  Honest() {
    // Without numbers of bounces, which would be warned of.
    std::string small = support::small_scenario;
    for (const std::string key : {"max_surface_bounces = 1\n", "max_bottom_bounces = 1\n"})
      small.erase(small.find(key), key.size());
    static_cast<void>(folder.write("small.toml", small));
    std::string run = support::small_scenario;
    run = run.substr(0, run.find("[platform]")) +
          "[run]\nfrequency = 1000.0\n[run.source]\ndepth = 100.0\n"
          "[run.receivers]\ndepth = [50.0]\nrange = [1000.0, 2000.0]\n";
    run.erase(run.find("seed = 3\n"), 9);
    run.replace(run.find("\"rigid\""), 7, "\"fluid\"");
    static_cast<void>(folder.write("run.toml", run));
  }
  [[nodiscard]] std::vector<std::string> warnings_of(const std::string& file) const {
    const Hdf5File opened = Hdf5File::open(folder / file);
    return opened.has_attribute("", "warnings") ? opened.attribute_texts("", "warnings")
                                                : std::vector<std::string>{};
  }
  support::TemporaryDirectory folder;
};

TEST_F(Honest, AWarningIsToldByEveryCommandAndStandsInItsFile) {
  const std::string with = std::string(" ") + half_profile;
  for (const std::string file : {"small.toml", "run.toml"}) {
    const auto run = asdic(folder, "validate " + file + with);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr(std::string("warning: ") + told));
    EXPECT_THAT(asdic(folder, "validate " + file).out, Not(HasSubstr("warning")));
  }
  for (const std::string words :
       {"ping small.toml --pings 1 -o out.h5 --set reverberation.enabled=false",
        "arrivals small.toml -o out.h5", "arrivals run.toml -o out.h5", "rays run.toml -o out.h5",
        "field run.toml -o out.h5"}) {
    const auto run = asdic(folder, words + with);
    EXPECT_EQ(run.status, 0) << words << ": " << run.err;
    EXPECT_THAT(run.err, HasSubstr(std::string("asdic: warning: ") + told)) << words;
    EXPECT_THAT(warnings_of("out.h5"), ElementsAre(HasSubstr(told))) << words;
    EXPECT_THAT(asdic(folder, words).err, Not(HasSubstr("warning"))) << words;
    EXPECT_THAT(warnings_of("out.h5"), testing::IsEmpty()) << words;
  }
  EXPECT_EQ(nlohmann::json::parse(
                asdic(folder, "field run.toml --json -q -o out.h5" + with).out)["warnings"]
                .size(),
            1U);
}

// Numbers of bounces are obeyed; what they leave out of shallow water stands beside the sound.
TEST_F(Honest, BouncesThatAreTooFewAreWarnedOf) {
  const std::string few =
      " --set propagation.max_surface_bounces=1 --set propagation.max_bottom_bounces=1";
  constexpr const char* lacks = "propagation.max_bottom_bounces: reverberation lacks the paths";
  EXPECT_THAT(asdic(folder, "validate small.toml" + few).out, HasSubstr(lacks));
  const auto run = asdic(folder, "ping small.toml --pings 1 -o out.h5" + few);
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr(std::string("asdic: warning: ") + lacks));
  EXPECT_THAT(warnings_of("out.h5"), testing::Contains(HasSubstr(lacks)));
}

// A study judges its first realisation, a session its first ping, and both have the estimate.
TEST_F(Honest, StudiesAndSessionsTellOfBouncesThatAreTooFew) {
  constexpr const char* lacks = "propagation.max_bottom_bounces: ";
  const std::string study =
      "[study]\nscenario = \"small.toml\"\nrealisations = 2\n[vary]\n"
      "\"environment.wind_speed\" = { law = \"uniform\", low = 5.0, high = 10.0 }\n"
      "[measure]\necho_level = true\n";
  static_cast<void>(folder.write("enough.toml", study));
  static_cast<void>(folder.write("few.toml", study +
                                                 "[set]\n\"propagation.max_surface_bounces\" = 1\n"
                                                 "\"propagation.max_bottom_bounces\" = 1\n"));
  const auto enough = asdic(folder, "study enough.toml -o enough.h5"),
             few = asdic(folder, "study few.toml -o few.h5");
  EXPECT_EQ(few.status, 0) << few.err;
  EXPECT_THAT(enough.err, Not(HasSubstr(lacks)));
  EXPECT_THAT(few.err, HasSubstr(std::string("asdic: warning: ") + lacks));
  const auto left_out = [&](const char* file) {
    return Hdf5File::open(folder / file).attribute_number("", "left_out_db");
  };
  EXPECT_LT(left_out("enough.h5"), 0.1);
  EXPECT_GT(left_out("few.h5"), 0.1);

  static_cast<void>(folder.write(
      "pings.txt",
      "{\"asdic\": 1}\n{\"command\": \"ping\", \"id\": 1}\n{\"command\": \"quit\"}\n"));
  const auto served = asdic(folder, "serve small.toml < pings.txt");
  EXPECT_THAT(served.out, testing::AllOf(HasSubstr("\"left_out_db\":"), Not(HasSubstr(lacks))));
  EXPECT_THAT(asdic(folder,
                    "serve small.toml --set propagation.max_surface_bounces=1 "
                    "--set propagation.max_bottom_bounces=1 < pings.txt")
                  .out,
              HasSubstr(lacks));
}

TEST_F(Honest, AStudyTellsOfItsRealisations) {
  static_cast<void>(folder.write(
      "study.toml",
      "[study]\nscenario = \"small.toml\"\nrealisations = 4\ndesign = \"grid\"\n[vary]\n"
      "\"pulse.frequency\" = { law = \"list\", values = [1000.0, 6000.0] }\n"
      "[measure]\necho_level = true\n[set]\n\"pings.sample_rate\" = 16000.0\n"));
  const auto run = asdic(folder, "study study.toml -o study.h5");
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("asdic: warning: reverberation.surface.kind: frequency 6000 Hz"));
  EXPECT_THAT(warnings_of("study.h5"), ElementsAre(HasSubstr("(realisation 1)")));
}

TEST_F(Honest, ServedPingsBearTheirWarnings) {
  static_cast<void>(folder.write("lines.txt", "{\"asdic\": 1}\n{\"command\": \"quit\"}\n"));
  EXPECT_THAT(asdic(folder, "serve small.toml " + std::string(half_profile) + " < lines.txt").out,
              HasSubstr("\"warnings\":[\"" + std::string(told)));
  EXPECT_THAT(asdic(folder, "serve small.toml < lines.txt").out, Not(HasSubstr("warnings")));
}

TEST_F(Honest, ARecordWithoutANumberIsNotProcessed) {
  ASSERT_EQ(asdic(folder, "ping small.toml -q -o p.h5 --set reverberation.enabled=false").status,
            0);
  const auto spoil = [&](std::size_t rows, std::size_t keep) {
    Hdf5File file = Hdf5File::edit(folder / "p.h5");
    const Shape shape = file.info("pressure").shape;
    std::vector<float> values = file.read<float>("pressure");
    const std::size_t of_ping = shape[1] * shape[2];
    for (std::size_t i = keep; i < rows * of_ping; ++i) values[i] = std::nanf("");
    std::map<std::string, double> kept;
    for (const std::string key : {"sample_rate_hz", "time_start", "time_step"})
      kept[key] = file.attribute_number("pressure", key);
    file.remove("pressure");
    file.write<float>("pressure", values, shape);
    for (const auto& [key, value] : kept) file.set_attribute("pressure", key, value);
    file.close();
  };
  spoil(1, 4000);  // a fifth of one phone of the first ping is left
  const auto some = asdic(folder, "process p.h5 -o some.h5");
  EXPECT_EQ(some.status, 0) << some.err;
  EXPECT_THAT(some.err,
              HasSubstr("asdic: warning: pressure of ping 1, array 0: 36000 samples are not "
                        "finite"));
  const Hdf5File processed = Hdf5File::open(folder / "some.h5");
  EXPECT_THAT(processed.attribute_texts("processed", "warnings"),
              testing::Contains(HasSubstr("not finite")));
  spoil(1, 0);
  const auto none = asdic(folder, "process p.h5 -o none.h5");
  EXPECT_EQ(none.status, 2);
  EXPECT_EQ(none.err,
            "asdic: p.h5: pressure of ping 1, array 0: found no finite sample, expected a "
            "recording\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "none.h5"));
}

}  // namespace
}  // namespace asdic::detail
