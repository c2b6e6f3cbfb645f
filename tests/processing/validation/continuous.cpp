#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/geometry.h"
#include "processing/known_blasts.h"
#include "processing/normaliser.h"
#include "support/processing.h"
#include "support/thesis.h"

namespace asdic::detail {
namespace {

/// A ship that goes north at 3 m/s and a partner 9 km away send sweeps of 8 s without a pause, each
/// in a band of its own; twelve phones under the ship receive. Water without refraction, noise, no
/// boundaries' echoes: what is tested is the receiver.
Scenario continuous(std::uint64_t seed, bool targets = true) {
  Scenario s = support::thesis(SoundSpeedProfile::isovelocity(1500.0));
  s.seed = seed;
  s.platforms[0].track.start = {.position = {0.0, 0.0, 1000.0}, .velocity = {0.0, 3.0, 0.0}};
  s.platforms.push_back({.name = "partner", .track = {}});
  s.platforms[1].track.start.position = {8000.0, 4000.0, 1100.0};
  s.arrays[0] = line_array(12, 0.6, 0.0, 0.0);
  s.transmitters[0].source_level_db = 200.0;
  s.transmitters.push_back(s.transmitters[0]);
  s.transmitters[1].platform = 1;
  s.transmitters[1].pulse =
      PulseSettings{.waveform = Lfm{1150.0, 1250.0}, .duration = 8.0, .window = PulseWindow::tukey};
  s.pulse = {.waveform = Lfm{950.0, 1050.0}, .duration = 8.0, .window = PulseWindow::tukey};
  if (targets)
    s.targets = {support::target({2500.0, 3000.0, 1000.0}, 10.0, {-2.0, 1.0, 0.0}),
                 support::target({-3500.0, 2000.0, 900.0}, 12.0, {3.0, 0.0, 0.0}),
                 support::target({1500.0, -4200.0, 1050.0}, 12.0, {0.0, 2.0, 0.0})};
  s.noise.law = WhiteNoise{55.0};
  s.pings.count = 2;
  s.pings.interval = 8.0;
  s.pings.recording_duration = 16.0;
  s.pings.sample_rate = 3000.0;
  s.pings.continuous = true;
  return s;
}

struct Outcome {
  int hits = 0, misses = 0, false_alarms = 0;
  double lowered_db = 0.0;  // the least
};

/// The first ping of either transmitter, received into what follows it, as a file tells it.
Outcome outcome(const Scenario& s, ProcessingSettings settings) {
  const PingSimulator simulator(s);
  std::vector<PingRecord> records;
  run_pings(simulator, [&](PingRecord&& record) { records.push_back(std::move(record)); });
  const PingProcessor processor(s, support::replicas_of(simulator), settings);
  Outcome sum{.lowered_db = infinity};
  const auto wanted = std::size_t(s.pings.recording_duration * s.pings.sample_rate);
  for (std::size_t row = 0; row < 2; ++row) {
    ArrayRecording r = support::recording_of(s, records[row]);
    std::vector<float> whole;
    for (std::size_t n = 0; n < r.phones.size(); ++n) {
      std::vector<float> phone;
      for (std::size_t k = row; k < records.size() && phone.size() < wanted; ++k) {
        const std::size_t samples = records[k].recording.samples;
        const auto from = records[k].pressure.begin() + std::ptrdiff_t(n * samples);
        phone.insert(phone.end(), from,
                     from + std::ptrdiff_t(std::min(samples, wanted - phone.size())));
      }
      whole.insert(whole.end(), phone.begin(), phone.end());
    }
    r.pressure = whole;
    std::vector<TrueEcho> echoes = true_echoes(records[row], 0);
    // Of a transmitter's other pings, which are no false alarms.
    for (const PingRecord& other : records)
      if (other.transmitter == records[row].transmitter && other.ping != records[row].ping)
        for (TrueEcho echo : true_echoes(other, 0)) {
          echo.target = another_ping;
          echo.time += other.start_time - records[row].start_time;
          echoes.push_back(echo);
        }
    const ProcessedArray done = processor.process(r, {}, echoes);
    for (std::size_t i = 0; i < echoes.size(); ++i)
      echoes[i].threshold_db = done.result.thresholds_db[i];
    const auto targets = true_targets(s, records[row].ping, records[row].start_time, echoes);
    const PingScore score =
        score_detections(done.result.detections, echoes, targets, done.shape, done.places.array,
                         processor.resolution(done), done.searched_from, done.searched_until);
    sum.hits += score.hits;
    sum.misses += score.misses;
    sum.false_alarms += score.false_alarms;
    if (records[row].transmitter == 1)
      sum.lowered_db = std::min(sum.lowered_db, done.blast.lowered_db());
  }
  return sum;
}

ProcessingSettings receiver(BlastCancelling cancel, int sub_bands = 1) {
  ProcessingSettings settings{.max_speed = 8.0, .target_depth = 1000.0};
  settings.cancel_direct_blast = cancel;
  settings.detector.sub_bands = sub_bands;
  return settings;
}

// Three targets, two transmitters: six echoes, each 15 dB or more over the noise of its cell. The
// truth is the simulation's (time along the ridge, bearing, Doppler factor), for each of several
// seas of noise. Without the cancelling the partner's echoes are lost under its own sound; with it
// all are found, whole or in sub-bands. Of six seas (seeds 1 to 6) 35 of 36 echoes are found: the
// first has one that is not.
TEST(ContinuousSonar, SixOfSixEchoesAreFoundUnderTheBlast) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Scenario s = continuous(seed);
    const Outcome found = outcome(s, receiver(BlastCancelling::automatic));
    EXPECT_GE(found.hits, seed == 1 ? 5 : 6) << seed;
    EXPECT_EQ(found.hits + found.misses, 6) << seed;
    EXPECT_GT(found.lowered_db, 25.0);
    if (seed != 2) continue;
    EXPECT_LE(outcome(s, receiver(BlastCancelling::off)).hits, 4);
    const Outcome parts = outcome(s, receiver(BlastCancelling::automatic, 4));
    EXPECT_EQ(parts.hits, 6);
  }
}

// Noise and blasts alone: a transmitter's search has 8 s × 100 Hz × 12 beams × some 10 independent
// filters, 10⁵ cells at 10⁻⁶, of which overlapping ones make a few times as many: 0.3 a search.
// More than four in two of them has a probability below 10⁻³.
TEST(ContinuousSonar, BlastsAloneGiveFewDetections) {
  const Scenario s = continuous(3, false);
  EXPECT_LE(outcome(s, receiver(BlastCancelling::automatic)).false_alarms, 4);
  EXPECT_LE(outcome(s, receiver(BlastCancelling::automatic, 4)).false_alarms, 4);
}

// --from leaves echoes while the transmitter sends on, from the own ship at once and from the
// partner when its own sound comes; where the array is blanked meanwhile, only after the pulse.
TEST(ContinuousSonar, SearchBeginsWhereEchoesCan) {
  Scenario s = continuous(1);
  EXPECT_TRUE(sends_on(s, 0, 0, 8.0));
  EXPECT_FALSE(sends_on(s, 0, 0, 1.0));
  s.pings.blanking = true;
  EXPECT_FALSE(sends_on(s, 0, 0, 8.0));
  EXPECT_TRUE(sends_on(s, 1, 0, 8.0));  // the partner's is no reason to be blanked
  s.pings.continuous = false;
  EXPECT_FALSE(sends_on(s, 1, 0, 8.0));
}

/// Two phones 3 m apart, a source that passes: range changes with the square of time.
struct Passing {
  Replica pulse;
  Baseband record;
  ListeningBand band;
  KnownBlast blast;
};

constexpr double rate = 1500.0, length = 12.0;

double range_at(double t, std::size_t phone) {
  return 4.0 * (t - 2.0) + 0.06 * (t - 2.0) * (t - 2.0) + 3.0 * static_cast<double>(phone);
}

Passing passing(double blast, double echo, double when = 2.6) {
  const Pulse pulse({.waveform = Lfm{200.0, 300.0}, .duration = 8.0, .window = PulseWindow::tukey});
  Passing made{.pulse = Replica(std::span<const float>(replica(pulse, rate)), rate),
               .record = {},
               .band = {.centre = 250.0, .width = 160.0},
               .blast = {}};
  std::vector<float> pressure;
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0.0, 1e-4);
  for (std::size_t n = 0; n < 2; ++n)
    for (int i = 0; i < int(length * rate); ++i) {
      const double t = i / rate, late = range_at(t, n) / 1500.0;
      const auto way = [&](double delay) { return pulse.analytic(t - delay - late).real(); };
      double p = blast * (way(2.0) - 0.8 * way(2.004) + 0.3 * way(2.35));
      p += echo * pulse.analytic(1.002 * (t - when)).real() + noise(random);
      pressure.push_back(static_cast<float>(p));
    }
  made.record = to_baseband(pressure, 2, rate, 0.0, made.band, 8.0);
  return made;
}

void know(Passing& p, bool moving) {
  p.blast.pulse = &p.pulse;
  for (const double delay : {2.0, 2.004, 2.35})
    p.blast.paths.push_back({.delay = delay, .slowness = 1.0 / 1500.0, .power = 1.0});
  for (int i = 0; i <= 120; ++i) p.blast.moments.push_back(0.1 * i);
  for (std::size_t n = 0; n < 2; ++n) {
    p.blast.range.emplace_back();
    for (const double t : p.blast.moments)
      p.blast.range[n].push_back(moving ? range_at(t, n) : range_at(2.0, n));
    p.blast.depth.emplace_back(p.blast.moments.size(), 0.0);
  }
}

// The truth: sound written down sample by sample, with a range that changes by 36 m, 6 m of it a
// curve. Noise is 80 dB below the blast. A source that is believed to rest is followed by filters
// of many parts, at the price of as many cells that are blind. A record without a blast keeps its
// bits.
TEST(BlastCanceller, LeavesTheNoiseOfAMovingSource) {
  Passing p = passing(1.0, 0.0);
  know(p, true);
  BlastCancellation result;
  cancel_blasts(p.record, p.band, std::span(&p.blast, 1), {}, result);
  EXPECT_EQ(result.cancelled, 1U);
  EXPECT_GT(result.lowered_db(), 60.0);
  Passing still = passing(1.0, 0.0);
  know(still, false);
  BlastCancellation worse;
  cancel_blasts(still.record, still.band, std::span(&still.blast, 1), {}, worse);
  EXPECT_LE(result.parts, 4);
  EXPECT_GE(worse.parts, 16);
  EXPECT_GT(worse.beside, 2.0 * result.beside);
  Passing nothing = passing(0.0, 0.0);
  know(nothing, true);
  const auto before = nothing.record.values;
  cancel_blasts(nothing.record, nothing.band, std::span(&nothing.blast, 1), {}, worse);
  EXPECT_EQ(worse.cancelled, 0U);
  EXPECT_TRUE(before == nothing.record.values);
}

// An echo 50 dB below, whose factor is 0.005 higher: along the ridge (κ = Tf/B = 24 s) it lies 0.12
// s earlier among the blast's delays. 0.15 s after the last way it is blind, 0.25 s after it 13
// cells away and spread by the other rate over 8 of them: 1.5 dB are allowed. Far away it keeps its
// level.
TEST(BlastCanceller, KeepsEchoesOutsideTheBlindZone) {
  const auto level = [](const Passing& p, double when) {
    const std::vector<double> factor{1.002};
    const MatchedFilterBank bank(p.pulse, factor, p.record);
    const BeamSpectra spectra = channel_spectra(p.record);
    FftBuffer<std::complex<float>> out(bank.work());
    bank.filter(0, spectra.beam(0), out.data());
    double most = 0.0;
    for (std::size_t i = 0; i < bank.samples(); ++i)
      if (std::abs(bank.time(double(i)) - when) < 0.02)
        most = std::max(most, static_cast<double>(std::abs(out[i])));
    return db_from_amplitude(most);
  };
  const auto lost = [&](double when) {
    const Passing alone = passing(0.0, 3e-3, when);
    Passing under = passing(1.0, 3e-3, when);
    know(under, true);
    BlastCancellation result;
    cancel_blasts(under.record, under.band, std::span(&under.blast, 1), {}, result);
    return level(alone, when) - level(under, when);
  };
  EXPECT_GT(lost(2.5), 20.0);
  EXPECT_LT(std::abs(lost(2.6)), 1.5);
  EXPECT_LT(std::abs(lost(3.0)), 0.3);
}

// Means of N exponential values over the mean of M such means: 4·10⁶ draws at P = 10⁻³ make 4000
// exceedances, ±63; five of these are 8 %. The threshold of single values would be passed by far
// fewer.
TEST(CfarMultiplier, OfMeansOfSeveralLooks) {
  std::mt19937_64 random(11);
  for (const auto& [looks, cells] : {std::pair(4, 12), std::pair(8, 24)}) {
    const double alpha = cfar_multiplier(1e-3, cells, looks);
    std::gamma_distribution<double> one(looks, 1.0 / looks), many(looks * cells, 1.0 / looks);
    int over = 0;
    constexpr int draws = 4000000;
    for (int i = 0; i < draws; ++i) over += one(random) > alpha * many(random) / cells ? 1 : 0;
    EXPECT_NEAR(over / (1e-3 * draws), 1.0, 0.08) << looks;
    EXPECT_LT(alpha, cfar_multiplier(1e-3, cells));
  }
  EXPECT_NEAR(cfar_multiplier(1e-6, 24.0), 24.0 * (std::pow(1e-6, -1.0 / 24.0) - 1.0), 1e-9);
}

// An echo of 8 m/s through four sub-bands: its amplitude, its time, at its own factor; a filter of
// factor 1 receives it in every sub-band at another time, along the ridge, and their mean is less.
TEST(SubBands, AreAlignedAtTheEchosFactor) {
  const Pulse pulse({.waveform = Lfm{200.0, 300.0}, .duration = 8.0, .window = PulseWindow::none});
  const Replica known(std::span<const float>(replica(pulse, rate)), rate);
  const double factor = 1.0107;
  std::vector<float> pressure;
  for (int i = 0; i < int(length * rate); ++i)
    pressure.push_back(static_cast<float>(pulse.analytic(factor * (i / rate - 2.0)).real()));
  const ListeningBand band{.centre = 250.0, .width = 160.0};
  const Baseband record = to_baseband(pressure, 1, rate, 0.0, band, 8.0);
  const std::vector<double> factors{1.0, factor};
  const MatchedFilterBank bank(known, factors, record, 4);
  const BeamSpectra spectra = channel_spectra(record);
  FftBuffer<std::complex<float>> work(bank.work());
  std::vector<float> power(bank.samples());
  const auto top = [&](std::size_t k) {
    bank.power(k, spectra.beam(0), work.data(), power.data());
    return std::max_element(power.begin(), power.end()) - power.begin();
  };
  const auto unaligned = top(0);
  EXPECT_LT(power[std::size_t(unaligned)], 0.4F);
  const auto aligned = top(1);
  EXPECT_NEAR(power[std::size_t(aligned)], 1.0F, 0.03F);
  // To a sample of the output, a ninth of a sub-band's cell of 40 ms.
  EXPECT_NEAR(bank.time(double(aligned)), 2.0, 1.0 / bank.sample_rate());
  const std::vector<double> edges = sub_band_edges(known, 4);
  ASSERT_EQ(edges.size(), 3U);  // a sweep's energy is even over its band
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(edges[k], 225.0 + 25.0 * double(k), 0.5);
}

}  // namespace
}  // namespace asdic::detail
