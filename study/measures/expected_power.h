#pragma once
#include <complex>
#include <map>
#include <vector>

#include "processing/matched_filter.h"
#include "sonar/ping/ping.h"

namespace asdic::detail::study {

/// E|y|² of a matched filter over what an array receives beside echoes: not drawn, but summed over
/// the streams of reverberation and added to that of the noise.
///
///   E|y(τ)|² = 2·SL² Σ_streams ∫ I(τ')·|C(τ' + l − τ)|²dτ'/E² · Σ_k v_k·Σ_noises |Σ_waves w·B_k|²
///            + 2/E Σ_k u_k N₀(f_k)·wᴴΓ(f_k)w
///   C(u) = ∫ s₊(η'(t − u))·s₊*(ηt)dt,   B_k = 1/n Σ_p e^{−i2πf_k(l_p − d_p)}
///
/// I the intensity of a stream over its delay, η' its Doppler factor; l_p its lag at phone p, d_p
/// that which the filter steers for, l the mean of l_p − d_p; f_k frequencies of the pulse, v_k
/// their shares of ∫|S|⁴df, u_k those of ∫|S|²df. docs/theory/studies.md, eq. (24)
class ExpectedPower {
 public:
  /// Of the ping's phones and places as the record has them. \param array  an index
  /// \throws InputError where what is received cannot be summed so (PingSimulator::mean_sea)
  ExpectedPower(const PingSimulator& simulator, const PingRecord& record, int array);

  /// \param filter  of that array   \param doppler  η   \param later  the times after its delays
  /// [s]   \return [later] [Pa²]
  [[nodiscard]] std::vector<double> operator()(const MatchedFilterAt& filter, double doppler,
                                               const std::vector<double>& later) const;

 private:
  struct Beam;
  class Answers;
  [[nodiscard]] double noise(const Beam& beam) const;
  /// Σ_k v_k·Σ_noises |Σ_waves w·B_k|² of a part of a stream, and l [s].
  struct Kept {
    double share = 0.0, late = 0.0;
  };
  [[nodiscard]] Kept kept_by(const Beam& beam, std::size_t part) const;

  const PingSimulator& simulator_;
  const Pulse& pulse_;
  int array_;
  std::size_t first_channel_;
  double sound_speed_;        // at the array [m/s]
  std::vector<Vec3> places_;  // of all phones of the array, as the record has them [m]
  PingSimulator::MeanSea sea_;
};

}  // namespace asdic::detail::study
