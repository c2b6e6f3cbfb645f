#pragma once
#include <complex>
#include <functional>
#include <span>
#include <vector>

#include "sonar/echoes/echo.h"
#include "sonar/scenario/transmitter.h"
#include "sonar/synthesis/synthesis.h"

namespace asdic::detail {

/// One of the frequencies that serve a pulse's band.
struct BandPart {
  std::function<double(double)> filter;  ///< of the pulse, over the frequency from its centre [Hz]
  BeamPattern pattern;                   ///< of the transmitter at that frequency
  double more_nepers_per_metre = 0.0;    ///< of absorption than at the centre
};

/// A pulse's band and the few frequencies that serve it. docs/theory/synthesis.md, "Across the
/// band"
class PulseBand {
 public:
  /// \param projector  as it pings
  PulseBand(const EchoContext& context, const Transmitter& projector, const Recording& recording,
            double max_doppler);

  [[nodiscard]] double centre() const noexcept { return centre_; }
  [[nodiscard]] double half_width() const noexcept { return half_band_; }
  /// What absorption and the transmitter's pattern need. \param longest  path there and back [m]
  [[nodiscard]] BandNodes nodes(double longest) const;
  [[nodiscard]] BandPart part(const BandNodes& nodes, std::size_t k) const;

 private:
  [[nodiscard]] double nepers_per_metre(double frequency) const;
  [[nodiscard]] BeamPattern pattern_at(double frequency) const;

  const Absorption& water_;
  const Transmitter& projector_;
  double centre_, half_band_, sound_speed_, heading_;
};

/// Echoes and direct blasts at the phones of an array, amplitudes as at the pulse's centre
/// frequency. \param phones  [n] from the array's reference point [m]
[[nodiscard]] Baseband narrow_band_sound(const Synthesizer& synthesizer,
                                         std::span<const EchoPath> paths,
                                         std::span<const Vec3> phones);

/// Paths at one of the frequencies that serve a pulse's band.
struct SoundOfBand {
  BandPart part;
  std::vector<std::complex<double>> amplitudes;  ///< [paths]
};

/// Amplitudes of paths with the water's absorption, the transmitter's pattern and waves at every
/// frequency that the band needs. \param legs  that the paths belong to
[[nodiscard]] std::vector<SoundOfBand> across_band(const EchoContext& context,
                                                   const Transmitter& projector,
                                                   std::span<const EchoPath> paths,
                                                   std::span<const Leg> legs,
                                                   const Recording& recording, double max_doppler);

/// The same with the water's absorption and the transmitter's pattern at every frequency of the
/// pulse: K pulses, each passed through one of Lagrange's polynomials over the band, each with the
/// amplitudes of its own frequency. K times the cost. Source: docs/theory/synthesis.md, "Across the
/// band". Legs that are no rays have the amplitude of waves at up to `most_wave_frequencies`.
/// \param projector  as it pings   \param legs  that the paths belong to
[[nodiscard]] Baseband wide_band_sound(const EchoContext& context, const Transmitter& projector,
                                       std::span<const EchoPath> paths, std::span<const Leg> legs,
                                       std::span<const Vec3> phones, const Recording& recording,
                                       double max_doppler);

}  // namespace asdic::detail
