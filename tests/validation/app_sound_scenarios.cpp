// The commands in the headers of the scenarios find what the headers say.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "io/hdf5_file.h"
#include "support/program.h"

namespace asdic {
namespace {

using support::asdic;

/// Every ping that the target is heard in, processed as the header of the scenario says.
void expect_found(const support::TemporaryDirectory& folder, const std::string& name,
                  const std::string& options) {
  const std::string file = name + ".h5";
  const support::Outcome ping =
      asdic(folder, "ping '" ASDIC_SCENARIOS "/" + name + ".toml' -o " + file + " -q");
  ASSERT_EQ(ping.status, 0) << ping.err;
  const support::Outcome found = asdic(folder, "process " + file + " --no-maps -q " + options);
  ASSERT_EQ(found.status, 0) << found.err;
}

// Bent, the line tells right from left: its one place is the true one. By half a beam of its
// length, λ/L = 1.8 degrees, and by half of what the pulse's uncertain Doppler shifts a sweep's
// delay, at ±16 m/s of its filters v·T·f/B = 40 m.
TEST(SoundScenarioCommands, TheTowedLineFindsTheTargetInTheTurn) {
  const support::TemporaryDirectory folder;
  expect_found(folder, "towed_array_turn", "--target-depth 150m --elevations -10:10");
  const Hdf5File file = Hdf5File::open(folder / "towed_array_turn.h5");
  const auto hit = file.read<std::int32_t>("processed/targets/hit");
  const auto off = file.read<double>("processed/targets/position_error"),
             bearing = file.read<double>("processed/targets/bearing_error_deg");
  ASSERT_EQ(hit.size(), 4U);
  for (const std::size_t ping : {0U, 1U, 2U, 3U}) EXPECT_EQ(hit[ping], 1) << "ping " << ping + 1;
  for (const std::size_t ping : {2U, 3U}) {
    EXPECT_LT(std::abs(bearing[ping]), 0.9) << "ping " << ping + 1;
    EXPECT_LT(off[ping], 80.0) << "ping " << ping + 1;
  }
}

}  // namespace
}  // namespace asdic
