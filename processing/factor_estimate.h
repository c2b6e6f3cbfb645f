#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "processing/replica.h"

namespace asdic::detail {

/// By how much a filter answers late to an echo of another factor: a sweep's ridge, to the second
/// order. A hyperbolic sweep's is long and bent: its delay goes as 1/η − 1.
/// Source: docs/theory/processing.md, eq. (13a)
class RidgeDelay {
 public:
  RidgeDelay() = default;
  /// \param reach  ratio of the factors less 1 at which it is exact
  RidgeDelay(const Replica& replica, double reach, int sub_bands);
  /// \param echo, filter  their factors   \return delay [s]
  [[nodiscard]] double operator()(double echo, double filter) const noexcept {
    const double offset = echo / filter - 1.0;
    return offset * (slope_ + offset * bend_) / filter;  // in the filter's own time
  }

 private:
  double slope_ = 0.0, bend_ = 0.0;
};

/// Tells a Doppler factor by two filters h below and h above the loudest, each asked where it
/// answers most: along the ridge.
///
/// A filter that is off by δ answers an echo with the amplitude ρ(δ), and the noise of two filters
/// is correlated by the same ρ. With L = ln(|y|²/η), the power over the noise that a filter
/// receives, an echo at the offset o gives
///
///   D(o) = L₊ − L₋ = 2 ln ρ(o − h) − 2 ln ρ(o + h)
///   σ² = 4 (1 − ρ(2h))/(ρ(h) D′(0))² · (1 + 1/S)/S · g²(S)
///
/// D is tabulated from the pulse's ambiguity function and read backwards. Where ρ² falls as
/// 1 − β²δ², σ² is Cramér and Rao's bound for small h, 1/(2Sβ²). Where it falls at once, 1 − c|δ|,
/// as of pulses that begin at once, there is no β. The variance of N sub-bands is an Nth, S a
/// sub-band's. g is 1 until simulated() has told how much more or less really scatters.
/// Source: docs/theory/processing.md, eq. (13)
class FactorEstimate {
 public:
  /// S of a sub-band at which the scatter is simulated [dB].
  static constexpr std::array nodes{0.0, 3.0, 6.0, 8.0, 10.0, 12.0, 14.0, 17.0, 20.0, 25.0, 30.0};
  using Scatter = std::array<double, nodes.size()>;

  FactorEstimate() = default;
  /// \param apart  h   \param cell  as of doppler_cell()
  FactorEstimate(const Replica& replica, double apart, double cell, int sub_bands);

  /// \param difference  L₊ − L₋   \return o, at most h to either side
  [[nodiscard]] double offset(double difference) const noexcept;
  /// \param snr  power over mean background, S + 1   \return standard deviation of noise
  [[nodiscard]] double sigma(double snr) const noexcept;
  /// Takes g from errors of a simulation. \param scatter  their root mean squares; 0 where none
  void simulated(const Scatter& scatter) noexcept;

 private:
  static constexpr int side = 4;  // offsets of a quarter of h each, to either side
  [[nodiscard]] double plain(double s) const noexcept {
    return unit_ * std::sqrt((1.0 + 1.0 / s) / s);
  }

  std::array<double, 2 * side + 1> difference_{};
  double apart_ = 0.0;
  double unit_ = 0.0;   // of S = 1
  double floor_ = 0.0;  // of the table itself
  Scatter log_g_{};
};

/// The factor found between filters.
struct FactorFound {
  std::size_t middle = 0;                    ///< filter from which
  double offset = 0.0;                       ///< the factor's offset is counted
  const FactorEstimate* estimate = nullptr;  ///< told by; none at the bank's ends
};

/// Goes from a bank's loudest filter to the factor of its echo, and knows how much that scatters:
/// both from one procedure, which the constructor runs on simulated echoes of several offsets
/// between two filters. Source: docs/theory/processing.md, eq. (13b)
class FactorFinder {
 public:
  FactorFinder() = default;
  /// \param step  between the bank's factors   \param filters  number in the bank, three at least
  /// \param cell  width of a Doppler cell, as doppler_cell() returns it
  FactorFinder(const Replica& replica, double step, std::size_t filters, double cell,
               int sub_bands);

  [[nodiscard]] const RidgeDelay& late() const noexcept { return late_; }

  /// \param last  the bank's last filter   \param log_snr  ln(|y|²/η) of a filter, asked near where
  /// the ridge has it from another: log_snr(filter, from)
  template <typename LogSnr>
  [[nodiscard]] FactorFound find(std::size_t loudest, std::size_t last,
                                 const LogSnr& log_snr) const {
    FactorFound found{.middle = loudest};
    const auto estimate = [&] {
      const std::size_t middle = found.middle, room = std::min(middle, last - middle);
      if (room == 0) return;
      const std::size_t aside = room < aside_ ? 1 : aside_;
      found.estimate = aside == 1 ? &close_ : &wide_;
      found.offset =
          found.estimate->offset(log_snr(middle + aside, middle) - log_snr(middle - aside, middle));
    };
    estimate();
    // Of filters close together noise makes one beside the loudest: asked again about that which
    // lies between them. No further, or what is left beside a loud echo would be drawn to it.
    const auto most = static_cast<std::ptrdiff_t>(aside_) - 1;
    const auto moved =
        std::clamp<std::ptrdiff_t>(std::lround(found.offset / std::max(step_, 1e-12)), -most, most);
    const auto next = static_cast<std::ptrdiff_t>(loudest) + moved;
    if (moved != 0 && next > 0 && next < static_cast<std::ptrdiff_t>(last)) {
      found.middle = static_cast<std::size_t>(next);
      estimate();
    }
    const double widest = 0.6 * step_ * static_cast<double>(aside_);
    found.offset = std::clamp(found.offset, -widest, widest);
    return found;
  }

 private:
  class Simulation;

  double step_ = 0.0, cell_ = 0.0;
  std::size_t aside_ = 1;  // filters compared lie so many to either side
  RidgeDelay late_;
  FactorEstimate close_, wide_;  // of filters one, and so many, to either side
};

}  // namespace asdic::detail
