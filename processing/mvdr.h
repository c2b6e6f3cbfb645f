#pragma once
#include <complex>
#include <span>
#include <vector>

#include "processing/beams.h"

namespace asdic::detail {

/// Adaptive weights that pass a plane wave unchanged and let through as little else as can be:
/// w = R⁻¹a/(aᴴR⁻¹a), R the phones' covariance E[x xᴴ] with δ·tr(R)/N added to its diagonal; the
/// beam is wᴴx. Capon, Proc. IEEE 57, 1408 (1969); loading: Cox, Zeskind & Owen, IEEE Trans. ASSP
/// 35, 1365 (1987). docs/theory/processing.md, eq. (6)
/// \param covariance  [N × N] Hermitian, row-major   \param steering  [N] a   \param loading  δ > 0
[[nodiscard]] std::vector<std::complex<double>> mvdr_weights(
    std::span<const std::complex<double>> covariance,
    std::span<const std::complex<double>> steering, double loading);

class Fields;

struct MvdrSettings {
  double loading_db = -10.0;         ///< 10 lg δ, re the mean power of a phone [dB]
  double snapshots_per_phone = 3.0;  ///< that a covariance is averaged over
  /// White noise that a beam may let through over the conventional one's 1/N. An echo is in the
  /// covariance itself: a beam a little off its direction would null it, however loud it is.
  double most_noise_db = 1.0;

  void describe(Fields& field);
};

/// The beams of conventional_beams(), adapted to what is received: the record is cut into
/// overlapping blocks (root-Hann windows, so that they add up to the record again) that are narrow
/// in frequency for the time sound takes across the array, and in every block and bin the weights
/// follow from the covariance of the blocks around it, its loading raised where that keeps the
/// beam's white noise gain (Cox, Zeskind & Owen 1987, docs/theory/processing.md, eq. (6a)).
[[nodiscard]] BeamSpectra mvdr_beams(const Baseband& baseband, std::span<const Vec3> phones,
                                     std::span<const Vec3> looks, double sound_speed,
                                     const MvdrSettings& settings);

}  // namespace asdic::detail
