#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/error.h"
#include "io/files/input_file.h"
#include "io/hdf5/own_files.h"
#include "io/mat/mat_file.h"
#include "support/temporary_directory.h"

// SciPy and Octave read whole files: tests/app/validation/mat_files.py.

namespace asdic::detail {
namespace {

using support::TemporaryDirectory;

std::string bytes(const std::filesystem::path& path) { return read_input(path, "a MAT-file"); }

TEST(MatFile, BytesAreThoseOfTheFormat) {
  const TemporaryDirectory folder;
  MatFile file(folder / "a.mat");
  file.write("x", MatMatrix{.rows = 1, .columns = 1, .values = {1.5}});
  file.finish();
  const std::string found = bytes(folder / "a.mat");
  ASSERT_EQ(found.size(), 128U + 64U);  // head; tag, flags, shape, name, number
  EXPECT_EQ(found.substr(0, 19), "MATLAB 5.0 MAT-file");
  EXPECT_EQ(found.substr(124, 4), (std::string{0, 1, 'I', 'M'}));
  const std::string matrix{14, 0, 0, 0, 56, 0, 0, 0};
  const std::string flags{6, 0, 0, 0, 8, 0, 0, 0, 6, 0, 0, 0, 0, 0, 0, 0};
  const std::string shape{5, 0, 0, 0, 8, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
  const std::string name{1, 0, 1, 0, 'x', 0, 0, 0};
  const std::string number{9, 0, 0, 0, 8, 0, 0, 0, 0, 0, 0, 0, 0, 0, char(0xF8), 0x3F};
  EXPECT_EQ(found.substr(128), matrix + flags + shape + name + number);
}

TEST(MatFile, TextsAreUtf16) {
  const TemporaryDirectory folder;
  MatFile file(folder / "a.mat");
  file.write("x", std::string("µ𝄞\xFF"));  // one unit, a pair of units, no UTF-8
  file.finish();
  const std::string text{4,          0, 0,    0,          8,    0,          0,   0,
                         char(0xB5), 0, 0x34, char(0xD8), 0x1E, char(0xDD), '?', 0};
  EXPECT_EQ(bytes(folder / "a.mat").substr(128 + 8 + 16 + 16 + 8), text);
}

TEST(MatFile, MoreThanTwoGigabytesAreRefusedBeforeTheyAreAskedFor) {
  const TemporaryDirectory folder;
  MatFile file(folder / "a.mat");
  const MatColumns large{.rows = std::size_t{1} << 26,
                         .columns = 4,
                         .is_complex = true,
                         .column = [](std::size_t) -> std::vector<float> {
                           ADD_FAILURE() << "a column was asked for";
                           return {};
                         }};
  EXPECT_EQ(bytes_of(large), std::uint64_t{1} << 31);
  try {
    file.write("pressure", large);
    FAIL() << "no complaint";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                testing::HasSubstr("a.mat: pressure: found 2147483648 bytes, expected "
                                   "less than 2 GiB"));
  }
}

TEST(MatFile, OnlyOursIsWrittenOver) {
  const TemporaryDirectory folder;
  {
    MatFile file(folder / "a.mat");
    file.finish();
  }
  EXPECT_TRUE(own::mat(folder / "a.mat"));
  MatFile(folder / "a.mat").finish();
  std::ofstream(folder / "b.mat") << "MATLAB 5.0 MAT-file, written by somebody else";
  EXPECT_FALSE(own::mat(folder / "b.mat"));
  EXPECT_THROW(MatFile(folder / "b.mat"), InputError);
  MatFile(folder / "b.mat", {.force = true}).finish();
}

}  // namespace
}  // namespace asdic::detail
