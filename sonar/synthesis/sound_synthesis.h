#pragma once
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "sonar/signal/band_limited_pulse.h"
#include "sonar/synthesis/synthesis.h"

namespace asdic::detail {

/// What phones receive of a sound that is no pulse: Synthesizer::baseband(), where `delay` of a
/// return tells of the sound's middle (u = 0) and amplitudes are over the sound's own. Its peak
/// should be about 1: errors are −90 dB of that. \param phones  [n] from the array's reference
/// point [m]
[[nodiscard]] Baseband baseband_of(const BandLimitedPulse& sound, const Recording& recording,
                                   double max_doppler, std::span<const Return> returns,
                                   std::span<const Vec3> phones);

/// A synthesizer's pulse (of its first filter), as the phones' band lets it through.
[[nodiscard]] const BandLimitedPulse& filtered_pulse(const Synthesizer& synthesizer);

/// One channel between its samples, p₊·e^{−i2πf_c t}, also somewhat before and after the record.
[[nodiscard]] SampledSignal signal_of(const Baseband& baseband, std::size_t channel);

/// Largest envelope of a channel within the record, sampled at 2.7 times its band.
[[nodiscard]] double largest_envelope(const Baseband& baseband, std::size_t channel);

/// Adds all channels to those of a baseband on another grid, about another carrier. What lies
/// outside of that one's record fades out in its overlap.
void add_resampled(const Baseband& from, Baseband& to);

}  // namespace asdic::detail
