#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/scenario/propagation.h"
#include "io/scenario/scenario_reader.h"
#include "support/temporary_directory.h"

namespace asdic::detail {
namespace {

using testing::HasSubstr;

/// [environment] out of parts; a run that asks for as little as can be.
PropagationCase read(const std::string& ocean, std::vector<std::string>* notes = nullptr) {
  std::vector<std::string> ignored;
  const std::string text = ocean + R"(
[run]
frequency = 500.0
[run.source]
depth = 20.0
[run.receivers]
depth = 30.0
range = 1000.0
)";
  return parse_propagation_case(text, "o.toml", {}, notes != nullptr ? *notes : ignored);
}

const std::string water = "[environment.sound_speed]\nkind = \"isovelocity\"\nspeed = 1500\n";

BoundaryMaterial bottom(const std::string& keys, std::vector<std::string>* notes = nullptr) {
  return read(water + "[environment.bottom]\ndepth = 100\n" + keys, notes)
      .environment.bottom.material;
}

double loss(const std::string& key, double value) {
  return std::get<FluidHalfSpace>(
             bottom("kind = \"fluid\"\nspeed = 2000\n" + key + " = " + std::to_string(value)))
      .attenuation_db_per_wavelength;
}

TEST(ScenarioOcean, WhatIsBesideThePlane) {
  const std::string sloping = water +
                              "[environment.bottom]\nkind = \"rigid\"\n"
                              "shape = { range = [0, 2000], depth = [100, 200] }\n";
  EXPECT_EQ(spreading_across(read(sloping).environment), Spreading::plane);
  EXPECT_EQ(
      spreading_across(read("environment.spreading = \"cylindrical\"\n" + sloping).environment),
      Spreading::cylindrical);
  try {
    static_cast<void>(read("environment.spreading = \"spherical\"\n" + sloping));
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("environment.spreading"));
  }
}

// At 500 Hz and 2000 m/s a wavelength is 4 m.
TEST(ScenarioOcean, AttenuationInEveryUnit) {
  const double neper = 20.0 / std::log(10.0);
  EXPECT_EQ(loss("attenuation_db_per_wavelength", 0.5), 0.5);
  EXPECT_NEAR(loss("attenuation_db_per_metre", 0.1), 0.4, 1e-15);
  EXPECT_NEAR(loss("attenuation_db_per_metre_khz", 0.1), 0.2, 1e-15);
  EXPECT_NEAR(loss("attenuation_nepers_per_metre", 0.01), 0.04 * neper, 1e-15);
  EXPECT_NEAR(loss("quality_factor", 50.0), neper * pi / 50.0, 1e-15);
  EXPECT_NEAR(loss("loss_parameter", 0.01), neper * 2.0 * pi * 0.01, 1e-15);
}

TEST(ScenarioOcean, EveryMaterial) {
  EXPECT_TRUE(std::holds_alternative<Vacuum>(bottom("kind = \"vacuum\"")));
  EXPECT_TRUE(std::holds_alternative<Rigid>(bottom("kind = \"rigid\"")));

  const auto chalk = std::get<ElasticHalfSpace>(
      bottom("kind = \"elastic\"\nspeed = 2500\nshear_speed = 1200\ndensity = 2300\n"
             "quality_factor = 100\nshear_attenuation_db_per_metre_khz = 0.2"));
  EXPECT_EQ(chalk.shear_speed, 1200.0);
  EXPECT_EQ(chalk.density, 2300.0);
  EXPECT_NEAR(chalk.attenuation_db_per_wavelength, 20.0 / std::log(10.0) * pi / 100.0, 1e-15);
  EXPECT_NEAR(chalk.shear_attenuation_db_per_wavelength, 0.24, 1e-15);

  const auto silt = std::get<FluidHalfSpace>(bottom("kind = \"grain-size\"\ngrain_size = 6.0"));
  EXPECT_EQ(silt.speed, sediment_of_grain_size(6.0, 1500.0, 1027.0).speed);
  EXPECT_EQ(silt.density, sediment_of_grain_size(6.0, 1500.0, 1027.0).density);
  const auto handbook = std::get<FluidHalfSpace>(
      bottom("kind = \"grain-size\"\ngrain_size = 6.0\nwater_speed = 1528\nwater_density = 1000"));
  EXPECT_EQ(handbook.speed, sediment_of_grain_size(6.0, 1528.0, 1000.0).speed);

  const auto table = std::get<ReflectionTable>(
      bottom("kind = \"table\"\ngrazing_deg = [0, 30, 90]\nmagnitude = [1.0, 0.7, 0.4]"));
  EXPECT_EQ(table.grazing, (std::vector<double>{0.0, radians(30.0), radians(90.0)}));
  EXPECT_EQ(table.phase, (std::vector<double>{0.0, 0.0, 0.0}));
}

// g/cm3 and km/s, as handbooks have them, make no bottom.
TEST(ScenarioOcean, AMaterialInOtherUnitsIsRefused) {
  const auto refused = [](const std::string& keys, const std::string& message) {
    try {
      static_cast<void>(bottom(keys));
      ADD_FAILURE() << keys;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(message)) << keys;
    }
  };
  for (const std::string kind : {"kind = \"fluid\"\n", "kind = \"elastic\"\n"}) {
    refused(kind + "density = 1.5",
            "environment.bottom.density: found 1.5 kg/m3, expected a density from 100 to 20000 "
            "kg/m3");
    refused(kind + "speed = 1.56",
            "environment.bottom.speed: found 1.56 m/s, expected a speed from 200 to 10000 m/s");
  }
  const BoundaryMaterial air = bottom("kind = \"fluid\"\nspeed = 343.0\ndensity = 1.2");
  EXPECT_DOUBLE_EQ(std::get<FluidHalfSpace>(air).density, 1.2) << "a gas is light";
}

TEST(ScenarioOcean, AReflectionTableFromAFile) {
  const support::TemporaryDirectory folder;
  const auto path =
      folder.write("bottom.csv", "grazing_deg,magnitude,phase_deg\n0,1,180\n90,0.5,0\n");
  const auto table =
      std::get<ReflectionTable>(bottom("kind = \"table\"\nfile = \"" + path.string() + "\""));
  EXPECT_EQ(table.magnitude, (std::vector<double>{1.0, 0.5}));
  EXPECT_EQ(table.phase, (std::vector<double>{radians(180.0), 0.0}));
}

TEST(ScenarioOcean, NoBoundaryReflectsMoreThanComesIn) {
  const auto says = [](const std::string& text, const std::string& part) {
    try {
      static_cast<void>(bottom(text));
      ADD_FAILURE() << text << " was taken";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(part));
    }
  };
  says("kind = \"table\"\ngrazing_deg = [0, 90]\nmagnitude = [1.01, 0.5]",
       "magnitude[0]: found 1.01, expected a magnitude from 0 to 1");
  const support::TemporaryDirectory folder;
  const auto path = folder.write("bottom.csv", "grazing_deg,magnitude\n0,1.0000005\n90,1.2\n");
  says("kind = \"table\"\nfile = \"" + path.string() + "\"", "bottom.csv:3: magnitude: found 1.2");
  const auto rounded = folder.write("rounded.csv", "grazing_deg,magnitude\n0,1.0000005\n90,1\n");
  EXPECT_EQ(
      std::get<ReflectionTable>(bottom("kind = \"table\"\nfile = \"" + rounded.string() + "\""))
          .magnitude[0],
      1.0);
  // |R| of eq. (3) of docs/theory/boundaries.md, by hand: 2.41 at 41.4 degrees beside water of 1500
  // m/s and 1027 kg/m3.
  says(
      "kind = \"elastic\"\nspeed = 2000\nshear_speed = 1500\n"
      "attenuation_db_per_wavelength = 0.01\nshear_attenuation_db_per_wavelength = 5.0",
      "reflection coefficient 2.4");
}

TEST(ScenarioOcean, ASolidThatGivesEnergyIsNoted) {
  std::vector<std::string> notes;
  static_cast<void>(
      bottom("kind = \"elastic\"\nspeed = 2000\nshear_speed = 1500\n"
             "attenuation_db_per_wavelength = 0.1\n"
             "shear_attenuation_db_per_wavelength = 1.0",
             &notes));
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_THAT(notes[0], HasSubstr("reflect more than comes in"));
}

TEST(ScenarioOcean, ShapesWithTheirMaterials) {
  const PropagationCase run = read(water + R"([environment.bottom.shape]
range = [0, 1000, 5000]
depth = [200, 180, 50]
interpolation = "smooth"
[[environment.bottom.shape.material]]
kind = "rigid"
[[environment.bottom.shape.material]]
kind = "grain-size"
grain_size = 2.0
[[environment.bottom.shape.material]]
kind = "fluid"
[environment.surface]
kind = "elastic"
speed = 3300
shear_speed = 1700
density = 900
attenuation_db_per_wavelength = 0.9
shear_attenuation_db_per_wavelength = 1.0
[environment.surface.shape]
range = [0, 50, 100]
depth = [-1, 1, -1]
interpolation = "curvilinear"
)");
  const Environment& ocean = run.environment;
  ASSERT_TRUE(ocean.bottom.shape.has_value());
  EXPECT_EQ(ocean.bottom.shape->interpolation(), ShapeInterpolation::smooth);
  EXPECT_EQ(ocean.bottom.depth, 200.0);
  EXPECT_TRUE(std::holds_alternative<Rigid>(ocean.bottom.material));
  EXPECT_TRUE(std::holds_alternative<Rigid>(ocean.bottom.material_at(999.0)));
  EXPECT_EQ(std::get<FluidHalfSpace>(ocean.bottom.material_at(1000.0)).speed,
            sediment_of_grain_size(2.0, 1500.0, 1027.0).speed);
  ASSERT_TRUE(ocean.surface.shape.has_value());
  EXPECT_EQ(ocean.surface.shape->interpolation(), ShapeInterpolation::curvilinear);
  EXPECT_TRUE(std::holds_alternative<ElasticHalfSpace>(ocean.surface.material_at(20.0)));
  EXPECT_FALSE(is_layered(ocean));
}

TEST(ScenarioOcean, AShapeAndItsMaterialsFromAFile) {
  const support::TemporaryDirectory folder;
  const auto path =
      folder.write("slope.csv",
                   "range,depth,speed,density,attenuation_db_per_wavelength,shear_speed,"
                   "shear_attenuation_db_per_wavelength\n0,200,1600,1800,0.5,0,0\n2000,100,2400,"
                   "2200,0.2,1000,0.5\n");
  const Boundary bottom = read(water +
                               "[environment.bottom]\nkind = \"rigid\"\n"
                               "[environment.bottom.shape]\nfile = \"" +
                               path.string() + "\"\n")
                              .environment.bottom;
  EXPECT_EQ(bottom.depth_at(1000.0), 150.0);
  EXPECT_EQ(std::get<FluidHalfSpace>(bottom.material_at(0.0)).speed, 1600.0);
  EXPECT_EQ(std::get<ElasticHalfSpace>(bottom.material_at(2000.0)).shear_speed, 1000.0);
}

TEST(ScenarioOcean, Sections) {
  const std::string rest = "[environment.bottom]\nkind = \"rigid\"\ndepth = 100\n";
  const Environment inline_rows = read(R"([environment.sound_speed]
kind = "section"
range = [-1000, 1000]
depth = [0, 50, 100]
speed = [[1500, 1490, 1490],
         [1510, 1495, 1490]]
)" + rest)
                                      .environment;
  ASSERT_TRUE(inline_rows.section.has_value());
  EXPECT_EQ(inline_rows.section->at(0.0, 0.0).c, 1505.0);
  EXPECT_EQ(inline_rows.water.at(0.0).c, 1505.0);  // its profile at range 0

  const support::TemporaryDirectory folder;  // a line a point, in any order
  const auto path = folder.write("front.csv",
                                 "depth,range,speed\n0,1000,1510\n50,1000,1495\n100,1000,1490\n"
                                 "0,-1000,1500\n50,-1000,1490\n100,-1000,1490\n");
  const Environment of_file = read("[environment.sound_speed]\nkind = \"section\"\nfile = \"" +
                                   path.string() + "\"\n" + rest)
                                  .environment;
  EXPECT_TRUE(std::equal(of_file.section->speeds().begin(), of_file.section->speeds().end(),
                         inline_rows.section->speeds().begin()));
}

TEST(ScenarioOcean, WhatTheWaterTakes) {
  const Environment ocean = read(water + R"([environment.bottom]
kind = "rigid"
depth = 1000
[environment.absorption]
kind = "none"
[[environment.biology]]
top = 100
bottom = 200
resonance = 500
quality_factor = 4
strength_db_per_km = 0.5
[environment.attenuation]
depth = [0, 100, 100, 1000]
db_per_km = [1, 1, 2, 2]
[environment.water_density]
depth = [0, 1000]
density = [1025, 1030]
)")
                                .environment;
  EXPECT_EQ(ocean.water_density.at(500.0), 1027.5);
  EXPECT_EQ(ocean.attenuation_db_per_km.at(100.0), 2.0);
  const double neper = 1e-3 / (20.0 / std::log(10.0));
  EXPECT_NEAR(attenuation_np_per_m(ocean, 500.0).at(150.0), (2.0 + 0.5 * 16.0) * neper, 1e-18);
  EXPECT_NEAR(attenuation_np_per_m(ocean, 500.0).at(50.0), neper, 1e-18);
  const Environment cloudy = read(water +
                                  "[environment.bottom]\nkind = \"rigid\"\ndepth = 10\n"
                                  "[environment.attenuation]\ndb_per_km = 3.0\n")
                                 .environment;
  EXPECT_EQ(cloudy.attenuation_db_per_km.at(5.0), 3.0);
  EXPECT_TRUE(is_layered(cloudy));
}

struct OceanFault {
  const char* name;
  std::string ocean;
  const char* message;
};

class OceanFaults : public testing::TestWithParam<OceanFault> {};

TEST_P(OceanFaults, IsReported) {
  try {
    static_cast<void>(read(GetParam().ocean));
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), GetParam().message);
  }
}

const std::string flat = "[environment.bottom]\nkind = \"rigid\"\ndepth = 100\n";
const OceanFault ocean_faults[] = {
    {"TwoAttenuations",
     water + "[environment.bottom]\ndepth = 100\nkind = \"fluid\"\nquality_factor = 10\n"
             "attenuation_db_per_metre = 1\n",
     "o.toml:7: environment.bottom.quality_factor: found 10, expected one attenuation, not this "
     "beside \"attenuation_db_per_metre\""},
    {"TooMuchAttenuation",
     water + "[environment.bottom]\ndepth = 100\nkind = \"fluid\"\nattenuation_db_per_metre = 50\n",
     "o.toml:7: environment.bottom.attenuation_db_per_metre: found 165 dB per wavelength, expected "
     "at most 50 dB per wavelength"},
    {"GrainsOfGravel",
     water + "[environment.bottom]\ndepth = 100\nkind = \"grain-size\"\ngrain_size = -3\n",
     "o.toml:7: environment.bottom.grain_size: found -3 phi, expected a mean grain size from -1 "
     "to 9 phi"},
    {"DepthAndShape",
     water +
         "[environment.bottom]\nkind = \"rigid\"\ndepth = 100\nshape = {range=[0], depth=[90]}\n",
     "o.toml:6: environment.bottom.depth: found 100, expected no \"depth\" beside \"shape\", which "
     "says it"},
    {"RangesOutOfOrder",
     water +
         "[environment.bottom]\nkind = \"rigid\"\nshape = {range=[0, 5, 5], depth=[90, 90, 80]}\n",
     "o.toml:6: environment.bottom.shape.range[2]: found 5 m, expected a range above the one "
     "before it, 5 m"},
    {"ThreeNodesTwoMaterials",
     water + "[environment.bottom.shape]\nrange=[0, 5, 6]\ndepth=[90, 90, 80]\n"
             "material = [{kind=\"rigid\"}, {kind=\"rigid\"}]\n",
     "o.toml:7: environment.bottom.shape.material: found an array of 2, expected one for each of "
     "the 3 nodes"},
    {"MaterialOfNoKind",
     water + "[environment.bottom.shape]\nrange=[0]\ndepth=[90]\nmaterial = [{kind=\"sand\"}]\n",
     "o.toml:7: environment.bottom.shape.material[0].kind: found \"sand\", expected \"vacuum\", "
     "\"rigid\", \"fluid\", \"elastic\", \"grain-size\", \"table\" or \"layered\""},
    {"BottomAboveTheSurface",
     water + "[environment.bottom]\nkind = \"rigid\"\nshape = {range=[0, 5], depth=[90, -1]}\n",
     "o.toml:6: environment.bottom.shape: found a depth of -1 m at range 5 m, expected a bottom "
     "below the surface, which is at 0 m there"},
    {"SmoothSpeltWrong",
     water + "[environment.bottom]\nkind = \"rigid\"\n[environment.bottom.shape]\nrange=[0]\n"
             "depth=[90]\ninterpolation = \"smoth\"\n",
     "o.toml:9: environment.bottom.shape.interpolation: found \"smoth\", expected "
     "\"piecewise-linear\", \"smooth\" or \"curvilinear\" (did you mean \"smooth\"?)"},
    {"SectionWithoutARow",
     "[environment.sound_speed]\nkind = \"section\"\nrange = [0, 5]\ndepth = [0, 100]\n"
     "speed = [[1500, 1500]]\n" +
         flat,
     "o.toml:5: environment.sound_speed.speed: found 1 rows, expected a row for each of the 2 "
     "ranges"},
    {"SectionWithAShortRow",
     "[environment.sound_speed]\nkind = \"section\"\nrange = [0, 5]\ndepth = [0, 100]\n"
     "speed = [[1500, 1500], [1500]]\n" +
         flat,
     "o.toml:5: environment.sound_speed.speed[1]: found an array of 1, expected as many numbers as "
     "in the first row, 2"},
    {"SectionBackwards",
     "[environment.sound_speed]\nkind = \"section\"\nrange = [5, 0]\ndepth = [0, 100]\n"
     "speed = [[1500, 1500], [1500, 1500]]\n" +
         flat,
     "o.toml:3: environment.sound_speed.range[1]: found 0 m, expected a range beyond the one "
     "before, 5 m"},
    {"LayerUpsideDown",
     water + flat +
         "[[environment.biology]]\ntop = 50\nbottom = 40\nresonance = 500\n"
         "quality_factor = 4\nstrength_db_per_km = 1\n",
     "o.toml:9: environment.biology[0].bottom: found 40, expected a depth below the layer's top, "
     "50 m"},
    {"TableOfAnglesBackwards",
     water + "[environment.bottom]\ndepth = 100\nkind = \"table\"\ngrazing_deg = [30, 20]\n"
             "magnitude = [1, 1]\n",
     "o.toml:7: environment.bottom.grazing_deg[1]: found 20, expected an angle above the one "
     "before it"},
};
INSTANTIATE_TEST_SUITE_P(ScenarioOcean, OceanFaults, testing::ValuesIn(ocean_faults),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace asdic::detail
