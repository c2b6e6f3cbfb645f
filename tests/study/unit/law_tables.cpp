#include "study/summary/law_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "io/hdf5/hdf5_file.h"
#include "study/reader/study_reader.h"
#include "study/runs/run_study.h"
#include "support/plain_sea.h"
#include "support/temporary_directory.h"

namespace asdic::detail::study {
namespace {

Study study_of(const support::TemporaryDirectory& folder, const std::string& vary,
               const std::string& design = "random") {
  return read_study(folder.write(
      "study.toml", "[study]\nrealisations = 4\ndesign = \"" + design + "\"\n[vary]\n" + vary +
                        "[measure]\npaths = true\n" + support::plain_sea));
}

LawTable table_of(const std::vector<LawTable>& all, const std::string& column,
                  const std::string& given = "") {
  for (const LawTable& table : all)
    if (table.column == column && table.given == given) return table;
  ADD_FAILURE() << column << ' ' << given;
  return {};
}

/// ∫ of a table by trapezoids.
double integral(const LawTable& table) {
  double sum = 0.0;
  for (std::size_t i = 1; i < table.value.size(); ++i)
    sum += 0.5 * (table.share[i] + table.share[i - 1]) * (table.value[i] - table.value[i - 1]);
  return sum;
}

// A density is the slope of its distribution, by differences.
TEST(LawTables, DensitiesAreTheSlopeOfTheirLaw) {
  for (const ContinuousLaw& law : std::vector<ContinuousLaw>{
           Uniform{-3.0, 8.0}, Normal{10.0, 3.0}, LogNormal{5.0, 0.7}, Triangular{-1.0, 0.5, 4.0},
           Triangular{0.0, 0.0, 1.0}, Weibull::rayleigh(7.0), Weibull{1.7, 9.0}})
    for (const CutLaw& cut :
         {CutLaw(law), CutLaw(law, CutLaw(law).quantile(0.2), CutLaw(law).quantile(0.9))})
      for (const double u : {0.03, 0.3, 0.52, 0.97}) {
        const double x = cut.quantile(u), h = 1e-5 * (1.0 + std::abs(x));
        const double slope = (cut.distribution(x + h) - cut.distribution(x - h)) / (2.0 * h);
        EXPECT_NEAR(cut.density(x), slope, 1e-4 * slope) << law.index() << ' ' << u;
      }
  EXPECT_EQ(CutLaw(Normal{}, -1.0, 1.0).density(1.5), 0.0);
}

TEST(LawTables, IntegrateToOne) {
  const support::TemporaryDirectory folder;
  static_cast<void>(folder.write("t.csv", "depth\n10\n20\n20\n40\n"));
  const std::vector<LawTable> all = law_tables(
      study_of(folder,
               "\"environment.wind_speed\" = { law = \"rayleigh\", mean = 7.0, max = 15.0 }\n"
               "\"target.0.strength_db\" = { law = \"normal\", mean = 10.0, deviation = 2.0 }\n"
               "\"target.0\" = { law = \"track\", radius = 3000.0, depth = 50.0 }\n"
               "\"array.phones\" = { law = \"categorical\", values = [2, 4], weights = [1, 3] }\n"
               "deep = { law = \"table\", file = \"t.csv\", columns = [\"depth\"], keys = [] }\n"));
  EXPECT_EQ(all.size(), 7U);
  for (const LawTable& table : all) {
    if (table.discrete) continue;
    EXPECT_NEAR(integral(table), 1.0, 2e-4) << table.column;
    EXPECT_TRUE(std::is_sorted(table.value.begin(), table.value.end()));
    EXPECT_NEAR(table.cumulative.back(), 1.0, 2e-5);
  }
  const LawTable wind = table_of(all, "wind_speed");
  EXPECT_EQ(wind.value.front(), 0.0);
  EXPECT_EQ(wind.value.back(), 15.0);
  EXPECT_EQ(wind.law, "{\"law\" = \"rayleigh\", \"max\" = 15, \"mean\" = 7}");
  const LawTable range = table_of(all, "target_0_range");  // 2r/R²
  EXPECT_NEAR(range.share.back(), 2.0 / 3000.0, 1e-9);
  const LawTable phones = table_of(all, "phones");
  EXPECT_TRUE(phones.discrete);
  EXPECT_EQ(phones.share, (std::vector<double>{0.25, 0.75}));
  const LawTable deep = table_of(all, "deep");
  EXPECT_EQ(deep.value, (std::vector<double>{10.0, 20.0, 40.0}));
  EXPECT_EQ(deep.share, (std::vector<double>{0.25, 0.5, 0.25}));
  EXPECT_EQ(table_of(all, "target_0_depth").value, std::vector<double>{50.0});
}

// Of a law for each case the mixture, by draws: 50000 of them leave √(p(1 − p)/50000) of a share.
TEST(LawTables, CasesAndTheirMixture) {
  const support::TemporaryDirectory folder;
  const std::vector<LawTable> all = law_tables(study_of(
      folder,
      "season = { law = \"categorical\", values = [\"winter\", \"summer\"], weights = [1, 3], keys "
      "= [] }\n\"environment.wind_speed\" = { given = \"season\", laws = { winter = { law = "
      "\"uniform\", low = 10, high = 20 }, summer = { law = \"uniform\", low = 0, high = 10 } } }\n"
      "twice = { law = \"expression\", value = \"2 * wind_speed\", keys = [] }\n"));
  const LawTable mixture = table_of(all, "wind_speed");
  EXPECT_EQ(mixture.how, "50000 draws of another seed");
  ASSERT_EQ(mixture.value.size(), 100U);
  for (std::size_t i = 0; i < mixture.value.size(); ++i) {
    if (std::abs(mixture.value[i] - 10.0) < 0.2) continue;
    const double p = (mixture.value[i] < 10.0 ? 0.75 : 0.25) * 0.02;  // of a bin of 0.2
    EXPECT_NEAR(mixture.share[i] * 0.2, p, 4.9 * std::sqrt(p * (1.0 - p) / 50000.0) + 1e-5);
  }
  EXPECT_NEAR(table_of(all, "wind_speed", "season: winter").share[5], 0.1, 1e-12);
  EXPECT_EQ(table_of(all, "wind_speed", "season: summer").value.back(), 10.0);
  const LawTable twice = table_of(all, "twice");
  EXPECT_NEAR(twice.value.back(), 39.8, 0.05);
  // On a grid choices come equally often.
  const std::vector<LawTable> grid = law_tables(study_of(
      folder, "\"array.phones\" = { law = \"categorical\", values = [2, 4], weights = [1, 3] }\n",
      "grid"));
  EXPECT_EQ(grid[0].share, (std::vector<double>{0.5, 0.5}));
}

// An outsider weighs rows of one law for another, with nothing but the file.
TEST(LawTables, StandInTheFile) {
  const support::TemporaryDirectory folder;
  const Study study =
      study_of(folder,
               "\"environment.wind_speed\" = { law = \"rayleigh\", mean = 7.0, max = 15.0 }\n"
               "names = { keys = [\"environment.bottom.kind\"], law = \"categorical\", values = "
               "[\"rigid\", \"vacuum\"] }\n");
  const Realiser realiser(study);
  const Work work = work_of(study, [&](std::uint64_t index) { return realiser.realise(index); });
  run_study(work, {.output = folder / "s.h5", .range = {0, 4}});
  const Hdf5File file = Hdf5File::open(folder / "s.h5");
  const auto value = file.read<double>("laws/wind_speed/value"),
             density = file.read<double>("laws/wind_speed/density"),
             cumulative = file.read<double>("laws/wind_speed/cumulative");
  const double shares = 1.0 - std::exp(-pi / 4.0 * 15.0 * 15.0 / 49.0);
  for (std::size_t i = 0; i < value.size(); ++i) {
    const double x = value[i], s2 = 196.0 / pi;  // 2σ² of Rayleigh's law of mean 7
    EXPECT_NEAR(density[i], 2.0 * x / s2 * std::exp(-x * x / s2) / shares, 1e-12);
    EXPECT_NEAR(cumulative[i], (1.0 - std::exp(-x * x / s2)) / shares, 1e-12);
  }
  EXPECT_EQ(file.read<double>("laws/names/probability"), (std::vector<double>{0.5, 0.5}));
  EXPECT_EQ(file.attribute_texts("laws/names/value", "labels"),
            (std::vector<std::string>{"rigid", "vacuum"}));
}

}  // namespace
}  // namespace asdic::detail::study
