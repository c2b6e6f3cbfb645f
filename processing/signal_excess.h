#pragma once
#include <complex>
#include <span>
#include <vector>

#include "core/units.h"
#include "sonar/scenario/noise_settings.h"
#include "sonar/signal/pulse.h"

namespace asdic::detail {

/// B = (∫|S|²df)²/∫|S|⁴df [Hz]: answers of the matched filter that far apart in 1/B are independent
/// in white noise.
[[nodiscard]] double noise_bandwidth(const Pulse& pulse);

/// What a pulse's matched filter gains over its background, whose levels are told before it.
struct MatchedFilterGain {
  double noise_db = 0.0;          ///< 10 lg(E·B₄₀), over noise in the −40 dB band
  double reverberation_db = 0.0;  ///< 10 lg(E·B), over sound with the pulse's own spectrum
};
[[nodiscard]] MatchedFilterGain matched_filter_gain(const Pulse& pulse);

/// Levels in one beam, before the matched filter [dB re 1 µPa]: what the beam leaves of each, where
/// it leaves the echo as it is.
struct BeamLevels {
  double echo_db = -infinity, reverberation_db = -infinity, noise_db = -infinity;
};

/// Signal excess [dB]:
///
///   SE = EL − 10 lg(10^{(RL − G_r)/10} + 10^{(NL − G_n)/10}) − DT
///
/// docs/theory/studies.md, eq. (8) \param threshold_db  DT
[[nodiscard]] double signal_excess_db(const BeamLevels& levels, const MatchedFilterGain& gain,
                                      double threshold_db);

/// Γ of all pairs of phones, [n × n], row by row; of independent noise 1 on the diagonal.
/// \param phones  [n] [m]   \param wavenumber  [rad/m]
[[nodiscard]] std::vector<std::complex<double>> noise_coherences(std::span<const Vec3> phones,
                                                                 double wavenumber,
                                                                 const NoiseField& noise);

/// A_n = −10 lg(wᴴΓw), w_n = e^{−iω s·x_n}/n: what a beam of all phones gains over noise [dB].
/// \param slowness  at which it looks [s/m]   \param angular_frequency  [rad/s]
/// \param coherence  Γ
[[nodiscard]] double gain_over_noise_db(std::span<const Vec3> phones, const Vec3& slowness,
                                        double angular_frequency,
                                        std::span<const std::complex<double>> coherence);

}  // namespace asdic::detail
