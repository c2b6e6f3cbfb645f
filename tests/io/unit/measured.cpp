#include "io/text/measured.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/scenario/scenario_reader.h"
#include "support/plain_sea.h"

// --set takes units: target.0.range=25km

namespace asdic::detail {
namespace {

Scenario with(const std::string& assignment) {
  const std::vector<std::string> overrides{assignment};
  return parse_scenario(support::plain_sea, "s.toml", overrides);
}

std::string fault(const std::string& assignment) {
  try {
    static_cast<void>(with(assignment));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no fault";
}

TEST(Measured, NumbersWithUnitsAreReadInSi) {
  for (const auto& [text, value, unit] : {std::tuple{"25km", 25000.0, "m"},
                                          {"25 km", 25000.0, "m"},
                                          {"-3dB", -3.0, "dB"},
                                          {"1.5kHz", 1500.0, "Hz"},
                                          {"250ms", 0.25, "s"},
                                          {"36km/h", 10.0, "m/s"},
                                          {"1e3m", 1000.0, "m"},
                                          {"12deg", 12.0, "degrees"},
                                          {"12 degrees_north", 12.0, "degrees"},
                                          {"5000 ft/s", 1524.0, "m/s"},
                                          {"3 metres", 3.0, "m"},
                                          {"3 m s-1", 3.0, "m/s"},
                                          {"273.15 K", 0.0, "degC"}}) {
    const auto read = parse_measured(text);
    ASSERT_TRUE(read) << text;
    EXPECT_DOUBLE_EQ(read->value, value) << text;
    EXPECT_EQ(read->unit, unit) << text;
  }
  for (const char* text : {"25", "km", "25 furlong", "25kmh", "", "nan km", "25  km"})
    EXPECT_FALSE(parse_measured(text)) << text;
}

TEST(Measured, OverridesTakeThem) {
  EXPECT_EQ(with("environment.bottom.depth=2km").environment.bottom.depth, 2000.0);
  EXPECT_EQ(std::get<Cw>(with("pulse.frequency=1.2kHz").pulse.waveform).frequency, 1200.0);
  EXPECT_EQ(with("pulse.duration=200ms").pulse.duration, 0.2);
  EXPECT_EQ(with("target.0.strength_db=12dB").targets[0].strength_db, 12.0);
  EXPECT_NEAR(with("environment.wind_speed=10kn").wind_speed, 5.144444, 1e-6);
  EXPECT_EQ(with("title=5km").title, "5km");  // words stay words
}

TEST(Measured, AWrongUnitIsRefused) {
  EXPECT_EQ(fault("pulse.duration=2km").substr(0, 49),
            "--set pulse.duration: found \"2km\", expected a dur");
  EXPECT_THAT(fault("environment.bottom.depth=-2km"),
              testing::HasSubstr("found \"-2km\", expected"));
  EXPECT_THAT(fault("seed=3m"), testing::HasSubstr("found \"3m\", expected a whole number"));
  EXPECT_THAT(fault("environment.bottom.depth=2furlong"),
              testing::HasSubstr("found \"2furlong\", expected"));
}

}  // namespace
}  // namespace asdic::detail
