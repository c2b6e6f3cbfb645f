#pragma once
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

/// What a pulse is made of, before its window: `name` in files, `title` in sentences.
template <class W>
concept Waveform = Described<W> && std::equality_comparable<W> && requires {
  { W::name } -> std::convertible_to<std::string_view>;
  { W::title } -> std::convertible_to<std::string_view>;
};

/// A tone or a sweep, e^{iφ(t)}: φ(t) [rad] is 0 at the leading edge, 0 ≤ t ≤ duration [s].
template <class W>
concept PhaseWaveform = Waveform<W> && requires(const W& waveform, double t, double duration) {
  { waveform.phase(t, duration) } -> std::same_as<double>;
  { waveform.frequencies() } -> std::same_as<PulseFrequencies>;
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
  static_assert(((PhaseWaveform<W> != SampledWaveform<W>)&&...), "each is either of the two");
  return std::visit(
      []<class One>(const One& one) -> std::optional<SoundSamples> {
        if constexpr (SampledWaveform<One>) return SoundSamples{one.samples, one.sample_rate};
        return std::nullopt;
      },
      waveform);
}

/// Of one that has a phase: what it goes through, its centre in the middle.
template <Waveform... W>
[[nodiscard]] std::optional<PulseFrequencies> frequencies_of(const std::variant<W...>& waveform) {
  return std::visit(
      []<class One>(const One& one) -> std::optional<PulseFrequencies> {
        if constexpr (PhaseWaveform<One>) return one.frequencies();
        return std::nullopt;
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
