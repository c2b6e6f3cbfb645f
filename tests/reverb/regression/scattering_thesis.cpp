#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "core/units.h"
#include "reverb/scattering/models.h"
#include "support/csv.h"

namespace asdic::detail {
namespace {

double strength(double wind, double grazing_deg) {
  const ScatterGeometry g = {.grazing_in = radians(grazing_deg),
                             .grazing_out = radians(grazing_deg)};
  return db_from_power(NrlSurface{.wind_speed = wind}.cross_section(g, 4000.0));
}

/// "7-12" or "-61..-53"
std::pair<double, double> range_of(const std::string& text, const std::string& separator) {
  const auto at = text.find(separator, 1);
  return {std::stod(text.substr(0, at)), std::stod(text.substr(at + separator.size()))};
}

// Danesh (MIT 2013), Tables 5.3 and 5.4. A_s was inferred from these very tables, so this guards
// the transcription of the law, not its physics. The thesis prints integers, truncated toward 0:
// ±1.5 dB at the stated ends of the grazing angles. Its `expected` column was read off plots of
// another frequency: ±3.5 dB anywhere in the range.
TEST(NrlSurface, ThesisTables) {
  const support::Csv csv("physics-reference/thesis_scattering_tables.csv");
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const double wind = csv["U_mps"][row];
    const auto [low, high] = range_of(csv.text("grazing_deg")[row], "-");
    const auto [faintest, loudest] = range_of(csv.text("simulated_dB")[row], "..");
    EXPECT_NEAR(strength(wind, low), faintest, 1.5) << row;
    EXPECT_NEAR(strength(wind, high), loudest, 1.5) << row;

    const double expected = csv["expected_dB"][row];
    EXPECT_GT(expected, strength(wind, low) - 3.5) << row;
    EXPECT_LT(expected, strength(wind, high) + 3.5) << row;

    // The same law by an independent program, printed to 0.01 dB.
    EXPECT_NEAR(strength(wind, low), csv["oracle_at_low"][row], 0.0051) << row;
    EXPECT_NEAR(strength(wind, high), csv["oracle_at_high"][row], 0.0051) << row;
  }
}

}  // namespace
}  // namespace asdic::detail
