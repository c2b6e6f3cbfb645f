#pragma once
#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/fields.h"

namespace asdic::detail {

/// Frequencies that a pulse goes through, from the lowest to the highest [Hz].
struct PulseFrequencies {
  double lowest = 0.0, highest = 0.0;
};

/// Parts of a pulse that are alike about its middle frequency, and silence between them.
struct Repeats {
  int count = 1;
  double duration = 0.0;  ///< of each [s]
  double interval = 0.0;  ///< from one's leading edge to the next's [s]

  /// The last that has begun at t.
  [[nodiscard]] int at(double t) const noexcept {
    if (count == 1) return 0;
    return static_cast<int>(std::clamp(std::floor(t / interval), 0.0, count - 1.0));
  }
};

/// cos(2πft + φ) of a pulse that is several at once.
struct Tone {
  double frequency = 0.0;  ///< [Hz]
  double phase = 0.0;      ///< φ [rad]
};

/// What a pulse is made of, before its window: `name` in files, `title` in sentences.
template <class W>
concept Waveform = Described<W> && std::equality_comparable<W> && requires {
  { W::name } -> std::convertible_to<std::string_view>;
  { W::title } -> std::convertible_to<std::string_view>;
};

/// A tone or a sweep, e^{iφ(t)}: φ(t) [rad] is 0 at the leading edge, 0 ≤ t ≤ duration [s]. One
/// that has `repeats(duration)` is silent between them, and its window is that of each.
template <class W>
concept PhaseWaveform = Waveform<W> && requires(const W& waveform, double t, double duration) {
  { waveform.phase(t, duration) } -> std::same_as<double>;
  { waveform.frequencies(duration) } -> std::same_as<PulseFrequencies>;
};

/// Tones at once, as loud as one another; a pulse scales their sum to a peak of 1.
template <class W>
concept ToneWaveform = Waveform<W> && requires(const W& waveform, double duration) {
  { waveform.tones() } -> std::same_as<std::vector<Tone>>;
  { waveform.frequencies(duration) } -> std::same_as<PulseFrequencies>;
};

/// Real pressure at a sample rate, which has its own duration and edges.
template <class W>
concept SampledWaveform = Waveform<W> && requires(const W& waveform) {
  { waveform.samples } -> std::convertible_to<const std::vector<double>&>;
  { waveform.sample_rate } -> std::convertible_to<double>;
};

struct SoundSamples {
  std::span<const double> samples;
  double sample_rate;  ///< [Hz]
  [[nodiscard]] double duration() const noexcept {
    return static_cast<double>(samples.size()) / sample_rate;
  }
};
/// Of one that is sampled.
template <Waveform... W>
[[nodiscard]] std::optional<SoundSamples> samples_of(const std::variant<W...>& waveform) {
  static_assert(
      ((int{PhaseWaveform<W>} + int{ToneWaveform<W>} + int{SampledWaveform<W>} == 1) && ...),
      "each is one of the three");
  return std::visit(
      []<class One>(const One& one) -> std::optional<SoundSamples> {
        if constexpr (SampledWaveform<One>) return SoundSamples{one.samples, one.sample_rate};
        return std::nullopt;
      },
      waveform);
}

/// Of one that is not sampled: what it goes through, its centre in the middle.
template <Waveform... W>
[[nodiscard]] std::optional<PulseFrequencies> frequencies_of(const std::variant<W...>& waveform,
                                                             double duration) {
  return std::visit(
      [&]<class One>(const One& one) -> std::optional<PulseFrequencies> {
        if constexpr (!SampledWaveform<One>) return one.frequencies(duration);
        return std::nullopt;
      },
      waveform);
}

/// Its parts; of most one, the whole.
template <Waveform... W>
[[nodiscard]] Repeats repeats_of(const std::variant<W...>& waveform, double duration) noexcept {
  return std::visit(
      [&]<class One>(const One& one) -> Repeats {
        if constexpr (requires { one.repeats(duration); }) return one.repeats(duration);
        return {.count = 1, .duration = duration, .interval = duration};
      },
      waveform);
}

/// Of one that is made of tones; of others none.
template <Waveform... W>
[[nodiscard]] std::vector<Tone> tones_of(const std::variant<W...>& waveform) {
  return std::visit(
      []<class One>(const One& one) -> std::vector<Tone> {
        if constexpr (ToneWaveform<One>) return one.tones();
        return {};
      },
      waveform);
}

/// φ(t) [rad] of one that has a phase.
template <Waveform... W>
[[nodiscard]] double phase_of(const std::variant<W...>& waveform, double t,
                              double duration) noexcept {
  return std::visit(
      [&]<class One>(const One& one) {
        if constexpr (PhaseWaveform<One>) return one.phase(t, duration);
        return 0.0;
      },
      waveform);
}

/// "LFM"
template <Waveform... W>
[[nodiscard]] std::string_view title_of(const std::variant<W...>& waveform) noexcept {
  return std::visit([](const auto& one) { return std::string_view(one.title); }, waveform);
}

}  // namespace asdic::detail
