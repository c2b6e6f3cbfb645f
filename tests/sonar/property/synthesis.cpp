#include "sonar/synthesis/synthesis.h"
#include "sonar/synthesis/direct_synthesis.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <set>

#include "core/error.h"
#include "sonar/scenario/array.h"
#include "support/random_returns.h"

namespace asdic::detail {
namespace {

using support::RandomReturns;

const std::vector<Vec3> three_phones = {Vec3(0, 0, 0), Vec3(3.7, -1.2, 0.4), Vec3(-20.0, 8.0, 5.0)};

std::vector<float> fast_synthesis(const Pulse& pulse, const Recording& recording,
                                  const Returns& returns, double max_doppler) {
  const Synthesizer synthesizer(pulse, recording, max_doppler);
  std::vector<float> pressure(three_phones.size() * recording.samples, 0.0F);
  synthesizer.add_samples(synthesizer.baseband(returns, three_phones), 1.0, pressure);
  return pressure;
}

/// Largest difference from the direct synthesis over the strongest return [dB].
double error_db(const PulseSettings& settings, const Recording& recording, const Returns& returns,
                double max_doppler) {
  const Pulse pulse(settings);
  const auto fast = fast_synthesis(pulse, recording, returns, max_doppler);
  const auto exact = direct_synthesis(pulse, recording, returns, three_phones);
  double strongest = 0.0, error = 0.0;
  for (const Return& r : returns) strongest = std::max(strongest, std::abs(r.amplitude));
  for (std::size_t i = 0; i < exact.size(); ++i)
    error = std::max(error, std::abs(double(fast[i]) - exact[i]));
  return db_from_amplitude(error / strongest);
}

const Recording four_seconds = {.sample_rate = 16000.0, .start = 0.3, .samples = 64000};

PulseSettings tone(double duration) { return {.waveform = Cw{}, .duration = duration}; }

struct Case {
  const char* name;
  PulseSettings pulse;
};

std::vector<Case> soft_pulses() {
  return {
      {"hann_tone_1s", tone(1.0)},
      {"hann_tone_100ms", tone(0.1)},
      {"hann_tone_20ms", tone(0.02)},
      {"tukey_tone_1s", {.duration = 1.0, .window = PulseWindow::tukey}},
      {"hann_lfm_100Hz", {.waveform = Lfm{}, .duration = 1.0}},
      {"tukey_lfm_1kHz_down",
       {.waveform = Lfm{.start_frequency = 4500.0, .end_frequency = 3500.0},
        .duration = 0.5,
        .window = PulseWindow::tukey,
        .tukey_fraction = 0.25}},
      {"hann_hfm",
       {.waveform = Hfm{.start_frequency = 3000.0, .end_frequency = 3600.0}, .duration = 0.7}},
  };
}

class SoftPulse : public testing::TestWithParam<Case> {};

// Delays run past both ends of the record, so pulses are cut there. Returns' errors add up: 100 of
// them overlap at random phase, ten times one's error; −80 dB of the strongest leaves that room.
TEST_P(SoftPulse, MatchesDirectSynthesisWithoutDoppler) {
  const auto returns = RandomReturns{.first = -1.0, .last = 5.0}.make();
  EXPECT_LT(error_db(GetParam().pulse, four_seconds, returns, 0.0), -80.0);
}

TEST_P(SoftPulse, MatchesDirectSynthesisOverASpanOfDoppler) {  // ±14 Hz at 4 kHz
  const auto returns = RandomReturns{.first = -1.0, .last = 5.0, .spread = 0.0035}.make();
  EXPECT_LT(error_db(GetParam().pulse, four_seconds, returns, 0.0036), -80.0);
}

TEST_P(SoftPulse, MatchesDirectSynthesisOfAFewMovers) {
  auto returns = RandomReturns{.first = 0.0, .last = 4.0, .channels = 3}.make();
  for (std::size_t i = 0; i < returns.size(); ++i)
    returns[i].doppler = i % 3 == 0 ? 0.99 : (i % 3 == 1 ? 1.0004 : 1.0101);
  EXPECT_LT(error_db(GetParam().pulse, four_seconds, returns, 0.011), -80.0);
}

INSTANTIATE_TEST_SUITE_P(All, SoftPulse, testing::ValuesIn(soft_pulses()),
                         [](const auto& test) { return std::string(test.param.name); });

// An edge that jumps cannot be had from any finite band: the phones' filter rounds it within
// 40/width of its place (width 256 Hz for the 1 s tone). Away from edges all is as exact as ever.
TEST(HardPulse, IsExactAwayFromItsEdges) {
  PulseSettings settings = tone(1.0);
  settings.window = PulseWindow::none;
  const Pulse pulse(settings);
  const Returns one = {{.delay = 1.2345678, .amplitude = {0.6, -0.8}, .doppler = 1.003}};
  const auto fast = fast_synthesis(pulse, four_seconds, one, 0.0035);
  const auto exact = direct_synthesis(pulse, four_seconds, one, three_phones);
  double error = 0.0;
  for (std::size_t i = 0; i < four_seconds.samples; ++i) {
    const double t = four_seconds.start + double(i) / four_seconds.sample_rate - one[0].delay;
    if (std::min(std::abs(t), std::abs(t - 1.0 / 1.003)) > 40.0 / 256.0)
      error = std::max(error, std::abs(double(fast[i]) - exact[i]));
  }
  EXPECT_LT(db_from_amplitude(error), -80.0);
}

// A file pulse is band-limited already; one made of a windowed tone must sound like the tone.
TEST(FilePulse, MatchesDirectSynthesis) {
  const Pulse model(tone(0.25));
  SampledPulse sampled{.sample_rate = 20000.0};
  for (int i = 0; i < 5000; ++i)
    sampled.samples.push_back(3.0 * model.analytic(i / 20000.0).real());
  const auto returns = RandomReturns{.first = -1.0, .last = 5.0, .spread = 0.002}.make();
  EXPECT_LT(error_db({.waveform = sampled}, four_seconds, returns, 0.002), -80.0);
}

TEST(Synthesis, EveryThreadCountGivesTheSameBits) {
  const Pulse pulse(tone(0.3));
  const auto returns =
      RandomReturns{.count = 2000, .first = -1.0, .last = 5.0, .spread = 0.003, .channels = 3}
          .make();
  std::vector<std::vector<float>> results;
  for (std::size_t threads : {1U, 2U, 7U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(fast_synthesis(pulse, four_seconds, returns, 0.003));
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

// Float rounding alone: 1e-6 of a sum of hundreds of returns of order one.
TEST(Synthesis, IsLinear) {
  const Pulse pulse(tone(0.3));
  const auto a = RandomReturns{.last = 4.0, .spread = 0.003, .seed = 2}.make();
  const auto b = RandomReturns{.last = 4.0, .spread = 0.003, .seed = 3}.make();
  Returns both = a;
  for (Return r : b) {
    r.amplitude *= -2.0;
    both.push_back(r);
  }
  const auto pa = fast_synthesis(pulse, four_seconds, a, 0.003);
  const auto pb = fast_synthesis(pulse, four_seconds, b, 0.003);
  const auto pc = fast_synthesis(pulse, four_seconds, both, 0.003);
  float error = 0.0F;
  for (std::size_t i = 0; i < pc.size(); ++i)
    error = std::max(error, std::abs(pc[i] - (pa[i] - 2.0F * pb[i])));
  EXPECT_LT(error, 2e-4F);
}

// ∫p²dt = ½|A|²·energy/η, and the baseband's envelope carries |A|²·energy/η: duration ÷ η.
TEST(Synthesis, KeepsThePulsesEnergy) {
  const Pulse pulse(tone(0.5));
  const double eta = 1.01;
  const Returns one = {{.delay = 2.0, .amplitude = {0.0, 2.0}, .doppler = eta}};
  const Synthesizer synthesizer(pulse, four_seconds, 0.02);
  const Baseband b = synthesizer.baseband(one, three_phones);
  double envelope = 0.0, pressure = 0.0;
  for (std::size_t i = 0; i < b.recorded; ++i)
    envelope += double(std::norm(b.channel(0)[i])) / b.sample_rate;
  for (float p : fast_synthesis(pulse, four_seconds, one, 0.02))
    pressure += double(p) * double(p) / four_seconds.sample_rate / 3.0;
  EXPECT_NEAR(envelope, 4.0 * pulse.energy() / eta, 1e-4 * envelope);
  EXPECT_NEAR(pressure, 2.0 * pulse.energy() / eta, 1e-4 * pressure);
}

// What lies wholly outside the record must leave silence, not come round by the FFT's period.
TEST(Synthesis, NothingWraps) {
  const Pulse pulse(tone(1.0));
  Returns outside;
  for (double delay : {-50.0, -1.1, 4.4, 5.0, 5.3, 6.0, 7.0, 1e9, -1e9})
    outside.push_back({.delay = delay, .amplitude = 1.0, .doppler = 1.0 - 1e-4 * delay / 1e9});
  for (Return& r : outside) r.slowness = Vec3::Zero();
  for (float p : fast_synthesis(pulse, four_seconds, outside, 0.001)) ASSERT_LT(std::abs(p), 1e-4F);
}

TEST(Synthesis, AddsToWhatIsThereAndScales) {
  const Pulse pulse(tone(0.3));
  const auto returns = RandomReturns{.last = 4.0}.make();
  const Synthesizer synthesizer(pulse, four_seconds, 0.0);
  const Baseband b = synthesizer.baseband(returns, three_phones);
  std::vector<float> once(3 * four_seconds.samples, 0.0F), twice(once.size(), 1.0F);
  synthesizer.add_samples(b, 1.0, once);
  synthesizer.add_samples(b, 2.0, twice);
  for (std::size_t i = 0; i < once.size(); i += 97)
    EXPECT_NEAR(twice[i], 1.0F + 2.0F * once[i], 1e-5F);
}

TEST(Synthesis, NoReturnsAreSilence) {
  for (float p : fast_synthesis(Pulse(tone(0.3)), four_seconds, {}, 0.0)) ASSERT_EQ(p, 0.0F);
}

TEST(Synthesis, RefusesToAlias) {
  try {
    const Synthesizer s(Pulse(tone(1.0)), {.sample_rate = 8000.0, .samples = 8000}, 0.0);
    FAIL() << "4 kHz at 8 kHz went through";
  } catch (const InputError& error) {
    EXPECT_EQ(error.fault().where, "sample_rate");
  }
}

// Complex samples against the exact pulses about their carrier: −80 dB, as for pressure. A rate
// that holds the synthesised band is met by interpolation, one that holds little more than the
// pulse's own −40 dB band by FFT, which leaves out what lies beyond: −40 dB.
TEST(ComplexSamples, AreTheExactPulsesAboutTheirCarrier) {
  const PulseSettings cw{.waveform = Cw{}, .duration = 0.5};
  const PulseSettings lfm{.waveform = Lfm{}, .duration = 0.4};
  struct Sampling {
    PulseSettings pulse;
    double rate, carrier, limit_db;
  };
  for (const Sampling& one :
       {Sampling{cw, 400.0, 4000.0, -80.0}, Sampling{cw, 431.7, 4003.3, -80.0},
        Sampling{cw, 5000.0, 3900.0, -80.0}, Sampling{lfm, 800.0, 4000.0, -80.0},
        Sampling{lfm, 1234.5, 4011.1, -80.0}, Sampling{cw, 60.0, 4000.0, -40.0}}) {
    const auto& [settings, rate, carrier, limit_db] = one;
    const Recording recording{.sample_rate = rate,
                              .start = 0.3,
                              .samples = static_cast<std::size_t>(4.0 * rate),
                              .carrier = carrier,
                              .epoch = 1.7};
    const double doppler = 5e-4;
    const Returns returns =
        RandomReturns{.count = 40, .first = 0.1, .last = 4.5, .spread = doppler}.make();
    const Pulse pulse(settings);
    const Synthesizer synthesizer(pulse, recording, doppler);
    std::vector<float> samples(three_phones.size() * recording.samples * 2, 0.0F);
    synthesizer.add_samples(synthesizer.baseband(returns, three_phones), 1.0, samples);
    double error = 0.0, strongest = 0.0;
    for (const Return& r : returns) strongest = std::max(strongest, std::abs(r.amplitude));
    for (std::size_t n = 0; n < three_phones.size(); ++n)
      for (std::size_t i = 0; i < recording.samples; ++i) {
        const double t = recording.start + static_cast<double>(i) / recording.sample_rate;
        std::complex<double> exact = 0.0;
        for (const Return& r : returns)
          exact += r.amplitude *
                   pulse.analytic(r.doppler * (t - r.delay - r.slowness.dot(three_phones[n])));
        exact *= std::polar(1.0, -2.0 * pi * std::remainder(carrier * (t + recording.epoch), 1.0));
        const float* b = samples.data() + 2 * (n * recording.samples + i);
        error = std::max(error, std::abs(std::complex<double>(b[0], b[1]) - exact));
      }
    EXPECT_LT(db_from_amplitude(error / strongest), limit_db) << rate << " Hz";
  }
}

// A curved return at a whole array, by way of a few lags, against the same phone by phone (arrays
// of one phone are), also across a turn at a waypoint: −85 dB of the echo.
TEST(CurvedReturns, AreThoseOfEveryPhoneByItself) {
  const Recording recording{.sample_rate = 16000.0, .start = 0.5, .samples = 32000};
  const std::vector<Vec3> line = line_array(24, 0.1875, 0.3, 0.0).phones;
  const Vec3 s(4e-4, 3e-4, 4e-4), turned(4.001e-4, 2.999e-4, 4e-4);  // [s/m]
  const auto piece = [&](double sent, double received, double rate, const Vec3& a, const Vec3& b) {
    DelayCurve::Piece p{.first_slowness = a, .last_slowness = b};
    for (std::size_t k = 0; k < 4; ++k) {
      const double share = std::array{0.0, 0.25, 0.75, 1.0}[k];
      p.sent[k] = sent + 0.2 * share;
      p.received[k] = received + 0.2 * share * rate + 1e-6 * share * share;
    }
    return p;
  };
  const DelayCurve one({piece(0.0, 1.0, 1.001, s, turned)});
  const DelayCurve two({piece(0.0, 1.0, 1.001, s, turned), piece(0.2, 1.200201, 0.999, turned, s)});
  for (const AnyWaveform& waveform : {AnyWaveform(Cw{}), AnyWaveform(Lfm{})})
    for (const DelayCurve* curve : {&one, &two}) {
      const Pulse pulse({.waveform = waveform, .duration = curve == &one ? 0.2 : 0.4});
      const Synthesizer synthesizer(pulse, recording, 2e-3);
      const std::vector<CurvedReturn> returns = {
          {.straight = {.delay = 1.0, .amplitude = {0.6, 0.8}, .slowness = s}, .curve = *curve}};
      Baseband all = synthesizer.baseband(Returns{}, line);
      synthesizer.add_curved(returns, line, all);
      double error = 0.0, peak = 0.0;
      for (std::size_t n = 0; n < line.size(); ++n) {
        const std::vector<Vec3> phone = {line[n]};
        Baseband alone = synthesizer.baseband(Returns{}, phone);
        synthesizer.add_curved(returns, phone, alone);
        for (std::size_t i = 0; i < all.samples; ++i) {
          error = std::max(error, std::abs(std::complex<double>(all.channel(n)[i]) -
                                           std::complex<double>(alone.channel(0)[i])));
          peak = std::max(peak, std::abs(std::complex<double>(alone.channel(0)[i])));
        }
      }
      EXPECT_GT(peak, 0.5);
      EXPECT_LT(db_from_amplitude(error), -85.0);
    }
}

/// Random returns made when asked for, and a record of the memory that is lent for them.
class CountingSource final : public ReturnSource {
 public:
  CountingSource(std::size_t blocks, double spread) : blocks_(blocks), spread_(spread) {}
  [[nodiscard]] std::size_t blocks() const override { return blocks_; }
  [[nodiscard]] std::size_t expected(std::size_t /*block*/) const override { return each; }
  void make(std::size_t block, ReturnBlock& into) const override {
    EXPECT_TRUE(into.returns.empty());
    into.returns =
        RandomReturns{.count = each, .last = 4.0, .spread = spread_, .seed = 1 + block}.make();
    const std::scoped_lock lock(lock_);
    lent_.insert(&into);
    ++made_;
  }
  [[nodiscard]] std::vector<DopplerSpan> dopplers() const override {
    return {{1.0 - spread_, 1.0 + spread_}};
  }
  [[nodiscard]] Returns all() const {
    Returns returns;
    for (std::size_t b = 0; b < blocks_; ++b) {
      ReturnBlock block;
      make(b, block);
      returns.insert(returns.end(), block.returns.begin(), block.returns.end());
    }
    return returns;
  }
  [[nodiscard]] std::size_t lent() const { return lent_.size(); }
  [[nodiscard]] std::size_t made() const { return made_; }  ///< blocks

  static constexpr std::size_t each = 4000;

 private:
  std::size_t blocks_;
  double spread_;
  mutable std::mutex lock_;
  mutable std::set<const ReturnBlock*> lent_;
  mutable std::size_t made_ = 0;
};

// Batches of 8 MB are at most 8·2²⁰/144 = 58 000 returns, 15 blocks, however many there are.
TEST(Synthesis, MemoryDoesNotGrowWithTheReturns) {
  const Synthesizer synthesizer(Pulse(tone(0.3)), four_seconds, 0.001);
  std::vector<std::size_t> lent;
  for (const std::size_t blocks : {20U, 80U}) {
    const CountingSource source(blocks, 0.0);
    static_cast<void>(synthesizer.baseband(source, three_phones));
    lent.push_back(source.lent());
  }
  EXPECT_LE(lent[0], 15U);
  EXPECT_EQ(lent[1], lent[0]);
}

// What is made grows with the scatterers, not with the phones: every block once, however many
// listen.
TEST(Synthesis, MakesEveryReturnOnceForAllPhones) {
  const Synthesizer synthesizer(Pulse(tone(0.3)), four_seconds, 0.001);
  for (const int phones : {1, 3, 40})
    for (const std::size_t blocks : {5U, 10U, 40U}) {
      const CountingSource source(blocks, 0.001);
      static_cast<void>(synthesizer.baseband(source, line_array(phones, 0.1875, 0.0, 0.0).phones));
      EXPECT_EQ(source.made(), blocks) << phones;
    }
}

// A source in batches, its Doppler factors cut into bands, gridded by 1, 2 and 7 threads: the same
// bits, and what the list of all its returns gives, some 400 000 to a second, to −80 dB of the sum.
TEST(Synthesis, ASourceIsTheListOfItsReturns) {
  const Synthesizer synthesizer(Pulse(tone(0.3)), four_seconds, 0.0031);
  const CountingSource source(40, 0.003);
  std::vector<Baseband> results;
  for (const std::size_t threads : {1U, 2U, 7U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(synthesizer.baseband(source, three_phones));
  }
  EXPECT_EQ(results[0].values, results[1].values);
  EXPECT_EQ(results[0].values, results[2].values);
  const Baseband list = synthesizer.baseband(source.all(), three_phones);
  float worst = 0.0F, largest = 0.0F;
  for (std::size_t i = 0; i < list.values.size(); ++i) {
    worst = std::max(worst, std::abs(list.values[i] - results[0].values[i]));
    largest = std::max(largest, std::abs(list.values[i]));
  }
  EXPECT_LT(worst, 1e-4F * largest);
}

// A few hundred returns out of a source, its factors in bands that the promised segment sets, are
// the direct sum.
TEST(Synthesis, ASourceMatchesDirectSynthesis) {
  const Pulse pulse(tone(0.05));
  const CountingSource source(1, 0.003);
  const Synthesizer synthesizer(pulse, four_seconds, 0.0031);
  std::vector<float> fast(three_phones.size() * four_seconds.samples, 0.0F);
  synthesizer.add_samples(synthesizer.baseband(source, three_phones), 1.0, fast);
  const auto exact = direct_synthesis(pulse, four_seconds, source.all(), three_phones);
  double error = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    error = std::max(error, std::abs(double(fast[i]) - exact[i]));
    largest = std::max(largest, std::abs(exact[i]));
  }
  EXPECT_LT(db_from_amplitude(error / largest), -80.0);
}

/// As many batches as blocks: each says that it fills one, and has a few hundred returns of all
/// Doppler factors in two segments of delay (a ring received along two paths).
class LargeSource final : public ReturnSource {
 public:
  explicit LargeSource(double spread) : spread_(spread) {}
  [[nodiscard]] std::size_t blocks() const override { return 6; }
  [[nodiscard]] std::size_t expected(std::size_t /*block*/) const override { return 4'000'000; }
  void make(std::size_t block, ReturnBlock& into) const override {
    const double near = -1.0 + 3.6 * static_cast<double>(block);
    for (const double first : {near, near + 7.3}) {
      const Returns part = RandomReturns{.count = 40,
                                         .first = first,
                                         .last = first + 3.6,
                                         .spread = spread_,
                                         .channels = 9,
                                         .seed = 1 + block}
                               .make();
      into.returns.insert(into.returns.end(), part.begin(), part.end());
    }
  }
  [[nodiscard]] std::vector<DopplerSpan> dopplers() const override {
    return {{1.0 - spread_, 1.0 + spread_}};
  }
  [[nodiscard]] Returns all() const {
    Returns returns;
    for (std::size_t b = 0; b < blocks(); ++b) {
      ReturnBlock block;
      make(b, block);
      returns.insert(returns.end(), block.returns.begin(), block.returns.end());
    }
    return returns;
  }

 private:
  double spread_;
};

// A vehicle under way with a broad pulse: batches whose grids are not kept are transformed in
// windows of delay. The direct sum to −80 dB of the strongest return, some hundred overlapping, at
// nine phones over 40 m, delays past both ends of the record, of which some are received at one
// phone only; the same bits by any number of threads.
TEST(Synthesis, BatchesInWindowsOfDelayMatchDirectSynthesis) {
  const Recording recording = {.sample_rate = 12000.0, .start = 0.4, .samples = 240000};
  std::vector<Vec3> phones = line_array(8, 0.1875, 0.3, 0.0).phones;
  phones.emplace_back(-30.0, 25.0, 8.0);
  const PulseSettings settings = {
      .waveform = Lfm{.start_frequency = 3900.0, .end_frequency = 4100.0}, .duration = 0.4};
  const Pulse pulse(settings);
  const LargeSource source(0.003);
  const Synthesizer synthesizer(pulse, recording, 0.0031);
  std::vector<Baseband> results;
  for (const std::size_t threads : {1U, 3U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(synthesizer.baseband(source, phones));
  }
  EXPECT_EQ(results[0].values, results[1].values);
  std::vector<float> fast(phones.size() * recording.samples, 0.0F);
  synthesizer.add_samples(results[0], 1.0, fast);
  const Returns all = source.all();
  const auto exact = direct_synthesis(pulse, recording, all, phones);
  double error = 0.0, strongest = 0.0;
  for (const Return& r : all) strongest = std::max(strongest, std::abs(r.amplitude));
  for (std::size_t i = 0; i < exact.size(); ++i)
    error = std::max(error, std::abs(double(fast[i]) - exact[i]));
  EXPECT_LT(db_from_amplitude(error / strongest), -80.0);
}

// A complex recording cuts an unwindowed sweep's band: what is synthesised for it is little wider
// than it.
TEST(HardPulse, IsSynthesisedOverWhatIsRecorded) {
  const PulseSettings settings = {
      .waveform = Lfm{.start_frequency = 3900.0, .end_frequency = 4100.0},
      .duration = 0.5,
      .window = PulseWindow::none};
  const Pulse pulse(settings);
  const auto half_band = [&](double rate) {
    const Recording recording{.sample_rate = rate, .samples = 4000, .carrier = 4000.0};
    return Synthesizer(pulse, recording, 0.002).half_band();
  };
  // Slopes included, what stays within ±600 Hz of the carrier under every factor, less two bins.
  EXPECT_NEAR(half_band(1200.0), (600.0 - 2.0 * 0.3 - 4000.0 * 0.002) / 1.002, 1e-6);
  EXPECT_GT(half_band(20000.0), 1.5 * half_band(1200.0));
}

}  // namespace
}  // namespace asdic::detail
