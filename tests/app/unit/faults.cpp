#include <gtest/gtest.h>

#include <algorithm>

#include "support/program.h"

// What goes wrong is told once, on standard error, as "asdic: WHERE: found X, expected Y".

namespace asdic::detail {
namespace {

using support::asdic;

struct Fault {
  std::string words;
  int status;
  std::vector<std::string> says;  // in this order
};

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.words; }

class Faults : public ::testing::TestWithParam<Fault> {};

TEST_P(Faults, AreOneLine) {
  support::TemporaryDirectory folder;
  static_cast<void>(folder.write("small.toml", support::small_scenario));
  static_cast<void>(folder.write("empty.h5", ""));
  static_cast<void>(folder.write("empty.toml", ""));
  static_cast<void>(folder.write("study.toml", "[study]\nscenario = \"small.toml\"\n"));
  static_cast<void>(folder.write("text.h5", "not HDF5 at all"));
  static_cast<void>(folder.write("hello.jsonl", "{\"asdic\": 1}\n"));
  static_cast<void>(folder.write("long.jsonl", std::string(20'000'000, 'x') + '\n'));
  const auto run = asdic(folder, GetParam().words);
  EXPECT_EQ(run.status, GetParam().status);
  EXPECT_EQ(run.out, "");
  EXPECT_TRUE(run.err.starts_with("asdic: ")) << run.err;
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  std::size_t at = 0;
  for (const std::string& part : GetParam().says) {
    at = run.err.find(part, at);
    ASSERT_NE(at, std::string::npos) << '"' << part << "\" is not in: " << run.err;
  }
}

INSTANTIATE_TEST_SUITE_P(
    CommandLine, Faults,
    ::testing::Values(
        Fault{"help pong", 2, {"pong", "did you mean \"ping\""}},
        Fault{"pong", 2, {"pong", "asdic --help"}},
        Fault{"ping", 2, {"SCENARIO", "asdic ping --help"}},
        Fault{"ping small.toml --fast", 2, {"--fast", "asdic ping --help"}},
        Fault{"ping small.toml --pings 0", 2, {"--pings"}},
        Fault{"ping small.toml --pings many", 2, {"many"}},
        Fault{"ping small.toml --threads 0", 2, {"--threads"}},
        Fault{"ping small.toml --seed -1", 2, {"--seed"}},
        Fault{"ping small.toml --seed abc",
              2,
              {"--seed: found abc, expected a seed from 0 to 9223372036854775807"}},
        Fault{"pnig small.toml",
              2,
              {"pnig: found no such command (did you mean \"ping\"?), expected one of ping, "}},
        Fault{"ping small.toml --ping 3",
              2,
              {"not expected: --ping (did you mean \"--pings\"?), 3;", "asdic ping --help"}},
        Fault{"rays small.toml --range 60miles",
              2,
              {"--range", "found \"60miles\"", "expected a length"}},
        Fault{"rays small.toml --range nan", 2, {"--range", "expected a length"}},
        Fault{"rays small.toml --range 0",
              2,
              {"--range", "expected a range from 0.001 to 20000000 m"}},
        Fault{"rays small.toml --elevations 0,95", 2, {"--elevations", "95 degrees"}},
        Fault{"rays small.toml --source-depth 2km", 2, {"--source-depth", "2000 m", "1000 m"}},
        Fault{"arrivals small.toml --range 5km", 2, {"--receiver-depth", "go together"}},
        Fault{"arrivals small.toml --target 1", 2, {"--target", "found 1", "from 0 to 0"}},
        Fault{"arrivals small.toml --leg both", 2, {"--leg"}},
        Fault{"export small.h5", 2, {"--wav"}},
        Fault{"serve small.toml --tcp 99999",
              2,
              {"--tcp: found 99999, expected a port from 0 to 65535", "asdic serve --help"}},
        Fault{"serve small.toml --tcp http", 2, {"--tcp: found http, expected a port"}},
        Fault{"ping small.toml --threads 2.5", 2, {"--threads: found 2.5, expected a number"}},
        Fault{"ocean --latitude 91 --longitude 0", 2, {"--latitude"}},
        Fault{"ocean --latitude 30 --longitude 0 --bearing 10", 2, {"--range", "go together"}}));

INSTANTIATE_TEST_SUITE_P(
    Scenario, Faults,
    ::testing::Values(
        Fault{"ping none.toml", 2, {"none.toml", "found no such file", "expected"}},
        Fault{"validate none.toml", 2, {"none.toml", "found", "expected"}},
        Fault{"ping small.toml --set pulse.frequency=-3",
              2,
              {"pulse.frequency", "found", "expected"}},
        Fault{"validate small.toml --set pulse.colour=3", 2, {"pulse.colour", "found", "expected"}},
        Fault{"validate small.toml --set target.0.rnage=3",
              2,
              {"--set target.0.rnage: found an unknown key", "(did you mean \"range\"?)"}},
        Fault{"validate small.toml --set target.0.velcoity=3", 2, {"did you mean \"velocity\"?"}},
        Fault{"validate small.toml --set environment.wind_speed='\"12 km\"'",
              2,
              {"--set environment.wind_speed: found \"12 km\", expected a wind speed from 0 to 60 "
               "m/s"}},
        Fault{"validate small.toml --set array.kind=towed --set array.behind=[]",
              2,
              {"array.behind: found an array of 0, expected an array of numbers", "one at least"}},
        Fault{
            "arrivals small.toml --set array.phones=0", 2, {"array.phones", "found", "expected"}}));

INSTANTIATE_TEST_SUITE_P(
    Files, Faults,
    ::testing::Values(
        Fault{"info none.h5", 2, {"none.h5", "found no such file", "expected"}},
        Fault{"info empty.h5", 2, {"empty.h5: found an empty file, expected"}},
        Fault{"plot empty.h5", 2, {"empty.h5: found an empty file", "asdic ping, area, place, st"}},
        Fault{"ping empty.toml", 2, {"empty.toml: found an empty file, expected a s"}},
        Fault{"plot study.toml", 2, {"study.toml:1: study: found a study, expected a scenario"}},
        Fault{"ping study.toml", 2, {"study.toml:1: study: found a study, expected"}},
        Fault{"field small.toml", 2, {"run: found nothing, expected a [run]"}},
        Fault{"plot text.h5", 2, {"text.h5", "found", "expected"}},
        Fault{"export --wav text.h5", 2, {"text.h5", "found", "expected"}},
        Fault{"ping small.toml -o nowhere/a.h5", 2, {"--output", "nowhere"}},
        Fault{"ping small.toml -o .", 2, {"--output", "folder"}},
        Fault{"ping small.toml -o small.toml", 2, {"--output", "the input itself"}},
        Fault{"ping small.toml -o /proc/a.h5", 1, {"/proc/a.h5"}},
        Fault{"rays small.toml -o /proc/a.h5", 1, {"/proc/a.h5"}},
        Fault{"arrivals small.toml -o /proc/a.h5", 1, {"/proc/a.h5"}},
        Fault{"rays small.toml > /dev/full", 1, {"standard output"}},
        Fault{"arrivals small.toml --json > /dev/full", 1, {"standard output"}},
        Fault{"--help > /dev/full", 1, {"standard output"}},
        Fault{"help units > /dev/full", 1, {"standard output"}},
        Fault{"settings pulse > /dev/full", 1, {"standard output"}},
        Fault{"validate small.toml > /dev/full", 1, {"standard output"}},
        Fault{"serve small.toml < hello.jsonl > /dev/full", 1, {"standard output: No space left"}},
        Fault{"serve small.toml --replay /dev/zero",
              2,
              {"/dev/zero: found a device, which is no file, expected"}},
        Fault{"serve small.toml --replay long.jsonl",
              2,
              {"long.jsonl:1: found another line, expected what --log has written"}}));

// Whatever a command reads: a file that is not there is told so, with what it should have been.
INSTANTIATE_TEST_SUITE_P(
    MissingFiles, Faults,
    ::testing::Values(
        Fault{"plot none.h5", 2, {"none.h5: found no such file, expected a file to draw: HDF5"}},
        Fault{"plot none.shd", 2, {"none.shd: found no such file, expected a file to draw"}},
        Fault{"rays none.toml", 2, {"none.toml: found no such file, expected a scenario file"}},
        Fault{"arrivals none.toml", 2, {"none.toml: found no such file, expected a scenario file"}},
        Fault{"field none.toml", 2, {"none.toml: found no such file, expected a scenario file"}},
        Fault{"serve none.toml", 2, {"none.toml: found no such file, expected a scenario file"}},
        Fault{"study none.toml", 2, {"none.toml: found no such file, expected a study file"}},
        Fault{"merge none.h5 -o all.h5", 2, {"none.h5: found no such file, expected an HDF5 file"}},
        Fault{"process none.h5", 2, {"none.h5: found no such file, expected an HDF5 file"}},
        Fault{"export none.h5 --wav", 2, {"none.h5: found no such file, expected an HDF5 file"}},
        Fault{"explain none", 2, {"none.env: found no such file, expected the input of a BELLHOP"}},
        Fault{"convert none.env a.toml", 2, {"none.env: found no such file, expected the input"}},
        Fault{"convert none.toml a.env", 2, {"none.toml: found no such file, expected a scenario"}},
        Fault{"convert none.shd a.h5", 2, {"none.shd: found no such file, expected a result"}},
        Fault{"compare a.shd b.shd", 2, {"a.shd: found no such file, expected a result"}},
        Fault{"ocean --latitude 30 --longitude 0 --data none",
              2,
              {"none/", "found no such file, expected a netCDF file"}},
        Fault{"ping small.toml --set include='\"none.toml\"'", 2, {"no such file", "expected"}}));

// A file that was cut at any place is refused by whoever reads it, never crashed on.
TEST(TruncatedFile, IsRefusedByEveryReader) {
  support::TemporaryDirectory folder;
  static_cast<void>(folder.write("small.toml", support::small_scenario));
  ASSERT_EQ(asdic(folder, "ping small.toml -q").status, 0);
  const auto size = std::filesystem::file_size(folder / "small.h5");
  for (const double share : {0.01, 0.3, 0.7, 0.99}) {
    std::filesystem::copy_file(folder / "small.h5", folder / "cut.h5",
                               std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(folder / "cut.h5",
                                 static_cast<std::uintmax_t>(share * static_cast<double>(size)));
    for (const char* words : {"info cut.h5", "plot cut.h5", "export --wav cut.h5"}) {
      const auto run = asdic(folder, words);
      EXPECT_EQ(run.status, 2) << words << " at " << share;
      EXPECT_EQ(run.out, "");
      EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
      EXPECT_NE(run.err.find("cut.h5"), std::string::npos) << run.err;
    }
  }
}

TEST(Plot, SaysWhenPythonOrItsModulesAreMissing) {
  support::TemporaryDirectory folder;
  static_cast<void>(folder.write("small.toml", support::small_scenario));
  ASSERT_EQ(asdic(folder, "ping small.toml -q").status, 0);
  const auto none = asdic(folder, "plot small.h5", "ASDIC_PYTHON=/none/python3");
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.err.find("/none/python3"), std::string::npos) << none.err;
  EXPECT_EQ(std::count(none.err.begin(), none.err.end(), '\n'), 1) << none.err;

  const auto bare = folder.write("bare", "#!/bin/sh\nexec /usr/bin/python3 -S \"$@\"\n");
  std::filesystem::permissions(bare, std::filesystem::perms::owner_all);
  const auto without = asdic(folder, "plot small.h5", "ASDIC_PYTHON=" + bare.string());
  EXPECT_EQ(without.status, 1);
  EXPECT_NE(without.err.find("matplotlib"), std::string::npos) << without.err;
  EXPECT_EQ(std::count(without.err.begin(), without.err.end(), '\n'), 1) << without.err;
}

TEST(Plot, PassesArgumentsAndExitStatusOn) {
  support::TemporaryDirectory folder;
  static_cast<void>(folder.write("small.toml", support::small_scenario));
  ASSERT_EQ(asdic(folder, "ping small.toml -q -o 'a b.h5'").status, 0);
  const auto fake =
      folder.write("fake", "#!/bin/sh\n[ \"$1\" = -c ] && exit 0\nprintf '<%s>' \"$@\"\nexit 7\n");
  std::filesystem::permissions(fake, std::filesystem::perms::owner_all);
  const auto run =
      asdic(folder, "plot 'a b.h5' -o 'my $pictures' --ping 2", "ASDIC_PYTHON=" + fake.string());
  EXPECT_EQ(run.status, 7);
  EXPECT_NE(run.out.find("asdic_plot.py><a b.h5><--output><my $pictures><--ping><2>"),
            std::string::npos)
      << run.out;
}

}  // namespace
}  // namespace asdic::detail
