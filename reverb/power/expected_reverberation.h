#pragma once
#include <array>
#include <complex>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/memory_budget.h"
#include "core/propagation_memory.h"
#include "reverb/fields/scattering_field.h"
#include "reverb/power/pulse_coherence.h"

namespace asdic::detail {

/// What is known of a ping's reverberation before a weight is drawn: how faint a pair may be to be
/// left out, the mean level, how many returns there will be. Found from pairs through the middles
/// of cells. docs/theory/reverberation.md
struct ExpectedReverberation {
  /// A pair through the middle of a cell of a few sectors, for the level.
  struct Sample {
    std::uint32_t place = 0;  // pairs of one place interfere
    std::uint16_t part = 0;   // of the place, where it is divided
    bool by_itself = false;   // it adds by energy: one of so many that their phases say nothing
    double delay = 0.0;
    std::complex<double> amplitude = 0.0;  // of the area that the place stands for
    /// Standard deviation of its phase over that area: outward, beside that and in depth [rad].
    std::array<float, 3> phases{};
    float extent = 0.0F;  ///< range of the delay over that area and depth, about `delay` [s]
  };
  /// Rings or sectors begin…end of a field.
  struct Block {
    std::size_t field = 0;
    std::uint32_t begin = 0, end = 0;
    std::size_t expected = 0;  ///< returns
  };

  /// \param pulse_duration  [s]
  ExpectedReverberation(std::span<const ScatteringField> fields, double pulse_duration);
  /// What the constructor takes at its peak: pairs are counted at some rings.
  [[nodiscard]] static MemoryNeed need(std::span<const ScatteringField> fields,
                                       double pulse_duration);
  /// Of all that it depends on; none where a pattern has no key. \param kind  of what else depends
  /// on the same
  [[nodiscard]] static std::optional<ExactKey> key(std::span<const ScatteringField> fields,
                                                   double pulse_duration,
                                                   Kept kind = Kept::expected_reverberation);
  [[nodiscard]] std::size_t bytes() const noexcept;

  AudibleLimits limits;
  std::vector<Sample> samples;
  std::vector<Block> blocks;  ///< all rings, some thousand returns each
  double returns = 0.0;       ///< if every scatterer is received

  /// Those of one field.
  [[nodiscard]] double returns_of(std::size_t field) const noexcept;

  /// Mean over weights of the peak envelope's square over that of the source at 1 m, at a time
  /// since the ping [s]: Σ_cells Σ_ab p_a·p_b*·exp(−½|Δ_a − Δ_b|²), p = A·D·s(t − τ) of the pairs a
  /// and b through the middle of a cell, Δ their phases' standard deviations over it.
  [[nodiscard]] double power(const std::function<std::complex<double>(double)>& sent,
                             double duration, double t) const;

  /// Properties of the pulse that mean_power() needs.
  struct SentPulse {
    const PulseCoherence& coherence;
    double duration = 0.0;   ///< [s]
    double energy = 0.0;     ///< ∫|s|²dt [s]
    double frequency = 0.0;  ///< centre [Hz]
  };
  /// power() as the mean over each of `count` steps of time. The pulse's energy counts as spread
  /// evenly over its duration, and every place sends evenly over the extent of its delay.
  /// \param first  beginning of the first step, since the ping [s]   \param step  [s]
  /// \return [count]
  [[nodiscard]] std::vector<double> mean_power(const SentPulse& pulse, double first, double step,
                                               std::size_t count) const;

 private:
  void cut_into_blocks(std::size_t field, const std::vector<double>& of_ring);
};

}  // namespace asdic::detail
