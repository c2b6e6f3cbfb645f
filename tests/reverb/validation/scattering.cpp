#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "reverb/scattering/models.h"
#include "support/csv.h"

namespace asdic::detail {
namespace {

constexpr double none = -999.0;     // the tables' "no contribution"
constexpr double printed = 5.1e-8;  // dB; half a unit in the tenth digit of numbers up to 110
// The table took a knot as 0.514444 m/s, 9e-7 too little: b, as v^−0.58, shifts by 5e-7, and S_s by
// that times |3.3·b·log₁₀(θ/30°)| + 18.4 < 80 dB.
constexpr double knot = 4e-5;

double strength(double sigma) { return sigma > 0.0 ? db_from_power(sigma) : none; }

ScatterGeometry backscatter(double grazing_deg) {
  return {.grazing_in = radians(grazing_deg), .grazing_out = radians(grazing_deg)};
}

// The laws computed by an independent program, c = 1500 m/s and the default parameters.
TEST(SurfaceScattering, MonostaticReference) {
  const support::Csv csv("physics-reference/surface_scattering.csv");
  int ogden_erskine_rows = 0;
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const double f = csv["f_Hz"][row], wind = csv["U_mps"][row];
    const ScatterGeometry g = backscatter(csv["grazing_deg"][row]);
    const NrlSurface nrl = {.wind_speed = wind};
    EXPECT_NEAR(NrlSurface::bubble_depth(wind), csv["efold_m"][row], 1e-9) << row;
    EXPECT_NEAR(strength(nrl.interface_cross_section(g, f)), csv["sigma_int_dB"][row], printed);
    EXPECT_NEAR(strength(nrl.bubble_cross_section(g, f)), csv["sigma_bub_dB"][row], printed) << row;
    EXPECT_NEAR(strength(nrl.cross_section(g, f)), csv["Ss_dB"][row], printed) << row;
    EXPECT_NEAR(strength(ChapmanHarris{.wind_speed = wind}.cross_section(g, f)),
                csv["Ss_chapman_harris_dB"][row], knot)
        << row;
    const double blend = csv["Ss_ogden_erskine_dB"][row];
    if (std::isnan(blend)) continue;  // the table stops at 1 kHz, where that law does
    ++ogden_erskine_rows;
    EXPECT_NEAR(strength(OgdenErskine{.wind_speed = wind}.cross_section(g, f)), blend, knot);
  }
  EXPECT_EQ(ogden_erskine_rows, 60);
}

TEST(SurfaceScattering, BistaticReference) {
  const support::Csv csv("physics-reference/surface_scattering_bistatic.csv");
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const double f = csv["f_Hz"][row];
    const ScatterGeometry g = {.grazing_in = radians(csv["grazing_in_deg"][row]),
                               .grazing_out = radians(csv["grazing_out_deg"][row]),
                               .azimuth = radians(csv["azimuth_deg"][row])};
    const NrlSurface nrl = {.wind_speed = csv["U_mps"][row]};
    EXPECT_NEAR(strength(nrl.interface_cross_section(g, f)), csv["sigma_int_dB"][row], printed);
    EXPECT_NEAR(strength(nrl.bubble_cross_section(g, f)), csv["sigma_bub_dB"][row], printed);
    EXPECT_NEAR(strength(nrl.cross_section(g, f)), csv["Ss_dB"][row], printed);
  }
}

// Chapman & Harris, JASA 34, 1592 (1962), evaluated by hand at 10 kn, 10°, 100 Hz: −76.50 dB.
TEST(SurfaceScattering, ChapmanHarrisByHand) {
  const double wind = 10.0 * 0.514444444444444;
  EXPECT_NEAR(ChapmanHarris::strength_db(radians(10.0), wind, 100.0), -76.50, 0.005);
}

// The empirical law is independent evidence for the NRL law, whose interface strength was inferred
// from a thesis. Where both claim to hold and bubbles matter (10–15 m/s, 10–40°, 1–4 kHz) they
// agree within 3 dB in the mean; single points within 7.5 dB (Chapman–Harris rises with frequency,
// bubbles do not). A sea without bubbles, the wrong model, fails.
TEST(SurfaceScattering, NrlAgreesWithChapmanHarris) {
  double mean = 0.0, worst = 0.0, mean_without_bubbles = 0.0;
  int n = 0;
  for (const double f : {1000.0, 2000.0, 4000.0})
    for (const double wind : {10.0, 12.5, 15.0})
      for (double grazing = 10.0; grazing <= 40.0; grazing += 5.0) {
        const ScatterGeometry g = backscatter(grazing);
        const NrlSurface nrl = {.wind_speed = wind};
        const double measured = strength(ChapmanHarris{.wind_speed = wind}.cross_section(g, f));
        const double difference = strength(nrl.cross_section(g, f)) - measured;
        mean += difference;
        mean_without_bubbles += strength(nrl.interface_cross_section(g, f)) - measured;
        worst = std::max(worst, std::abs(difference));
        ++n;
      }
  EXPECT_LT(std::abs(mean / n), 3.0);
  EXPECT_LT(worst, 7.5);
  EXPECT_LT(mean_without_bubbles / n, -3.0);
}

// F is what a layer of incoherent scatterers, thinning as e^{−z/d}, gives under a pressure-release
// lid: F = (4/d)·∫₀^∞ e^{−2z/d} sin²(pz/d) sin²(qz/d) dz. Simpson's rule on 0..20d with 20 000
// steps errs by 1e-12 here (p, q ≤ 30 radians per d: 33 points per period of the fastest term).
TEST(SurfaceScattering, BubbleTermIsALayerUnderALid) {
  const NrlSurface sea = {.wind_speed = 12.0};
  const double d = NrlSurface::bubble_depth(sea.wind_speed), f = 4000.0;
  const double k = 2.0 * pi * f / sea.sound_speed;
  for (const double in : {0.05, 0.3, 1.2})
    for (const double out : {0.05, 0.4, 1.5}) {
      const double p = k * d * std::sin(in), q = k * d * std::sin(out);
      constexpr int steps = 20'000;
      const double h = 20.0 / steps;
      double integral = 0.0;
      for (int i = 0; i <= steps; ++i) {
        const double z = i * h, sp = std::sin(p * z), sq = std::sin(q * z);
        const double weight = i == 0 || i == steps ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
        integral += weight * h / 3.0 * std::exp(-2.0 * z) * sp * sp * sq * sq;
      }
      const double layer = 0.0019 * std::pow(d, 1.15) * std::pow(k, -0.6) * 4.0 * integral;
      const double sigma = sea.bubble_cross_section({.grazing_in = in, .grazing_out = out}, f);
      EXPECT_NEAR(sigma, layer, 1e-9 * layer) << in << ' ' << out;
    }
}

}  // namespace
}  // namespace asdic::detail
