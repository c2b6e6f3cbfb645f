#pragma once
#include <complex>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/propagation_memory.h"
#include "raytrace/ocean/environment.h"
#include "raytrace/waves/water_window.h"

namespace asdic::detail {

/// Where what many places of one ocean have in common is kept.
struct OceanMemory {
  PropagationMemory& memory;
  std::uint64_t ocean = 0;  ///< its identity
};

/// The pressure at a place and how it changes there.
struct WaveAt {
  std::complex<double> p = 0.0, along = 0.0;                ///< and ∂p/∂r
  std::complex<double> by_source = 0.0, by_receiver = 0.0;  ///< ∂p/∂z of either end

  [[nodiscard]] WaveAt mixed_with(const WaveAt& other, double share) const noexcept;
};

/// The same ocean with a bottom that returns nothing.
[[nodiscard]] Environment without_bottom(Environment ocean);

/// The water of an ocean whose bottom returns nothing, at one frequency.
class WaterColumn {
 public:
  WaterColumn(const Environment& ocean, double frequency, double cut_for)
      : ocean_(without_bottom(ocean)), column_(ocean_, frequency, cut_for) {}
  WaterColumn(const WaterColumn&) = delete;
  WaterColumn& operator=(const WaterColumn&) = delete;

  [[nodiscard]] const WaveColumn& column() const noexcept { return column_; }
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  Environment ocean_;
  WaveColumn column_;
};

/// What a source and a receiver need for their waterborne field at any range up to a furthest: the
/// kernels of all wavenumbers. Exact for its layers, and smooth in the depths.
///
/// What costs, the waves through all of the water, is asked of `memory` for edges of layers beside
/// the ends: an end that rises or sinks by metres finds it known.
class WaterborneWaves {
 public:
  struct Need {
    double frequency;     ///< [Hz]
    double cut_for;       ///< that of the layers [Hz]
    double upper, lower;  ///< depths of the ends [m]
    double furthest;      ///< range [m]
  };
  /// \throws Interrupted
  WaterborneWaves(const Environment& ocean, const Need& need, const OceanMemory& memory);

  /// \param range  up to the furthest [m]   \param source_is_upper  which end ∂p/∂z is told of as
  [[nodiscard]] WaveAt at(double range, bool source_is_upper) const noexcept;
  /// Share that a wavenumber has in it: 1, less towards the edges of its window. \param s  [1/m]
  [[nodiscard]] double weight(double s) const noexcept { return window_.weight(s); }
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  /// Of one wavenumber, with its weight.
  struct Kernel {
    std::complex<double> g, by_upper, by_lower;
  };
  WaterWindow window_;
  std::vector<Kernel> kernels_;  // [window_.count]
};

void add_to(ExactKey& key, const WaterborneWaves::Need& need);

/// The furthest range of those that have kernels in common: in steps of 19 %.
[[nodiscard]] double furthest_in_step(double range);

}  // namespace asdic::detail
