#include "io/files/input_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <functional>

#include "core/error.h"
#include "io/bellhop/case_reader.h"
#include "io/climatology/climatology.h"
#include "io/climatology/data_grid.h"
#include "io/hdf5/hdf5_file.h"
#include "io/result/result_file.h"
#include "io/scenario/scenario_reader.h"
#include "io/text/csv_table.h"
#include "io/wav/wav.h"
#include "support/temporary_directory.h"

namespace asdic::detail {
namespace {

using support::TemporaryDirectory;
using testing::HasSubstr;

std::string refusal(const std::function<void()>& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was refused";
}

TEST(InputFile, IsReadToItsEnd) {
  const TemporaryDirectory folder;
  const std::string text(3'000'000, 'x');
  const auto path = folder.write("a", text);
  EXPECT_EQ(read_input(path, "a file"), text);
  EXPECT_EQ(InputFile(path, "a file").read(5), "xxxxx");
  EXPECT_EQ(InputFile(path, "a file").size(), text.size());
  EXPECT_EQ(read_input(folder.write("empty", ""), "a file"), "");
  EXPECT_THAT(read_input("/proc/self/status", "a file"), HasSubstr("Pid:"));  // its size is 0
}

TEST(InputFile, TakesLittleMoreMemoryThanItHasBytes) {
  const TemporaryDirectory folder;
  for (const std::size_t size : {0U, 100U, 5000U, 3'000'000U}) {
    const auto path = folder.write("a", std::string(size, 'x'));
    EXPECT_LE(read_input(path, "a file").capacity(), size + 8192) << size;
  }
}

TEST(InputFile, SaysWhatIsThereInstead) {
  const TemporaryDirectory folder;
  const auto said = [&](const std::filesystem::path& path) {
    return refusal([&] { static_cast<void>(read_input(path, "a scenario file")); });
  };
  EXPECT_EQ(said("/no/such"), "/no/such: found no such file, expected a scenario file");
  EXPECT_THAT(said(folder.path()), HasSubstr("found a folder, expected a scenario file"));
  EXPECT_THAT(said("/dev/zero"), HasSubstr("found a device, which is no file, expected"));
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(said(folder / "pipe"), HasSubstr("found a pipe, which is no file, expected"));
}

// A pipe that nobody writes to would be waited for; every reader refuses it.
TEST(InputFile, EveryReaderComesByIt) {
  const TemporaryDirectory folder;
  const auto pipe = [&](const std::string& name) {
    const auto path = folder / name;
    if (mkfifo(path.c_str(), 0600) != 0) throw std::runtime_error("no pipe");
    return path;
  };
  const std::vector<std::pair<std::string, std::function<void(const std::filesystem::path&)>>>
      readers{{"a.toml", [](const auto& path) { static_cast<void>(read_scenario(path)); }},
              {"a.csv", [](const auto& path) { static_cast<void>(read_csv(path)); }},
              {"p.csv", [](const auto& path) { static_cast<void>(read_pulse_file(path)); }},
              {"p.wav", [](const auto& path) { static_cast<void>(read_pulse_file(path)); }},
              {"a.h5", [](const auto& path) { static_cast<void>(Hdf5File::open(path)); }},
              {"b.h5", [](const auto& path) { static_cast<void>(read_result(path)); }},
              {"a.nc", [](const auto& path) { static_cast<void>(DataGrid::find(path, {"x"})); }},
              {"a.env", [](const auto& path) { static_cast<void>(bellhop::read_case(path)); }},
              {"a.shd", [](const auto& path) { static_cast<void>(read_result(path)); }},
              {"a.arr", [](const auto& path) { static_cast<void>(read_result(path)); }},
              {"a.ray", [](const auto& path) { static_cast<void>(read_result(path)); }}};
  for (const auto& [name, read] : readers) {
    const auto path = pipe(name);
    EXPECT_THAT(refusal([&, &reader = read] { reader(path); }),
                HasSubstr("a pipe, which is no file"))
        << name;
  }
}

}  // namespace
}  // namespace asdic::detail
