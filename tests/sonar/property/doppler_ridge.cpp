// Very many returns, whose impulses are moved along the ridge of their sweep, against every one of
// them by itself.
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <vector>

#include "sonar/synthesis/direct_synthesis.h"
#include "sonar/synthesis/doppler_expansion.h"
#include "sonar/synthesis/synthesis.h"
#include "support/random_returns.h"

namespace asdic::detail {
namespace {

using support::RandomReturns;

const std::vector<Vec3> two_phones = {Vec3(1.5, -0.4, 0.2), Vec3(-3.0, 2.0, 0.5)};

struct Case {
  const char* name;
  PulseSettings pulse;
  double doppler, spread;           // factors
  double first = -0.4, last = 1.3;  // delays [s]
};

PulseSettings sweep(double from, double to, double duration, PulseWindow window) {
  return {.waveform = Lfm{.start_frequency = from, .end_frequency = to},
          .duration = duration,
          .window = window,
          .tukey_fraction = 0.1};
}

std::vector<Case> cases() {
  return {
      {"up", sweep(1950.0, 2050.0, 0.3, PulseWindow::hann), 1.0, 0.0023},
      {"down_of_a_fast_receiver", sweep(2100.0, 1900.0, 0.3, PulseWindow::tukey), 1.012, 0.003},
      {"hyperbolic",
       {.waveform = Hfm{.start_frequency = 1800.0, .end_frequency = 2200.0},
        .duration = 0.3,
        .window = PulseWindow::hann},
       0.995,
       0.004},
      {"narrow", sweep(1995.0, 2005.0, 0.3, PulseWindow::hann), 1.0, 0.0023},
      {"over_the_records_begin", sweep(1950.0, 2050.0, 0.3, PulseWindow::hann), 1.0, 0.0023, -0.31,
       0.06},
      {"over_its_end", sweep(2050.0, 1950.0, 0.3, PulseWindow::hann), 1.0, 0.0023, 0.95, 1.2},
      {"tone", {.waveform = Cw{.frequency = 2000.0}, .duration = 0.3}, 1.0, 0.0023},
  };
}

const Recording one_second = {.sample_rate = 6000.0, .start = 0.05, .samples = 6000};

std::vector<float> received_of(const Case& c, const Returns& returns) {
  const Synthesizer synthesizer(Pulse(c.pulse), one_second,
                                std::abs(c.doppler - 1.0) + 1.01 * c.spread);
  std::vector<float> pressure(two_phones.size() * one_second.samples, 0.0F);
  synthesizer.add_samples(synthesizer.baseband(returns, two_phones), 1.0, pressure);
  return pressure;
}

class ManyReturns : public testing::TestWithParam<Case> {};

TEST_P(ManyReturns, AreTheirSumToEightyDecibels) {
  const Case& c = GetParam();
  const Returns returns = RandomReturns{.count = 21'000,
                                        .first = c.first,
                                        .last = c.last,
                                        .doppler = c.doppler,
                                        .spread = c.spread}
                              .make();
  const std::vector<float> received = received_of(c, returns);
  const std::vector<double> exact =
      direct_synthesis(Pulse(c.pulse), one_second, returns, two_phones);
  double error = 0.0, all = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    error += std::pow(static_cast<double>(received[i]) - exact[i], 2);
    all += exact[i] * exact[i];
  }
  RecordProperty("error_db", std::to_string(db_from_power(error / all)));
  EXPECT_LT(db_from_power(error / all), -80.0);
}

INSTANTIATE_TEST_SUITE_P(All, ManyReturns, testing::ValuesIn(cases()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(ManyReturns, HaveTheSameBitsForAnyNumberOfThreads) {
  const Case c = cases().front();
  const Returns returns =
      RandomReturns{.count = 21'000, .first = -0.4, .last = 1.3, .spread = c.spread}.make();
  std::vector<std::vector<float>> received;
  for (const std::size_t threads : {1, 2, 5}) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                            threads);
    received.push_back(received_of(c, returns));
  }
  EXPECT_EQ(received[0], received[1]);
  EXPECT_EQ(received[0], received[2]);
}

}  // namespace
}  // namespace asdic::detail
