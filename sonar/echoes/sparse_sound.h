#pragma once
#include <functional>
#include <span>
#include <vector>

#include "sonar/echoes/echo.h"
#include "sonar/scenario/transmitter.h"
#include "sonar/synthesis/synthesis.h"

namespace asdic::detail {

/// One of the frequencies that represent a pulse's band.
struct BandPart {
  double frequency = 0.0;                ///< [Hz]
  std::function<double(double)> filter;  ///< factor of the pulse at a distance from its centre [Hz]
  BeamPattern pattern;                   ///< pattern of the transmitter at that frequency
  double more_nepers_per_metre = 0.0;    ///< absorption beyond that at the centre
};

/// Smallest change that matters, relative to an echo's pressure, at the edges of the pulse's band
/// (99 % of its energy): 0.5 dB. Over the whole band it is about half of that, and the waveform is
/// right to −30 dB.
inline constexpr double tolerable_change = 0.06;

/// Root of the energy of what paths carry at either edge of a band beside what they carry at the
/// centre, over that of what they carry there; the greater one. Where waves cannot change by
/// `tolerable_change` they are not looked at. \param half_width  of the band about the pulse's
/// centre [Hz]
[[nodiscard]] double change_across_band(const EchoContext& context, const Transmitter& projector,
                                        std::span<const EchoPath> paths, double half_width);

/// Whether paths are to be received by wide_band_sound(): by the settings, "auto" where the change
/// across the pulse's band is more than tolerable.
[[nodiscard]] bool across_the_band(const EchoContext& context, const Transmitter& projector,
                                   std::span<const EchoPath> paths);

/// Echoes and direct blasts at an array, by how they are received.
struct SparseSound {
  std::vector<EchoPath> narrow;  ///< with the amplitudes of the pulse's centre frequency
  std::vector<EchoPath> wide;    ///< by wide_band_sound()
};

/// Sorts echoes and blasts by how they are received. Each target is judged by its own echoes, and
/// the blast by itself, so the echoes of several targets are the sum of each target's own.
[[nodiscard]] SparseSound by_band(const EchoContext& context, const Transmitter& projector,
                                  std::vector<EchoPath> paths);

/// Parts of a pulse's band for each leg of an echo by itself.
struct TwoStepBand {
  std::vector<BandPart> out;   ///< of the way there; empty: one amplitude serves the whole band
  std::vector<BandPart> home;  ///< of the way back, for the sound at the target
};

/// Parts by which echoes along paths like these are received.   \param longest  longest path there
/// and back [m]
[[nodiscard]] TwoStepBand two_step_band(const EchoContext& context, const Transmitter& projector,
                                        std::span<const EchoPath> paths, double longest,
                                        const Recording& recording, double max_doppler);

/// Echoes and direct blasts at the phones of an array, with the amplitudes at the pulse's centre
/// frequency.   \param phones  [n] from the array's reference point [m]
[[nodiscard]] Baseband narrow_band_sound(const Synthesizer& synthesizer,
                                         std::span<const EchoPath> paths,
                                         std::span<const Vec3> phones);

/// Echoes and direct blasts with the water's absorption, the transmitter's pattern, the boundaries'
/// reflection and the amplitudes of waves at every frequency of the pulse. They are the sum of K
/// pulses, each passed through one of Lagrange's polynomials over the band, with the amplitudes at
/// its own frequency. The cost is K times that of narrow_band_sound(). Source:
/// docs/theory/synthesis.md, "Across the band".   \param projector  as it pings
/// \param more  sound of the same recording to which it is added
[[nodiscard]] Baseband wide_band_sound(const EchoContext& context, const Transmitter& projector,
                                       std::span<const EchoPath> paths,
                                       std::span<const Vec3> phones, const Recording& recording,
                                       double max_doppler, Baseband more = {});

/// Peak of the envelope that wide_band_sound() gives at the array's reference point, whenever it is
/// received: within the record or not [Pa].
[[nodiscard]] double peak_of_wide_band(const EchoContext& context, const Transmitter& projector,
                                       std::span<const EchoPath> paths, const Recording& recording,
                                       double max_doppler);

}  // namespace asdic::detail
