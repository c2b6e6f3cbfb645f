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
  [[nodiscard]] PulseFrequencies frequencies() const noexcept {
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
  EXPECT_EQ(frequencies_of(waveform)->highest, 3400.0);
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
        AnyWaveform(Hfm{300.0, 400.0}), AnyWaveform(Hfm{400.0, 300.0})}) {
    SCOPED_TRACE(name_of(waveform));
    const PulseFrequencies through = *frequencies_of(waveform);
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
        PulseSettings{.window = PulseWindow::none}}) {
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

}  // namespace
}  // namespace asdic::detail
