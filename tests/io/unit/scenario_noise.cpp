#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "io/scenario/scenario_reader.h"

namespace asdic::detail {
namespace {

const std::string ocean_and_sonar = R"([environment]
wind_speed = 5
[environment.sound_speed]
kind = "isovelocity"
speed = 1500.0
[environment.bottom]
depth = 5000.0
kind = "rigid"
[platform]
position = [0.0, 0.0, 100.0]
[transmitter]
source_level_db = 220.0
taper = "omnidirectional"
[pulse]
kind = "cw"
frequency = 1000.0
duration = 0.1
[array]
kind = "horizontal"
phones = 4
spacing = 0.5
[pings]
recording_duration = 1
sample_rate = 8000
)";

NoiseSettings noise_of(const std::string& table) {
  return parse_scenario(ocean_and_sonar + "[noise]\n" + table, "s.toml").noise;
}

InputFault fault_of(const std::string& table) {
  try {
    static_cast<void>(noise_of(table));
  } catch (const InputError& error) {
    return error.fault();
  }
  return {};
}

TEST(ScenarioNoise, AsBeforeWithoutAKind) {
  EXPECT_FALSE(noise_of("").any());
  const NoiseSettings noise = noise_of("spectral_level_db = 40");
  EXPECT_TRUE(noise.plain());
  EXPECT_EQ(noise.flat_level_db(), 40.0);
}

TEST(ScenarioNoise, SpectraAndTheirDefaults) {
  const NoiseSettings wenz = noise_of("kind = \"wenz\"\nshipping = 0.2");
  EXPECT_EQ(std::get<WenzNoise>(*wenz.law).shipping, 0.2);
  EXPECT_EQ(std::get<WenzNoise>(*wenz.law).wind_speed, 5.0) << "that of the environment";
  EXPECT_TRUE(wenz.thermal);
  const NoiseSettings knudsen = noise_of("kind = \"knudsen\"\nsea_state = 2.5\nthermal = true");
  EXPECT_EQ(std::get<KnudsenNoise>(*knudsen.law).sea_state, 2.5);
  EXPECT_TRUE(knudsen.thermal);
  const NoiseSettings table =
      noise_of("kind = \"table\"\nfrequency = [10, 100]\nlevel_db = [90, 70]");
  EXPECT_EQ(std::get<NoiseTable>(*table.law).level_db[1], 70.0);
  EXPECT_FALSE(table.thermal);
}

TEST(ScenarioNoise, Coherence) {
  EXPECT_EQ(noise_of("spectral_level_db = 40\ncoherence = \"isotropic\"").coherence,
            NoiseCoherence::isotropic);
  const NoiseSettings sheet =
      noise_of("kind = \"wenz\"\ncoherence = \"surface\"\ndipole_exponent = 2");
  EXPECT_EQ(sheet.coherence, NoiseCoherence::surface);
  EXPECT_EQ(sheet.directions.dipole_exponent, 2.0);
  const NoiseSettings profile = noise_of(
      "kind = \"wenz\"\ncoherence = \"profile\"\n[noise.profile]\nelevation_deg = [-90, 0, "
      "90]\nlevel_db = [-10, 0, -3]");
  EXPECT_EQ(profile.directions.elevation.size(), 3U);
  EXPECT_DOUBLE_EQ(profile.directions.elevation[2], radians(90.0));
}

TEST(ScenarioNoise, SaysWhatIsWrong) {
  const auto expect = [](const std::string& table, const std::string& where,
                         const std::string& expected) {
    const InputFault fault = fault_of(table);
    EXPECT_NE(fault.where.find(where), std::string::npos) << table << ": " << fault.where;
    EXPECT_NE(fault.expected.find(expected), std::string::npos) << table << ": " << fault.expected;
  };
  expect("kind = \"pink\"", "noise.kind", "wenz");
  expect("kind = \"white\"", "noise.spectral_level_db", "level");
  expect("coherence = \"isotropic\"", "noise.spectral_level_db", "level");
  expect("kind = \"wenz\"\nshipping = 2", "noise.shipping", "1");
  expect("kind = \"wenz\"\nspectral_level_db = 40", "noise.spectral_level_db", "kind");
  expect("kind = \"knudsen\"\nsea_state = 7", "noise.sea_state", "6");
  expect("kind = \"knudsen\"\nsea_state = 1\nwind_speed = 3", "noise.sea_state", "wind_speed");
  expect("kind = \"table\"\nfrequency = [100, 10]\nlevel_db = [1, 2]", "noise.frequency[1]",
         "above the one before it");
  expect("kind = \"table\"\nfrequency = [10, 100]\nlevel_db = [1]", "noise.level_db",
         "as many values");
  expect("kind = \"wenz\"\ncoherence = \"diffuse\"", "noise.coherence", "isotropic");
  expect("kind = \"wenz\"\ncoherence = \"surface\"\ndipole_exponent = 0", "noise.dipole_exponent",
         "exponent");
  expect(
      "kind = \"wenz\"\ncoherence = \"profile\"\n[noise.profile]\nelevation_deg = [0, -5]\n"
      "level_db = [1, 2]",
      "noise.profile.elevation_deg[1]", "above the one before it");
}

TEST(ScenarioInterferer, ShipsAndTheirFaults) {
  const auto read = [](const std::string& ship) {
    return parse_scenario(ocean_and_sonar + "[[interferer]]\n" + ship, "s.toml").interferers;
  };
  const auto ships = read(
      "name = \"tanker\"\nposition = [0, 5000, 6]\nvelocity = [7, 0, 0]\nlevel_db = 145\n"
      "tonal = [{ frequency = 60, level_db = 160 }]");
  ASSERT_EQ(ships.size(), 1U);
  EXPECT_EQ(ships[0].level_db, 145.0);
  EXPECT_EQ(ships[0].slope_db_per_decade, -20.0);
  EXPECT_EQ(ships[0].tonals[0].level_db, 160.0);
  const auto expect = [&](const std::string& ship, const std::string& where,
                          const std::string& expected) {
    try {
      static_cast<void>(read(ship));
      ADD_FAILURE() << ship;
    } catch (const InputError& error) {
      EXPECT_NE(error.fault().where.find(where), std::string::npos) << error.fault().where;
      EXPECT_NE(error.fault().expected.find(expected), std::string::npos) << error.fault().expected;
    }
  };
  expect("position = [0, 0, 6]", "interferer[0].level_db", "a level, a spectrum or a tonal");
  expect("level_db = 145", "interferer[0].position", "[");
  expect("position = [0, 0, 6000]\nlevel_db = 145", "interferer[0].position",
         "between the surface");
  expect("position = [0, 0, 6]\nlevel_db = 145\nspectrum = { frequency = [10], level_db = [9] }",
         "interferer[0].level_db", "spectrum");
  expect("position = [0, 0, 6]\ntonal = [{ frequency = -1, level_db = 1 }]", "tonal[0].frequency",
         "frequency");
}

TEST(ScenarioRoughness, OfASurfaceByHeightOrByWind) {
  const auto read = [](const std::string& surface) {
    return parse_scenario(ocean_and_sonar + "[environment.surface]\n" + surface, "s.toml")
        .environment.surface.roughness;
  };
  EXPECT_TRUE(read("").smooth());
  EXPECT_EQ(read("roughness = 0.3").rms_height, 0.3);
  EXPECT_EQ(read("roughness = 0.3\nroughness_floor_db = -10").floor_db, -10.0);
  EXPECT_EQ(read("roughness = \"wind\"").rms_height, pierson_moskowitz_height(5.0));
  EXPECT_EQ(read("roughness = \"wind\"").sea_wind, 5.0);
  EXPECT_EQ(read("roughness = 0.3").sea_wind, 0.0);
  EXPECT_EQ(read("bubbles = \"apl-uw\"").bubble_wind, 5.0);
  EXPECT_EQ(read("roughness = 0.3\nroughness_wind = 7").sea_wind, 7.0);
  for (const std::string wrong :
       {"bubbles = \"foam\"", "roughness_wind = 3", "roughness = -1", "roughness = \"rain\"",
        "roughness = 1\nroughness_floor_db = 3", "roughness_floor_db = -3"}) {
    EXPECT_THROW(static_cast<void>(read(wrong)), InputError) << wrong;
  }
}

}  // namespace
}  // namespace asdic::detail
