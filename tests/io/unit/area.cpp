#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "io/climatology/map_reader.h"
#include "io/scenario/scenario_reader.h"
#include "io/scenario/writer.h"
#include "io/settings/writer.h"
#include "raytrace/area/earth_places.h"
#include "support/netcdf_writer.h"
#include "support/temporary_directory.h"

namespace asdic::detail {
namespace {

using support::NetcdfWriter;
using support::TemporaryDirectory;
using testing::HasSubstr;

std::vector<double> even(double begin, double step, std::size_t n) {
  std::vector<double> values;
  for (std::size_t i = 0; i < n; ++i) values.push_back(begin + step * double(i));
  return values;
}

/// Metres in a degree of latitude and of longitude at 40 N, M·π/180 and N·cos φ·π/180 on the
/// ellipsoid of a = 6378137 m, 1/f = 298.257223563.
constexpr double of_latitude = 111'034.6326, of_longitude = 85'393.8570;

/// Heights as GEBCO stores them, but from north to south: −1000 m and 2 m deeper with every place
/// to the east, 5 m with every one to the north, from 20.3 W 39.7 N on.
void write_heights(const std::filesystem::path& path) {
  NetcdfWriter file(path);
  constexpr std::size_t n = 121;
  file.axis("lat", even(40.3, -0.005, n), {{"units", "degrees_north"}});
  file.axis("lon", even(339.7, 0.005, n), {{"units", "degrees_east"}});
  std::vector<double> heights;
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i)
      heights.push_back(-1000.0 - 2.0 * double(i) - 5.0 * double(n - 1 - j));
  file.variable("elevation", NC_SHORT, {"lat", "lon"}, heights, {{"units", "m"}});
}

/// Speeds of two levels, the lower one missing in the west; kinds; wind.
void write_others(const std::filesystem::path& path) {
  NetcdfWriter file(path, NC_NETCDF4);
  file.axis("depth", {0.0, 100.0, 3000.0}, {{"units", "m"}, {"positive", "down"}});
  file.axis("lat", even(39.0, 0.25, 9), {{"units", "degrees_north"}});
  file.axis("lon", even(-21.0, 0.25, 9), {{"units", "degrees_east"}});
  std::vector<double> speeds;
  for (const double c : {1520.0, 1500.0, -999.0})
    for (std::size_t j = 0; j < 9; ++j)
      for (std::size_t i = 0; i < 9; ++i) speeds.push_back(c == 1500.0 && i < 3 ? -999.0 : c);
  file.variable("sound_speed", NC_FLOAT, {"depth", "lat", "lon"}, speeds, {},
                {{"_FillValue", -999.0}});
  std::vector<double> kinds, wind;
  for (std::size_t j = 0; j < 9; ++j)
    for (std::size_t i = 0; i < 9; ++i) {
      kinds.push_back(i < 4 ? 3.0 : 5.0);
      wind.push_back(7.0 + double(j));
    }
  file.variable("sediment", NC_BYTE, {"lat", "lon"}, kinds);
  file.variable("wind_speed", NC_FLOAT, {"lat", "lon"}, wind, {{"units", "m s-1"}});
}

const std::string sonar = R"(
[platform]
position = [0.0, 0.0, 100.0]
[transmitter]
source_level_db = 220.0
elevation_deg = 0.0
beamwidth_deg = 20.0
[pulse]
kind = "cw"
frequency = 4000.0
duration = 0.1
[array]
kind = "horizontal"
phones = 2
spacing = 0.18
[pings]
recording_duration = 10.0
)";

const std::string place = R"(
[environment.origin]
latitude_deg = 40.0
longitude_deg = -20.0
[environment.bottom]
kind = "fluid"
[environment.area.bathymetry]
file = "heights.nc"
)";

const std::string layered = "[environment.sound_speed]\nkind = \"isovelocity\"\nspeed = 1500.0\n";

class AreaFiles : public testing::Test {
 protected:
  AreaFiles() {
    write_heights(folder_ / "heights.nc");
    write_others(folder_ / "others.nc");
  }
  Scenario read(const std::string& text) const {
    return parse_scenario(text, folder_ / "place.toml");
  }
  std::string fault(const std::string& text) const {
    try {
      static_cast<void>(read(text));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  TemporaryDirectory folder_;
};

// 60 places east and 60 north of the first: 1000 + 120 + 300 m; the slope in metres of the map.
TEST_F(AreaFiles, HeightsAreDepthsAtTheirPlaces) {
  const Scenario s = read(place + layered + sonar);
  ASSERT_TRUE(s.area);
  const MapValue here = s.area->floor().at(0.0, 0.0);
  EXPECT_NEAR(here.value, 1420.0, 1e-6);
  EXPECT_NEAR(here.x, 2.0 / (0.005 * of_longitude), 1e-7);
  EXPECT_NEAR(here.y, 5.0 / (0.005 * of_latitude), 1e-7);
  EXPECT_EQ(s.area->settings().origin, (GeographicPlace{40.0, -20.0}));
  EXPECT_NEAR(s.environment.bottom.depth_at(1000.0), s.area->bottom_depth(0.0, 1000.0), 0.05);
  EXPECT_EQ(s.environment.water.at(10.0).c, 1500.0);
}

TEST_F(AreaFiles, WaterKindsAndWindHaveMapsOfTheirOwn) {
  const Scenario s = read(place + R"(
[environment.area.sound_speed]
file = "others.nc"
[environment.area.wind]
file = "others.nc"
[environment.area.seabed]
file = "others.nc"
variable = "sediment"
[[environment.area.seabed.class]]
number = 3
name = "sand"
kind = "fluid"
speed = 1700.0
[[environment.area.seabed.class]]
number = 5
kind = "rigid"
)" + sonar);
  EXPECT_NEAR(s.wind_speed, 11.0, 1e-6);
  EXPECT_NEAR(s.area->speed_at(0.0, 0.0, 100.0).c, 1500.0, 1e-3);
  // What is missing of the second level has its neighbours' speed; the third has none anywhere.
  EXPECT_NEAR(s.area->speed_at(-80e3, 0.0, 100.0).c, 1500.0, 1e-3);
  EXPECT_NEAR(s.area->speed_at(0.0, 0.0, 3000.0).c, 1500.0 + 0.0165 * 2900.0, 1e-2);
  EXPECT_EQ(s.area->material_at(5000.0, 0.0), BoundaryMaterial(Rigid{}));
  EXPECT_EQ(std::get<FluidHalfSpace>(s.area->material_at(-15000.0, 0.0)).speed, 1700.0);
}

TEST_F(AreaFiles, WhatIsWrittenIsReadAgain) {
  const Scenario s = read(place + R"(
[environment.surface]
kind = "vacuum"
roughness = "wind"
[environment.area.wind]
file = "others.nc"
[environment.area.sound_speed]
file = "others.nc"
[environment.area.seabed]
file = "others.nc"
[[environment.area.seabed.class]]
number = 5
kind = "rigid"
[[environment.area.seabed.class]]
number = 3
kind = "fluid"
speed = 1700.0
)" + sonar);
  const Scenario again = read(to_toml(s));
  EXPECT_EQ(again.area->settings(), s.area->settings());
  EXPECT_EQ(again.area->everywhere(), s.area->everywhere());
  EXPECT_EQ(again.origin, s.origin);
}

TEST_F(AreaFiles, FaultsAreToldByTheirNames) {
  EXPECT_THAT(fault(place + sonar), HasSubstr("environment.sound_speed"));
  EXPECT_THAT(fault(place + layered + sonar + "[environment.bottom.shape]\nrange=[0]\ndepth=[1]\n"),
              HasSubstr("environment.bottom.shape"));
  EXPECT_THAT(
      fault(layered + sonar +
            "[environment.bottom]\nkind = \"rigid\"\n"
            "[environment.area.bathymetry]\nfile = \"heights.nc\"\n"),
      testing::AllOf(HasSubstr("[environment.origin]"), HasSubstr("heights.nc: elevation")));
  EXPECT_THAT(fault(place + "variable = \"tide\"\n" + layered + sonar),
              testing::AllOf(HasSubstr("heights.nc"), HasSubstr("no variable \"tide\""),
                             HasSubstr("elevation")));
  std::string elsewhere = place;
  elsewhere.replace(elsewhere.find("40.0"), 4, "45.0");
  EXPECT_THAT(fault(elsewhere + layered + sonar), HasSubstr("heights.nc: elevation"));
  EXPECT_THAT(fault(place + R"(
[environment.area.sound_speed]
file = "others.nc"
variable = "sediment"
)" + sonar),
              HasSubstr("a variable over depth and map"));
  EXPECT_THAT(fault(place + layered + sonar +
                    "[[target]]\nposition = [0.0, 90000.0, 50.0]\n"
                    "strength_db = 10.0\n"),
              testing::AllOf(HasSubstr("target"), HasSubstr("a place on the map")));
}

// The map is 39.6975 to 40.3025 N and 20.3025 to 19.6975 W: ±0.3025° of latitude are 33 588 m.
TEST_F(AreaFiles, APlaceOffTheMapIsToldWithTheMapsExtent) {
  EXPECT_THAT(fault(place + layered + sonar +
                    "[[target]]\nposition = [0.0, 90000.0, 50.0]\nstrength_db = 10.0\n"),
              testing::AllOf(HasSubstr("heights.nc: elevation, 39.6975 to 40.3025 N"),
                             HasSubstr("y from about -335"), HasSubstr("to 335"),
                             HasSubstr("0 m east, 90000 m north (40.810")));
  std::string elsewhere = place;
  elsewhere.replace(elsewhere.find("40.0"), 4, "45.0");
  EXPECT_THAT(fault(elsewhere + layered + sonar),
              testing::AllOf(HasSubstr("heights.nc: elevation, 39.6975 to 40.3025 N"),
                             HasSubstr("45 N -20 E")));
}

// Of a map of depths that look like heights all is land; of one with an island, that place alone.
TEST_F(AreaFiles, LandIsToldByMapHeightAndPlace) {
  const auto write = [&](auto&& height) {
    NetcdfWriter file(folder_ / "land.nc");
    file.axis("lat", even(39.0, 0.25, 9), {{"units", "degrees_north"}});
    file.axis("lon", even(-21.0, 0.25, 9), {{"units", "degrees_east"}});
    std::vector<double> heights;
    for (std::size_t k = 0; k < 81; ++k) heights.push_back(height(k));
    file.variable("elevation", NC_FLOAT, {"lat", "lon"}, heights, {{"units", "m"}});
  };
  const std::string land = std::string(place).replace(place.find("heights.nc"), 10, "land.nc") +
                           "interpolation = \"faceted\"\n";
  write([](std::size_t) { return 700.0; });
  EXPECT_THAT(fault(land + layered + sonar),
              testing::AllOf(HasSubstr("0 m east, 0 m north (40 N -20 E) is land, 700 m high, by "
                                       "land.nc: elevation"),
                             HasSubstr("all of that map seems to be land"), HasSubstr("depth")));
  write([](std::size_t k) { return k == 40 ? 300.0 : -1000.0; });
  EXPECT_THAT(fault(land + layered + sonar),
              testing::AllOf(HasSubstr("is land, 300 m high, by land.nc: elevation"),
                             testing::Not(HasSubstr("seems"))));
}

TEST_F(AreaFiles, AGridThatDoesNotHoldTheOriginIsToldWithItsAxes) {
  {
    NetcdfWriter file(folder_ / "plane.nc");
    file.axis("y", even(3'500'000.0, 500.0, 9), {{"units", "m"}, {"axis", "Y"}});
    file.axis("x", even(480'000.0, 500.0, 9), {{"units", "m"}, {"axis", "X"}});
    file.variable("depth", NC_FLOAT, {"y", "x"}, std::vector<double>(81, 700.0), {{"units", "m"}});
  }
  const std::string plane = std::string(place).replace(place.find("heights.nc"), 10, "plane.nc");
  EXPECT_THAT(fault(plane + layered + sonar),
              testing::AllOf(HasSubstr("plane.nc: depth, x from 479750 to 484250 m, y from 3499750 "
                                       "to 3504250 m"),
                             HasSubstr("environment.area.easting"),
                             HasSubstr("environment.area.northing")));
  EXPECT_THAT(fault(plane + layered + sonar +
                    "[[target]]\nposition = [0.0, 3000.0, 50.0]\nstrength_db = 10.0\n"
                    "[environment.area]\neasting = 482000.0\nnorthing = 3502000.0\n"),
              HasSubstr("x from -2250 to 2250 m, y from -2250 to 2250 m"));
}

TEST_F(AreaFiles, AMissingVariableIsToldWithThoseThatThereAre) {
  EXPECT_THAT(fault(place + "variable = \"tide\"\n" + layered + sonar),
              HasSubstr("expected one of elevation, or FILE:VARIABLE"));
  EXPECT_THAT(fault(place + "[environment.area.wind]\nfile = \"heights.nc\"\n" + layered + sonar),
              testing::AllOf(HasSubstr("no variable of wind"),
                             HasSubstr("or FILE:VARIABLE with one of elevation"),
                             testing::Not(HasSubstr("sfcWind"))));
}

// Every 49th of a degree, which no decimal ends: the transect passes by the hole.
TEST_F(AreaFiles, AHoleIsToldByARoundedPlaceAndWithARemedy) {
  {
    NetcdfWriter file(folder_ / "hole.nc");
    file.axis("lat", even(39.0, 1.0 / 49.0, 99), {{"units", "degrees_north"}});
    file.axis("lon", even(-21.0, 1.0 / 49.0, 99), {{"units", "degrees_east"}});
    std::vector<double> heights(99 * 99, -1000.0);
    heights[49 * 99 + 46] = -32767.0;
    file.variable("elevation", NC_SHORT, {"lat", "lon"}, heights, {{"units", "m"}},
                  {{"_FillValue", -32767.0}});
  }
  const std::string holed = std::string(place).replace(place.find("heights.nc"), 10, "hole.nc");
  EXPECT_THAT(
      fault(holed + layered + sonar),
      testing::AllOf(testing::ContainsRegex(
                         "hole\\.nc: elevation at [34][90]\\.[0-9]{1,4} N -20\\.[0-9]{1,4} E: "),
                     HasSubstr("a shorter reach, another file"), HasSubstr("second --bathymetry")));
}

// Wind grows by 4 m/s with every degree to the north. Noise is that of the wind over the array, a
// plane is as rough as the mean wind along it makes the sea, and what is given as a number stays.
TEST_F(AreaFiles, NoiseAndRoughnessAreThoseOfTheWindWhereTheyAre) {
  const std::string wind = "[environment.area.wind]\nfile = \"others.nc\"\n";
  const std::string rough =
      "[environment.surface]\nkind = \"vacuum\"\nroughness = \"wind\"\nbubbles = \"apl-uw\"\n";
  const std::string north =
      std::string(sonar).replace(sonar.find("[0.0, 0.0, 100.0]"), 17, "[0.0, 20e3, 100.0]");
  const Scenario s = read(place + wind + rough + layered + north + "[noise]\nkind = \"wenz\"\n");
  constexpr double a_metre = 4.0 / of_latitude;
  EXPECT_NEAR(s.wind_speed, 11.0 + 20e3 * a_metre, 1e-4);
  EXPECT_NEAR(std::get<WenzNoise>(*s.noise.law).wind_speed, s.wind_speed, 1e-12);
  const auto roughness = [](const Scenario& of, double bearing) {
    return of.area->section(Vec2::Zero(), bearing, 30e3).surface.roughness;
  };
  for (const double bearing : {0.0, 1.0, pi / 2.0, pi}) {
    const double mean = 11.0 + 15e3 * a_metre * std::cos(bearing);
    EXPECT_NEAR(roughness(s, bearing).sea_wind, mean, 2e-3) << bearing;
    EXPECT_NEAR(roughness(s, bearing).bubble_wind, mean, 2e-3) << bearing;
    EXPECT_NEAR(roughness(s, bearing).rms_height, pierson_moskowitz_height(mean), 1e-3) << bearing;
    EXPECT_FALSE(roughness(s, bearing).elsewhere.wavenumbers.empty());
  }
  const std::string numbers = std::string(rough).replace(rough.find("\"wind\""), 6, "0.5");
  const Scenario given = read(place + wind + numbers + layered + sonar);
  EXPECT_EQ(roughness(given, 0.0).rms_height, 0.5);
  EXPECT_THAT(fault(place + wind + layered + sonar + "[environment]\nwind_speed = 5.0\n"),
              HasSubstr("none beside [environment.area.wind]"));
}

// Kilometres, knots and km/s become our units; others, and grain sizes, are refused by name.
TEST_F(AreaFiles, UnitsAreThoseOfTheFile) {
  const auto write = [&](const std::string& name, const std::string& units, double value) {
    NetcdfWriter file(folder_ / "units.nc");
    file.axis("lat", even(39.0, 0.25, 9), {{"units", "degrees_north"}});
    file.axis("lon", even(-21.0, 0.25, 9), {{"units", "degrees_east"}});
    file.variable(name, NC_FLOAT, {"lat", "lon"}, std::vector<double>(81, value),
                  {{"units", units}});
  };
  const std::string units = std::string(place).replace(place.find("heights.nc"), 10, "units.nc");
  write("elevation", "km", -2.5);
  EXPECT_NEAR(read(units + layered + sonar).area->bottom_depth(0.0, 0.0), 2500.0, 1e-3);
  write("elevation", "fathoms", -1000.0);
  EXPECT_THAT(fault(units + layered + sonar),
              testing::AllOf(HasSubstr("units.nc: elevation"), HasSubstr("fathoms")));
  write("elevation", "", -2500.0);
  EXPECT_THAT(read(units + layered + sonar).notes,
              testing::Contains(HasSubstr("units.nc: elevation has no units")));
  write("sediment", "phi", 3.0);
  EXPECT_THAT(fault(place + layered + R"(
[environment.area.seabed]
file = "units.nc"
[[environment.area.seabed.class]]
number = 3
kind = "rigid"
)" + sonar),
              testing::AllOf(HasSubstr("units.nc: sediment"), HasSubstr("grain sizes in phi")));
}

// A floor whose name says nothing, whose long_name does: depths, not heights.
TEST_F(AreaFiles, DepthsAreKnownByTheirLongName) {
  {
    NetcdfWriter file(folder_ / "named.nc");
    file.axis("lat", even(39.0, 0.25, 9), {{"units", "degrees_north"}});
    file.axis("lon", even(-21.0, 0.25, 9), {{"units", "degrees_east"}});
    file.variable("bath", NC_FLOAT, {"lat", "lon"}, std::vector<double>(81, 700.0),
                  {{"units", "m"}, {"long_name", "depth of the sea floor"}});
  }
  const std::string named = std::string(place).replace(place.find("heights.nc"), 10, "named.nc");
  EXPECT_NEAR(read(named + layered + sonar).area->bottom_depth(0.0, 0.0), 700.0, 1e-3);
}

// Axes of a projection may be turned against the meridian: no latitudes are made of them.
TEST_F(AreaFiles, ProjectedMapsHaveNoPlacesOnTheEarth) {
  {
    NetcdfWriter file(folder_ / "plane.nc");
    file.axis("y", even(-20.0, 5.0, 9), {{"units", "km"}, {"axis", "Y"}});
    file.axis("x", even(-20.0, 5.0, 9), {{"units", "km"}, {"axis", "X"}});
    file.variable("depth", NC_FLOAT, {"y", "x"}, std::vector<double>(81, 700.0), {{"units", "m"}});
  }
  const std::string plane = std::string(place).replace(place.find("heights.nc"), 10, "plane.nc");
  const Scenario projected = read(plane + layered + sonar), placed = read(place + layered + sonar);
  EXPECT_FALSE(EarthPlaces(projected.origin, projected.area.get()).known());
  EXPECT_THAT(projected.notes,
              testing::Contains(testing::AllOf(HasSubstr("plane.nc: depth"),
                                               HasSubstr("results have no latitudes"))));
  EXPECT_TRUE(EarthPlaces(placed.origin, placed.area.get()).known());
  EXPECT_THAT(placed.notes, testing::Not(testing::Contains(HasSubstr("no latitudes"))));
}

// 10⁸ places: opened in kilobytes.
TEST_F(AreaFiles, ALargeGridIsOpenedAndNotLoaded) {
  {
    NetcdfWriter file(folder_ / "large.nc", NC_64BIT_OFFSET);  // 200 MB, of which none is written
    constexpr std::size_t n = 10'000;
    nc_set_fill(file.id(), NC_NOFILL, nullptr);
    file.axis("lat", even(15.0, 0.005, n), {{"units", "degrees_north"}});
    file.axis("lon", even(-45.0, 0.005, n), {{"units", "degrees_east"}});
    file.variable("elevation", NC_SHORT, {"lat", "lon"}, {});
  }
  std::vector<std::string> notes;
  const OpenedMap map =
      open_map(folder_ / "large.nc", "", climatology::bathymetry_quantity(), -20.0, notes);
  EXPECT_EQ(map.grid->x().size(), 10'000U);
  EXPECT_EQ(map.grid->bytes(), 0U);
  EXPECT_EQ(*map.grid->at(5000, 5000), 0.0F);
  EXPECT_LE(map.grid->bytes(), 128U * 128U * 4U);
}

TEST(FillVolume, LevelsAreFilledFromTheirNeighbours) {
  const float none = std::nanf("");
  std::vector<float> values = {1500.0F, 1490.0F, none, 1510.0F, none, none, none, none, none};
  fill_volume(3, 1, {0.0, 100.0, 200.0}, values);
  EXPECT_FLOAT_EQ(values[4], 1490.0F);
  EXPECT_FLOAT_EQ(values[6], 1510.0F);
  EXPECT_FLOAT_EQ(values[8], 1490.0F + 1.65F);
}

}  // namespace
}  // namespace asdic::detail
