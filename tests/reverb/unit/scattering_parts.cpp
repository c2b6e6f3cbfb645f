// What scatters, out of the settings.
#include "reverb/fields/scattering_parts.h"

#include <gtest/gtest.h>

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
