#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>

#include "core/error.h"
#include "core/units.h"
#include "io/scenario/scenario_reader.h"
#include "raytrace/ocean/seawater.h"
#include "study/measures/sampler.h"
#include "study/reader/study_reader.h"
#include "support/kolmogorov.h"
#include "support/netcdf_writer.h"
#include "support/plain_sea.h"
#include "support/temporary_directory.h"

// Inputs out of files: joint tables, time series, tracks, a month of a climatology.

namespace asdic::detail::study {
namespace {

class MeasuredInputs : public testing::Test {
 protected:
  Study study_of(const std::string& vary, std::uint64_t n = 4000) {
    const std::string tables = "[study]\nrealisations = " + std::to_string(n) + "\n[vary]\n" +
                               vary + "[measure]\npaths = true\n";
    return read_study(folder.write("study.toml", tables + support::plain_sea));
  }
  std::string fault_of(const std::string& vary) {
    try {
      static_cast<void>(study_of(vary));
    } catch (const InputError& error) {
      std::string text = error.what();
      const std::string path = folder.path().string() + "/";
      for (auto at = text.find(path); at != std::string::npos; at = text.find(path))
        text.erase(at, path.size());
      return text;
    }
    return "no fault";
  }
  std::map<std::string, std::vector<double>> drawn(const Study& study) {
    const Sampler sampler(study);
    std::map<std::string, std::vector<double>> columns;
    for (std::uint64_t i = 0; i < study.realisations; ++i) {
      const Sampler::Drawn row = sampler.draw(i);
      for (std::size_t c = 0; c < row.values.size(); ++c)
        columns[sampler.columns()[c].name].push_back(row.values[c]);
    }
    return columns;
  }

  support::TemporaryDirectory folder;
};

/// Kolmogorov–Smirnov: below 2.69 but for one case in 10⁶.
template <class Law>
double distance(const std::vector<double>& x, Law&& law) {
  return support::kolmogorov_distance(x, law) * std::sqrt(double(x.size()));
}

const std::string joint =
    "sea = { law = \"table\", keys = [\"environment.wind_speed\", \"noise.spectral_level_db\"], "
    "columns = [\"wind\", \"Level\", \"hs\"], ";

TEST_F(MeasuredInputs, RowsOfATableAreDrawnWholeByTheirWeights) {
  static_cast<void>(
      folder.write("sea.csv", "wind,level,hs,w\n2,40,0.1,1\n8,50,1.5,3\n15,60,4,0\n3,41,0.2,4\n"));
  for (const bool weighted : {false, true}) {
    const Study study =
        study_of(joint + "file = \"sea.csv\"" + (weighted ? ", weight = \"w\"" : "") + " }\n");
    const auto x = drawn(study);
    const std::map<double, std::pair<double, double>> rows{
        {2.0, {40.0, 0.1}}, {8.0, {50.0, 1.5}}, {15.0, {60.0, 4.0}}, {3.0, {41.0, 0.2}}};
    std::map<double, double> counts;
    for (std::size_t i = 0; i < x.at("sea_wind_speed").size(); ++i) {
      const double wind = x.at("sea_wind_speed")[i];
      EXPECT_EQ(x.at("sea_spectral_level_db")[i], rows.at(wind).first);
      EXPECT_EQ(x.at("sea_hs")[i], rows.at(wind).second);
      ++counts[wind];
    }
    const std::map<double, double> shares =
        weighted ? std::map<double, double>{{2.0, 0.125}, {8.0, 0.375}, {15.0, 0.0}, {3.0, 0.5}}
                 : std::map<double, double>{{2.0, 0.25}, {8.0, 0.25}, {15.0, 0.25}, {3.0, 0.25}};
    for (const auto& [wind, p] : shares)  // binomial, 4.9 standard deviations
      EXPECT_NEAR(counts[wind], 4000.0 * p, 4.9 * std::sqrt(4000.0 * p * (1.0 - p))) << wind;
    // What is written is the row, at both keys.
    TomlValue tree = study.scenario;
    const Sampler sampler(study);
    sampler.apply(sampler.draw(0), tree);
    EXPECT_EQ(*number_of(*find_at(tree, "environment.wind_speed")), x.at("sea_wind_speed")[0]);
    EXPECT_EQ(*number_of(*find_at(tree, "noise.spectral_level_db")),
              x.at("sea_spectral_level_db")[0]);
  }
}

TEST_F(MeasuredInputs, NetcdfAndCsvAreTheSameTable) {
  static_cast<void>(folder.write("sea.csv", "wind,level,hs\n2,40,0.1\n8,50,1.5\n3,41,0.2\n"));
  {
    support::NetcdfWriter file(folder / "sea.nc");
    file.dimension("row", 3);
    file.variable("wind", NC_SHORT, {"row"}, {20.0, 80.0, 30.0}, {}, {{"scale_factor", 0.1}});
    file.variable("Level", NC_DOUBLE, {"row"}, {40.0, 50.0, 41.0});
    file.variable("hs", NC_DOUBLE, {"row"}, {0.1, 1.5, 0.2});
  }
  const auto csv = drawn(study_of(joint + "file = \"sea.csv\" }\n", 100)),
             netcdf = drawn(study_of(joint + "file = \"sea.nc\" }\n", 100));
  for (std::size_t i = 0; i < 100; ++i)
    EXPECT_NEAR(csv.at("sea_wind_speed")[i], netcdf.at("sea_wind_speed")[i], 1e-12);
  EXPECT_EQ(csv.at("sea_hs"), netcdf.at("sea_hs"));
}

/// 5 + 3 sin(2πt/8760 h), and a bearing that turns through north twice a day.
std::string year() {
  std::string text = "time,wind,from\n";
  for (int hour = 0; hour <= 8760; ++hour)
    text += std::to_string(hour) + "," +
            std::to_string(5.0 + 3.0 * std::sin(2.0 * pi * hour / 8760.0)) + "," +
            std::to_string((30 * hour + 15) % 360) + "\n";
  return text;
}

// The wind of a random hour has the arcsine law, F(x) = ½ + asin((x − 5)/3)/π; the bearing is even.
TEST_F(MeasuredInputs, AYearOfWindAtARandomTime) {
  static_cast<void>(folder.write("year.csv", year()));
  const auto x = drawn(
      study_of("year = { law = \"time_series\", file = \"year.csv\", time_unit = \"h\", keys = "
               "[\"environment.wind_speed\", \"target.0.bearing_deg\"], columns = [\"wind\", "
               "\"from\"] }\n"));
  const auto& time = x.at("year_time");
  EXPECT_LT(distance(time, [](double t) { return t / 8760.0; }), 2.69);
  const auto arcsine = [](double v) {
    return 0.5 + std::asin(std::clamp((v - 5.0) / 3.0, -1.0, 1.0)) / pi;
  };
  EXPECT_LT(distance(x.at("year_wind_speed"), arcsine), 2.69);
  EXPECT_GT(distance(x.at("year_wind_speed"), [](double v) { return (v - 2.0) / 6.0; }), 2.69);
  EXPECT_LT(distance(x.at("year_bearing_deg"), [](double v) { return v / 360.0; }), 2.69);
  for (std::size_t i = 0; i < time.size(); ++i) {
    // A chord is below its arc by h²·max|x″|/8 = 3(2π/8760)²/8 at most, and six digits are written.
    EXPECT_NEAR(x.at("year_wind_speed")[i], 5.0 + 3.0 * std::sin(2.0 * pi * time[i] / 8760.0),
                1e-6 + 3.0 * std::pow(2.0 * pi / 8760.0, 2) / 8.0);
    const double bearing = x.at("year_bearing_deg")[i];
    EXPECT_TRUE(bearing >= 0.0 && bearing < 360.0);
    EXPECT_NEAR(std::remainder(bearing - 30.0 * time[i] - 15.0, 360.0), 0.0, 1e-8);
  }
}

TEST_F(MeasuredInputs, ByRowEachHoldsUntilTheNext) {
  // The last one for 2, the mean.
  static_cast<void>(folder.write("steps.csv", "time,wind\n0,1\n1,2\n3,3\n6,4\n"));
  const auto x =
      drawn(study_of("\"environment.wind_speed\" = { law = \"time_series\", file = "
                     "\"steps.csv\", columns = [\"wind\"], interpolation = \"row\" }\n"));
  std::map<double, double> counts;
  for (const double v : x.at("wind_speed")) ++counts[v];
  ASSERT_EQ(counts.size(), 4U);
  for (const auto& [wind, p] : std::map<double, double>{
           {1.0, 1.0 / 8.0}, {2.0, 2.0 / 8.0}, {3.0, 3.0 / 8.0}, {4.0, 2.0 / 8.0}})
    EXPECT_NEAR(counts[wind], 4000.0 * p, 4.9 * std::sqrt(4000.0 * p * (1.0 - p))) << wind;
  const auto some =
      drawn(study_of("\"environment.wind_speed\" = { law = \"time_series\", file = "
                     "\"steps.csv\", columns = [\"wind\"], interpolation = \"row\", "
                     "from = 1.0, until = 3.0 }\n"));
  EXPECT_EQ(some.at("wind_speed"), std::vector<double>(4000, 2.0));
}

// A circle of 1 km in ten minutes, in steps of 15 s: its chords have the speed 2R·sin(ωΔ/2)/Δ, and
// their courses are square to the radius in their middle.
TEST_F(MeasuredInputs, ATrackHasItsPlaceAndVelocity) {
  std::string text = "time,x,y,z\n";
  for (int i = 0; i <= 40; ++i) {
    const double a = 2.0 * pi * i / 40.0;
    text += std::to_string(i / 4.0) + "," + std::to_string(3000.0 + 1000.0 * std::sin(a)) + "," +
            std::to_string(1000.0 * std::cos(a)) + "," + std::to_string(100.0 + i) + "\n";
  }
  static_cast<void>(folder.write("track.csv", text));
  const Study study = study_of(
      "\"target.0\" = { law = \"time_series\", file = \"track.csv\", time_unit = \"min\", "
      "track = [\"x\", \"y\", \"z\"] }\n",
      200);
  const Sampler sampler(study);
  const double chord = 2.0 * 1000.0 * std::sin(pi / 40.0) / 15.0;
  for (std::uint64_t i = 0; i < study.realisations; ++i) {
    const Sampler::Drawn row = sampler.draw(i);
    const double time = row.values[0], east = row.values[1] - 3000.0, north = row.values[2];
    EXPECT_NEAR(std::hypot(east, north), 1000.0, 1000.0 * (1.0 - std::cos(pi / 40.0)) + 1e-3);
    EXPECT_NEAR(row.values[3], 100.0 + 4.0 * time, 1e-9);
    EXPECT_NEAR(row.values[4], chord, 1e-5);
    const double middle = std::floor(4.0 * time) * 9.0 + 4.5;  // degrees of the chord's middle
    EXPECT_NEAR(std::remainder(row.values[5] - (middle + 90.0), 360.0), 0.0, 1e-4);
    TomlValue tree = study.scenario;
    sampler.apply(row, tree);
    const auto velocity = std::get<TomlValue::Array>(find_at(tree, "target.0.velocity")->data);
    EXPECT_NEAR(*number_of(velocity[0]), chord * std::sin(radians(row.values[5])), 1e-6);
    EXPECT_NEAR(*number_of(velocity[2]), 1.0 / 15.0, 1e-9);
    EXPECT_EQ(*number_of(std::get<TomlValue::Array>(find_at(tree, "target.0.position")->data)[0]),
              row.values[1]);
  }
}

/// Twelve months of water at one place: 8 °C + the month above 100 m, 4 °C below.
void write_climatology(const std::filesystem::path& path, bool seasons) {
  support::NetcdfWriter file(path);
  std::vector<double> time, temperature, salinity;
  for (int month = 0; month < 12; ++month) {
    time.push_back(15.0 + 30.4 * month);
    for (int level = 0; level < 3; ++level)
      for (int cell = 0; cell < 4; ++cell) {
        temperature.push_back(level == 2 ? 4.0 : 8.0 + (seasons ? month + 1 : 0));
        salinity.push_back(35.0);
      }
  }
  file.axis("time", time, {{"units", "days since 0001-01-01 00:00:00"}, {"climatology", "b"}});
  file.axis("depth", {0.0, 100.0, 1000.0}, {{"units", "m"}, {"positive", "down"}});
  file.axis("lat", {10.0, 11.0}, {{"units", "degrees_north"}});
  file.axis("lon", {20.0, 21.0}, {{"units", "degrees_east"}});
  file.variable("t_an", NC_DOUBLE, {"time", "depth", "lat", "lon"}, temperature,
                {{"units", "degrees_celsius"}, {"standard_name", "sea_water_temperature"}});
  file.variable("s_an", NC_DOUBLE, {"time", "depth", "lat", "lon"}, salinity,
                {{"units", "1"}, {"standard_name", "sea_water_practical_salinity"}});
}

const std::string months =
    "profile = { law = \"climatology\", latitude_deg = 10.2, longitude_deg = 20.1, temperature = "
    "\"months.nc\"";

TEST_F(MeasuredInputs, AMonthOfAClimatology) {
  write_climatology(folder / "months.nc", true);
  const Study study =
      study_of(months +
               ", months = [1, 8], weights = [1, 3] }\n"
               "\"environment.wind_speed\" = { given = \"profile\", laws = { january = { law = "
               "\"uniform\", low = 10, high = 12 }, august = { law = \"uniform\", low = 2, high = "
               "4 } } }\n");
  const Sampler sampler(study);
  EXPECT_EQ(sampler.columns()[0].labels, (std::vector<std::string>{"january", "august"}));
  double january = 0.0;
  for (std::uint64_t i = 0; i < study.realisations; ++i)
    january += sampler.draw(i).values[0] == 0.0;
  EXPECT_NEAR(january, 1000.0, 4.9 * std::sqrt(4000.0 * 0.25 * 0.75));
  for (std::uint64_t i = 0; i < 20; ++i) {
    const Sampler::Drawn row = sampler.draw(i);
    TomlValue tree = study.scenario;
    sampler.apply(row, tree);
    const Scenario scenario = scenario_of(tree, study.scenario_path);
    const bool winter = row.values[0] == 0.0;
    EXPECT_EQ(row.values[1] >= 10.0, winter);
    EXPECT_NEAR(scenario.environment.water.at(0.0).c,
                sound_speed(SeawaterEquation::chen_millero, winter ? 9.0 : 16.0, 35.0, 0.0, 10.2),
                1e-9);
  }
}

/// Twelve months of wind: 5 m/s and the month.
void write_wind(const std::filesystem::path& path) {
  support::NetcdfWriter file(path);
  std::vector<double> time, wind;
  for (int month = 0; month < 12; ++month) {
    time.push_back(15.0 + 30.4 * month);
    for (int cell = 0; cell < 4; ++cell) wind.push_back(5.0 + month + 1.0);
  }
  file.axis("time", time, {{"units", "days since 0001-01-01 00:00:00"}, {"climatology", "b"}});
  file.axis("lat", {10.0, 11.0}, {{"units", "degrees_north"}});
  file.axis("lon", {20.0, 21.0}, {{"units", "degrees_east"}});
  file.variable("w", NC_DOUBLE, {"time", "lat", "lon"}, wind,
                {{"units", "m/s"}, {"standard_name", "wind_speed"}});
}

TEST_F(MeasuredInputs, TheWindOfAMonthIsDrawnWithItsWater) {
  write_climatology(folder / "months.nc", true);
  write_wind(folder / "wind.nc");
  const std::string both = months + ", wind = \"wind.nc\", months = [1, 8, 11] }\n";
  const Study study = study_of(both);
  const Sampler sampler(study);
  ASSERT_EQ(sampler.columns().size(), 2U);
  EXPECT_EQ(sampler.columns()[0].name, "profile");
  EXPECT_EQ(sampler.columns()[1].name, "profile_wind_speed");
  EXPECT_EQ(sampler.columns()[1].unit, "m/s");
  std::set<double> seen;
  for (std::uint64_t i = 0; i < 40; ++i) {
    const Sampler::Drawn row = sampler.draw(i);
    TomlValue tree = study.scenario;
    sampler.apply(row, tree);
    const Scenario scenario = scenario_of(tree, study.scenario_path);
    const double month = std::vector<double>{1.0, 8.0, 11.0}[std::size_t(row.values[0])];
    EXPECT_EQ(row.values[1], 5.0 + month);
    EXPECT_EQ(scenario.wind_speed, 5.0 + month);
    EXPECT_NEAR(scenario.environment.water.at(0.0).c,
                sound_speed(SeawaterEquation::chen_millero, 8.0 + month, 35.0, 0.0, 10.2), 1e-9);
    seen.insert(month);
  }
  EXPECT_EQ(seen.size(), 3U);
  // Beside an entry of the wind's own it is a column to look at: its law has the month's mean.
  const Study own = study_of(both +
                             "\"environment.wind_speed\" = { law = \"rayleigh\", mean = "
                             "\"profile_wind_speed\" }\n");
  const auto x = drawn(own);
  std::vector<double> share;  // 1 − exp(−π/4·(x/mean)²) is uniform, of the month's mean alone
  for (std::size_t i = 0; i < x.at("wind_speed").size(); ++i) {
    const double ratio = x.at("wind_speed")[i] / x.at("profile_wind_speed")[i];
    share.push_back(1.0 - std::exp(-0.25 * M_PI * ratio * ratio));
  }
  EXPECT_LT(distance(share, [](double u) { return u; }), 2.69);
  EXPECT_NE(identity(study), identity(study_of(months + ", months = [1, 8, 11] }\n")));
}

TEST_F(MeasuredInputs, TimesMayBeDates) {
  static_cast<void>(folder.write(
      "wind.csv", "time,wind_speed\n2024-02-28,2\n2024-02-29T12:00,5\n2024-03-01T00:00Z,6\n"));
  const std::string series =
      "wind = { law = \"time_series\", file = \"wind.csv\", keys = "
      "[\"environment.wind_speed\"]";
  const Study study = study_of(series + " }\n");
  EXPECT_EQ(Sampler(study).columns()[0].unit, "days since 1970-01-01");
  const auto x = drawn(study);
  const std::vector<double>& time = x.at("wind_time");
  constexpr double first = 19781.0;  // 2024-02-28
  EXPECT_LT(distance(time, [](double t) { return (t - first) / 2.0; }), 2.69);
  for (std::size_t i = 0; i < time.size(); ++i) {  // 2 m/s and 2 a day, in both pieces
    EXPECT_NEAR(x.at("wind")[i], 2.0 + 2.0 * (time[i] - first), 1e-9);
  }
  const auto later =
      drawn(study_of(series + ", from = \"2024-02-29\", until = \"2024-02-29T06:00\" }\n"));
  for (const double t : later.at("wind_time")) EXPECT_TRUE(t >= first + 1.0 && t <= first + 1.25);
  EXPECT_NE(fault_of(series + ", from = \"2025-01-01\" }\n")
                .find("expected a date from 2024-02-28 to "
                      "2024-03-01"),
            std::string::npos)
      << fault_of(series + ", from = \"2025-01-01\" }\n");
  static_cast<void>(folder.write("wind.csv", "time,wind_speed\n2024-02-28,2\n2024-02-30,5\n"));
  EXPECT_NE(
      fault_of(series + " }\n").find("wind.csv:3: time: found \"2024-02-30\", expected a date"),
      std::string::npos)
      << fault_of(series + " }\n");
}

TEST_F(MeasuredInputs, TextsOfATableAreLabels) {
  static_cast<void>(folder.write("sea.csv",
                                 "window,wind,regime\nhann,2,calm\nnone,9,storm\n"
                                 "hann,3,calm\nhann,11,storm\n"));
  const std::string table =
      "sea = { law = \"table\", file = \"sea.csv\", columns = [\"window\", "
      "\"wind\", \"regime\"], keys = [\"pulse.window\", "
      "\"environment.wind_speed\"] }\n";
  const Study study = study_of(table +
                               "\"target.0.depth\" = { given = \"sea_regime\", laws.calm = { law = "
                               "\"uniform\", low = 10, high = 20 }, laws.storm = { law = "
                               "\"uniform\", low = 50, high = 60 } }\n");
  const Sampler sampler(study);
  EXPECT_EQ(sampler.columns()[0].labels, (std::vector<std::string>{"hann", "none"}));
  EXPECT_EQ(sampler.columns()[2].name, "sea_regime");
  EXPECT_EQ(sampler.columns()[2].labels, (std::vector<std::string>{"calm", "storm"}));
  for (std::uint64_t i = 0; i < 60; ++i) {
    const Sampler::Drawn row = sampler.draw(i);
    const bool storm = row.values[1] > 5.0;
    EXPECT_EQ(row.values[2] == 1.0, storm);
    EXPECT_EQ(row.values[3] > 40.0, storm);
    EXPECT_EQ(row.values[0] == 1.0, row.values[1] == 9.0);
    TomlValue tree = study.scenario;
    sampler.apply(row, tree);
    EXPECT_EQ(std::get<std::string>(tree.find("pulse")->find("window")->data),
              row.values[1] == 9.0 ? "none" : "hann");
  }
  static_cast<void>(folder.write("sea.csv", "window,wind,regime\nhann,2,calm\nhann,x,storm\n"));
  EXPECT_NE(
      fault_of(table).find("sea.csv:3: wind: found \"x\", expected a number, as in other rows"),
      std::string::npos)
      << fault_of(table);
}

TEST_F(MeasuredInputs, FilesAreOfTheStudysIdentity) {
  const std::string wind = "\"environment.wind_speed\" = { law = \"table\", file = \"a.csv\" }\n";
  static_cast<void>(folder.write("a.csv", "wind_speed\n1\n2\n"));
  const std::string one = identity(study_of(wind));
  static_cast<void>(folder.write("a.csv", "wind_speed\n1\n3\n"));
  EXPECT_NE(identity(study_of(wind)), one);
  write_climatology(folder / "months.nc", true);
  const std::string first = identity(study_of(months + ", months = [1] }\n"));
  write_climatology(folder / "months.nc", false);
  EXPECT_NE(identity(study_of(months + ", months = [1] }\n")), first);
}

TEST_F(MeasuredInputs, FaultsAreTold) {
  static_cast<void>(folder.write("a.csv", "time,wind_speed,w\n0,1,1\n2,2,-1\n1,3,0\n"));
  write_climatology(folder / "months.nc", false);
  const std::string wind = "\"environment.wind_speed\" = { file = ", at = "study.toml:4: vary.";
  const std::vector<std::pair<std::string, std::string>> faults{
      {wind + "\"b.csv\", law = \"table\" }\n", at +
                                                    "\"environment.wind_speed\".file: found no "
                                                    "such file \"b.csv\", expected a CSV or netCDF "
                                                    "file"},
      {wind + "\"a.csv\", law = \"table\", columns = [\"speed\"] }\n",
       "a.csv: found the columns \"time,wind_speed,w\", expected a column \"speed\""},
      {wind + "\"a.csv\", law = \"table\", weight = \"w\" }\n",
       at + "\"environment.wind_speed\".weight: found -1 in a.csv:3, expected weights of at least "
            "0"},
      {wind + "\"a.csv\", law = \"time_series\" }\n",
       at + "\"environment.wind_speed\".file: found 1 after 2 in a.csv:4, expected times that rise "
            "from row to row"},
      {wind + "\"a.csv\", law = \"table\", keys = [] }\n",
       at + "\"environment.wind_speed\".columns: found nothing, expected an array of names of "
            "columns, each in quotes"},
      {"\"target.0\" = { law = \"time_series\", file = \"a.csv\", track = [\"w\"] }\n",
       at + "\"target.0\".track: found an array of 1, expected three names of columns: east, north "
            "and depth [m]"},
      {months + " }\n",
       at + "profile.temperature: found the same water in every month, expected files that tell "
            "months apart"},
      {months + ", months = [13] }\n",
       at + "profile.months[0]: found 13, expected a month from 1 to 12"}};
  for (const auto& [vary, message] : faults) EXPECT_EQ(fault_of(vary), message) << vary;
}

}  // namespace
}  // namespace asdic::detail::study
