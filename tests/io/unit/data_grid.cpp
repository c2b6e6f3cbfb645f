#include "io/climatology/data_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "core/error.h"
#include "support/netcdf_writer.h"
#include "support/temporary_directory.h"

namespace asdic::detail {
namespace {

using support::NetcdfWriter;
using support::TemporaryDirectory;
using testing::ElementsAre;
using testing::HasSubstr;

using Values = std::vector<double>;

/// (time, x, depth, y): an odd order, every axis falling but time; 1000·t + 100·k + 10·j + i by the
/// indices of axes that rise.
std::filesystem::path write_odd(const TemporaryDirectory& folder) {
  const auto path = folder / "odd.nc";
  NetcdfWriter file(path);
  file.axis("t", {0.0, 6.0}, {{"units", "hours since 2024-02-28 21:00"}});
  file.axis("x", {3.0, 2.0, 1.0, 0.0},
            {{"units", "km"}, {"standard_name", "projection_x_coordinate"}});
  file.axis("level", {30.0, 20.0, 10.0}, {{"units", "m"}, {"positive", "down"}});
  file.axis("y", {500.0, 0.0}, {{"units", "m"}, {"axis", "Y"}});
  Values packed;
  for (int t = 0; t < 2; ++t)
    for (int i = 3; i >= 0; --i)
      for (int k = 2; k >= 0; --k)
        for (int j = 1; j >= 0; --j)
          packed.push_back(i == 2 && j == 1 && k == 0 ? -1 : 1000 * t + 100 * k + 10 * j + i);
  file.variable("speed", NC_SHORT, {"t", "x", "level", "y"}, packed, {{"units", "m/s"}},
                {{"scale_factor", 0.5}, {"add_offset", 1000.0}, {"valid_min", 0.0}});
  return path;
}

TEST(DataGrid, ProjectedAxesInTheOrderOfTheFile) {
  const TemporaryDirectory folder;
  const auto grid = DataGrid::find(write_odd(folder), {"speed"});
  ASSERT_TRUE(grid);
  EXPECT_FALSE(grid->geographic());
  EXPECT_FALSE(grid->wraps());
  EXPECT_THAT(grid->eastings(), ElementsAre(3000.0, 2000.0, 1000.0, 0.0));
  EXPECT_THAT(grid->northings(), ElementsAre(500.0, 0.0));
  EXPECT_THAT(grid->depths(), ElementsAre(10.0, 20.0, 30.0));
  ASSERT_EQ(grid->moments().size(), 2U);
  EXPECT_EQ(iso(grid->moments()[1]), "2024-02-29T03:00");
  EXPECT_EQ(grid->nearest(900.0, 400.0, 2, 1), 1000.0 + 0.5 * 1211.0);
  EXPECT_EQ(grid->bilinear(500.0, 0.0, 0, 0), 1000.0 + 0.5 * 0.5);
  EXPECT_TRUE(std::isnan(grid->nearest(-501.0, 0.0)));
}

TEST(DataGrid, BlocksOnRisingAxes) {
  const TemporaryDirectory folder;
  const auto grid = DataGrid::find(write_odd(folder), {"speed"});
  ASSERT_TRUE(grid);
  const auto block = grid->block({0, 2}, {0, 1}, {0, 1}, 1);  // x = 3 to 1 km, the upper two levels
  EXPECT_THAT(block.eastings, ElementsAre(1000.0, 2000.0, 3000.0));
  EXPECT_THAT(block.northings, ElementsAre(0.0, 500.0));
  EXPECT_THAT(block.depths, ElementsAre(10.0, 20.0));
  ASSERT_EQ(block.values.size(), 12U);
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t j = 0; j < 2; ++j)
      for (std::size_t i = 0; i < 3; ++i)
        if (i == 1 && j == 1 && k == 0)
          EXPECT_TRUE(std::isnan(block.at(i, j, k)));
        else
          EXPECT_EQ(block.at(i, j, k),
                    1000.0 + 0.5 * static_cast<double>(1000 + 100 * k + 10 * j + i + 1));
  EXPECT_THROW(static_cast<void>(grid->block({0, 4}, {0, 1})), std::out_of_range);
  EXPECT_THROW(static_cast<void>(grid->block({2, 0}, {0, 1})), std::out_of_range);  // no globe
  EXPECT_THROW(static_cast<void>(grid->block({0, 0}, {0, 1}, {0, 3})), std::out_of_range);
  EXPECT_THROW(static_cast<void>(grid->block({0, 0}, {0, 1}, {0, 0}, 2)), std::out_of_range);
}

// A block of more than a piece is the same as its parts.
TEST(DataGrid, LargeBlocksAreReadInPieces) {
  const TemporaryDirectory folder;
  const auto path = folder / "large.nc";
  constexpr std::size_t nx = 1500, ny = 1100;
  {
    NetcdfWriter file(path, NC_CLOBBER | NC_NETCDF4);
    Values x(nx), y(ny), z(nx * ny);
    for (std::size_t i = 0; i < nx; ++i) x[i] = 0.01 * static_cast<double>(i);
    for (std::size_t j = 0; j < ny; ++j) y[j] = 5.0 - 0.01 * static_cast<double>(j);
    for (std::size_t n = 0; n < z.size(); ++n) z[n] = static_cast<double>(n % 30'011);
    file.axis("lon", x, {{"units", "degrees_east"}});
    file.axis("lat", y, {{"units", "degrees_north"}});
    file.variable("elevation", NC_SHORT, {"lat", "lon"}, z);
  }
  const auto grid = DataGrid::find(path, {"elevation"});
  ASSERT_TRUE(grid);
  const auto block = grid->block({0, nx - 1}, {0, ny - 1});
  for (std::size_t j = 0; j < ny; j += 7)
    for (std::size_t i = 0; i < nx; i += 11)
      ASSERT_EQ(block.at(i, j), static_cast<double>(((ny - 1 - j) * nx + i) % 30'011));
}

TEST(DataGrid, BlocksAcrossTheSeamOfTheGlobe) {
  const TemporaryDirectory folder;
  const auto path = folder / "globe.nc";
  {
    NetcdfWriter file(path);
    file.axis("longitude", {0.0, 90.0, 180.0, 270.0}, {{"units", "degrees_east"}});
    file.axis("latitude", {-45.0, 45.0}, {{"units", "degrees_north"}});
    file.variable("u10", NC_FLOAT, {"latitude", "longitude"}, {0, 1, 2, 3, 10, 11, 12, 13});
  }
  const auto grid = DataGrid::find(path, {"u10"});
  ASSERT_TRUE(grid);
  EXPECT_TRUE(grid->wraps());
  const auto block = grid->block({3, 1}, {0, 1});
  EXPECT_THAT(block.eastings, ElementsAre(270.0, 360.0, 450.0));
  EXPECT_THAT(block.values, ElementsAre(3, 0, 1, 13, 10, 11));
}

// Longitudes of a grid over the date line, as some makers number them, go on rising.
TEST(DataGrid, LongitudesThatJump) {
  const TemporaryDirectory folder;
  const auto path = folder / "fiji.nc";
  {
    NetcdfWriter file(path);
    file.axis("lon", {179.0, 179.5, -180.0, -179.5}, {{"units", "degrees_east"}});
    file.axis("lat", {-18.0, -17.0}, {{"units", "degrees_north"}});
    file.variable("z", NC_FLOAT, {"lat", "lon"}, {0, 1, 2, 3, 4, 5, 6, 7});
  }
  const auto grid = DataGrid::find(path, {"z"});
  ASSERT_TRUE(grid);
  EXPECT_THAT(grid->eastings(), ElementsAre(179.0, 179.5, 180.0, 180.5));
  EXPECT_EQ(grid->nearest(-179.5, -17.0), 7.0);
}

TEST(DataGrid, AxesThatAreNoneAreInputErrors) {
  const TemporaryDirectory folder;
  const auto fault = [&](const Values& x, const char* units) -> std::string {
    {
      NetcdfWriter file(folder / "bad.nc");
      file.axis("x", x, {{"units", units}, {"axis", "X"}});
      file.axis("lat", {0.0, 1.0}, {{"units", "degrees_north"}});
      file.variable("z", NC_FLOAT, {"lat", "x"}, Values(2 * x.size()));
    }
    try {
      static_cast<void>(DataGrid::find(folder / "bad.nc", {"z"}));
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(fault({0.0, 1.0}, "degrees"), "");
  EXPECT_THAT(fault({0.0, 1.0, 0.5}, "degrees"),
              HasSubstr("bad.nc: x: found an axis whose values neither rise nor fall"));
  EXPECT_THAT(fault({0.0, 1.0}, "km"), HasSubstr("bad.nc: z: found one axis in degrees"));
}

// netCDF's own fill value, and a range of unpacked values beside packed ones.
TEST(DataGrid, MissingWithoutAFillValue) {
  const TemporaryDirectory folder;
  const auto path = folder / "fill.nc";
  {
    NetcdfWriter file(path);
    file.axis("lon", {0.0, 1.0, 2.0}, {{"units", "degrees_east"}});
    file.axis("lat", {0.0}, {{"units", "degrees_north"}});
    const int id = file.variable("t", NC_SHORT, {"lat", "lon"}, {100, NC_FILL_SHORT, 300}, {},
                                 {{"scale_factor", 0.1}});
    const double range[] = {5.0, 20.0};
    nc_redef(file.id());
    nc_put_att_double(file.id(), id, "valid_range", NC_DOUBLE, 2, range);
    nc_enddef(file.id());
  }
  const auto grid = DataGrid::find(path, {"t"});
  ASSERT_TRUE(grid);
  EXPECT_NEAR(grid->nearest(0.0, 0.0), 10.0, 1e-12);
  EXPECT_TRUE(std::isnan(grid->nearest(1.0, 0.0)));
  EXPECT_TRUE(std::isnan(grid->nearest(2.0, 0.0)));  // 30, above 20
}

TEST(DataGrid, TimesOfAClimatology) {
  const TemporaryDirectory folder;
  const auto path = folder / "woa.nc";
  {
    NetcdfWriter file(path);
    file.dimension("nbounds", 2);
    file.axis(
        "time", {372.5},
        {{"units", "months since 1955-01-01 00:00:00"}, {"climatology", "climatology_bounds"}},
        NC_FLOAT);
    file.variable("climatology_bounds", NC_FLOAT, {"time", "nbounds"}, {0.0, 745.0});
    file.axis("lon", {0.5, 1.5}, {{"units", "degrees_east"}});
    file.axis("lat", {0.5}, {{"units", "degrees_north"}});
    file.variable("t_an", NC_FLOAT, {"time", "lat", "lon"}, {1.0, 2.0});
  }
  const auto grid = DataGrid::find(path, {"t_an"});
  ASSERT_TRUE(grid);
  EXPECT_TRUE(grid->every_year());
  EXPECT_EQ(iso(grid->moments().at(0)), "1986-01-16T12:00");
  ASSERT_EQ(grid->spans().size(), 2U);
  EXPECT_EQ(iso(grid->spans()[1]), "2017-02-01");
}

// A grid as large as GEBCO's (3.7e9 cells, 7.5 GB if it were written) is opened, not loaded.
TEST(DataGrid, LargeGridsAreOpenedNotLoaded) {
  const TemporaryDirectory folder;
  const auto path = folder / "gebco.nc";
  constexpr std::size_t nx = 86'400, ny = 43'200;
  {
    NetcdfWriter file(path, NC_CLOBBER | NC_64BIT_DATA);
    int old = 0;
    nc_set_fill(file.id(), NC_NOFILL, &old);  // a sparse file: only what is written is on the disk
    Values x(nx), y(ny);
    for (std::size_t i = 0; i < nx; ++i) x[i] = -180.0 + (static_cast<double>(i) + 0.5) / 240.0;
    for (std::size_t j = 0; j < ny; ++j) y[j] = -90.0 + (static_cast<double>(j) + 0.5) / 240.0;
    file.axis("lon", x, {{"units", "degrees_east"}});
    file.axis("lat", y, {{"units", "degrees_north"}});
    const int id = file.variable("elevation", NC_SHORT, {"lat", "lon"}, {});
    const std::size_t place[] = {30'000, 70'000};
    const short height = -4321;
    ASSERT_EQ(nc_put_var1_short(file.id(), id, place, &height), NC_NOERR);
    const std::size_t end[] = {ny - 1, nx - 1};
    ASSERT_EQ(nc_put_var1_short(file.id(), id, end, &height), NC_NOERR);
  }
  const auto begin = std::chrono::steady_clock::now();
  const auto grid = DataGrid::find(path, {"elevation"});
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->nearest(-180.0 + 70'000.4 / 240.0, -90.0 + 30'000.6 / 240.0), -4321.0);
  const auto block = grid->block({69'990, 70'010}, {29'990, 30'010});
  EXPECT_EQ(block.at(10, 10), -4321.0);
  EXPECT_EQ(block.values.size(), 441U);
  // 30 ms alone; a load of 7.5 GB takes seconds, and the child may not have so much memory.
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
}

}  // namespace
}  // namespace asdic::detail
