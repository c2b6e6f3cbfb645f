#pragma once
#include <complex>

namespace asdic::detail {

/// a·b of finite numbers: without the look at infinities that std::complex takes.
template <class Real>
[[nodiscard]] constexpr std::complex<Real> finite_product(std::complex<Real> a,
                                                          std::complex<Real> b) noexcept {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

}  // namespace asdic::detail
