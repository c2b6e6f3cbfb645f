#include <gtest/gtest.h>

#include <cmath>

#include "raytrace/ocean/seawater.h"
#include "support/csv.h"

namespace asdic::detail {
namespace {

constexpr double bar = 1e5;

// Mackenzie's own check value, JASA 70, 807 (1981), printed to 1 mm/s.
TEST(Seawater, MackenzieCheckValue) {
  EXPECT_NEAR(sound_speed_mackenzie(25.0, 35.0, 1000.0), 1550.744, 5e-4);
}

// The UNESCO check value (40 °C, 40 psu, 1000 bar) by the 1990 scale, to 1 mm/s, where the last
// digit of the coefficients is worth as much. The coefficients of 1977 would give 1731.995 here.
TEST(Seawater, ChenMilleroCheckValue) {
  EXPECT_NEAR(sound_speed_chen_millero(40.0, 40.0, 1000.0 * bar), 1732.018, 1e-3);
}

// Wong & Zhu (1995), Tables III and IV, printed to 1 mm/s; their rounding of kg/cm² (1.019716 per
// bar) is worth 4e-5 m/s at 1000 bar.
TEST(Seawater, WongAndZhuTables) {
  const support::Csv csv("wong_zhu_1995.csv");
  int compared = 0;
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const bool chen_millero = csv.text("equation")[row] == name(SeawaterEquation::chen_millero);
    const auto law = chen_millero ? sound_speed_chen_millero : sound_speed_del_grosso;
    const double c = law(csv["T_degC"][row], csv["S_psu"][row], csv["gauge_bar"][row] * bar);
    EXPECT_NEAR(c, csv["c"][row], 5.5e-4) << "row " << row;
    ++compared;
  }
  EXPECT_EQ(compared, 34);
}

// Ten significant digits are printed: 5e-7 m/s.
TEST(Seawater, PhysicsReference) {
  const support::Csv csv("physics-reference/sound_speed.csv");
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const double t = csv["T_degC"][row], s = csv["S_psu"][row];
    EXPECT_NEAR(sound_speed_mackenzie(t, s, csv["depth_m"][row]), csv["c_mackenzie"][row], 6e-7);
    EXPECT_NEAR(sound_speed_chen_millero(t, s, csv["gauge_bar"][row] * bar),
                csv["c_chen_millero_its90"][row], 6e-7);
  }
}

// UNESCO's check value of depth from pressure: 10 000 dbar at 30° in the standard ocean is
// 9712.653 m (Fofonoff & Millard, UNESCO Tech. Pap. Mar. Sci. 44, 1983). An independent formula;
// 1 kPa is 0.1 m.
TEST(Seawater, PressureOfTheStandardOcean) {
  EXPECT_NEAR(gauge_pressure_standard_ocean(9712.653, 30.0), 1e8, 1e3);
}

// The same law by hand for 1000 m at 45°: 10.0818 + 0.02465 − 0.000125 + 2.8e-7 MPa, times
// k = 9.80622/9.80612, which is not quite 1 (1e-5, 100 Pa); the common oceans take off
// 0.0090909 + 0.0062 MPa.
TEST(Seawater, PressureByHand) {
  const double standard = 10.1064263e6;
  EXPECT_NEAR(gauge_pressure_standard_ocean(1000.0, 45.0), standard, 1.0);
  EXPECT_NEAR(gauge_pressure(1000.0, 45.0), standard - 15290.9, 1.0);
  EXPECT_EQ(gauge_pressure(0.0, 45.0), 0.0);
  EXPECT_EQ(gauge_pressure(-3.0, 45.0), 0.0);
}

// Three fits to three sets of measurements, in water that the sea holds: they differ by less than
// 1 m/s (Dushaw et al., JASA 93, 255 (1993)), though not by nothing.
TEST(Seawater, TheEquationsAgreeWhereTheSeaIs) {
  struct Water {
    double temperature, salinity, depth;
  };
  for (const Water& w : {Water{25.0, 35.5, 0.0}, Water{18.0, 36.0, 200.0}, Water{10.0, 35.0, 700.0},
                         Water{4.0, 34.8, 2000.0}, Water{2.0, 34.7, 4000.0},
                         Water{2.0, 34.7, 5500.0}, Water{13.5, 38.4, 2500.0}}) {
    const auto c = [&](SeawaterEquation equation) {
      return sound_speed(equation, w.temperature, w.salinity, w.depth, 45.0);
    };
    const double chen_millero = c(SeawaterEquation::chen_millero);
    EXPECT_NEAR(c(SeawaterEquation::del_grosso), chen_millero, 1.0) << w.depth;
    EXPECT_NEAR(c(SeawaterEquation::mackenzie), chen_millero, 1.0) << w.depth;
  }
}

TEST(Seawater, DepthOfAPressureIsTheInverse) {
  for (const double latitude : {0.0, 30.0, -60.0})
    for (const double depth : {0.5, 10.0, 100.0, 1000.0, 5000.0, 11000.0})
      EXPECT_NEAR(depth_at_pressure(gauge_pressure(depth, latitude), latitude), depth, 1e-6);
  EXPECT_EQ(depth_at_pressure(-1e4, 30.0), 0.0);
}

// UNESCO Techn. Papers in Marine Science 44 (1983): the potential temperature of S = 40,
// T = 40 degC at 10 000 dbar is 36.89073 degC, both on IPTS-68. Their one step of Runge and Kutta's
// over all of the pressure is off by 4e-5.
TEST(Seawater, TemperatureInSituOfThePotentialOne) {
  constexpr double t68 = 1.00024;
  EXPECT_NEAR(temperature_in_situ(36.89073 / t68, 40.0, 1e8) * t68, 40.0, 1e-4);
  EXPECT_EQ(temperature_in_situ(5.0, 35.0, 0.0), 5.0);
}

// Check values of TEOS-10's functions of conservative and potential temperature
// (www.teos-10.org, gsw_CT_from_pt).
TEST(Seawater, PotentialTemperatureOfTheConservativeOne) {
  const double salinity[] = {34.7118, 34.8915, 35.0256, 34.8472, 34.7366, 34.7324};
  const double conservative[] = {28.809923015982083, 28.439144260767169, 22.786246608464264,
                                 10.226165605435785, 6.827183417643142,  4.323565182322069};
  const double potential[] = {28.7832, 28.4209, 22.7850, 10.2305, 6.8292, 4.3245};
  for (int i = 0; i < 6; ++i)
    EXPECT_NEAR(potential_temperature(conservative[i], salinity[i]), potential[i], 1e-9);
  EXPECT_NEAR(practical_salinity(35.16504), 35.0, 1e-12);
}

}  // namespace
}  // namespace asdic::detail
