#pragma once
#include <array>
#include <complex>
#include <cstddef>

#include "raytrace/waves/depth_wave.h"

namespace asdic::detail {

/// Solutions of u″ + q(z)·u = 0 at one depth for several wavenumbers, side by side: DepthWave each.
struct DepthWaves {
  static constexpr std::size_t count = 8;
  using Numbers = std::array<double, count>;

  alignas(64) Numbers u_re{}, u_im{}, du_re{}, du_im{}, growth{};

  void set(std::size_t lane, const DepthWave& wave) noexcept {
    u_re[lane] = wave.u.real(), u_im[lane] = wave.u.imag();
    du_re[lane] = wave.du.real(), du_im[lane] = wave.du.imag();
    growth[lane] = wave.growth;
  }
  [[nodiscard]] DepthWave get(std::size_t lane) const noexcept {
    return {{u_re[lane], u_im[lane]}, {du_re[lane], du_im[lane]}, growth[lane]};
  }
};

/// Their wavenumbers, and the squares of these [1/m, 1/m²]. Lanes beyond the first `used` repeat
/// the first one.
struct Wavenumbers {
  std::size_t used = 0;
  std::array<std::complex<double>, DepthWaves::count> xi;
  alignas(64) DepthWaves::Numbers square_re{}, square_im{};

  /// \param at  the wavenumber of a lane   \param lanes  1 … count
  template <class At>
  Wavenumbers(std::size_t lanes, At&& at) : used(lanes) {
    for (std::size_t l = 0; l < DepthWaves::count; ++l) {
      xi[l] = l < used ? at(l) : xi[0];
      const std::complex<double> square = xi[l] * xi[l];
      square_re[l] = square.real(), square_im[l] = square.imag();
    }
  }
};

/// follow() for each wavenumber, q = k² − ξ²: the same formulas in SIMD lanes.
/// \param k2_from, k2_to  (ω/c − iα)² at both ends of the piece [1/m²]   \param thickness  > 0 [m]
void follow(DepthWaves& waves, const Wavenumbers& xi, std::complex<double> k2_from,
            std::complex<double> k2_to, double thickness) noexcept;

}  // namespace asdic::detail
