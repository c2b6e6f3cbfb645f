// The scenarios that show reverberation in two dimensions, run.
#include <gtest/gtest.h>

#include <cmath>

#include "io/scenario_reader.h"
#include "sonar/ping.h"

namespace asdic {
namespace {

PingRecord run(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return PingSimulator(
             read_scenario(std::string(ASDIC_SCENARIOS) + "/" + name + ".toml", overrides))
      .simulate(1);
}

double mean_db(const PingRecord& record, double from, double to) {
  const auto& power = record.levels.reverberation;
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < power.size(); ++i) {
    const double t = (double(i) + 0.5) * record.levels.time_step;
    if (t >= from && t < to) sum += double(power[i]), count += 1.0;
  }
  return db_from_power(sum / count);
}

// Nothing is heard of the layer before sound has been at its top and back, 0.33 s; then it is loud.
TEST(ReverberationScenarios, TheLayerIsHeardWhenSoundHasBeenThere) {
  const PingRecord layer = run("deep_scattering_layer");
  const PingRecord without = run("deep_scattering_layer", {"reverberation.volume=[]"});
  EXPECT_NEAR(mean_db(layer, 0.0, 0.3), mean_db(without, 0.0, 0.3), 0.01);
  EXPECT_GT(mean_db(layer, 0.7, 2.0), mean_db(without, 0.7, 2.0) + 10.0);
}

// The target's echo lies off the ridge of its bearing by its own closing speed, 5 m/s: 2·v·cos/λ =
// 10 Hz at 1500 Hz and 1500 m/s, along a ray that dips 1 degree or so; 0.2 Hz.
TEST(ReverberationScenarios, TheTargetLeavesTheRidge) {
  const PingRecord record = run("moving_platform_reverb");
  ASSERT_FALSE(record.echoes.empty());
  const Return& heard = record.echoes.front().heard;
  const double ridge = 2.0 * 6.0 * 3000.0 / std::hypot(3000.0, 2000.0);  // 2·v·cos(angle)/λ [Hz]
  EXPECT_NEAR(1500.0 * (heard.doppler - 1.0) - ridge, 10.0, 0.2);
  EXPECT_GT(record.summary[0].reverberation_db, record.summary[0].noise_db + 20.0);
}

}  // namespace
}  // namespace asdic
