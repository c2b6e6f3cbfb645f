#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "core/error.h"
#include "core/text.h"
#include "io/scenario/scenario_reader.h"
#include "io/text/csv_table.h"

namespace asdic::detail {
namespace {

const std::string& scenario() {
  static const std::string text = read_text_file(ASDIC_SCENARIOS "/deep_ocean.toml");
  return text;
}

/// Reading ends in a scenario or in an InputError with all its parts; never otherwise.
void read_or_complain(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    static_cast<void>(parse_scenario(text, "deep_ocean.toml", overrides));
  } catch (const InputError& error) {
    RC_ASSERT(!error.fault().where.empty());
    RC_ASSERT(!error.fault().got.empty());
    RC_ASSERT(!error.fault().expected.empty());
  }
}

RC_GTEST_PROP(ScenarioReader, SurvivesAnyByteChanged, ()) {
  std::string text = scenario();
  const int changes = *rc::gen::inRange(1, 4);
  for (int i = 0; i < changes; ++i)
    text[*rc::gen::inRange<std::size_t>(0, text.size())] = *rc::gen::arbitrary<char>();
  read_or_complain(text);
}

RC_GTEST_PROP(ScenarioReader, SurvivesAnyPieceLost, ()) {
  std::string text = scenario();
  const auto start = *rc::gen::inRange<std::size_t>(0, text.size());
  text.erase(start, *rc::gen::inRange<std::size_t>(1, 200));
  read_or_complain(text);
}

RC_GTEST_PROP(ScenarioReader, SurvivesAnyNumberAnywhere, ()) {
  const auto key = *rc::gen::element<std::string>(
      "environment.bottom.depth", "environment.sound_speed.depth.3", "pulse.duration",
      "pulse.frequency", "array.phones", "array.spacing", "pings.count", "pings.sample_rate",
      "pings.recording_duration", "target.0.position.0", "target.0.velocity.2",
      "platform.position.2", "transmitter.beamwidth_deg", "environment.sound_speed.temperature.0",
      "seed");
  const auto value = *rc::gen::oneOf(
      rc::gen::map(rc::gen::arbitrary<double>(), [](double x) { return to_text(x); }),
      rc::gen::map(rc::gen::arbitrary<int>(), [](int n) { return std::to_string(n); }),
      rc::gen::element<std::string>("nan", "inf", "-inf", "1e308", "0", "-0.0", "[]", "{}",
                                    "true"));
  read_or_complain(scenario(), {key + "=" + value});
}

RC_GTEST_PROP(ToText, ReadsBackAsTheSameNumber, (double number)) {
  RC_ASSERT(std::stod(to_text(number)) == number);
}

}  // namespace
}  // namespace asdic::detail
