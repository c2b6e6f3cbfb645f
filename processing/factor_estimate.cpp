#include "processing/factor_estimate.h"

#include <algorithm>
#include <cmath>

#include "processing/matched_filter.h"

namespace asdic::detail {
namespace {

/// Of the factors' span in which a filter answers within 3 dB, measured with echoes of 40 dB.
constexpr double error_of_table = 0.004;

}  // namespace

FactorEstimate::FactorEstimate(const Replica& replica, double apart, double cell, int sub_bands)
    : apart_(apart), floor_(error_of_table * 2.0 * cell) {
  const auto rho = [&](double echo, double filter) {  // both from the loudest filter's factor
    const double ratio = (1.0 + echo) / (1.0 + filter);
    return std::max(doppler_answer(replica, ratio, sub_bands).response, 1e-6);
  };
  double near = 0.0;
  for (int k = -side; k <= side; ++k) {
    const double offset = k * apart / side, above = rho(offset, apart), below = rho(offset, -apart);
    difference_[static_cast<std::size_t>(k + side)] = 2.0 * std::log(above) - 2.0 * std::log(below);
    if (k == 0) near = 0.5 * (above + below);
  }
  const double slope = (difference_[side + 1] - difference_[side - 1]) / (2.0 * apart / side);
  const double far = std::min(rho(apart, -apart), 1.0);
  unit_ = slope > 0.0 ? 2.0 * std::sqrt((1.0 - far) / sub_bands) / (near * slope) : apart;
}

double FactorEstimate::offset(double difference) const noexcept {
  const double step = apart_ / side;
  for (int k = -side; k < side; ++k) {
    const double low = difference_[static_cast<std::size_t>(k + side)],
                 high = difference_[static_cast<std::size_t>(k + side + 1)];
    if (difference >= high && k + 1 < side) continue;
    if (!(high > low)) return k * step;
    return step * (k + std::clamp((difference - low) / (high - low), 0.0, 1.0));
  }
  return apart_;
}

double FactorEstimate::sigma(double snr) const noexcept {
  const double s = std::max(snr - 1.0, 0.1);
  return std::hypot(unit_ * std::sqrt((1.0 + 1.0 / s) / s), floor_);
}

}  // namespace asdic::detail
