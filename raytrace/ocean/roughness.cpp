#include "raytrace/ocean/roughness.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"
#include "raytrace/math/gauss_legendre.h"

namespace asdic::detail {
namespace {

constexpr double gravity = 9.81;                     // [m/s²]
constexpr double to_19_5_metres = 1.026;             // wind there over that at 10 m
constexpr double pm_alpha = 8.1e-3, pm_beta = 0.74;  // of Pierson & Moskowitz
constexpr double speed_of_waves = 1500.0;  // that turns k into f for an empirical law [m/s]

/// Mean over directions of Re √(sin²θ − x² − 2x cos θ cos φ): the vertical wavenumber, over k, of
/// what the waves of wavenumber xk scatter. In φ = φ₀ + (π − φ₀)u², φ₀ where it begins, nothing is
/// singular.
double mean_vertical(double x, double sine) {
  const double cosine = std::sqrt((1.0 - sine) * (1.0 + sine));
  const double a = (sine - x) * (sine + x), b = 2.0 * x * cosine;
  if (a <= -b) return 0.0;
  const double first = a >= b ? 0.0 : std::acos(a / b), width = pi - first;
  double sum = 0.0;
  for (const double half : {0.0, 0.5})
    gauss_legendre<10>(half, half + 0.5, [&](double u, double weight) {
      const double square = a - b * std::cos(first + width * u * u);
      sum += 2.0 * weight * u * std::sqrt(std::max(square, 0.0));
    });
  return width * sum / pi;
}

/// Even steps of ln x up to the last that scatters into the water, 1 + cos θ.
constexpr double finest_step = 0.02;
/// Exponent of the spectrum's cut-off beyond which nothing is left.
constexpr double gone = 40.0;

/// ln of 4 sin θ ∫ ½α x⁻² e^{−β/(x κ)²} A(x) d(ln x), κ = kU²/g, A = mean_vertical. The logarithm
/// stays finite where the waves are too short to scatter sound and the integral itself underflows.
template <class Vertical>
double log_first_order(double sine, double scaled, double last, const Vertical& vertical,
                       int steps) {
  const auto cut = [&](double x) { return pm_beta / (x * x * scaled * scaled); };
  const double least = cut(last);
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double x = last * std::exp(-(i + 0.5) * finest_step), beyond = cut(x) - least;
    if (beyond > gone) break;
    sum += 0.5 * pm_alpha / (x * x) * std::exp(-beyond) * vertical(i);
  }
  return std::log(4.0 * sine * sum * finest_step) - least;
}

double eckart(double sine, double scaled) {  // G² = 4 sin²θ·h²k², h² = αU⁴/(4βg²)
  return sine * sine * pm_alpha * scaled * scaled / pm_beta;
}

/// ln(p₁/G²) over ln κ and ln sin θ, by cubics between nodes (Catmull & Rom).
class FirstOrderTable {
 public:
  FirstOrderTable() {
    constexpr int most_steps = 800;  // of ln x: down to 10⁻⁷
    for (int a = 0; a < angles; ++a) {
      const double sine = std::min(1.0, std::exp(log_sine(a))), last = 1.0 + cosine_of(sine);
      std::vector<double> vertical(most_steps);
      for (int i = 0; i < most_steps; ++i)
        vertical[std::size_t(i)] = mean_vertical(last * std::exp(-(i + 0.5) * finest_step), sine);
      for (int w = 0; w < waves; ++w) {
        const double scaled = std::exp(log_scaled(w));
        value_[std::size_t(a)][std::size_t(w)] =
            log_first_order(
                sine, scaled, last, [&](int i) { return vertical[std::size_t(i)]; }, most_steps) -
            std::log(eckart(sine, scaled));
      }
    }
  }

  /// p₁/G²
  [[nodiscard]] double ratio(double sine, double scaled) const noexcept {
    const Place a = place((std::log(std::max(sine, 1e-300)) - log_sine(0)) / sine_step, angles);
    const Place w = place((std::log(scaled) - log_scaled(0)) / scaled_step, waves);
    double value = 0.0;
    for (int i = 0; i < 4; ++i) {
      const auto& row = value_[std::size_t(node(a.first + i, angles))];
      double along = 0.0;
      for (int j = 0; j < 4; ++j)
        along += w.weight[std::size_t(j)] * row[std::size_t(node(w.first + j, waves))];
      value += a.weight[std::size_t(i)] * along;
    }
    return std::exp(value);
  }

 private:
  static constexpr int angles = 47, waves = 61;
  static constexpr double sine_step = 0.15, scaled_step = 0.25;  // sin θ from 0.001, κ from 0.02
  static double log_sine(int i) { return (i - angles + 1) * sine_step; }
  static double log_scaled(int i) { return std::log(0.02) + i * scaled_step; }
  static double cosine_of(double sine) { return std::sqrt((1.0 - sine) * (1.0 + sine)); }

  struct Place {
    int first = 0;  // of four nodes
    std::array<double, 4> weight{};
  };
  static Place place(double at, int nodes) {
    at = std::clamp(at, 0.0, nodes - 1.0);
    const int i = std::min(static_cast<int>(at), nodes - 2);
    const double t = at - i, u = 1.0 - t;
    return {i - 1,
            {-0.5 * t * u * u, u * (1.0 + t - 1.5 * t * t), t * (1.0 + u - 1.5 * u * u),
             -0.5 * u * t * t}};
  }
  static int node(int i, int nodes) { return std::clamp(i, 0, nodes - 1); }

  std::array<std::array<double, waves>, angles> value_{};
};

const FirstOrderTable& first_order_table() {
  static const FirstOrderTable table;
  return table;
}

}  // namespace

double ScatteredElsewhere::at(double grazing, double wavenumber) const noexcept {
  if (wavenumbers.empty() || angles < 2) return 0.0;
  const double place = std::clamp(grazing / (0.5 * pi), 0.0, 1.0) * double(angles - 1);
  const std::size_t a = std::min(static_cast<std::size_t>(place), angles - 2);
  const auto of = [&](std::size_t i) {
    const double* row = share.data() + i * angles + a;
    return std::lerp(row[0], row[1], place - double(a));
  };
  const std::size_t n = wavenumbers.size();
  if (wavenumber <= wavenumbers.front()) return of(0);
  if (wavenumber >= wavenumbers.back()) return of(n - 1);
  const auto next = static_cast<std::size_t>(
      std::upper_bound(wavenumbers.begin(), wavenumbers.end(), wavenumber) - wavenumbers.begin());
  return std::lerp(of(next - 1), of(next),
                   std::log(wavenumber / wavenumbers[next - 1]) /
                       std::log(wavenumbers[next] / wavenumbers[next - 1]));
}

double first_order_exponent(double sine, double scaled_wavenumber, Sea sea, double shortest) {
  const double cosine = std::sqrt((1.0 - sine) * (1.0 + sine));
  const double last = std::min(1.0 + cosine, shortest);
  const auto vertical = [&](int i) {
    const double x = last * std::exp(-(i + 0.5) * finest_step);
    if (sea == Sea::isotropic) return mean_vertical(x, sine);
    const double a = (sine - x) * (sine + x), b = 2.0 * x * cosine;
    return 0.5 * (std::sqrt(std::max(a - b, 0.0)) + std::sqrt(std::max(a + b, 0.0)));
  };
  return std::exp(log_first_order(sine, scaled_wavenumber, last, vertical, 100'000));
}

double scattering_exponent(const Roughness& roughness, double sine, double wavenumber) noexcept {
  if (!(roughness.rms_height > 0.0 && sine > 0.0)) return 0.0;
  const double g = 2.0 * wavenumber * roughness.rms_height * sine, kirchhoff = g * g;
  if (!(roughness.sea_wind > 0.0) || g >= 2.0) return kirchhoff;
  const double u = to_19_5_metres * roughness.sea_wind;
  const double first = kirchhoff * first_order_table().ratio(sine, wavenumber * u * u / gravity);
  if (g <= 1.0) return first;
  const double t = g - 1.0;
  return std::lerp(first, kirchhoff, t * t * (3.0 - 2.0 * t));
}

RoughReflection rough_reflection(const Roughness& roughness, double sine,
                                 double wavenumber) noexcept {
  if (roughness.smooth()) return {};
  const double floor = std::pow(10.0, roughness.floor_db / 20.0);
  const double mean =
      std::max(std::exp(-0.5 * scattering_exponent(roughness, sine, wavenumber)), floor);
  const double elsewhere = roughness.rms_height > 0.0
                               ? roughness.elsewhere.at(std::asin(std::min(sine, 1.0)), wavenumber)
                               : 0.0;
  const double energy = std::max(mean * mean, 1.0 - elsewhere);
  if (!(roughness.bubble_wind > 0.0)) return {mean, energy};
  const double frequency = wavenumber * speed_of_waves / (2.0 * pi);
  const double left =
      std::pow(10.0, -0.05 * bubble_loss_db(roughness.bubble_wind, sine, frequency));
  return {mean * left, energy * left * left};
}

double coherent_reflection(const Roughness& roughness, double sine, double wavenumber) noexcept {
  return rough_reflection(roughness, sine, wavenumber).coherent;
}

double bubble_loss_db(double wind_speed, double sine, double frequency) noexcept {
  constexpr double breaking = 6.0;  // [m/s]
  const double wind = std::max(wind_speed, breaking);
  const double loss = 1.26e-3 / std::max(sine, 1e-6) * std::pow(wind, 1.57) *
                      std::pow(1e-3 * std::abs(frequency), 0.85);
  return wind_speed >= breaking ? loss : loss * std::exp(1.2 * (wind_speed - breaking));
}

double pierson_moskowitz_height(double wind_speed) noexcept {
  const double u = to_19_5_metres * wind_speed;
  return 0.0523 * u * u / gravity;
}

}  // namespace asdic::detail
