// The background of a matched filter, summed. Truth: the mean over pings that are simulated with
// other seeds, phone by phone, and heard by the filter in its plain form.
#include "study/measures/expected_power.h"

#include <gtest/gtest.h>

#include <cctype>
#include <cmath>

#include "core/error.h"
#include "io/scenario/scenario_reader.h"
#include "study/measures/echo_filter.h"
#include "support/plain_sea.h"
#include "support/temporary_directory.h"

namespace asdic::detail::study {
namespace {

struct Sea {
  const char* name;
  std::vector<std::string> overrides;
  int pings = 24;
  double cells = 20.0;  // together, over which the mean is compared
};

void PrintTo(const Sea& sea, std::ostream* out) { *out << sea.name; }

std::vector<std::string> with(std::vector<std::string> more) {
  std::vector<std::string> all{
      "reverberation={ bottom = { kind = \"lambert\", mu_db = -27.0 }, surface = { kind = "
      "\"ogden-erskine\" } }",
      "propagation.max_bottom_bounces=1",
      "pings.recording_duration=4.0",
      "target.0.position=[1000.0, 300.0, 100.0]",
      "target.0.strength_db=-200.0",
      "noise.spectral_level_db=20.0",
      "pings.samples=baseband"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

const char* const ring =
    "array={ kind = \"positions\", positions = [[1.5, 0.0, -0.5], [1.06, 1.06, -0.5], "
    "[0.0, 1.5, -0.5], [-1.06, 1.06, -0.5], [-1.5, 0.0, 0.5], [-1.06, -1.06, 0.5], "
    "[0.0, -1.5, 0.5], [1.06, -1.06, 0.5]] }";
const char* const sweep =
    "pulse={ kind = \"lfm\", start_frequency = 900.0, end_frequency = 1100.0, duration = 0.25, "
    "window = \"tukey\", tukey_fraction = 0.2 }";

class SummedBackground : public testing::TestWithParam<Sea> {
 protected:
  Scenario scenario(std::uint64_t seed) {
    Scenario made =
        read_scenario(folder_.write("sea.toml", support::plain_sea), GetParam().overrides);
    made.seed = seed;
    return made;
  }
  support::TemporaryDirectory folder_;
};

TEST_P(SummedBackground, IsTheMeanOfPings) {
  PingSimulator simulator(scenario(1));
  simulator.receives_one_ping();
  const PingRecord record = simulator.simulate(1);
  MatchedFilterPlan plan;
  plan.background = MatchedFilterPlan::Background::expected;
  plan.draws = GetParam().pings;
  const auto drawn =
      expected_answers(simulator, record, plan, 0, true, [&](int k, const SampleRange&) {
        PingSimulator other(scenario(100 + static_cast<std::uint64_t>(k)));
        other.receives_one_ping();
        return other.simulate(1);
      });
  plan.background = MatchedFilterPlan::Background::summed;
  const auto summed = summed_answers(simulator, record, plan, 0, true);
  const std::vector<double>&truth = drawn.at(0).cells, &sums = summed.at(0).cells;
  ASSERT_EQ(sums.size(), truth.size());
  double ratio = 0.0, count = 0.0, all = 0.0, cells = 0.0;
  int compared = 0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (!(truth[i] > 0.0)) continue;
    ratio += truth[i] / sums[i];
    all += truth[i] / sums[i];
    cells += 1.0;
    if (++count < GetParam().cells) continue;
    // Of exponential values; neighbours are a little alike.
    EXPECT_NEAR(ratio / count, 1.0, 5.0 / std::sqrt(count * plan.draws / 1.3)) << "cell " << i;
    ratio = count = 0.0;
    ++compared;
  }
  EXPECT_GE(compared, 3);
  EXPECT_NEAR(all / cells, 1.0, 5.0 / std::sqrt(cells * plan.draws / 1.3));
}

INSTANTIATE_TEST_SUITE_P(
    In, SummedBackground,
    testing::Values(Sea{"a sweep, a ring of phones", with({ring, sweep})},
                    Sea{"a tone under way, a ring",
                        with({ring, "platform.velocity=[6.0, 3.0, 0.0]", "pulse.duration=0.5"}),
                        100, 1.0},
                    Sea{"bistatic, two phones", with({sweep, "array.offset=[400.0, -200.0, 60.0]",
                                                      "target.0.velocity=[-5.0,0.0,0.0]"})},
                    Sea{"isotropic noise", with({ring, sweep, "noise.spectral_level_db=90.0",
                                                 "noise.coherence=isotropic"})}),
    [](const auto& sea) {
      std::string name = sea.param.name;
      std::erase_if(name, [](unsigned char c) { return std::isalnum(c) == 0; });
      return name;
    });

}  // namespace
}  // namespace asdic::detail::study
