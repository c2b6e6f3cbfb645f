#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "io/hdf5/hdf5_file.h"
#include "support/program.h"

namespace asdic::detail {
namespace {

using support::asdic;

// scenarios/sweep.toml: a beam that sweeps past a target which closes at 4 m/s along the east axis,
// x(t) = 16 000 m − 4 t. The upright array tells no bearing: tracks are of range. In the pings
// whose beam meets the target (11 to 14 down, 23 to 28 up) it must be found, at its Doppler, and
// the track through them must follow the truth within a cell: 1/B_noise of a Hann tone of 1 s is
// 0.52 s, 390 m of range; half of that once the track has settled.
TEST(ProcessedSweep, TrackFollowsTheClosingTarget) {
  const support::TemporaryDirectory folder;
  ASSERT_EQ(asdic(folder, "ping '" ASDIC_SCENARIOS "/sweep.toml' -o sweep.h5 -q").status, 0);
  ASSERT_EQ(asdic(folder, "process sweep.h5 --target-depth 125m -q").status, 0);
  const Hdf5File file = Hdf5File::open(folder / "sweep.h5");

  const auto ping = file.read<std::int32_t>("processed/targets/ping"),
             hit = file.read<std::int32_t>("processed/targets/hit");
  std::map<int, int> found;
  for (std::size_t i = 0; i < ping.size(); ++i) found[ping[i]] = hit[i];
  for (const int n : {11, 12, 13, 14, 24, 25, 26, 27, 28}) EXPECT_EQ(found[n], 1) << "ping " << n;

  const auto track = file.read<std::int32_t>("processed/tracks/track"),
             target = file.read<std::int32_t>("processed/tracks/target");
  const auto time = file.read<double>("processed/tracks/time"),
             range = file.read<double>("processed/tracks/range"),
             rate = file.read<double>("processed/tracks/range_rate");
  std::map<int, std::vector<std::size_t>> points;
  for (std::size_t i = 0; i < track.size(); ++i)
    if (target[i] == 0) points[track[i]].push_back(i);
  ASSERT_FALSE(points.empty());
  const auto longest = std::max_element(points.begin(), points.end(), [](auto& a, auto& b) {
    return a.second.size() < b.second.size();
  });
  ASSERT_GE(longest->second.size(), 12U);
  for (std::size_t k = 2; k < longest->second.size(); ++k) {
    const std::size_t i = longest->second[k];
    EXPECT_NEAR(range[i], 16000.0 - 4.0 * time[i], 195.0) << time[i];
    // half a Doppler bin, c/(4 f T) = 0.375 m/s at 1 kHz
    EXPECT_NEAR(rate[i], -4.0, 0.375) << time[i];
  }
}

}  // namespace
}  // namespace asdic::detail
