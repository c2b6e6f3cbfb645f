#include "sonar/synthesis/impulse_grid.h"

#include <algorithm>

#include "core/rotate_back.h"
#include "sonar/signal/tap_sums.h"

namespace asdic::detail {
namespace {

using Weights = DelayKernel::Weights;
constexpr auto not_received = static_cast<std::size_t>(-1);

/// Returns that fall between the same two samples.
struct Run {
  const Weights* taps;
  std::size_t count;
  const float* weights;  // ℓ_m(η) of the first
  std::size_t row;       // from the weights of one return to the next's

  /// To the grids of nodes m, m + 1, … \param stride of the grids [floats]
  template <std::size_t nodes>
  void add(std::size_t m, float* grid, std::size_t stride) const noexcept {
    deposit<nodes>(taps, count, weights + m, row, grid + m * stride, stride);
  }
};

}  // namespace

void ImpulseGrid::add(const OrderedReturns& returns, const OrderedReturns::Band& band,
                      const Part& part, const Vec3& phone,
                      std::complex<float>* grids) const noexcept {
  if (band.moved)
    add_band<true>(returns, band, part, phone, grids);
  else
    add_band<false>(returns, band, part, phone, grids);
}

template <bool moved>
void ImpulseGrid::add_band(const OrderedReturns& returns, const OrderedReturns::Band& band,
                           const Part& part, const Vec3& phone,
                           std::complex<float>* grids) const noexcept {
  const Weights even =
      Weights::NullaryExpr([](Eigen::Index i) { return i % 2 == 0 ? 1.0F : 0.0F; });
  const Weights odd = 1.0F - even;
  const float unit_weight = 1.0F;
  const std::size_t row = band.nodes == 1 ? 0 : band.nodes;
  Block at;
  std::array<Weights, block> taps;
  std::array<std::size_t, block> below;  // the sample at or below the impulse
  // Where impulses lie on the grid, and where they are the middles of pulses that are received.
  double first_on_grid = DelayKernel::taps;
  auto last_on_grid = static_cast<double>(length - DelayKernel::taps);
  if constexpr (!moved) {
    first_on_grid = std::max(first_on_grid, first_position);
    last_on_grid = std::min(last_on_grid, last_position);
  }

  for (std::size_t start = part.begin; start < part.end; start += block) {
    const std::size_t n = std::min(block, part.end - start);
    locate<moved>(returns, start, n, part.response, phone, at);
    for (std::size_t i = 0; i < n; ++i) {
      const double position = at.position[i];
      bool received = position >= first_on_grid && position <= last_on_grid;
      if constexpr (moved) {
        const double middle = position - rate * returns.late[start + i];
        received = received && middle >= first_position && middle <= last_position;
      }
      below[i] = received ? static_cast<std::size_t>(position) : not_received;
      if (!received) continue;
      const auto fraction = static_cast<float>(position - static_cast<double>(below[i]));
      taps[i] = kernel.weights(fraction) * (at.real[i] * even + at.imag[i] * odd);
    }
    const float* weights = row == 0 ? &unit_weight
                                    : returns.weights.data() + band.first_weight +
                                          (start - band.ends[0]) * row + part.first_node;
    // Sorted by sample, neighbours mostly fall between the same two: summed in registers.
    for (std::size_t i = 0, next = 0; i < n; i = next) {
      for (next = i + 1; next < n && below[next] == below[i];) ++next;
      if (below[i] == not_received) continue;
      const Run run = {
          .taps = taps.data() + i, .count = next - i, .weights = weights + i * row, .row = row};
      float* grid = reinterpret_cast<float*>(grids + (below[i] - DelayKernel::before));
      std::size_t m = 0;
      for (; m + 8 <= part.nodes; m += 8) run.add<8>(m, grid, 2 * stride);
      if (m + 4 <= part.nodes) run.add<4>(m, grid, 2 * stride), m += 4;
      if (m + 2 <= part.nodes) run.add<2>(m, grid, 2 * stride), m += 2;
      if (m < part.nodes) run.add<1>(m, grid, 2 * stride);
    }
  }
}

template <bool moved>
void ImpulseGrid::locate(const OrderedReturns& returns, std::size_t start, std::size_t n,
                         std::size_t response, const Vec3& phone, Block& at) const noexcept {
  const double x = phone.x(), y = phone.y(), z = phone.z();
  const double* __restrict impulse = returns.impulse.data() + start;
  const double* __restrict late = moved ? returns.late.data() + start : nullptr;
  const double* __restrict sx = returns.slowness_x.data() + start;
  const double* __restrict sy = returns.slowness_y.data() + start;
  const double* __restrict sz = returns.slowness_z.data() + start;
  const float* __restrict re = returns.real.data() + response * returns.size() + start;
  const float* __restrict im = returns.imag.data() + response * returns.size() + start;
  for (std::size_t i = 0; i < n; ++i) {
    const double delay = impulse[i] + (sx[i] * x + sy[i] * y + sz[i] * z);
    double a = re[i], b = im[i];
    const double middle = moved ? delay - late[i] : delay;
    rotate_back(carrier * middle, a, b);  // e^{−i2π f_c τ}
    at.position[i] = (delay - first) * rate;
    at.real[i] = static_cast<float>(a);
    at.imag[i] = static_cast<float>(b);
  }
}

}  // namespace asdic::detail
