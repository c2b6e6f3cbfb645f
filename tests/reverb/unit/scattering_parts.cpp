// What scatters, out of the settings.
#include "reverb/fields/scattering_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace asdic::detail {
namespace {

/// Surface, bottom, a layer of 120 m and one of two sheets.
ReverberationSettings everything() {
  ReverberationSettings settings;
  settings.bottom = Lambert{};
  settings.volume = {{.top = 100.0, .bottom = 220.0}, {.top = 300.0, .bottom = 340.0, .sheets = 2}};
  return settings;
}

TEST(ScatteringParts, AreTheBoundariesAndTheSheetsOfLayers) {
  const std::vector<ScatteringPart> parts = scattering_parts(everything(), 10.0, 1500.0);
  ASSERT_EQ(parts.size(), 7U);
  EXPECT_EQ(parts[0].level.boundary, BoundaryKind::surface);
  EXPECT_EQ(parts[1].level.boundary, BoundaryKind::bottom);
  // Three sheets of 40 m, then two of 20 m, each about its middle.
  for (int i = 0; i < 3; ++i) {
    EXPECT_DOUBLE_EQ(parts[2 + static_cast<std::size_t>(i)].level.depth, 120.0 + 40.0 * i);
    EXPECT_DOUBLE_EQ(parts[2 + static_cast<std::size_t>(i)].thickness, 40.0);
  }
  EXPECT_DOUBLE_EQ(parts[5].level.depth, 310.0);
  EXPECT_DOUBLE_EQ(parts[6].level.depth, 330.0);
  std::set<std::uint64_t> ids;
  for (const ScatteringPart& part : parts) ids.insert(part.id);
  EXPECT_EQ(ids.size(), parts.size());
}

TEST(ScatteringParts, AreNoneWhereNothingScatters) {
  ReverberationSettings settings = everything();
  settings.enabled = false;
  EXPECT_TRUE(scattering_parts(settings, 10.0, 1500.0).empty());
  settings.enabled = true;
  settings.surface_scatters = false;
  settings.bottom.reset();
  settings.volume.clear();
  EXPECT_TRUE(scattering_parts(settings, 10.0, 1500.0).empty());
}

// Sheets are thinner near source and receiver. The power of a sheet received alone, at the layer's
// edge, goes as the inverse fourth power of the distance; in a narrow beam, whose area grows, as
// the inverse square. Over half a sheet this changes by at most half a decibel. Far away sheets are
// 50 m thick.
TEST(ScatteringParts, AreThinWhereSpreadingChanges) {
  for (const double end : {5.0, 250.0}) {
    const VolumeLayer layer{.top = 100.0, .bottom = 200.0};
    std::vector<double> sheets = sheets_of(layer, {.depths = {end}, .finest = 1.0});
    const double near = end < 100.0 ? 95.0 : 50.0;
    if (end > 200.0) std::reverse(sheets.begin(), sheets.end());
    double from = near;
    for (std::size_t i = 0; i < sheets.size(); ++i) {
      const double off = 20.0 * std::log10(1.0 + 0.5 * sheets[i] / from);
      EXPECT_LT(i == 0 ? 2.0 * off : off, 0.51) << end << " m, sheet " << i;
      from += sheets[i];
    }
    EXPECT_NEAR(from, near + 100.0, 1e-9);
    EXPECT_LT(sheets.size(), 15U);
  }
  const VolumeLayer far{.top = 2000.0, .bottom = 2100.0};
  EXPECT_EQ(sheets_of(far, {.depths = {5.0}, .finest = 1.0}), (std::vector<double>{50.0, 50.0}));
  const VolumeLayer around{.top = 0.0, .bottom = 400.0};
  EXPECT_LE(sheets_of(around, {.depths = {5.0, 60.0}, .finest = 1.0}).size(), 201U);
}

// A sheet of 40 m through a platform lies a tenth of that above or below it then; others stay.
TEST(ScatteringParts, AreMovedAsideFromAPlatform) {
  const auto moved = [](double depth) {
    ScatteringPart sheet = scattering_parts(everything(), 10.0, 1500.0)[2];
    move_aside(sheet, depth);
    return sheet.level.depth;
  };
  EXPECT_DOUBLE_EQ(moved(120.0), 124.0);
  EXPECT_DOUBLE_EQ(moved(121.0), 117.0);
  EXPECT_DOUBLE_EQ(moved(119.0), 123.0);
  EXPECT_DOUBLE_EQ(moved(122.0), 120.0);
  EXPECT_DOUBLE_EQ(moved(118.0), 120.0);
}

}  // namespace
}  // namespace asdic::detail
