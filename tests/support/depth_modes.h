#pragma once
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace asdic::detail::support {

/// Normal modes of a layered sea without loss, by finite differences in depth: Sturm's count and
/// bisection for the wavenumbers, inverse iteration for the modes. It shares nothing with asdic.
struct DepthModes {
  double step = 0.0;                     ///< distance of the nodes [m]
  std::vector<double> wavenumber;        ///< [modes] [rad/m]
  std::vector<std::vector<double>> psi;  ///< [modes × nodes] at (i + 1)·step, ∫ψ²/ρ dz = 1

  [[nodiscard]] double at(std::size_t mode, double depth) const {
    const double place = depth / step - 1.0;
    const auto i = std::size_t(place);
    return std::lerp(psi[mode][i], psi[mode][i + 1], place - double(i));
  }
  /// Σ|p_m|², the intensity without interference, relative to 1 m from the source.
  /// \param density  at the source
  [[nodiscard]] double energy(double source, double receiver, double range, double density) const {
    double sum = 0.0;
    for (std::size_t m = 0; m < wavenumber.size(); ++m) {
      const double p = at(m, source) * at(m, receiver) / density;
      sum += 2.0 * M_PI / (range * wavenumber[m]) * p * p;
    }
    return sum;
  }
};

/// Modes of a sea between a free surface and, at `depth`, a rigid or a free end.
/// \param speed, density  functions of depth [m/s], any unit
/// \param least, most  bounds of the modes' wavenumbers [rad/m]
inline DepthModes depth_modes(double frequency, double depth, bool rigid, int nodes,
                              const std::function<double(double)>& speed,
                              const std::function<double(double)>& density, double least,
                              double most) {
  const auto n = std::size_t(rigid ? nodes : nodes - 1);
  const double h = depth / nodes;
  std::vector<double> diagonal(n), beside(n), weight(n), rho(n + 2);
  for (std::size_t i = 0; i < rho.size(); ++i) rho[i] = density(double(i) * h);
  const auto between = [&](std::size_t i) { return 0.5 * (rho[i] + rho[i + 1]); };
  for (std::size_t i = 0; i < n; ++i) {
    const bool end = rigid && i + 1 == n;  // the last cell is half as thick
    const double k = 2.0 * M_PI * frequency / speed(double(i + 1) * h);
    const double stiff = 1.0 / between(i) + (end ? 0.0 : 1.0 / between(i + 1));
    weight[i] = (end ? 2.0 : 1.0) * rho[i + 1];
    diagonal[i] = k * k - weight[i] * stiff / (h * h);
  }
  for (std::size_t i = 0; i + 1 < n; ++i)
    beside[i] = std::sqrt(weight[i] * weight[i + 1]) / (between(i + 1) * h * h);
  const auto above = [&](double x) {
    int count = 0;
    double pivot = 1.0;
    for (std::size_t i = 0; i < n; ++i) {
      pivot = diagonal[i] - x - (i > 0 ? beside[i - 1] * beside[i - 1] / pivot : 0.0);
      count += pivot > 0.0;
    }
    return count;
  };
  DepthModes modes{.step = h};
  for (int m = above(most * most), last = above(least * least); m < last; ++m) {
    double low = least * least, high = most * most;
    for (int i = 0; i < 52; ++i) {
      const double middle = 0.5 * (low + high);
      (above(middle) > m ? low : high) = middle;
    }
    std::vector<double> v(n);
    for (std::size_t i = 0; i < n; ++i) v[i] = 1.0 + 0.3 * std::sin(1.7 * double(i) + m);
    for (int turn = 0; turn < 3; ++turn) {  // (T − λ)·x = v by elimination with pivots
      std::vector<double> d = diagonal, e = beside, f(n, 0.0);
      for (double& value : d) value -= low * (1.0 + 1e-14);
      for (std::size_t i = 0; i + 1 < n; ++i) {
        double below = beside[i];
        if (std::abs(below) > std::abs(d[i])) {
          std::swap(d[i], below);
          std::swap(e[i], d[i + 1]);
          std::swap(f[i], e[i + 1]);
          std::swap(v[i], v[i + 1]);
        }
        const double factor = below / d[i];
        d[i + 1] -= factor * e[i];
        e[i + 1] -= factor * f[i];
        v[i + 1] -= factor * v[i];
      }
      double square = 0.0;
      for (std::size_t i = n; i-- > 0;) {
        v[i] -= (i + 1 < n ? e[i] * v[i + 1] : 0.0) + (i + 2 < n ? f[i] * v[i + 2] : 0.0);
        v[i] /= d[i];
        square += v[i] * v[i];
      }
      for (double& value : v) value /= std::sqrt(square);
    }
    for (std::size_t i = 0; i < n; ++i) v[i] *= std::sqrt(weight[i] / h);
    modes.wavenumber.push_back(std::sqrt(low));
    modes.psi.push_back(std::move(v));
  }
  return modes;
}

}  // namespace asdic::detail::support
