#pragma once
#include <cstddef>
#include <numeric>
#include <vector>

#include "sonar/signal/interpolation_taps.h"
#include "sonar/synthesis/delay_kernel.h"

namespace asdic::detail {

/// So much oversampled, a signal is interpolated to −97 dB by 12 taps under the window of the 24
/// that 1.35 times take: A = 97 = 2.285·(taps − 1)·2π(1 − 1/oversampling) + 8, β = 0.1102(A − 8.7).
inline constexpr double oversampling_for_12_taps = 2.3;
static_assert(DelayKernel::oversampling >= 1.35);

/// The taps' weights where samples of the record lie between those of the baseband: sample i lies
/// at i·q/p of these, so that there are p places.
template <int n_taps>
class PlaceWeights {
 public:
  static constexpr int before = InterpolationTaps<float, n_taps>::before;
  using Weights = typename InterpolationTaps<float, n_taps>::Weights;
  /// \param from, to  samples of one period of the baseband, of the record
  PlaceWeights(std::size_t from, std::size_t to)
      : q_(from / std::gcd(from, to)), p_(to / std::gcd(from, to)) {
    constexpr std::size_t most = 2048;
    for (std::size_t k = 0; p_ <= most && k < p_; ++k) weights_.push_back(found(k));
  }
  /// Where a sample lies: after the baseband's sample `below`, place k of p.
  struct Place {
    std::size_t below = 0, k = 0;
  };
  [[nodiscard]] Place place(std::size_t i) const noexcept { return {i * q_ / p_, i * q_ % p_}; }
  void next(Place& place) const noexcept {
    for (place.k += q_; place.k >= p_; place.k -= p_) ++place.below;
  }
  /// \param own  where they are put if they are not kept
  [[nodiscard]] const float* at(const Place& place, Weights& own) const {
    return weights_.empty() ? (own = found(place.k)).data() : weights_[place.k].data();
  }

 private:
  [[nodiscard]] Weights found(std::size_t k) const {
    static const InterpolationTaps<float, n_taps> taps(9.73);
    return taps.at(static_cast<float>(k) / static_cast<float>(p_));
  }

  std::size_t q_, p_;
  std::vector<Weights> weights_;
};

}  // namespace asdic::detail
