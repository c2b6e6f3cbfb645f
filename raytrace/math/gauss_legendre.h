#pragma once
#include <array>
#include <cstddef>

namespace asdic::detail {

/// Gauss–Legendre nodes on (−1, 1) and their weights. Abramowitz & Stegun (1964), table 25.4.
template <std::size_t n>
struct GaussLegendre;
template <>
struct GaussLegendre<4> {
  static constexpr std::array<double, 4> node = {-0.8611363115940526, -0.3399810435848563,
                                                 0.3399810435848563, 0.8611363115940526};
  static constexpr std::array<double, 4> weight = {0.3478548451374538, 0.6521451548625461,
                                                   0.6521451548625461, 0.3478548451374538};
};
template <>
struct GaussLegendre<6> {
  static constexpr std::array<double, 6> node = {-0.9324695142031521, -0.6612093864662645,
                                                 -0.2386191860831969, 0.2386191860831969,
                                                 0.6612093864662645,  0.9324695142031521};
  static constexpr std::array<double, 6> weight = {0.1713244923791704, 0.3607615730481386,
                                                   0.4679139345726910, 0.4679139345726910,
                                                   0.3607615730481386, 0.1713244923791704};
};
template <>
struct GaussLegendre<8> {
  static constexpr std::array<double, 8> node = {
      -0.9602898564975363, -0.7966664774136267, -0.5255324099163290, -0.1834346424956498,
      0.1834346424956498,  0.5255324099163290,  0.7966664774136267,  0.9602898564975363};
  static constexpr std::array<double, 8> weight = {
      0.1012285362903763, 0.2223810344533745, 0.3137066458778873, 0.3626837833783620,
      0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
};
template <>
struct GaussLegendre<10> {
  static constexpr std::array<double, 10> node = {
      -0.9739065285171717, -0.8650633666889845, -0.6794095682990244, -0.4333953941292472,
      -0.1488743389816312, 0.1488743389816312,  0.4333953941292472,  0.6794095682990244,
      0.8650633666889845,  0.9739065285171717};
  static constexpr std::array<double, 10> weight = {
      0.0666713443086881, 0.1494513491505806, 0.2190863625159821, 0.2692667193099963,
      0.2955242247147529, 0.2955242247147529, 0.2692667193099963, 0.2190863625159821,
      0.1494513491505806, 0.0666713443086881};
};

/// ∫ f over (a, b): f(x, weight) is called at each of the n nodes; exact for polynomials to degree
/// 2n − 1.
template <std::size_t n = 10, class F>
void gauss_legendre(double a, double b, F&& f) {
  const double centre = 0.5 * (a + b), half = 0.5 * (b - a);
  for (std::size_t i = 0; i < n; ++i)
    f(centre + half * GaussLegendre<n>::node[i], half * GaussLegendre<n>::weight[i]);
}

}  // namespace asdic::detail
