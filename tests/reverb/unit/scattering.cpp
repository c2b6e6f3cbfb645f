#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"
#include "reverb/scattering/models.h"

namespace asdic::detail {
namespace {

// Table 4.2's pieces: 0 at 3 m/s exactly, and 0.292635 against 0.292625 m at 7.5 m/s.
TEST(NrlSurface, BubbleLayerIsContinuous) {
  EXPECT_EQ(NrlSurface::bubble_depth(0.0), 0.0);
  EXPECT_EQ(NrlSurface::bubble_depth(3.0), 0.0);
  EXPECT_NEAR(NrlSurface::bubble_depth(3.0 + 1e-9), 0.0, 1e-9);
  EXPECT_NEAR(NrlSurface::bubble_depth(7.5), 0.292635, 1e-12);
  EXPECT_NEAR(NrlSurface::bubble_depth(7.5 + 1e-9), 0.292625, 1e-9);
  EXPECT_NEAR(NrlSurface::bubble_depth(20.0), 2.577, 1e-12);
}

// kd sin θ ≪ 1: 0.0057·d^5.15·k^3.4·sin⁴θ, to a relative 5(kd sin θ)²; and ≫ 1:
// 0.001425·d^1.15·k^−0.6 at any angle, to 1.25/(kd sin θ)².
TEST(NrlSurface, AsymptotesOfTheBubbleTerm) {
  const NrlSurface sea = {.wind_speed = 10.0};
  const double d = NrlSurface::bubble_depth(10.0);
  const auto sigma = [&](double grazing, double f) {
    return sea.bubble_cross_section({.grazing_in = grazing, .grazing_out = grazing}, f);
  };
  const double k_low = 2.0 * pi * 10.0 / 1500.0, sine = std::sin(0.01);
  const double rayleigh = 0.0057 * std::pow(d, 5.15) * std::pow(k_low, 3.4) * std::pow(sine, 4);
  EXPECT_NEAR(sigma(0.01, 10.0), rayleigh, 1e-6 * rayleigh);
  const double k_high = 2.0 * pi * 1e6 / 1500.0;
  const double saturated = 0.001425 * std::pow(d, 1.15) * std::pow(k_high, -0.6);
  EXPECT_NEAR(sigma(0.5, 1e6), saturated, 1e-5 * saturated);
  EXPECT_NEAR(sigma(1.5, 1e6), saturated, 1e-5 * saturated);
}

// At small p, q the sum of fractions would cancel: F ~ 3p²q² must survive to 1e-12 and below.
TEST(NrlSurface, BubbleTermSurvivesSmallArguments) {
  const NrlSurface sea = {.wind_speed = 3.01};
  const ScatterGeometry g = {.grazing_in = 1e-3, .grazing_out = 1e-3};
  const double one = sea.bubble_cross_section(g, 100.0);
  const double two = sea.bubble_cross_section(g, 200.0);
  EXPECT_NEAR(two / one, std::pow(2.0, 3.4), 1e-6);
}

// The interface term is capped where perturbation theory ends: at the vertical and at specular.
TEST(NrlSurface, InterfaceIsCapped) {
  const NrlSurface sea;
  EXPECT_EQ(sea.interface_cross_section({.grazing_in = pi / 2, .grazing_out = pi / 2}, 4e3), 1.0);
  EXPECT_EQ(
      sea.interface_cross_section({.grazing_in = 0.3, .grazing_out = 0.3, .azimuth = 0.0}, 4e3),
      1.0);
}

// Without roughness there is no interface term, not even where Q = 0.
TEST(NrlSurface, NoRoughnessNoInterface) {
  const NrlSurface sea = {.A_s = 0.0};
  EXPECT_EQ(
      sea.interface_cross_section({.grazing_in = 0.3, .grazing_out = 0.3, .azimuth = 0.0}, 4e3),
      0.0);
}

// Above 30° the printed law rises without limit as the wind dies (b → ∞: at 0.1 m/s, 60°, 1 kHz it
// would say +23 dB). Ours never rises as the wind falls.
TEST(ChapmanHarris, LightAirsDoNotRoar) {
  double before = -1e9;
  for (double wind = 0.01; wind < 15.0; wind *= 1.1) {
    const double s = ChapmanHarris::strength_db(radians(60.0), wind, 1000.0);
    EXPECT_GE(s, before - 1e-12);
    EXPECT_LT(s, 0.0);
    before = s;
  }
}

// Ogden & Erskine hand over from the interface to Chapman–Harris between U_p and U_c: at 500 Hz
// 7.22 m/s and 20.14 − 17 + 9.1 − 1.6625 = 10.5775 m/s.
TEST(OgdenErskine, HandsOver) {
  const double g = radians(20.0), f = 500.0;
  const auto s = [&](double wind) { return OgdenErskine::strength_db(g, wind, f); };
  EXPECT_EQ(s(7.0), OgdenErskine::interface_db(g, 7.0, f));
  EXPECT_EQ(s(10.6), ChapmanHarris::strength_db(g, 10.6, f));
  const double middle = 0.5 * (7.22 + 10.5775);
  EXPECT_NEAR(
      s(middle),
      0.5 * (OgdenErskine::interface_db(g, middle, f) + ChapmanHarris::strength_db(g, middle, f)),
      1e-10);
}

TEST(AnySurfaceScattering, HelpersReachTheModelInside) {
  AnySurfaceScattering any = NrlSurface{};
  EXPECT_EQ(name_of(any), "nrl");
  set_sea(any, 15.0, 1540.0);
  EXPECT_EQ(std::get<NrlSurface>(any).wind_speed, 15.0);
  EXPECT_EQ(std::get<NrlSurface>(any).sound_speed, 1540.0);
  const ScatterGeometry g = {.grazing_in = 0.2, .grazing_out = 0.3};
  EXPECT_EQ(scattering_cross_section(any, g, 4000.0),
            std::get<NrlSurface>(any).cross_section(g, 4000.0));
}

}  // namespace
}  // namespace asdic::detail
