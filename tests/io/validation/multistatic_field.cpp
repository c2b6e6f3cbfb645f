// scenarios/multistatic_field.toml: two pingers, three receivers, one stream.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "io/scenario/scenario_reader.h"
#include "sonar/ping/ping.h"
#include "sonar/ping/run_pings.h"
#include "sonar/scenario/sampling.h"

namespace asdic::detail {
namespace {

using Rows = std::vector<std::vector<double>>;  // [channels][samples × components]

PingSimulator simulator(std::vector<std::string> changes) {
  changes.emplace_back("noise={}");
  return PingSimulator(read_scenario(ASDIC_SCENARIOS "/multistatic_field.toml", changes));
}

void add(Rows& rows, const PingRecord& record, std::size_t first) {
  const std::size_t n = record.recording.samples * record.recording.components();
  for (std::size_t c = 0; c < rows.size(); ++c) {
    rows[c].resize(std::max(rows[c].size(), first + n), 0.0);
    for (std::size_t i = 0; i < n; ++i) rows[c][first + i] += double(record.pressure[c * n + i]);
  }
}

Rows stream_of(const PingSimulator& field) {
  Rows rows(channels_of(field.scenario()));
  run_pings(field, [&](PingRecord&& record) { add(rows, record, rows[0].size()); });
  return rows;
}

/// Where ping `number` starts in the rows.
std::size_t start_of(const PingSimulator& field, int number) {
  return 2 * std::size_t(
                 std::llround(field.transmission(number).time * recorded_rate(field.scenario())));
}

/// Mean-square pressure of one row over some of its samples [dB re 1 µPa].
double level(const std::vector<double>& row, std::size_t first, std::size_t count) {
  double sum = 0.0;
  for (std::size_t i = first; i < first + 2 * count; ++i) sum += row[i] * row[i];
  return db_from_power(0.5 * sum / double(count)) + 120.0;
}

// A phone receives the sum of all six pings, reverberation and all, each as if it were alone: to
// the rounding of float, six times 2^-24 of what is loudest. And it is a sum: in the seconds after
// the second ping the phones in the north receive the first one besides, 119 dB of it.
TEST(MultistaticField, TheStreamIsTheSumOfItsPings) {
  const PingSimulator field = simulator({"pings.blanking=false"});
  ASSERT_TRUE(field.scenario().reverberation.enabled);
  ASSERT_EQ(field.pings(), 6);
  const Rows stream = stream_of(field);
  Rows sum(stream.size());
  std::vector<PingRecord> alone;
  for (int ping = 1; ping <= 6; ++ping) {
    alone.push_back(field.sound(ping));
    add(sum, alone.back(), start_of(field, ping));
  }
  for (std::size_t c = 0; c < stream.size(); ++c) {
    ASSERT_EQ(stream[c].size(), sum[c].size());
    double loudest = 0.0, worst = 0.0;
    for (std::size_t i = 0; i < sum[c].size(); ++i) {
      loudest = std::max(loudest, std::abs(sum[c][i]));
      worst = std::max(worst, std::abs(stream[c][i] - sum[c][i]));
    }
    EXPECT_LT(worst, 6.0 * std::ldexp(loudest, -24)) << "channel " << c;
  }

  Rows second(stream.size());
  add(second, alone[1], 0);
  const auto first = start_of(field, 2), seconds = std::size_t(recorded_rate(field.scenario()));
  const std::size_t north = 8;
  EXPECT_GT(level(stream[north], first, seconds), 115.0);
  EXPECT_LT(level(second[north], 0, seconds), 60.0);
}

// While a pinger sends, half a second, the phones under it are silent, and only they.
TEST(MultistaticField, PhonesUnderThePingerAreBlanked) {
  const PingSimulator field = simulator({});
  const Rows stream = stream_of(field);
  const auto half = std::size_t(0.5 * recorded_rate(field.scenario()));
  for (const int ping : {1, 2, 3, 4, 5, 6}) {
    const std::size_t first = start_of(field, ping);
    for (std::size_t c = 0; c < stream.size(); ++c) {
      const bool under = ping % 2 == 1 ? c < 4 : c >= 4 && c < 8;  // west and east take turns
      const auto from = stream[c].begin() + std::ptrdiff_t(first);
      const auto silent =
          std::count(from, from + std::ptrdiff_t(2 * half), 0.0) == std::ptrdiff_t(2 * half);
      if (ping == 1 && !under) continue;  // the others receive nothing yet
      EXPECT_EQ(silent, under) << "ping " << ping << ", channel " << c;
    }
  }
}

}  // namespace
}  // namespace asdic::detail
