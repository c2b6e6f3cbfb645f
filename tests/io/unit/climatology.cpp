#include "io/climatology/climatology.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netcdf.h>

#include <cmath>

#include "core/error.h"
#include "io/climatology/data_grid.h"
#include "io/scenario/propagation.h"
#include "io/text/csv_table.h"
#include "support/temporary_directory.h"

namespace asdic::detail {
namespace {

using support::TemporaryDirectory;
using testing::HasSubstr;

/// A small netCDF file by the conventions, to see each of them read: longitudes −180..180 in steps
/// of 60, latitudes from north to south, depth positive up, packed shorts, two months' worth of 12.
std::filesystem::path write_grid(const TemporaryDirectory& folder) {
  const auto path = folder / "grid.nc";
  int file = 0, x = 0, y = 0, z = 0, t = 0, id[4] = {}, temperature = 0, height = 0;
  const auto ok = [](int status) {
    if (status != NC_NOERR) throw std::runtime_error(nc_strerror(status));
  };
  const auto text = [&](int variable, const char* key, const std::string& value) {
    ok(nc_put_att_text(file, variable, key, value.size(), value.c_str()));
  };
  ok(nc_create(path.c_str(), NC_CLOBBER, &file));
  ok(nc_def_dim(file, "a", 6, &x));
  ok(nc_def_dim(file, "b", 3, &y));
  ok(nc_def_dim(file, "c", 2, &z));
  ok(nc_def_dim(file, "d", 12, &t));
  ok(nc_def_var(file, "a", NC_DOUBLE, 1, &x, &id[0]));
  ok(nc_def_var(file, "b", NC_FLOAT, 1, &y, &id[1]));
  ok(nc_def_var(file, "c", NC_FLOAT, 1, &z, &id[2]));
  ok(nc_def_var(file, "d", NC_INT, 1, &t, &id[3]));
  text(id[0], "standard_name", "longitude");
  text(id[1], "units", "degrees_north");
  text(id[2], "positive", "up");
  text(id[3], "units", "days since 2000-01-01");
  const int all[] = {t, z, y, x}, plane[] = {y, x};
  ok(nc_def_var(file, "packed", NC_SHORT, 4, all, &temperature));
  text(temperature, "standard_name", "sea_water_temperature");
  const double scale = 0.01, offset = 10.0;
  const short fill = -999;
  ok(nc_put_att_double(file, temperature, "scale_factor", NC_DOUBLE, 1, &scale));
  ok(nc_put_att_double(file, temperature, "add_offset", NC_DOUBLE, 1, &offset));
  ok(nc_put_att_short(file, temperature, "_FillValue", NC_SHORT, 1, &fill));
  ok(nc_def_var(file, "elevation", NC_FLOAT, 2, plane, &height));
  ok(nc_enddef(file));
  const double longitude[] = {-180, -120, -60, 0, 60, 120};
  const float latitude[] = {60, 0, -60}, depth[] = {-500, -100};
  const int time[] = {15, 45, 75, 105, 135, 165, 195, 225, 255, 285, 315, 345};
  ok(nc_put_var_double(file, id[0], longitude));
  ok(nc_put_var_float(file, id[1], latitude));
  ok(nc_put_var_float(file, id[2], depth));
  ok(nc_put_var_int(file, id[3], time));
  std::vector<short> values;  // 10 °C + (1000·month + 100·level + 10·row + column)/100
  std::vector<float> heights;
  for (int m = 0; m < 12; ++m)
    for (int level = 0; level < 2; ++level)
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 6; ++i)
          values.push_back(
              i == 3 && j == 1 ? fill : static_cast<short>(1000 * m + 100 * level + 10 * j + i));
  for (int i = 0; i < 18; ++i) heights.push_back(i == 9 ? 20.0F : -4000.0F - static_cast<float>(i));
  ok(nc_put_var_short(file, temperature, values.data()));
  ok(nc_put_var_float(file, height, heights.data()));
  ok(nc_close(file));
  return path;
}

TEST(DataGrid, ReadsByTheConventions) {
  const TemporaryDirectory folder;
  const auto grid = DataGrid::find(write_grid(folder), {"nothing", "sea_water_temperature"});
  ASSERT_TRUE(grid.has_value());
  EXPECT_EQ(grid->variable(), "packed");
  EXPECT_EQ(grid->times(), 12U);
  EXPECT_EQ(grid->depths(), (std::vector<double>{100.0, 500.0}));      // up became down, and sorted
  EXPECT_NEAR(grid->nearest(-120.0, 60.0, 0, 0), 10.0 + 1.01, 1e-12);  // stored level 1
  EXPECT_NEAR(grid->nearest(-120.0, 60.0, 1, 2), 10.0 + 20.01, 1e-12);
  EXPECT_NEAR(grid->nearest(240.0, 60.0, 0, 0), 10.0 + 1.01, 1e-12);   // the same meridian
  EXPECT_NEAR(grid->nearest(179.0, -60.0, 1, 0), 10.0 + 0.20, 1e-12);  // wraps to −180
  EXPECT_TRUE(std::isnan(grid->nearest(0.0, 0.0)));
  EXPECT_FALSE(DataGrid::find(folder / "grid.nc", {"salinity"}).has_value());
}

TEST(DataGrid, BilinearLeavesMissingNeighboursOut) {
  const TemporaryDirectory folder;
  const auto grid = DataGrid::find(write_grid(folder), {"packed"});
  ASSERT_TRUE(grid.has_value());
  EXPECT_NEAR(grid->bilinear(-90.0, 30.0, 1, 0), 10.0 + (0.01 + 0.02 + 0.11 + 0.12) / 4.0, 1e-12);
  EXPECT_NEAR(grid->bilinear(150.0, 60.0, 1, 0), 10.0 + (0.05 + 0.00) / 2.0, 1e-12);  // the seam
  EXPECT_NEAR(grid->bilinear(30.0, 0.0, 1, 0), 10.0 + 0.14, 1e-12);  // its western one is missing
  EXPECT_TRUE(std::isnan(grid->bilinear(0.0, 0.0, 1, 0)));
}

TEST(DataGrid, OtherFilesAreInputErrors) {
  const TemporaryDirectory folder;
  const auto path = folder.write("text.nc", "hello");
  try {
    static_cast<void>(DataGrid::find(path, {"x"}));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("text.nc: found a file that cannot be opened"));
  }
}

TEST(Climatology, MissingFilesSayHowToGetThem) {
  const TemporaryDirectory folder;
  try {
    static_cast<void>(
        sample_ocean(default_ocean_sources(folder.path()), {.latitude = 30.5, .longitude = -60.5}));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("etopo5.cdf: found no such file, expected a netCDF file of "
                                        "bathymetry (install Debian's ferret-datasets: "
                                        "scripts/setup.sh --climatology"));
  }
  const OceanSources sources = default_ocean_sources(folder.path());
  EXPECT_THROW(static_cast<void>(sample_ocean(sources, {.latitude = 91.0})), InputError);
  EXPECT_THROW(static_cast<void>(sample_ocean(sources, {.latitude = std::nan("")})), InputError);
  EXPECT_THROW(static_cast<void>(sample_ocean(sources, {.when = {.month = 13}})), InputError);
  EXPECT_THROW(static_cast<void>(sample_section(sources, {.range = -1.0})), InputError);
}

OceanRequest at(double latitude, double longitude, std::optional<int> month = {}) {
  return {.latitude = latitude, .longitude = longitude, .when = {.month = month}};
}

/// Every 5 km, as the sections of the repository are.
OceanRequest track(double latitude, double longitude, double bearing_deg, double range) {
  return {.latitude = latitude,
          .longitude = longitude,
          .bearing_deg = bearing_deg,
          .range = range,
          .step = 5000.0};
}

class RealOcean : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(sources_.temperature[0].path))
      GTEST_SKIP() << "no ferret-datasets here";
  }
  OceanSources sources_ = default_ocean_sources();
};

// Levitus (1982) annual mean and ETOPO5, values as ncdump prints them at the grid points 30.5 N
// 299.5 E.
TEST_F(RealOcean, SargassoSea) {
  const OceanSample ocean = sample_ocean(sources_, at(30.5, -60.5));
  EXPECT_EQ(ocean.depth.size(), 20U);
  EXPECT_EQ(ocean.depth.back(), 5000.0);
  EXPECT_EQ(ocean.water_depth, 5395.0);
  EXPECT_NEAR(ocean.temperature.front(), 23.392, 5e-4);
  EXPECT_NEAR(ocean.temperature.back(), 2.165, 5e-4);
  EXPECT_NEAR(ocean.salinity.front(), 36.594, 5e-4);
  ASSERT_TRUE(ocean.wind_speed.has_value());
  EXPECT_GT(*ocean.wind_speed, 4.0);
  EXPECT_LT(*ocean.wind_speed, 9.0);
  EXPECT_EQ(sample_ocean(sources_, at(30.5, 299.5)).temperature, ocean.temperature);
  // The winds of January are not those of August; the profile has no months, and says so.
  const OceanSample january = sample_ocean(sources_, at(30.5, -60.5, 1));
  EXPECT_GT(*january.wind_speed, *sample_ocean(sources_, at(30.5, -60.5, 8)).wind_speed + 2.0);
  EXPECT_THAT(january.notes, testing::Contains(HasSubstr("the profile has no time axis")));
  EXPECT_THROW(static_cast<void>(sample_ocean(sources_, at(45.0, 5.0))), InputError);  // the Alps
}

// Westward from 30.5 N 60.5 W the abyssal plain goes on for 100 km; a transect to Africa ends at
// its coast, and crosses a profile a degree.
TEST_F(RealOcean, Sections) {
  const OceanSection west = sample_section(sources_, track(30.5, -60.5, 270.0, 1e5));
  ASSERT_EQ(west.range.size(), 21U);
  EXPECT_NEAR(west.floor.front(), 5395.0, 0.5);  // 60.5 W is a grid point, but for single precision
  EXPECT_EQ(west.range.back(), 1e5);
  for (const double depth : west.floor) EXPECT_GT(depth, 4000.0);
  ASSERT_EQ(west.station.size(), 2U);  // 30.5 N 60.5 W, and from 61 W on its neighbour
  EXPECT_EQ(west.depth.front(), 0.0);
  EXPECT_GE(west.depth.back(), west.floor.front());
  EXPECT_EQ(west.speed.size(), 2 * west.depth.size());
  const OceanSection east = sample_section(sources_, track(30.5, -60.5, 80.0, 8e6));
  EXPECT_LT(east.range.back(), 6e6);
  EXPECT_GT(east.station.size(), 30U);
  EXPECT_THAT(east.notes, testing::Contains(HasSubstr("ends at the coast")));
}

// The section's first profile is that of the place, as a scenario reads its temperature and
// salinity. Straight lines leave it by h²c″/8: at most 25² m²·4.5e-4 (m/s)/m²/8 = 0.035 m/s here,
// at 1 km; and the fragment prints two decimals.
TEST_F(RealOcean, ASectionHoldsTheProfileOfItsStart) {
  const std::string run =
      "[run]\nfrequency = 100\n[run.source]\ndepth = 50\n[run.receivers]\ndepth = 20\n"
      "range = 1000\n";
  const OceanSample here = sample_ocean(sources_, at(30.5, -60.5));
  std::vector<std::string> notes;
  const Environment one =
      parse_propagation_case(write_scenario_fragment(here) + run, "one.toml", {}, notes)
          .environment;
  const Environment section =
      parse_propagation_case(
          write_scenario_fragment(here, sample_section(sources_, track(30.5, -60.5, 270.0, 1e5))) +
              run,
          "track.toml", {}, notes)
          .environment;
  ASSERT_TRUE(section.section.has_value());
  ASSERT_TRUE(section.bottom.shape.has_value());
  EXPECT_TRUE(is_layered(one));
  for (double z = 0.0; z <= 5395.0; z += 1.0)
    EXPECT_NEAR(section.section->at(-1.0, z).c, one.water.at(z).c, 0.04) << z;
}

TEST_F(RealOcean, TheCommittedFragmentsAreWhatTheDataSay) {
  const OceanSample here = sample_ocean(sources_, at(30.5, -60.5));
  EXPECT_EQ(write_scenario_fragment(here), read_text_file(ASDIC_SCENARIOS "/ocean_sargasso.toml"));
  const OceanSample bermuda = sample_ocean(sources_, at(31.5, -65.5));
  EXPECT_EQ(
      write_scenario_fragment(bermuda, sample_section(sources_, track(31.5, -65.5, 45.0, 250e3))),
      read_text_file(ASDIC_SCENARIOS "/ocean_bermuda.toml"));
}

}  // namespace
}  // namespace asdic::detail
