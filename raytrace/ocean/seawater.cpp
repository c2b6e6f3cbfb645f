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

double depth_at_pressure(double gauge_pressure_, double latitude_deg) noexcept {
  if (!(gauge_pressure_ > 0.0)) return 0.0;
  double z = gauge_pressure_ / 1.01e4;  // Newton: pressure grows by 1.01e4 Pa/m, within 3 %
  for (int i = 0; i < 20; ++i) {
    const double step = (gauge_pressure_ - gauge_pressure(z, latitude_deg)) / 1.01e4;
    z += step;
    if (std::abs(step) < 1e-7) break;
  }
  return z;
}

namespace {

/// Γ(S, T, p) [K/dbar] at T [°C, IPTS-68] and p [dbar]. Bryden (1973).
double adiabatic_lapse_rate(double s, double t, double p) noexcept {
  const double ds = s - 35.0;
  const double at_surface = polynomial(std::array{3.5803e-5, 8.5258e-6, -6.836e-8, 6.6228e-10}, t) +
                            polynomial(std::array{1.8932e-6, -4.2393e-8}, t) * ds;
  const double by_p = polynomial(std::array{1.8741e-8, -6.7795e-10, 8.733e-12, -5.4481e-14}, t) +
                      polynomial(std::array{-1.1351e-10, 2.7759e-12}, t) * ds;
  const double by_p2 = polynomial(std::array{-4.6206e-13, 1.8676e-14, -2.1687e-16}, t);
  return at_surface + p * (by_p + p * by_p2);
}

constexpr double t68_over_t90 = 1.00024;

}  // namespace

double temperature_in_situ(double potential_degc, double salinity, double gauge_pressure) noexcept {
  const double end = gauge_pressure / 1e4;  // [dbar]
  const int steps = std::max(1, static_cast<int>(std::ceil(end / 2000.0)));
  const double h = end / steps;
  double t = potential_degc * t68_over_t90;
  for (int i = 0; i < steps; ++i) {  // dT/dp = Γ, Runge and Kutta's fourth order
    const double p = h * i;
    const double k1 = adiabatic_lapse_rate(salinity, t, p);
    const double k2 = adiabatic_lapse_rate(salinity, t + h / 2.0 * k1, p + h / 2.0);
    const double k3 = adiabatic_lapse_rate(salinity, t + h / 2.0 * k2, p + h / 2.0);
    const double k4 = adiabatic_lapse_rate(salinity, t + h * k3, p + h);
    t += h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
  }
  return t / t68_over_t90;
}

namespace {

/// Conservative temperature of potential temperature: potential enthalpy over c_p⁰. A polynomial in
/// x² = S_A/(40 g/kg·35.16504/35) and y = θ/40 °C, row by power of x, column by power of y.
constexpr std::array H0 = {61.01362420681071,  168776.46138048015,  -2735.2785605119625,
                           2574.2164453821433, -1536.6644434977543, 545.7340497931629,
                           -50.91091728474331, -18.30489878927802};
constexpr std::array H2 = {268.5520265845071,   -12019.028203559312, 3734.858026725145,
                           -2046.7671145057618, 465.28655623826234,  -0.6370820302376359,
                           -10.650848542359153};
constexpr std::array H3 = {937.2099110620707, 588.1802812170108, 248.39476522971285,
                           -3.871557904936333, -2.6268019854268356};
constexpr std::array H4 = {-1687.914374187449, 936.3206544460336,  -942.7827304544439,
                           369.4389437509002,  -33.83664947895248, -9.987880382780322};
constexpr std::array H5 = {246.9598888781377, 123.59576582457964, -48.5891069025409};  // by x

double conservative_temperature(double theta, double x2) noexcept {
  const double x = std::sqrt(x2), y = theta / 40.0;
  const double enthalpy =
      polynomial(H0, y) +
      x2 * (polynomial(H2, y) +
            x * (polynomial(H3, y) + x * (polynomial(H4, y) + x * polynomial(H5, x))));
  return enthalpy / 3991.86795711963;
}

}  // namespace

double potential_temperature(double conservative_degc, double absolute_salinity) noexcept {
  const double x2 = std::max(0.0, absolute_salinity) * 35.0 / (40.0 * 35.16504);
  double theta = conservative_degc;  // Θ leaves θ by at most 1.4 K, and dΘ/dθ 1 by 6 %
  for (int i = 0; i < 50; ++i) {
    const double step = conservative_degc - conservative_temperature(theta, x2);
    theta += step;
    if (std::abs(step) < 1e-10) break;
  }
  return theta;
}

}  // namespace asdic::detail
