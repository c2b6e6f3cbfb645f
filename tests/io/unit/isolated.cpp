#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <thread>

#include "core/error.h"
#include "io/hdf5/hdf5_file.h"
#include "io/isolated/child.h"
#include "io/isolated/pack.h"
#include "io/ping/ping_file.h"
#include "io/result/result_file.h"
#include "support/temporary_directory.h"

namespace asdic::detail {
namespace {

using isolated::Child;
using isolated::Limits;
using support::TemporaryDirectory;
using testing::AllOf;
using testing::HasSubstr;

constexpr Limits quick{.processor = std::chrono::milliseconds(200),
                       .wall = std::chrono::seconds(2)};

template <class Work>
std::string refusal(Work work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was refused";
}

/// A child that does something when it is asked.
Child child_that(const std::function<std::string(std::string_view)>& work,
                 const Limits& limits = quick) {
  return Child(
      "f.h5", "HDF5", [&]() -> Child::Answer { return work; }, limits);
}

TEST(IsolatedChild, AnswersQuestions) {
  Child child = child_that([n = 0](std::string_view question) mutable {
    return std::string(question) + std::to_string(++n);
  });
  EXPECT_EQ(child.ask("a"), "a1");
  EXPECT_EQ(child.ask(""), "2");
  EXPECT_EQ(child.ask(std::string(3'000'000, 'x')), std::string(3'000'000, 'x') + "3");
}

TEST(IsolatedChild, PassesOnWhatIsThrown) {
  Child child = child_that([](std::string_view question) -> std::string {
    if (question == "input") throw InputError({.where = "w", .got = "g", .expected = "e"});
    if (question == "memory") throw std::bad_alloc();
    if (question == "logic") throw std::logic_error("a block of another rank");
    throw RunError("the disk is gone");
  });
  EXPECT_EQ(refusal([&] { static_cast<void>(child.ask("input")); }), "w: found g, expected e");
  EXPECT_THAT(refusal([&] { static_cast<void>(child.ask("memory")); }),
              HasSubstr("f.h5: found a damaged file: reading it asks for more than"));
  EXPECT_THROW(static_cast<void>(child.ask("logic")), std::logic_error);
  EXPECT_THROW(static_cast<void>(child.ask("run")), RunError);  // and it lives on
  EXPECT_EQ(refusal([&] { static_cast<void>(child.ask("input")); }), "w: found g, expected e");
}

TEST(IsolatedChild, ItsDeathIsAFaultOfTheFile) {
  Child child = child_that([](std::string_view) -> std::string { std::abort(); });
  EXPECT_THAT(refusal([&] { static_cast<void>(child.ask("x")); }),
              AllOf(HasSubstr("f.h5: found a damaged file: the HDF5 library crashes on it"),
                    HasSubstr("Aborted")));
  EXPECT_THAT(refusal([&] { static_cast<void>(child.ask("x")); }), HasSubstr("has failed before"));
}

TEST(IsolatedChild, RunningInCirclesEnds) {
  Child child = child_that([](std::string_view) -> std::string {
    for (volatile int i = 0;;) i = i + 1;
  });
  EXPECT_THAT(refusal([&] { static_cast<void>(child.ask("x")); }),
              HasSubstr("the HDF5 library does not come to an end with it"));
}

TEST(IsolatedChild, WaitingForEverEnds) {
  Child child = child_that([](std::string_view) -> std::string {
    for (;;) pause();
  });
  EXPECT_THAT(refusal([&] { static_cast<void>(child.ask("x")); }),
              HasSubstr("does not come to an end"));
}

TEST(IsolatedChild, MemoryIsLimited) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the address sanitizer takes terabytes of addresses";
#endif
  Limits little = quick;
  little.memory = std::size_t{64} << 20;
  Child child = child_that(
      [](std::string_view) { return std::to_string(std::string(1U << 30, 'x').size()); }, little);
  EXPECT_THAT(refusal([&] { static_cast<void>(child.ask("x")); }), HasSubstr("more than 64 MB"));
}

TEST(IsolatedChild, FaultsOfOpeningAreThoseOfTheConstructor) {
  EXPECT_EQ(refusal([] {
              const Child child("f", "HDF5", []() -> Child::Answer {
                throw InputError({.where = "f", .got = "nothing", .expected = "something"});
              });
            }),
            "f: found nothing, expected something");
  EXPECT_THAT(
      refusal([] { const Child child("f", "HDF5", []() -> Child::Answer { std::abort(); }); }),
      HasSubstr("the HDF5 library crashes on it"));
}

// Neither the signals of a terminal nor other threads disturb it.
TEST(IsolatedChild, IsLeftAloneByCtrlC) {
  Child child = child_that([](std::string_view) {
    raise(SIGINT);
    raise(SIGTERM);
    return std::string("here");
  });
  EXPECT_EQ(child.ask(""), "here");
}

TEST(IsolatedChild, ManyThreadsMayHaveTheirOwn) {
  std::vector<std::jthread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([] {
      for (int i = 0; i < 20; ++i) {
        Child child = child_that([](std::string_view q) { return std::string(q); }, Limits{});
        EXPECT_EQ(child.ask("x"), "x");
      }
    });
}

TEST(IsolatedRun, WhatItWritesStays) {
  const TemporaryDirectory folder;
  int here = 0;
  isolated::run(
      folder / "a", "HDF5",
      [&] {
        here = 1;
        static_cast<void>(folder.write("a", "text"));
      },
      Limits{});
  EXPECT_EQ(here, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "a"));
}

TEST(Packed, ComesBackAsItWas) {
  isolated::Packed out;
  out.put(std::string("a\0b", 3));
  out.put(std::vector<std::string>{"", "x"});
  out.put(std::vector<double>{1.5, -0.0});
  out.put(std::filesystem::path("p"));
  out.put(true);
  isolated::Unpacked in(out.bytes());
  EXPECT_EQ(in.get<std::string>(), std::string("a\0b", 3));
  EXPECT_EQ(in.get<std::vector<std::string>>(), (std::vector<std::string>{"", "x"}));
  EXPECT_EQ(in.get<std::vector<double>>(), (std::vector<double>{1.5, 0.0}));
  EXPECT_EQ(in.get<std::filesystem::path>(), "p");
  EXPECT_TRUE(in.get<bool>());
  EXPECT_THROW(static_cast<void>(in.get<double>()), std::logic_error);  // no more
}

/// Everything there is to read in a file.
void read_all(const std::filesystem::path& path) {
  const Hdf5File file = Hdf5File::open(path);
  for (const DatasetInfo& info : file.datasets()) {
    for (const std::string& key : file.attributes(info.path))
      static_cast<void>(file.attribute_texts(info.path, key));
    if (info.type == ElementType::text)
      static_cast<void>(file.read_text(info.path));
    else if (info.type != ElementType::other)
      static_cast<void>(file.read<double>(info.path));
  }
  for (const std::string& key : file.attributes(""))
    static_cast<void>(file.attribute_texts("", key));
}

// Files on which HDF5 1.10.8 crashed, or never came to an end, in this process.
TEST(Hdf5File, DamagedFilesAreRefused) {
  for (const char* name :
       {"attribute-text-crash.h5", "hang.h5", "info-crash.h5", "merge-crash.h5"}) {
    const std::filesystem::path path = std::string(ASDIC_TEST_DATA "/hostile/") + name;
    EXPECT_THAT(refusal([&] { read_all(path); }), HasSubstr(name));
  }
}

TEST(Hdf5File, ReadsInPiecesWhatItReadsWhole) {
  const TemporaryDirectory folder;
  std::vector<double> values(5 * 7 * 90'000);  // 25 MB: more than is asked for at a time
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i);
  {
    Hdf5File file = Hdf5File::create(folder / "a.h5");
    file.write<double>("x", values, {5, 7, 90'000});
    file.write<double>("scalar", std::vector<double>{4.0}, {});
    file.write_text("text", "ein Satz, µ");
    file.write_text("none", "");
    file.set_attribute("x", "list", std::vector<std::string>{"a", "", "ccc"});
    file.set_attribute("", "long", std::string(100'000, 'y'));
    file.close();
  }
  const Hdf5File file = Hdf5File::open(folder / "a.h5");
  EXPECT_EQ(file.read<double>("x"), values);
  const auto block = file.read<double>("x", {1, 2, 3}, {3, 2, 4});
  ASSERT_EQ(block.size(), 24U);
  EXPECT_EQ(block[0], values[(1 * 7 + 2) * 90'000 + 3]);
  EXPECT_EQ(block[23], values[(3 * 7 + 3) * 90'000 + 6]);
  EXPECT_EQ(file.read<double>("scalar"), std::vector<double>{4.0});
  EXPECT_EQ(file.read_text("text"), "ein Satz, µ");
  EXPECT_EQ(file.read_text("none"), "");
  EXPECT_EQ(file.attribute_texts("x", "list"), (std::vector<std::string>{"a", "", "ccc"}));
  EXPECT_EQ(file.attribute_text("", "long"), std::string(100'000, 'y'));
}

}  // namespace
}  // namespace asdic::detail
