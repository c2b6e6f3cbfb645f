#include "raytrace/waves/range_sum.h"

#include <cmath>
#include <unsupported/Eigen/FFT>

#include "core/units.h"

namespace asdic::detail {
namespace {

constexpr double sharpness = 2.30 * 12;  // β of the window e^{β(√(1−x²)−1)}, x from −1 to 1

double window_at(double x) {
  const double rest = 1.0 - x * x;
  return rest > 0.0 ? std::exp(sharpness * (std::sqrt(rest) - 1.0)) : 0.0;
}

}  // namespace

RangeSum::RangeSum(double spacing, std::span<const double> ranges) : correction_(block) {
  // ∫φ(2m/w)·cos(2πjm/M) dm; φ ends so flatly that an even sum is exact enough
  constexpr int nodes = 200;
  for (std::size_t j = 0; j < block; ++j) {
    const double turn = pi * double(window) * (double(j) - double(block / 2)) / double(fine);
    double transform = 0.0;
    for (int k = -nodes + 1; k < nodes; ++k) {
      const double x = double(k) / nodes;
      transform += window_at(x) * std::cos(turn * x);
    }
    correction_[j] = 1.0 / (transform * 0.5 * double(window) / nodes);
  }
  first_.reserve(ranges.size());
  weight_.reserve(ranges.size() * window);
  for (const double r : ranges) {
    const double place = spacing * r / (2.0 * pi) * double(fine);
    const double first = std::ceil(place - 0.5 * double(window));
    first_.push_back(std::size_t(first + double(fine)) % fine);
    for (std::size_t m = 0; m < window; ++m)
      weight_.push_back(window_at((first + double(m) - place) * 2.0 / double(window)));
  }
}

void RangeSum::sum(std::span<const std::complex<double>> a, Memory& memory,
                   std::span<std::complex<double>> sum) const {
  thread_local Eigen::FFT<double> transform;  // keeps its factors
  memory.in.assign(fine, 0.0);
  memory.out.resize(fine);
  for (std::size_t j = 0; j < block; ++j)
    memory.in[(j + fine - block / 2) % fine] = correction_[j] * a[j];
  transform.fwd(memory.out.data(), memory.in.data(), int(fine));
  for (std::size_t i = 0; i < sum.size(); ++i) {
    std::complex<double> total = 0.0;
    std::size_t at = first_[i];
    for (std::size_t m = 0; m < window; ++m, at = at + 1 == fine ? 0 : at + 1)
      total += weight_[i * window + m] * memory.out[at];
    sum[i] = total;
  }
}

}  // namespace asdic::detail
