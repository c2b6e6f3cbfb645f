#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "sonar/signal/waveforms/waveform.h"

namespace asdic::detail {

/// Chips of one tone each, as long as one another, whose frequencies hop without a jump of the
/// phase: chip k of N has f + (o_k − (N + 1)/2)·Δf. The order o is a Costas array: no two pairs of
/// chips are apart by the same number of chips and of steps, so that with Δf = N/T an echo
/// displaced by whole chips and whole steps meets the pulse in one chip at most.
/// Costas, Proc. IEEE 72, 996 (1984).
struct Costas {
  static constexpr std::string_view name = "costas", title = "Costas";
  double frequency = 4000.0;                                    ///< f, the middle of all [Hz]
  std::vector<double> order = {1, 2, 4, 8, 5, 10, 9, 7, 3, 6};  ///< o, each of 1…N once
  std::optional<double> step = {};                              ///< Δf [Hz]; by default N/T

  void describe(Fields& field);
  void check(Fields& field, double duration) const;
  [[nodiscard]] PulseFrequencies frequencies(double duration) const noexcept;
  [[nodiscard]] double phase(double t, double duration) const noexcept;
  [[nodiscard]] bool operator==(const Costas&) const = default;
};
static_assert(PhaseWaveform<Costas>);

/// o_k = g^k mod p, k = 0…p − 2: Welch's construction. \param prime  p   \param root  g, a
/// primitive root of it. \return empty if they are none
[[nodiscard]] std::vector<double> welch_costas(int prime, int root);
/// With the smallest primitive root; empty if it is no prime.
[[nodiscard]] std::vector<double> welch_costas(int prime);

}  // namespace asdic::detail
