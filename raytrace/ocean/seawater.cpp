#include "raytrace/ocean/seawater.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"

namespace asdic::detail {
namespace {

constexpr double pascal_per_bar = 1e5;
constexpr double pascal_per_kg_cm2 = 98066.5;  // technical atmosphere, kgf/cm²

/// a[0] + a[1]·x + a[2]·x² + …
template <std::size_t n>
constexpr double polynomial(const std::array<double, n>& a, double x) {
  double sum = 0.0;
  for (std::size_t i = n; i-- > 0;) sum = sum * x + a[i];
  return sum;
}

// Chen & Millero's coefficients, row by power of P [bar], column by power of T [°C, ITS-90].
// C: pure water.
constexpr std::array C0 = {1402.388, 5.03830, -5.81090e-2, 3.3432e-4, -1.47797e-6, 3.1419e-9};
constexpr std::array C1 = {0.153563, 6.8999e-4, -8.1829e-6, 1.3632e-7, -6.1260e-10};
constexpr std::array C2 = {3.1260e-5, -1.7111e-6, 2.5986e-8, -2.5353e-10, 1.0415e-12};
constexpr std::array C3 = {-9.7729e-9, 3.8513e-10, -2.3654e-12};
// A: times S.
constexpr std::array A0 = {1.389, -1.262e-2, 7.166e-5, 2.008e-6, -3.21e-8};
constexpr std::array A1 = {9.4742e-5, -1.2583e-5, -6.4928e-8, 1.0515e-8, -2.0142e-10};
constexpr std::array A2 = {-3.9064e-7, 9.1061e-9, -1.6009e-10, 7.994e-12};
constexpr std::array A3 = {1.100e-10, 6.651e-12, -3.391e-13};
// B: times S^{3/2}; D: times S².
constexpr std::array B0 = {-1.922e-2, -4.42e-5};
constexpr std::array B1 = {7.3637e-5, 1.7950e-7};
constexpr std::array D0 = {1.727e-3, -7.9836e-6};  // by power of P

}  // namespace

std::string_view name(SeawaterEquation equation) noexcept {
  switch (equation) {
    case SeawaterEquation::chen_millero:
      return "chen-millero";
    case SeawaterEquation::mackenzie:
      return "mackenzie";
    case SeawaterEquation::del_grosso:
      return "del-grosso";
  }
  return "";
}

namespace {

constexpr ValidRange chen_millero_ranges[] = {{"temperature", "degC", 0.0, 40.0},
                                              {"salinity", "psu", 0.0, 40.0},
                                              {"pressure", "MPa", 0.0, 100.0}};
constexpr ValidRange mackenzie_ranges[] = {{"temperature", "degC", 2.0, 30.0},
                                           {"salinity", "psu", 25.0, 40.0},
                                           {"depth", "m", 0.0, 8000.0}};
constexpr ValidRange del_grosso_ranges[] = {{"temperature", "degC", 0.0, 30.0},
                                            {"salinity", "psu", 30.0, 40.0},
                                            {"pressure", "MPa", 0.0, 98.0665}};

}  // namespace

const Validity& validity(SeawaterEquation equation) noexcept {
  static constexpr Validity chen_millero{"chen-millero", "JASA 62, 1129, 1977",
                                         chen_millero_ranges};
  static constexpr Validity mackenzie{"mackenzie", "JASA 70, 807, 1981", mackenzie_ranges};
  static constexpr Validity del_grosso{"del-grosso", "JASA 56, 1084, 1974", del_grosso_ranges};
  switch (equation) {
    case SeawaterEquation::mackenzie:
      return mackenzie;
    case SeawaterEquation::del_grosso:
      return del_grosso;
    case SeawaterEquation::chen_millero:
      break;
  }
  return chen_millero;
}

double sound_speed_chen_millero(double t, double s, double gauge_pressure) noexcept {
  const double p = gauge_pressure / pascal_per_bar;
  const auto row = [&](const auto& x0, const auto& x1, const auto& x2, const auto& x3) {
    return polynomial(
        std::array{polynomial(x0, t), polynomial(x1, t), polynomial(x2, t), polynomial(x3, t)}, p);
  };
  const double pure = row(C0, C1, C2, C3);
  const double a = row(A0, A1, A2, A3);
  const double b = polynomial(B0, t) + polynomial(B1, t) * p;
  const double d = polynomial(D0, p);
  // c = C_w(T, P) + A(T, P)·S + B(T, P)·S^{3/2} + D(P)·S²
  const double root_s = std::sqrt(std::max(0.0, s));
  return pure + s * (a + b * root_s + d * s);
}

double sound_speed_del_grosso(double t, double s, double gauge_pressure) noexcept {
  const double p = gauge_pressure / pascal_per_kg_cm2;
  // c = C₀₀₀ + ΔC_T + ΔC_S + ΔC_P + ΔC_STP
  const double c_t = t * (5.012285 + t * (-5.51184e-2 + t * 2.21649e-4));
  const double c_s = s * (1.329530 + s * 1.288598e-4);
  const double c_p = p * (0.1560592 + p * (2.449993e-5 - p * 8.833959e-9));
  const double c_tp = t * p *
                      (6.353509e-3 - 4.383615e-7 * t * t + 2.656174e-8 * t * p - 1.593895e-6 * p +
                       5.222483e-10 * p * p);
  const double c_st = s * t * (-1.275936e-2 + 9.688441e-5 * t);
  const double c_stp = s * p * (-3.406824e-4 * t + 4.857614e-6 * s * t - 1.616745e-9 * s * p);
  return 1402.392 + c_t + c_s + c_p + c_tp + c_st + c_stp;
}

double sound_speed_mackenzie(double t, double s, double d) noexcept {
  return 1448.96 + 4.591 * t - 5.304e-2 * t * t + 2.374e-4 * t * t * t + 1.340 * (s - 35.0) +
         1.630e-2 * d + 1.675e-7 * d * d - 1.025e-2 * t * (s - 35.0) - 7.139e-13 * t * d * d * d;
}

double gauge_pressure_standard_ocean(double depth, double latitude_deg) noexcept {
  const double z = std::max(0.0, depth);
  const double sine = std::sin(radians(latitude_deg));
  const double gravity = 9.7803 * (1.0 + 5.3e-3 * sine * sine);
  // h(z, φ) = h(z, 45°)·k(z, φ) [MPa]
  const double at_45 = z * (1.00818e-2 + z * (2.465e-8 + z * (-1.25e-13 + z * 2.8e-19)));
  const double k = (gravity - 2e-5 * z) / (9.80612 - 2e-5 * z);
  return 1e6 * at_45 * k;
}

double gauge_pressure(double depth, double latitude_deg) noexcept {
  const double z = std::max(0.0, depth);
  const double common_oceans = 1.0e-2 * z / (z + 100.0) + 6.2e-6 * z;  // [MPa]
  return gauge_pressure_standard_ocean(z, latitude_deg) - 1e6 * common_oceans;
}

double sound_speed(SeawaterEquation equation, double temperature_degc, double salinity,
                   double depth, double latitude_deg) noexcept {
  const double z = std::max(0.0, depth);
  switch (equation) {
    case SeawaterEquation::mackenzie:
      return sound_speed_mackenzie(temperature_degc, salinity, z);
    case SeawaterEquation::chen_millero:
      return sound_speed_chen_millero(temperature_degc, salinity, gauge_pressure(z, latitude_deg));
    case SeawaterEquation::del_grosso:
      break;
  }
  return sound_speed_del_grosso(temperature_degc, salinity, gauge_pressure(z, latitude_deg));
}

}  // namespace asdic::detail
