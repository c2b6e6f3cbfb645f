// The recipe "A waveform" of docs/develop/recipes.md: what a new waveform needs, and what follows.
#include <gtest/gtest.h>

#include <cmath>
#include <variant>

#include "core/error.h"
#include "core/quantities.h"
#include "core/settings_words.h"
#include "io/settings/reader.h"
#include "io/settings/writer.h"
#include "sonar/signal/pulse.h"

namespace asdic::detail {
namespace {

// [recipe]
/// A sweep whose rate is 0 where it begins: f(t) = f₁ + (f₂ − f₁)(t/T)²,
/// φ(t) = 2πt(f₁ + ⅓(f₂ − f₁)(t/T)²).
struct QuadraticSweep {
  static constexpr std::string_view name = "quadratic", title = "quadratic sweep";
  double start_frequency = 3950.0;  ///< f₁ [Hz]
  double end_frequency = 4050.0;    ///< f₂ [Hz]

  void describe(Fields& field) { describe_sweep(field, start_frequency, end_frequency); }
  [[nodiscard]] PulseFrequencies frequencies(double /*duration*/) const noexcept {
    return {std::min(start_frequency, end_frequency), std::max(start_frequency, end_frequency)};
  }
  [[nodiscard]] double phase(double t, double duration) const noexcept {
    const double share = t / duration, width = end_frequency - start_frequency;
    return 2.0 * pi * t * (start_frequency + width * share * share / 3.0);
  }
  [[nodiscard]] bool operator==(const QuadraticSweep&) const = default;
};
static_assert(PhaseWaveform<QuadraticSweep>);
// [recipe]

/// The closed list with one word more, and what PulseSettings makes of it.
using OneMoreWaveform = std::variant<Cw, Lfm, Hfm, SampledPulse, QuadraticSweep>;
struct SettingsOfOneMore {
  OneMoreWaveform waveform = Cw{};
  void describe(Fields& field) { field.one_of(required("kind"), waveform, "what it is made of"); }
};

SettingsOfOneMore read(std::string_view text) {
  const TomlValue root = parse_toml(text, "s.toml");
  SettingsOfOneMore settings;
  KnownSettings known;
  read_settings(TomlTable(root), settings, known);
  return settings;
}

// The frequency that it goes through, by a symmetric difference of the phase: the third derivative
// 4π(f₂ − f₁)/T² = 5e3 rad/s³ leaves h²/6·5e3/(2π) < 1e-9 Hz, the rounding of a phase of 2e4 rad
// 4e-12/(2π·1e-5) < 1e-6 Hz.
TEST(WaveformRecipe, GoesWhereItSays) {
  const OneMoreWaveform waveform =
      read("kind = \"quadratic\"\nstart_frequency = 3000\nend_frequency = 3400\n").waveform;
  EXPECT_EQ(name_of(waveform), "quadratic");
  EXPECT_EQ(title_of(waveform), "quadratic sweep");
  EXPECT_FALSE(samples_of(waveform));
  EXPECT_EQ(frequencies_of(waveform, 1.0)->highest, 3400.0);
  EXPECT_EQ(phase_of(waveform, 0.0, 1.0), 0.0);
  constexpr double h = 1e-5;
  for (const double t : {0.1, 0.5, 0.9}) {
    const double rate =
        (phase_of(waveform, t + h, 1.0) - phase_of(waveform, t - h, 1.0)) / (2.0 * h);
    EXPECT_NEAR(rate / (2.0 * pi), 3000.0 + 400.0 * t * t, 1e-5);
  }
}

TEST(WaveformRecipe, IsReadCheckedWrittenAndTold) {
  try {
    static_cast<void>(read("kind = \"quadratic\"\nstart_frequency = 3000\nend_frequncy = 3400\n"));
    ADD_FAILURE() << "a misspelt key";
  } catch (const InputError& error) {
    EXPECT_EQ(error.fault().where, "s.toml:3: end_frequncy");
  }
  try {
    static_cast<void>(read("kind = \"cubic\"\n"));
    ADD_FAILURE() << "an unknown kind";
  } catch (const InputError& error) {
    EXPECT_NE(error.fault().expected.find("\"file\" or \"quadratic\""), std::string::npos);
  }
  const SettingsOfOneMore one{.waveform = QuadraticSweep{100.1, 200.3}};
  const SettingsOfOneMore again = read(print_toml(settings_tree(one)));
  EXPECT_EQ(again.waveform, one.waveform);
  EXPECT_EQ(settings_words(again), settings_words(one));
  EXPECT_NE(settings_words(SettingsOfOneMore{Lfm{100.1, 200.3}}), settings_words(one));
}

/// Every waveform that has a phase stays between the frequencies that it says, and starts at 0.
TEST(WaveformRecipe, EveryWaveformKeepsToItsFrequencies) {
  for (const AnyWaveform& waveform :
       {AnyWaveform(Cw{350.0}), AnyWaveform(Lfm{300.0, 400.0}), AnyWaveform(Lfm{400.0, 300.0}),
        AnyWaveform(Hfm{300.0, 400.0}), AnyWaveform(Hfm{400.0, 300.0}),
        AnyWaveform(Sfm{.frequency = 350.0, .swing = 90.0, .modulation_frequency = 3.0}),
        AnyWaveform(Sfm{.frequency = 350.0,
        .swing = 90.0,
        .modulation_frequency = 3.0,
        .end_modulation_frequency = 11.0}),
        AnyWaveform(Costas{.frequency = 350.0}),
        AnyWaveform(Costas{.frequency = 350.0, .order = welch_costas(7), .step = 12.5}),
        AnyWaveform(Ptfm{.start_frequency = 400.0, .end_frequency = 300.0, .sweeps = 7}),
        AnyWaveform(PulseTrain{.start_frequency = 300.0,
        .end_frequency = 400.0,
        .pulses = 4,
        .pulse_duration = 0.5})}) {
    SCOPED_TRACE(name_of(waveform));
    const PulseFrequencies through = *frequencies_of(waveform, 2.0);
    EXPECT_EQ(phase_of(waveform, 0.0, 2.0), 0.0);
    for (double t = 0.01; t < 2.0; t += 0.0317) {
      const double rate =
          (phase_of(waveform, t + 1e-5, 2.0) - phase_of(waveform, t - 1e-5, 2.0)) / 2e-5;
      EXPECT_GE(rate / (2.0 * pi), through.lowest - 1e-5);
      EXPECT_LE(rate / (2.0 * pi), through.highest + 1e-5);
    }
  }
}

// A file says "none" by leaving the window out; a struct's default is another.
TEST(PulseSettings, AreWrittenAndReadBackBitForBit) {
  for (const PulseSettings& pulse :
       {PulseSettings{}, PulseSettings{.waveform = Hfm{812.3, 0.1 + 0.2}, .duration = 0.1},
        PulseSettings{.waveform = Lfm{}, .window = PulseWindow::tukey, .tukey_fraction = 1.0 / 3.0},
        PulseSettings{.window = PulseWindow::none},
        PulseSettings{.waveform = Sfm{.end_modulation_frequency = 1.0 / 3.0}},
        PulseSettings{.waveform = Costas{.order = welch_costas(13), .step = 0.1 + 0.2}},
        PulseSettings{.waveform = Ptfm{.sweeps = 17}},
        PulseSettings{.waveform = GeometricComb{.lines = 5, .gap_ratio = 1.0 + 1.0 / 3.0}},
        PulseSettings{.waveform = PulseTrain{.pulses = 3, .pulse_duration = 1.0 / 3.0}},
        PulseSettings{.waveform = PulseTrain{.start_frequency = 812.3, .end_frequency = 812.3}}}) {
    const TomlValue tree = settings_tree(pulse);
    PulseSettings again{.duration = 9.0, .window = PulseWindow::tukey};
    KnownSettings known;
    read_settings(TomlTable(tree), again, known);
    EXPECT_EQ(again.waveform, pulse.waveform);
    EXPECT_EQ(settings_words(again), settings_words(pulse));
  }
  const TomlValue least = parse_toml("kind = \"cw\"\nfrequency = 100\nduration = 1\n", "s.toml");
  PulseSettings read;
  KnownSettings known;
  read_settings(TomlTable(least), read, known);
  EXPECT_EQ(read.window, PulseWindow::none);
}

PulseSettings pulse_of(const std::string& text) {
  const TomlValue root = parse_toml(text, "s.toml");
  PulseSettings settings;
  KnownSettings known;
  read_settings(TomlTable(root), settings, known);
  return settings;
}

std::string refusal_of(const std::string& text) {
  try {
    static_cast<void>(pulse_of(text));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(GeneratedPulses, AreReadInEachWayThatFilesSayThem) {
  const PulseSettings listed = pulse_of(
      "kind = \"costas\"\nfrequency = 4000\nduration = 1\norder = [1, 2, 4, 3]\nstep = 8\n");
  EXPECT_EQ(std::get<Costas>(listed.waveform),
            (Costas{.frequency = 4000.0, .order = {1, 2, 4, 3}, .step = 8.0}));
  const PulseSettings welch =
      pulse_of("kind = \"costas\"\nfrequency = 4000\nduration = 1\nprime = 11\n");
  EXPECT_EQ(std::get<Costas>(welch.waveform).order, Costas{}.order);  // 1, 2, 4, 8, 16 − 11, …
  const PulseSettings other =
      pulse_of("kind = \"costas\"\nfrequency = 4000\nduration = 1\nprime = 7\nroot = 5\n");
  EXPECT_EQ(std::get<Costas>(other.waveform).order, (std::vector<double>{1, 5, 4, 6, 2, 3}));
  const PulseSettings tones = pulse_of(
      "kind = \"pulse_train\"\nfrequency = 500\npulses = 3\npulse_duration = 0.1\nduration = 1\n");
  EXPECT_EQ(
      std::get<PulseTrain>(tones.waveform),
      (PulseTrain{
          .start_frequency = 500.0, .end_frequency = 500.0, .pulses = 3, .pulse_duration = 0.1}));
}

TEST(GeneratedPulses, AreRefusedWithWhatWasExpected) {
  const std::string costas = "kind = \"costas\"\nfrequency = 4000\nduration = 1\n";
  EXPECT_EQ(
      refusal_of(costas + "order = [1, 2, 3]\n"),
      "s.toml:4: order: found chips 1 and 2 as many steps apart as 2 and 3, expected a Costas "
      "array, where no two pairs of chips are alike");
  EXPECT_EQ(refusal_of(costas + "order = [1, 2, 2]\n"),
            "s.toml:4: order: found others, expected each of 1 to 3 once");
  EXPECT_EQ(refusal_of(costas + "prime = 12\n"),
            "s.toml:4: prime: found 12, expected a prime number");
  EXPECT_EQ(refusal_of(costas + "prime = 11\nroot = 3\n"),  // its powers are five numbers
            "s.toml:5: root: found 3, expected a primitive root of 11");
  EXPECT_NE(refusal_of(costas + "prime = 11\norder = [1, 2]\n"), "");
  EXPECT_NE(refusal_of(costas).find("s.toml:1: prime: found nothing"), std::string::npos);
  EXPECT_EQ(refusal_of("kind = \"costas\"\nfrequency = 40\nduration = 1\nprime = 11\n"),
            "s.toml:2: frequency: found 40, expected one above 45 Hz, half of what the chips span");
  EXPECT_EQ(refusal_of("kind = \"sfm\"\nfrequency = 100\nswing = 220\nmodulation_frequency = "
                       "5\nduration = 1\n"),
            "s.toml:2: frequency: found 100, expected one above 110 Hz, half of the swing");
  EXPECT_EQ(refusal_of("kind = \"ptfm\"\nstart_frequency = 100\nend_frequency = 200\nsweeps = "
                       "1\nduration = 1\n"),
            "s.toml:4: sweeps: found 1, expected a whole number from 2 to 10000");
  const std::string comb =
      "kind = \"geometric_comb\"\nstart_frequency = 3900\nend_frequency = 4100\nduration = 1\n";
  EXPECT_EQ(
      refusal_of(comb + "lines = 20\ngap_ratio = 1.5\n"),
      "s.toml:6: gap_ratio: found 1.5, expected a smaller one, fewer lines or a longer pulse: "
      "the smallest gap is 0.04512965664480362 Hz, below 1/duration, where lines melt into one");
  EXPECT_EQ(refusal_of(comb + "lines = 8\ngap_ratio = 1\n"),
            "s.toml:6: gap_ratio: found 1, expected a ratio from 1.0001 to 10");
  EXPECT_EQ(refusal_of("kind = \"pulse_train\"\nfrequency = 500\npulses = 3\npulse_duration = "
                       "0.4\nduration = 1\n"),
            "s.toml:4: pulse_duration: found 0.4, expected at most 0.3333333333333333 s: 3 pulses "
            "one after "
            "another within the duration");
}

}  // namespace
}  // namespace asdic::detail
