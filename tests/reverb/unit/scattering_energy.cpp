#include <gtest/gtest.h>

#include <cmath>

#include "raytrace/ocean/roughness.h"
#include "reverb/scattering/energy.h"
#include "reverb/scattering/models.h"
#include "support/csv.h"

namespace asdic::detail {
namespace {

/// (1/sin θᵢ)∫σ dΩ by the middles of even cells, far more of them.
template <class Law>
double by_cells(const Law& law, double grazing, double frequency, double beyond) {
  constexpr int elevations = 800, bearings = 1600;
  double sum = 0.0;
  for (int i = 0; i < elevations; ++i) {
    const double out = 0.5 * pi * (i + 0.5) / elevations;
    double ring = 0.0;
    for (int j = 0; j < bearings; ++j) {
      const double turn = pi * (j + 0.5) / bearings;
      const double off =
          std::acos(std::min(1.0, std::sin(grazing) * std::sin(out) +
                                      std::cos(grazing) * std::cos(out) * std::cos(turn)));
      if (off >= beyond) ring += law.cross_section({grazing, out, turn}, frequency);
    }
    sum += ring * std::cos(out);
  }
  return 2.0 * sum * (0.5 * pi / elevations) * (pi / bearings) / std::sin(grazing);
}

TEST(ScatteredShare, OfLambertIsPiMu) {
  for (const double grazing : {0.02, 0.3, 1.5})
    EXPECT_NEAR(scattered_share(Lambert{}, grazing, 1000.0), pi * std::pow(10.0, -2.7), 1e-9);
}

// The cap of the interface's peak has an edge: a hundredth of what comes in is asked for.
TEST(ScatteredShare, OfTheNrlLawByPlainCells) {
  for (const double wind : {5.0, 15.0})
    for (const double grazing_deg : {3.0, 10.0, 20.0}) {
      const NrlSurface law{.wind_speed = wind};
      const double grazing = radians(grazing_deg);
      for (const double beyond : {0.0, forward_lobe})
        EXPECT_NEAR(scattered_share(law, grazing, 3500.0, beyond),
                    by_cells(law, grazing, 3500.0, beyond), 0.01)
            << wind << ' ' << grazing_deg << ' ' << beyond;
    }
}

// Where the sound goes that a sea scatters, by the small-slope approximation (an independent
// program: tests/reverb/data/surface-lobe/lobe.py), 1 to 20 kHz, 2 to 20°, 5 to 15 m/s. All but 2 %
// of what comes in stays within the forward lobe; a lobe of 10° would lose nearly half of what is
// scattered. What the NRL law takes beyond it leaves the path within 0.5 dB of what is there: most
// in 15 m/s at 20°.
TEST(ScatteredShare, TheForwardLobeHoldsWhatASeaScattersForward) {
  const support::Csv csv("surface-lobe/lobe.csv");
  ASSERT_EQ(csv.rows(), 48U);
  EXPECT_DOUBLE_EQ(degrees(forward_lobe), 30.0);
  double least_10 = 1.0, worst_db = 0.0;
  for (std::size_t i = 0; i < csv.rows(); ++i) {
    const double share = std::min(csv["scattered"][i], 1.0 - std::exp(-csv["rayleigh_squared"][i]));
    EXPECT_LT(share * (1.0 - csv["within_30"][i]), 0.02) << i;
    if (share > 0.05) {
      EXPECT_GT(csv["within_30"][i], 0.94) << i;
      least_10 = std::min(least_10, csv["within_10"][i]);
    }
    const NrlSurface law{.wind_speed = csv["wind_mps"][i]};
    const double elsewhere =
        scattered_share(law, radians(csv["grazing_deg"][i]), csv["f_Hz"][i], forward_lobe);
    const double kept = 1.0 - share * (1.0 - csv["within_30"][i]);
    worst_db = std::max(worst_db, std::abs(10.0 * std::log10((1.0 - elsewhere) / kept)));
  }
  EXPECT_LT(least_10, 0.6);
  EXPECT_LT(worst_db, 0.5);
}

// The law sends most of what it scatters about the mirrored direction, where it was not measured:
// two thirds of all that comes in at 10 m/s, and beyond that lobe a few hundredths.
TEST(ScatteredShare, OfTheNrlLawIsForward) {
  const NrlSurface law{.wind_speed = 10.0};
  EXPECT_NEAR(scattered_share(law, radians(10.0), 3500.0), 0.67, 0.02);
  EXPECT_LT(scattered_share(law, radians(10.0), 3500.0, forward_lobe), 0.1);
}

// Coherent, forward, elsewhere and absorbed, by every surface law, 1 to 20 kHz, 2 to 20°, 5 to
// 15 m/s: 1 within 0.02, wherever law and mean field do not exceed 1 by themselves.
TEST(ScatteredShare, LeavesABalanceOfOne) {
  int balanced = 0;
  for (const double wind : {5.0, 10.0, 15.0})
    for (AnySurfaceScattering law :
         {AnySurfaceScattering{NrlSurface{}}, AnySurfaceScattering{ChapmanHarris{}},
          AnySurfaceScattering{OgdenErskine{}}}) {
      set_sea(law, wind, 1500.0);
      Roughness sea{.rms_height = pierson_moskowitz_height(wind),
                    .sea_wind = wind,
                    .bubble_wind = wind,
                    .floor_db = -300.0};
      sea.elsewhere = scattered_elsewhere(law, 1000.0, 20000.0, 1500.0);
      for (const double frequency : {1000.0, 3500.0, 20000.0})
        for (const double grazing_deg : {2.0, 5.0, 10.0, 20.0}) {
          const double grazing = radians(grazing_deg), k = 2.0 * pi * frequency / 1500.0;
          const double elsewhere = std::visit(
              [&](const auto& model) {
                return scattered_share(model, grazing, frequency, forward_lobe);
              },
              law);
          const RoughReflection left = rough_reflection(sea, std::sin(grazing), k);
          const double bubbles =
              std::pow(10.0, -0.1 * bubble_loss_db(wind, std::sin(grazing), frequency));
          const double along = left.energy / bubbles;  // coherent and forward, of what is left
          EXPECT_GE(along, left.coherent * left.coherent / bubbles - 1e-12);
          const double mean = std::exp(-scattering_exponent(sea, std::sin(grazing), k));
          if (mean + elsewhere > 1.0) continue;
          ++balanced;
          EXPECT_NEAR(along + elsewhere, 1.0, 0.02)
              << name_of(law) << ' ' << wind << ' ' << frequency << ' ' << grazing_deg;
        }
    }
  EXPECT_GE(balanced, 60);
}

}  // namespace
}  // namespace asdic::detail
