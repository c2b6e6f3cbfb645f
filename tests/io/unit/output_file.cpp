#include "io/files/output_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "core/error.h"
#include "io/climatology/netcdf_file.h"
#include "io/files/files_read.h"
#include "io/hdf5/hdf5_file.h"
#include "io/hdf5/own_files.h"
#include "io/text/csv_table.h"
#include "support/left_of.h"
#include "support/program.h"
#include "support/temporary_directory.h"

namespace asdic::detail {
namespace {

using support::content;
using support::left_of;
using testing::HasSubstr;
using testing::MatchesRegex;

class Output : public testing::Test {
 protected:
  /// What is said to a target; "" if it may be written.
  static std::string said(const std::filesystem::path& target, const OutputRules& rules = {}) {
    try {
      const OutputFile output(target, rules);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  }

  support::TemporaryDirectory folder;
};

TEST_F(Output, HasItsNameOnlyWhenItIsWhole) {
  const auto target = folder / "a.txt";
  OutputFile output(target);
  const std::string part = output.part().filename().string();
  EXPECT_THAT(part, MatchesRegex("a\\.txt\\.[0-9a-z]{4}\\.part"));
  EXPECT_EQ(output.part().filename(), part) << "made once";
  EXPECT_EQ(target_of(output.part()), target);
  EXPECT_EQ(parts_of(target), std::vector{output.part()});
  output.write("whole");
  EXPECT_EQ(content(target), "whole");
  EXPECT_TRUE(parts_of(target).empty());
}

// A complete result removes the parts of runs that were killed, unless its rules call a part worth
// keeping. A run that fails leaves them.
TEST_F(Output, TakesPartsAwayThatAreOfNoUse) {
  const auto target = folder / "a.txt";
  static_cast<void>(folder.write("a.txt.0000.part", "a half"));
  static_cast<void>(folder.write("a.txt.1111.part", "a salvage"));
  static_cast<void>(folder.write("a.txt.part", "somebody's"));
  const auto worth = [](const std::filesystem::path& part) { return content(part) == "a salvage"; };
  {
    OutputFile output(target, {.worth = worth});
    static_cast<void>(output.part());
    EXPECT_EQ(parts_of(target).size(), 3U);
  }
  EXPECT_EQ(left_of(target), "a.txt.0000.part a.txt.1111.part ");
  OutputFile(target, {.worth = worth}).write("x");
  EXPECT_EQ(left_of(target), "a.txt.1111.part ");
  EXPECT_EQ(content(folder / "a.txt.part"), "somebody's");
}

// A signal that ends the program removes unfinished files, except those worth keeping.
TEST_F(Output, LeavesNothingWhenASignalEndsTheProgram) {
  const auto target = folder / "a.txt";
  {
    OutputFile output(target), other(folder / "b.txt");
    static_cast<void>(output.part());
    static_cast<void>(other.part());
    other.keep();
    remove_unfinished();
    EXPECT_EQ(left_of(target), "");
    EXPECT_FALSE(std::filesystem::exists(target.string() + ".lock"));
    EXPECT_EQ(parts_of(folder / "b.txt").size(), 1U);
  }
  OutputFile(target).write("x");
  remove_unfinished();
  EXPECT_EQ(content(target), "x");
}

TEST_F(Output, KeepsWhatIsWorthSomething) {
  const auto target = folder / "a.txt";
  {
    OutputFile output(target);
    static_cast<void>(output.part());
    output.keep();
  }
  EXPECT_EQ(parts_of(target).size(), 1U);
  EXPECT_FALSE(std::filesystem::exists(target));
}

TEST_F(Output, ReplacesFilesAlone) {
  const auto outside = folder.write("outside", "mine");
  std::filesystem::create_symlink(outside, folder / "link");
  std::filesystem::create_symlink(folder / "nowhere", folder / "dangling");
  std::filesystem::create_directory(folder / "sub");
  ASSERT_EQ(mkfifo((folder / "fifo").c_str(), 0600), 0);
  for (const bool force : {false, true}) {
    EXPECT_THAT(said(folder / "link", {.force = force}), HasSubstr("--output: found a link, "));
    EXPECT_THAT(said(folder / "dangling", {.force = force}), HasSubstr("found a link, "));
    EXPECT_THAT(said(folder / "fifo", {.force = force}), HasSubstr("found a FIFO, "));
    EXPECT_THAT(said(folder / "sub", {.force = force}), HasSubstr("found the folder "));
    EXPECT_THAT(said(folder / "none/x", {.force = force}), HasSubstr("found no folder "));
  }
  EXPECT_THAT(said(""), HasSubstr("found the folder"));
  EXPECT_EQ(content(outside), "mine");
}

// A device of our own making, of the same kind as /dev/null: only root can make one.
TEST_F(Output, ReplacesNoDevice) {
  const auto device = folder / "null";
  if (mknod(device.c_str(), S_IFCHR | 0666, makedev(1, 3)) != 0) GTEST_SKIP() << "not as this user";
  EXPECT_THAT(said(device, {.force = true}), HasSubstr("found a device, "));
  EXPECT_TRUE(std::filesystem::is_character_file(device));
}

TEST_F(Output, WritesOverItsOwnOrNothingUnlessForced) {
  const auto foreign = folder.write("a.h5", "a letter");
  EXPECT_THAT(said(foreign),
              HasSubstr("which asdic did not write, expected another name, or --for"));
  EXPECT_THAT(said(foreign, {.own = own::hdf5}), HasSubstr("which asdic did not write"));
  EXPECT_EQ(said(foreign, {.own = own::hdf5, .force = true}), "");
  EXPECT_EQ(content(foreign), "a letter") << "nothing is written before it is whole";
  EXPECT_EQ(said(folder.write("empty", "")), "") << "an empty file is nobody's loss";
  {
    Hdf5File::create(folder / "b.h5").set_attribute("", "filetype", "asdic field");
    Hdf5File::create(folder / "c.h5").set_attribute("", "filetype", "statepoint");
  }
  EXPECT_EQ(said(folder / "b.h5", {.own = own::hdf5}), "");
  EXPECT_THAT(said(folder / "c.h5", {.own = own::hdf5}), HasSubstr("asdic did not write"));
}

TEST_F(Output, IsNoInputOfTheRunUnderAnyName) {
  const auto input = folder.write("cast.csv", "depth,speed\n0,1500\n");
  std::filesystem::create_hard_link(input, folder / "hard.csv");
  EXPECT_THAT(said(input, {.force = true, .inputs = {folder / "hard.csv"}}),
              HasSubstr("found the input itself"));
  {
    const FilesRead reading;
    static_cast<void>(read_csv(input));
    EXPECT_THAT(said(input, {.force = true}), HasSubstr("found the input itself"));
    EXPECT_THAT(said(folder / "hard.csv", {.force = true}), HasSubstr("(read as \""));
    EXPECT_THAT(said(folder.path() / "." / "cast.csv", {.force = true}), HasSubstr("the input"));
  }
  EXPECT_EQ(said(input, {.force = true}), "") << "another run has read nothing yet";
}

// A file that a command reads after it has begun its output is an input as well, unless the command
// renews it.
TEST_F(Output, IsNoInputThatIsReadMeanwhile) {
  const auto data = folder.write("cast.csv", "depth,speed\n0,1500\n");
  for (const bool renews : {false, true}) {
    const FilesRead reading;
    OutputFile output(data, {.force = true, .renews = renews});
    static_cast<void>(read_csv(data));
    if (renews) {
      output.write("new");
    } else {
      EXPECT_THROW(output.write("new"), RunError);
      EXPECT_EQ(content(data), "depth,speed\n0,1500\n");
      std::filesystem::remove(parts_of(data).at(0));
    }
  }
  EXPECT_EQ(content(data), "new");
}

// A child process reads for this process, which does not see the files that the child opens.
TEST_F(Output, IsNoInputThatAChildReads) {
  { Hdf5File::create(folder / "a.nc").set_attribute("", "filetype", "asdic ocean"); }
  const FilesRead reading;
  static_cast<void>(netcdf_variables(folder / "a.nc"));
  EXPECT_THAT(said(folder / "a.nc", {.own = own::hdf5}), HasSubstr("found the input itself"));
}

// A letter that somebody put there while hours of work went on.
TEST_F(Output, LeavesWhatCameMeanwhileAndKeepsTheResult) {
  const auto target = folder / "a.h5";
  OutputFile output(target, {.own = own::hdf5});
  static_cast<void>(output.part());
  static_cast<void>(folder.write("a.h5", "a letter"));
  try {
    output.write("the result");
    FAIL();
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), HasSubstr("asdic did not write"));
    EXPECT_THAT(error.what(), HasSubstr("the result is in " + parts_of(target).at(0).string()));
  }
  EXPECT_EQ(content(target), "a letter");
  EXPECT_EQ(content(parts_of(target).at(0)), "the result");
}

TEST_F(Output, TellsWhoIsAtWork) {
  const auto target = folder / "a.h5";
  {
    const OutputFile first(target);
    EXPECT_THAT(said(target),
                MatchesRegex(".*a\\.h5: another asdic is at work on it: process " +
                             std::to_string(getpid()) + " on host .+ since 20..-..-..T..:..:..Z"));
    EXPECT_EQ(left_of(target), "a.h5.lock");
  }
  EXPECT_EQ(said(target), "");
  EXPECT_EQ(left_of(target), "");
}

TEST_F(Output, TheLockOfAKilledProcessIsFree) {
  const auto target = folder / "a.h5";
  int ready[2] = {};
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    OutputFile output(target);
    static_cast<void>(output.part());
    if (write(ready[1], "x", 1) != 1) std::_Exit(1);
    pause();
    std::_Exit(0);
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  EXPECT_THAT(said(target), HasSubstr("process " + std::to_string(child)));
  kill(child, SIGKILL);
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
  EXPECT_TRUE(std::filesystem::exists(target.string() + ".lock"));
  OutputFile(target).write("next");
  EXPECT_EQ(content(target), "next");
  EXPECT_TRUE(parts_of(target).empty()) << "the killed one's is of no use any more";
  EXPECT_FALSE(std::filesystem::exists(target.string() + ".lock"));
}

TEST_F(Output, TakesNobodysFileForALock) {
  const auto lock = folder.write("a.h5.lock", "my padlock's number");
  EXPECT_THAT(said(folder / "a.h5"), HasSubstr("a.h5.lock: found a file that asdic did not write"));
  EXPECT_EQ(content(lock), "my padlock's number");
}

TEST(TargetOf, ReadsTheNamesOfParts) {
  EXPECT_EQ(target_of("x/ping.h5.k3f9.part"), "x/ping.h5");
  EXPECT_EQ(target_of("ping.h5.part"), "");
  EXPECT_EQ(target_of("ping.h5.K3F9.part"), "");
  EXPECT_EQ(target_of(".k3f9.part"), "");
}

// What a person may have under a name of ours is not ours; what BELLHOP writes counts as ours.
TEST_F(Output, KnowsItsOwnKinds) {
  const auto text = [&](const std::string& words) { return folder.write("file", words); };
  const std::string letter = "Dear reader,\nthis is not a result.\n";
  for (const Recognise own : {own::hdf5, own::sound, own::sound_scale, own::scenario, own::table,
                              own::picture, own::shade_file, own::arrivals_file, own::ray_file,
                              own::print_file, own::case_file, own::case_companion}) {
    EXPECT_FALSE(own(text(letter)));
    EXPECT_FALSE(own(folder / "none"));
    EXPECT_FALSE(own(folder.path()));
  }
  EXPECT_TRUE(own::scenario(text("# 30.5 N, March. Written by asdic ocean.\n[environment]\n")));
  EXPECT_FALSE(own::scenario(text("title = \"by hand\"\n# Written by asdic\n")));
  EXPECT_TRUE(own::table(text("ping,array,time,doppler_factor\n")));
  EXPECT_TRUE(own::table(text("track,array,side,ambiguous,ping\n")));
  EXPECT_FALSE(own::table(text("time,pressure\n0,1\n")));
  EXPECT_TRUE(own::print_file(text("asdic 0.1.0 (g++), munk.env\n")));
  EXPECT_TRUE(own::print_file(text("\n BELLHOP/BELLHOP3D\n")));
  EXPECT_TRUE(own::case_file(text("'t'\n50\n1\n! Written by asdic\n")));
  EXPECT_TRUE(own::arrivals_file(text(" '2D'\n 50.0\n")));
  const std::filesystem::path cases = ASDIC_TEST_DATA "/bellhop";
  EXPECT_TRUE(own::shade_file(cases / "munk-coherent-hat/case.shd"));
  EXPECT_TRUE(own::arrivals_file(cases / "deep-source-arrivals/case.arr"));
  EXPECT_TRUE(own::ray_file(cases / "eigenrays-channel/case.ray"));
  EXPECT_FALSE(own::ray_file(cases / "munk-coherent-hat/case.shd"));
}

}  // namespace
}  // namespace asdic::detail
