// Rays that turn beside a maximum of the sound speed: the PCHIP profile of deep_ocean.toml is flat
// at the surface, where rays of one bounce and none part.
#include <gtest/gtest.h>

#include "io/scenario/scenario_reader.h"
#include "raytrace/paths/eigenrays.h"

namespace asdic::detail {
namespace {

TEST(SearchBesideAMaximum, GivesPathsThatArriveOrNone) {
  const Scenario s = read_scenario(ASDIC_SCENARIOS "/deep_ocean.toml");
  const EigenraySolver solver(s.environment);
  std::vector<double> ranges = {24933.093012153262};  // once: a delay of 4.6e125 s
  for (int i = 0; i < 2000; ++i) ranges.push_back(24900.0 + 0.05 * i);
  for (const double depth : {298.0, 300.0, 304.0, 305.0, 308.0}) {
    const auto found = solver.find(125.0, depth, ranges, 4000.0,
                                   {.max_surface_bounces = 1, .max_bottom_bounces = 1});
    for (std::size_t i = 0; i < ranges.size(); ++i)
      for (const Arrival& path : found[i]) {
        // Between straight at the fastest and 1.3 times the way at the slowest.
        EXPECT_GT(path.delay, ranges[i] / 1560.0) << ranges[i];
        EXPECT_LT(path.delay, 1.3 * ranges[i] / 1480.0) << ranges[i];
        EXPECT_LT(std::abs(path.amplitude), 1.0 / 5000.0) << ranges[i];
      }
  }
}

}  // namespace
}  // namespace asdic::detail
