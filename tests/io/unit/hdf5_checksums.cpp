#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <numeric>
#include <random>

#include "core/error.h"
#include "io/files/output_file.h"
#include "io/hdf5/file_check.h"
#include "io/hdf5/fletcher.h"
#include "io/hdf5/hdf5_file.h"
#include "io/ping/ping_file.h"
#include "io/ping/recovery.h"
#include "io/text/csv_table.h"
#include "support/left_of.h"
#include "support/ping_record.h"
#include "support/temporary_directory.h"

namespace asdic::detail {
namespace {

using support::small_record;
using support::small_scenario;
using testing::HasSubstr;

std::vector<float> ramp(std::size_t n) {
  std::vector<float> values(n);
  std::iota(values.begin(), values.end(), 0.5F);
  return values;
}

/// What check_file() says; "" if all is well.
std::string damage(const std::filesystem::path& path) {
  try {
    static_cast<void>(check_file(Hdf5File::open(path)));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// Changes a bit where a number stands in a file.
void flip(const std::filesystem::path& path, float number) {
  std::string bytes = read_text_file(path);
  const auto at = bytes.find(std::string(reinterpret_cast<const char*>(&number), sizeof number));
  ASSERT_NE(at, std::string::npos);
  bytes[at] = static_cast<char>(bytes[at] ^ 4);
  std::ofstream(path, std::ios::binary) << bytes;
}

// As the format says it: words of two bytes, the higher first, both sums modulo 65535. Lengths
// around lanes and segments; bytes at random, all set (sums that are 0 modulo 65535), mostly not.
TEST(Checksums, AreThoseOfTheFormat) {
  std::mt19937 random(1);
  for (std::size_t size = 0; size < 9000; size += size < 600 ? 2 : 34)
    for (const int kind : {0, 1, 2, 3}) {
      std::vector<std::byte> bytes(size);
      for (std::byte& b : bytes)
        b = static_cast<std::byte>(kind == 0   ? random()
                                   : kind == 1 ? 0xffU
                                   : kind == 2 ? (random() % 50 == 0 ? 0xffU : 0U)
                                               : 0U);
      std::uint32_t first = 0, second = 0;
      const auto folded = [](std::uint32_t sum) {
        return sum > 0xffffU ? (sum & 0xffffU) + (sum >> 16U) : sum;
      };
      for (std::size_t i = 0; i < size; i += 2) {
        const auto word = std::to_integer<std::uint32_t>(bytes[i]) << 8U |
                          std::to_integer<std::uint32_t>(bytes[i + 1]);
        first = folded(first + word);
        second = folded(second + first);
      }
      ASSERT_EQ(hdf5::fletcher32(bytes), second << 16U | first) << size << ' ' << kind;
    }
}

// HDF5 verifies what it reads: our own sums must be those of its filter. Lines of a chunk each (our
// way), odd numbers of words, blocks of 256 words and more, columns (its way).
TEST(Checksums, AreThoseOfHdf5) {
  const support::TemporaryDirectory folder;
  for (const std::size_t samples : {1U, 2U, 127U, 128U, 129U, 5000U}) {
    Hdf5File file = Hdf5File::create(folder / "a.h5");
    file.create_growing<float>("lines", {3, samples}, Shape{1, 1, samples});
    file.create_growing<float>("iq", {3, samples, 2}, Shape{1, 1, samples, 2});
    file.create_growing<float>("column", {}, std::size_t{64});
    for (int row = 0; row < 2; ++row) {
      file.append<float>("lines", ramp(3 * samples));
      file.append<float>("iq", ramp(6 * samples));
      file.append<float>("column", ramp(100));
    }
    file.append<float>("lines", ramp(2 * 3 * samples));
    file.close();
    const Hdf5File read = Hdf5File::open(folder / "a.h5");
    auto twice = ramp(6 * samples);
    EXPECT_EQ(read.read<float>("iq", {1, 0, 0, 0}, {1, 3, samples, 2}), twice);
    EXPECT_EQ(read.read<float>("lines", {2, 0, 0}, {2, 3, samples}), twice);
    EXPECT_EQ(read.read<float>("column", {100}, {100}), ramp(100));
    const FileCheck found = check_file(read);
    EXPECT_EQ(found.checked, 3U);
    EXPECT_EQ(found.values, 4 * 3 * samples + 2 * 6 * samples + 200);
  }
}

TEST(Checksums, FindAChangedBitAndSayWhere) {
  const support::TemporaryDirectory folder;
  const auto path = folder / "a.h5";
  {
    Hdf5File file = Hdf5File::create(path);
    file.create_growing<float>("pressure", {2, 300}, Shape{1, 1, 300});
    file.append<float>("pressure", ramp(2 * 600));
  }
  EXPECT_EQ(damage(path), "");
  flip(path, 950.5F);  // in the second row's second line
  EXPECT_THAT(damage(path), HasSubstr("a.h5: /pressure[1, 1]: found damaged data"));
}

class Recover : public testing::Test {
 protected:
  /// The part that a writer leaves which dies after so many pings.
  std::filesystem::path part(int pings) {
    const auto target = folder / "p.h5";
    {
      PingFileWriter writer(target, scenario, {});
      for (int ping = 1; ping <= pings; ++ping) writer.append(small_record(scenario, ping));
    }
    return parts_of(target).at(0);
  }

  support::TemporaryDirectory folder;
  const Scenario scenario = small_scenario(std::vector<std::string>{"pings.count=3"});
};

TEST_F(Recover, MakesAFileOfWholePings) {
  const auto left = part(2);
  {  // a third ping, of which everything but its number was written
    Hdf5File file = Hdf5File::edit(left);
    file.append<double>("ping_time", std::vector{99.0});
    file.append<std::int32_t>("echoes/ping", std::vector<std::int32_t>{3});
  }
  const std::string before = read_text_file(left);
  const Recovery found = recover_ping_file(left, OutputFile(folder / "saved.h5"));
  EXPECT_EQ(found.pings, 2U);
  EXPECT_EQ(found.requested, 3U);
  EXPECT_TRUE(read_text_file(left) == before) << "the part stays as it was";
  const PingFile saved(folder / "saved.h5");
  EXPECT_EQ(saved.pings(), 2U);
  EXPECT_FALSE(saved.complete());
  EXPECT_EQ(saved.file().info("ping_time").shape, Shape{2});
  EXPECT_EQ(saved.file().info("echoes/ping").shape, saved.file().info("echoes/delay").shape);
  EXPECT_EQ(saved.file().attribute_number("", "recovered"), 1.0);
  const PingRecord second = small_record(scenario, 2);
  EXPECT_EQ(saved.pressure(1, 0).front(), second.pressure.front());
  EXPECT_EQ(damage(folder / "saved.h5"), "");
}

TEST_F(Recover, AllPingsMakeACompleteFile) {
  static_cast<void>(recover_ping_file(part(3), OutputFile(folder / "saved.h5")));
  EXPECT_TRUE(PingFile(folder / "saved.h5").complete());
}

TEST_F(Recover, RefusesWhatHoldsNoPing) {
  const auto left = part(1);
  {
    Hdf5File file = Hdf5File::edit(left);
    file.shrink("ping", 0);
  }
  EXPECT_THROW(static_cast<void>(recover_ping_file(left, OutputFile(folder / "s.h5"))), InputError);
  EXPECT_THROW(
      static_cast<void>(recover_ping_file(folder.write("text", "x"), OutputFile(folder / "s.h5"))),
      InputError);
  EXPECT_FALSE(std::filesystem::exists(folder / "s.h5"));
  EXPECT_EQ(support::left_of(folder / "s.h5"), "");
}

}  // namespace
}  // namespace asdic::detail
