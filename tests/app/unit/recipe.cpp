#include <gtest/gtest.h>

#include <fstream>

#include "app/file_exports.h"
#include "support/program.h"

// The example of docs/develop/recipes.md: a new format that `asdic export` writes.

namespace asdic::detail::app {
namespace {

/// The example: the loudest sample of every phone, a line each.
struct PeaksExport {
  static constexpr std::string_view name = "peaks";
  static constexpr std::string_view help = "NAME_pingNNN.txt, the greatest |p| of every phone [Pa]";
  static void check(const PingFile&, const ExportChoice&) {}  // it takes every file
  static void write(const PingFile& file, const ExportChoice& choice) {
    for (std::size_t ping = choice.first; ping < choice.end; ++ping) {
      std::ofstream out(choice.folder / ("peaks_" + std::to_string(ping + 1) + ".txt"));
      for (std::size_t channel = 0; channel < file.channels(); ++channel) {
        float peak = 0.0F;
        for (const float p : file.pressure(ping, channel)) peak = std::max(peak, std::abs(p));
        out << peak << '\n';
      }
    }
  }
};

TEST(Recipe, AFileExportIsAFileAndAWord) {
  constexpr auto& exports = export_list<WavExport, PeaksExport>;
  ASSERT_EQ(exports.size(), 2U);
  EXPECT_EQ(exports[1].name, "peaks");
  const support::TemporaryDirectory folder;
  static_cast<void>(folder.write("small.toml", support::small_scenario));
  ASSERT_EQ(support::asdic(folder,
                           "ping small.toml -o small.h5 -q --set pings.count=1 "
                           "--set reverberation.enabled=false")
                .status,
            0);
  const PingFile file(folder / "small.h5");
  const ExportChoice choice{
      .file = folder / "small.h5", .folder = folder.path(), .first = 0, .end = 1};
  exports[1].check(file, choice);
  exports[1].write(file, choice);
  std::ifstream in(folder / "peaks_1.txt");
  for (std::size_t channel = 0; channel < file.channels(); ++channel) {
    float peak = 0.0F;
    ASSERT_TRUE(in >> peak) << channel;
    EXPECT_GT(peak, 0.0F);
  }
}

}  // namespace
}  // namespace asdic::detail::app
