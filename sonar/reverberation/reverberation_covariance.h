#pragma once
#include <complex>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/propagation_memory.h"
#include "reverb/fields/scattering_field.h"
#include "reverb/power/pulse_coherence.h"
#include "sonar/signal/band_response.h"

namespace asdic::detail {

/// Reverberation at an array as a Gaussian process: its power over delay, and which phones receive
/// it together.
///
/// Scatterers with complex Gaussian weights of their own for every ping make a sound that is
/// complex Gaussian itself, so mean power and covariance between phones say all of it. At delay τ
/// the array receives an impulse x(τ) with ⟨x x^H⟩ = I(τ)·C(τ) dτ, C(τ) = F F^H of unit mean
/// diagonal, summed over all pairs of paths through places at all bearings. Each phone has a
/// component for each of K frequencies f_k, at which a direction's phase is e^{−i2πf_k s·x}:
/// between them it is a polynomial. What is left out: that one scatterer is received again later
/// than a pulse. docs/theory/reverberation.md, "Covariance"
struct ReverberationCovariance {
  /// Who receives, and how finely.
  struct Listener {
    std::span<const Vec3> phones;  ///< relative to the array's reference point [m]
    BandNodes band;                ///< f_k
    double pulse_duration = 1.0;   ///< [s]
    /// Of the pulse with itself; none: a tone that never ends.
    std::shared_ptr<const PulseCoherence> coherence = std::make_shared<const PulseCoherence>();
    double latest = 60.0;  ///< end of the record [s]
  };
  /// Bins of delay that share a factor.
  struct Segment {
    std::size_t begin = 0, end = 0;  ///< bins
    std::size_t first = 0;           ///< of its columns
    std::size_t rank = 0;            ///< how many; 0: silence
  };

  /// Frequencies for phones so far apart and a band that holds all but a hundredth of a pulse's
  /// energy: phases are right to a hundredth of a radian.
  [[nodiscard]] static BandNodes frequencies_for(std::span<const Vec3> phones, double centre,
                                                 double bandwidth);

  /// \param fields  received monostatically, nothing in motion   \param limits  as the scatterers
  /// have
  ReverberationCovariance(std::span<const ScatteringField* const> fields,
                          const AudibleLimits& limits, const Listener& listener);

  /// Whether a field may be received so: source and receiver at one place, at rest, scatterers
  /// without motion or texture, weights of every ping's own.
  [[nodiscard]] static bool serves(const ScatteringField& field) noexcept;
  [[nodiscard]] std::size_t bytes() const noexcept;

  BandNodes band;                 ///< f_k
  std::size_t components = 0;     ///< K × phones: component k·phones + n is phone n at f_k
  double bin = 1.0;               ///< width of a bin of delay [s]
  std::vector<double> intensity;  ///< [bins] I, mean over components [1/s]
  std::vector<Segment> segments;
  std::vector<std::complex<float>> columns;  ///< of all factors F, [rank × components] each
};

/// Keys of the draws that a ping makes of a covariance or of streams.
struct CovarianceDraw {
  std::uint64_t seed = 1;
  std::uint32_t ping = 1;
  /// Key in place of the ping, for what every ping of a transmitter receives alike.
  std::uint32_t lasting = ~std::uint32_t{0};
};

}  // namespace asdic::detail
