#include "study/measures/signal_excess.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"
#include "processing/detection_threshold.h"
#include "study/measures/measures.h"
#include "study/reader/study_reader.h"
#include "support/plain_sea.h"
#include "support/temporary_directory.h"

namespace asdic::detail::study {
namespace {

class SignalExcess : public testing::Test {
 protected:
  Study read(const std::string& measure, std::vector<std::string> overrides = {}) {
    overrides.emplace_back("environment.absorption={kind=\"none\"}");
    return read_study(
        folder_.write("study.toml", "[study]\nrealisations = 1000\n[measure]\n" + measure +
                                        "detection_signal_excess = true\n" + support::plain_sea),
        overrides);
  }
  support::TemporaryDirectory folder_;
};

double value(const Study& study, const Row& row, const std::string& name) {
  const std::vector<Column> all = columns(study);
  for (std::size_t c = 0; c < all.size(); ++c)
    if (all[c].name == name) return row.values.at(c);
  throw std::runtime_error("no column " + name);
}

const std::string known =
    "echo_level = true\necho_to_background = true\nnoise_level = true\n"
    "detection = { false_alarm_probability = 1e-3 }\nmatched_filter = { background = \"noise\" }\n";

// One straight path in white noise of N₀ = 40 dB: SNR = EL + 10 lg(nE) − N₀, E = 3/8·0.1 s.
TEST_F(SignalExcess, InWhiteNoiseItIsTheEnergysSnrOverTheThreshold) {
  for (const double phones : {2.0, 1.0}) {
    const Study study =
        read(known, phones > 1.0 ? std::vector<std::string>{}
                                 : std::vector<std::string>{"measure.matched_filter.phone=1"});
    const Row row = Realiser(study).realise(0);
    const double level = value(study, row, "echo_level_db");
    EXPECT_NEAR(
        value(study, row, "detection_signal_excess_db"),
        level + db_from_power(phones * 0.375 * 0.1) - 40.0 - detection_threshold_db(1e-3, infinity),
        1e-6);
    EXPECT_NEAR(value(study, row, "echo_to_background_db"),
                level - value(study, row, "noise_level_db"), 1e-9);
  }
}

// What it says: at 0 dB half of the echoes are detected, over a known background and over one that
// is averaged.
TEST_F(SignalExcess, AtZeroHalfOfTheEchoesAreDetected) {
  const std::string around = "echo_level = true\ndetection = { false_alarm_probability = 1e-3 }\n";
  for (const std::string& measure : {known, around}) {
    const Study first = read(measure);
    const double excess = value(first, Realiser(first).realise(0), "detection_signal_excess_db");
    const Study study =
        read(measure, {"transmitter.source_level_db=" + std::to_string(200.0 - excess)});
    const Realiser realiser(study);
    double hits = 0.0;
    constexpr int n = 600;
    for (std::uint64_t i = 0; i < n; ++i) {
      const Row row = realiser.realise(i);
      EXPECT_NEAR(value(study, row, "detection_signal_excess_db"), 0.0, 1e-4);
      hits += value(study, row, "detected");
    }
    // Binomial, 4.9 standard deviations: 1e-6.
    EXPECT_NEAR(hits / n, 0.5, 4.9 * std::sqrt(0.25 / n)) << measure;
  }
}

// Isotropic noise at half a wavelength: sin(kd)/(kd) = 0, the gain of independent noise; phones at
// one place receive the same noise, and two of them gain nothing.
TEST_F(SignalExcess, CoherentNoiseIsGainedOnByWhatTheArrayGains) {
  const auto excess = [&](const std::vector<std::string>& overrides) {
    const Study study = read(known, overrides);
    return value(study, Realiser(study).realise(0), "detection_signal_excess_db");
  };
  const double alone = excess({"measure.matched_filter.phone=0"});
  const std::string isotropic = "noise.coherence=isotropic";
  EXPECT_NEAR(excess({}) - alone, db_from_power(2.0), 1e-9);
  EXPECT_NEAR(excess({isotropic}) - alone, db_from_power(2.0), 1e-3);
  EXPECT_NEAR(excess({isotropic, "array.spacing=0.001"}) - alone, 0.0, 1e-3);
}

TEST_F(SignalExcess, WithoutATargetThereIsNone) {
  const Study study = read(known, {"target.0.first_ping=5"});
  EXPECT_EQ(value(study, Realiser(study).realise(0), "detection_signal_excess_db"), -infinity);
}

TEST_F(SignalExcess, NeedsAReceiverAndTheOldNameIsToldOf) {
  const auto fault = [&](const std::string& measure) -> std::string {
    try {
      static_cast<void>(read(measure));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no fault";
  };
  EXPECT_THAT(
      fault("echo_level = true\n"),
      testing::HasSubstr("measure.detection_signal_excess: found true, expected a detection "
                         "with it"));
  const Study old = read(known + "signal_excess = true\n");
  EXPECT_THAT(old.warnings, testing::ElementsAre(testing::HasSubstr(
                                "measure.signal_excess: old name of echo_to_background")));
  const Row row = Realiser(old).realise(0);
  EXPECT_EQ(value(old, row, "signal_excess_db"), value(old, row, "echo_to_background_db"));
  EXPECT_THAT(read(known).warnings, testing::IsEmpty());
}

}  // namespace
}  // namespace asdic::detail::study
