// Reverberation of pairs of ends: exchanged, brought together, from ping to ping; sectors, fast
// synthesis, rows and Doppler segments against every scatterer on its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "sonar/synthesis/direct_synthesis.h"
#include "support/received_spectrum.h"
#include "support/reverberant_sea.h"

namespace asdic::detail {
namespace {

using support::at, support::quiet_sea, support::spectrum;
using Sea = support::ReverberantSea;

/// Everything that scatters, and two platforms.
Scenario bistatic() {
  Scenario s = support::thesis(SoundSpeedProfile::munk());
  s.environment.bottom = {.depth = 3000.0, .material = FluidHalfSpace{}};
  s.platforms = {{}, {}};
  s.platforms[0].track.start.position = {0.0, 0.0, 300.0};
  s.platforms[1].track.start.position = {2500.0, 1000.0, 120.0};
  s.arrays[0].platform = 1;
  s.pulse.duration = 0.2;
  s.reverberation = {.enabled = true, .azimuths = 24};
  s.reverberation.bottom = EllisCrowe{};
  s.reverberation.volume = {{.top = 500.0, .bottom = 560.0}};
  s.propagation.max_surface_bounces = s.propagation.max_bottom_bounces = 1;
  s.pings.recording_duration = 6.0;
  return s;
}

// Source and receiver exchanged: the same returns, pair by pair (i, j) as (j, i), with the same
// delays and amplitudes to rounding; only the directions are the other end's. A pair that is at the
// very limit of what is received may be on either side of it.
TEST(ReverberationField, SourceAndReceiverMayChangePlaces) {
  Scenario s = bistatic();
  const Returns there = Sea(s).ping(1).returns();
  s.transmitters[0].platform = 1;
  s.arrays[0].platform = 0;
  const Returns back = Sea(s).ping(1).returns();
  struct Sums {
    std::complex<double> phased = 0.0;
    double power = 0.0, size = 0.0;
  };
  const auto sums = [](const Returns& returns) {
    Sums found;
    for (const Return& r : returns) {
      found.phased += r.amplitude * std::polar(1.0, 40.0 * r.delay);
      found.power += std::norm(r.amplitude);
      found.size += std::abs(r.amplitude);
    }
    return found;
  };
  EXPECT_GT(there.size(), 10'000U);
  EXPECT_NEAR(double(there.size()), double(back.size()), 10.0);
  const Sums one = sums(there), other = sums(back);
  EXPECT_NEAR(one.power, other.power, 1e-6 * other.power);
  EXPECT_LT(std::abs(one.phased - other.phased), 1e-6 * other.size);
}

// A bistatic pair brought together is the monostatic sonar, bit for bit.
TEST(ReverberationField, ABistaticPairBroughtTogetherIsMonostatic) {
  Scenario s = bistatic();
  s.platforms[1] = s.platforms[0];
  const Baseband two = Sea(s).receive(1);
  s.platforms.resize(1);
  s.arrays[0].platform = 0;
  EXPECT_TRUE(two.values == Sea(s).receive(1).values);
}

// The texture, the weights and the places of a field belong to the world: a ping from the same
// place a fraction of the coherence time later receives nearly the same, exp(−(Δt/T)²); one from a
// place beyond the array's sight of it does not, and without persistence the next ping does not
// either. Correlation of N ≈ 300 independent samples: ± 1/√(2N) = 0.04 each, 4.9 sigma 0.2.
TEST(ReverberationField, SuccessivePingsForgetAsTheLawSays) {
  Scenario s = support::even_sea();
  s.pulse = {.duration = 0.12};
  s.pings.recording_duration = 40.0;
  const auto correlation = [](const Baseband& a, const Baseband& b) {
    std::complex<double> cross = 0.0;
    double of_a = 0.0, of_b = 0.0;
    for (double t = 7.0; t < 39.0; t += 0.11) {
      const auto x = at(a, 0, t), y = at(b, 0, t);
      const double weight = std::pow(t, 5.0);
      cross += weight * std::conj(x) * y;
      of_a += weight * std::norm(x);
      of_b += weight * std::norm(y);
    }
    return (cross / std::sqrt(of_a * of_b)).real();
  };
  s.reverberation.surface_field.statistics.coherence_time = 60.0;
  const Sea sea(s);
  const Baseband first = sea.receive(1, 0.0);
  for (const double later : {20.0, 50.0, 90.0})
    EXPECT_NEAR(correlation(first, sea.receive(2, later)), std::exp(-std::pow(later / 60.0, 2.0)),
                0.2)
        << later;
  s.reverberation.surface_field.statistics.coherence_time = infinity;
  const Sea frozen(s);
  EXPECT_NEAR(correlation(frozen.receive(1, 0.0), frozen.receive(2, 500.0)), 1.0, 1e-6);
  // Somewhere else: another anchor. λ is 0.375 m, so that even metres are far.
  Scenario elsewhere = s;
  elsewhere.platforms[0].track.start.position.x() += 20.0;
  EXPECT_NEAR(correlation(frozen.receive(1, 0.0), Sea(elsewhere).receive(1, 0.0)), 0.0, 0.2);
  s.reverberation.surface_field.statistics.coherence_time = 0.0;
  const Sea fresh(s);
  EXPECT_NEAR(correlation(fresh.receive(1, 0.0), fresh.receive(2, 1.0)), 0.0, 0.2);
}

// Sectors in place of scatterers: the same mean, covariance between phones and Doppler spectrum. A
// vehicle that moves under Bragg waves, paths by the bottom (so that reciprocal pairs add
// coherently), 60 pings of 16 samples. Power to 4.9·√(2/960) = 22 %; coherences to 4.9·√(2/1920) =
// 0.16; every bin of the spectrum (of 1 Hz, 240 windows) to 4.9·√(2/240) = 45 % of the largest.
TEST(ReverberationField, SectorsAreTheScatterersStatistically) {
  Scenario s = support::even_sea();
  s.environment.bottom = {.depth = 1000.0, .material = FluidHalfSpace{}};
  s.propagation.max_surface_bounces = s.propagation.max_bottom_bounces = 1;
  s.platforms[0].track.start = {.position = {0.0, 0.0, 300.0}, .velocity = {5.0, 2.0, 0.0}};
  s.reverberation.surface_field.motion.kind = ScattererMotion::Kind::bragg;
  s.reverberation.azimuths = 18;
  s.pulse = {.waveform = Cw{.frequency = 1500.0}, .duration = 0.25};
  s.arrays[0].phones = {Vec3::Zero(), Vec3(0.15, 0.1, 0.0), Vec3(0.0, 0.0, 0.2)};
  s.pings.sample_rate = 4000.0;
  s.pings.recording_start = 3.0;
  s.pings.recording_duration = 4.1;
  const Sea sea(s);
  std::vector<double> frequencies;
  for (double f = -14.0; f <= 14.0; f += 1.0) frequencies.push_back(f);
  struct Statistics {
    double power = 0.0;
    std::complex<double> across = 0.0, down = 0.0;
    std::vector<double> spectrum;
    std::size_t returns = 0;
  };
  const auto observe = [&](bool sectors) {
    Statistics found{.spectrum = std::vector<double>(frequencies.size())};
    const std::complex<double> one = 1.0;
    for (std::uint32_t number = 1; number <= 60; ++number) {
      const PingReverberation ping = sea.ping(number);
      const Returns returns = sectors ? ping.sector_returns() : ping.plain_returns();
      found.returns = returns.size();
      const Baseband received = sea.receive(returns);
      for (double t = 3.1; t < 7.0; t += 0.25) {
        const auto a = at(received, 0, t), b = at(received, 1, t), c = at(received, 2, t);
        const double weight = std::pow(t, 4.0);
        found.power += weight * std::norm(a);
        found.across += weight * std::conj(a) * b;
        found.down += weight * std::conj(a) * c;
      }
      for (double from = 3.0; from < 7.0; from += 1.0) {
        const auto more = spectrum(received, {&one, 1}, from, from + 1.0, frequencies);
        for (std::size_t k = 0; k < more.size(); ++k)
          found.spectrum[k] += more[k] * std::pow(from + 0.5, 4.0);
      }
    }
    return found;
  };
  const Statistics plain = observe(false), fast = observe(true);
  EXPECT_LT(fast.returns, plain.returns / 2);
  EXPECT_NEAR(fast.power / plain.power, 1.0, 0.22);
  EXPECT_LT(std::abs(fast.across / fast.power - plain.across / plain.power), 0.16);
  EXPECT_LT(std::abs(fast.down / fast.power - plain.down / plain.power), 0.16);
  const double most = *std::max_element(plain.spectrum.begin(), plain.spectrum.end());
  for (std::size_t k = 0; k < frequencies.size(); ++k)
    EXPECT_NEAR(fast.spectrum[k] / most, plain.spectrum[k] / most, 0.45) << frequencies[k];
  // The limit switches.
  Scenario limited = s;
  limited.reverberation.most_returns = plain.returns / 2;
  const Sea other(limited);
  EXPECT_NEAR(other.ping(1).expected_returns(), double(plain.returns),
              0.05 * double(plain.returns));
  EXPECT_LE(other.ping(1).returns().size(), plain.returns / 2);
}

// Moving ends, Bragg lines, all boundaries, arrays: the fast synthesis against every pulse
// evaluated at every sample, for a few hundred of the scatterers. Error below −80 dB of the
// strongest sample.
TEST(ReverberationField, FastSynthesisIsDirectSynthesis) {
  Scenario s = bistatic();
  s.platforms[0].track.start.velocity = {4.0, -3.0, 0.5};
  s.platforms[1].track.start.velocity = {-2.0, 5.0, 0.0};
  s.reverberation.surface_field.motion = {.kind = ScattererMotion::Kind::bragg,
                                          .current = {0.5, 0.2}};
  s.reverberation.volume[0].field.motion = {.kind = ScattererMotion::Kind::spread,
                                            .speed_rms = 0.4};
  s.pulse = {.waveform = Lfm{}, .duration = 0.2};
  s.arrays[0] = line_array(3, 0.4, 0.4, 0.1);
  s.arrays[0].platform = 1;
  s.reverberation.resolve_azimuth = false;
  // Sheets of equal thickness, so that many returns are of the same strength.
  VolumeLayer& layer = s.reverberation.volume[0];
  layer.sheets = std::max(1, int(std::ceil((layer.bottom - layer.top) / 50.0)));
  const Sea sea(s);
  const Returns all = sea.ping(1).returns();
  Returns some;
  for (std::size_t i = 0; i < all.size(); i += all.size() / 400) some.push_back(all[i]);
  const double strongest =
      std::abs(std::max_element(some.begin(), some.end(), [](const Return& a, const Return& b) {
                 return std::abs(a.amplitude) < std::abs(b.amplitude);
               })->amplitude);
  std::erase_if(some, [&](const Return& r) { return std::abs(r.amplitude) < 0.03 * strongest; });
  ASSERT_GT(some.size(), 40U);
  const Synthesizer synthesizer(sea.pulse(), sea.recording(), doppler_bound(s));
  std::vector<float> fast(3 * sea.recording().samples);
  synthesizer.add_samples(synthesizer.baseband(some, s.arrays[0].phones), 1.0, fast);
  const auto plain = direct_synthesis(sea.pulse(), sea.recording(), some, s.arrays[0].phones);
  double worst = 0.0, peak = 0.0;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    worst = std::max(worst, std::abs(plain[i] - double(fast[i])));
    peak = std::max(peak, std::abs(plain[i]));
  }
  EXPECT_LT(worst, 1e-4 * peak);
}

// Every row of the file says what scattered, and all three are among them.
TEST(ReverberationField, RowsSayWhatScattered) {
  Scenario s = quiet_sea();
  s.reverberation.surface_scatters = true;
  s.reverberation.bottom = Lambert{};
  s.reverberation.volume = {{.top = 1000.0, .bottom = 1050.0, .strength_db = -75.0}};
  s.pings.recording_duration = 8.0;
  const Sea sea(s);
  std::array<int, 3> rows{};
  for (const PatchRow& row : sea.ping(1).rows(100'000).rows) {
    ++rows[static_cast<std::size_t>(row.ground)];
    if (row.ground == PatchRow::Ground::volume) {
      EXPECT_NEAR(row.scattering_strength_db, -75.0 + db_from_power(50.0), 1e-9);
    } else if (row.ground == PatchRow::Ground::bottom) {
      EXPECT_NEAR(row.scattering_strength_db,
                  -27.0 + db_from_power(std::sin(row.grazing_in) * std::sin(row.grazing_out)),
                  1e-9);
    }
  }
  for (const int n : rows) EXPECT_GT(n, 20);
}

// The segments of Doppler factors that a source promises hold all that it makes: every kind of
// motion, one platform and two.
TEST(ReverberationField, DopplerFactorsLieWhereTheyArePromised) {
  for (const auto kind :
       {ScattererMotion::Kind::still, ScattererMotion::Kind::bragg, ScattererMotion::Kind::spread})
    for (const bool bistatic : {false, true})
      for (const double speed : {0.0, 4.0}) {
        Scenario s = quiet_sea();
        s.reverberation.surface_scatters = true;
        s.reverberation.surface_field.motion = {
            .kind = kind, .speed_rms = 1.0, .current = {0.5, -0.3}};
        s.platforms[0].track.start.velocity = {speed, 0.5 * speed, 0.1 * speed};
        if (bistatic) {
          s.platforms.push_back(s.platforms[0]);
          s.platforms[1].track.start.position.x() += 2000.0;
          s.arrays[0].platform = 1;
        }
        s.pings.recording_duration = 9.0;
        const Sea sea(s);
        const PingReverberation ping = sea.ping(1);
        const std::vector<DopplerSpan> spans = ping.dopplers();
        for (const Return& r : ping.returns())
          ASSERT_TRUE(std::any_of(spans.begin(), spans.end(),
                                  [&](const DopplerSpan& span) {
                                    return r.doppler >= span.lowest - 1e-12 &&
                                           r.doppler <= span.highest + 1e-12;
                                  }))
              << r.doppler << ' ' << int(kind) << ' ' << bistatic << ' ' << speed;
      }
}

}  // namespace
}  // namespace asdic::detail
