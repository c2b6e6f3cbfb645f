#include "sonar/noise/noise_spectrum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace asdic {
namespace {

constexpr double lowest_frequency = 1.0;  // of Wenz's curves [Hz]
constexpr double knot = 1852.0 / 3600.0;  // [m/s]

/// Straight between (x, y), constant beyond.
double interpolated(std::span<const double> x, std::span<const double> y, double at) noexcept {
  if (!(at > x.front())) return y.front();
  if (at >= x.back()) return y.back();
  const auto i = static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), at) - x.begin()) - 1;
  return std::lerp(y[i], y[i + 1], (at - x[i]) / (x[i + 1] - x[i]));
}

}  // namespace

const Validity& wenz_validity() noexcept {
  static constexpr ValidRange ranges[] = {{"frequency", "Hz", lowest_frequency, 1e5}};
  static constexpr Validity validity{"Wenz's noise", "JASA 34, 1936, 1962", ranges};
  return validity;
}

double level_db(const WenzNoise& law, double frequency) noexcept {
  const double f = std::max(frequency, lowest_frequency) / 1000.0;
  const double lg_f = std::log10(f);
  const double turbulence = 17.0 - 30.0 * lg_f;
  const double shipping =
      40.0 + 20.0 * (law.shipping - 0.5) + 26.0 * lg_f - 60.0 * std::log10(f + 0.03);
  const double wind =
      50.0 + 7.5 * std::sqrt(law.wind_speed) + 20.0 * lg_f - 40.0 * std::log10(f + 0.4);
  return db_from_power(power_from_db(turbulence) + power_from_db(shipping) + power_from_db(wind));
}

const Validity& knudsen_validity() noexcept {
  static constexpr ValidRange ranges[] = {{"frequency", "Hz", 100.0, 25000.0},
                                          {"wind speed", "m/s", 0.0, 30.5 * knot}};
  static constexpr Validity validity{"Knudsen's noise", "J. Mar. Res. 7, 410, 1948", ranges};
  return validity;
}

double level_db(const KnudsenNoise& law, double frequency) noexcept {
  constexpr std::array sea_states = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0};
  constexpr std::array at_1_khz = {44.0, 55.0, 61.5, 64.5, 66.5, 68.5, 70.0};  // [dB]
  return interpolated(sea_states, at_1_khz, law.sea_state) -
         17.0 * std::log10(std::max(frequency, 100.0) / 1000.0);
}

double level_db(const NoiseTable& law, double frequency) noexcept {
  const auto& f = law.frequency;
  if (!(frequency > f.front())) return law.level_db.front();
  if (frequency >= f.back()) return law.level_db.back();
  const auto i =
      static_cast<std::size_t>(std::upper_bound(f.begin(), f.end(), frequency) - f.begin()) - 1;
  return std::lerp(law.level_db[i], law.level_db[i + 1],
                   std::log(frequency / f[i]) / std::log(f[i + 1] / f[i]));
}

double thermal_level_db(double frequency) noexcept {
  return -15.0 + 20.0 * std::log10(std::max(frequency, lowest_frequency) / 1000.0);
}

double sea_state_of_wind(double wind_speed) noexcept {
  constexpr std::array knots = {0.5, 2.0, 5.0, 8.5, 13.5, 19.0, 24.5, 30.5};
  constexpr std::array sea_states = {0.0, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0};
  return interpolated(knots, sea_states, wind_speed / knot);
}

double noise_level_db(const NoiseSettings& noise, double frequency) {
  if (!noise.any()) return -infinity;
  const double level =
      noise.law ? std::visit([&](const auto& law) { return level_db(law, frequency); }, *noise.law)
                : *noise.spectral_level_db;
  if (!noise.thermal) return level;
  return db_from_power(power_from_db(level) + power_from_db(thermal_level_db(frequency)));
}

double noise_density(const NoiseSettings& noise, double frequency) {
  return power_from_db(noise_level_db(noise, frequency)) * micropascal * micropascal;
}

double noise_power(const NoiseSettings& noise, double low, double high) noexcept {
  if (!noise.any() || !(high > low)) return 0.0;
  if (!noise.law && !noise.thermal) return noise_density(noise, low) * (high - low);
  // Below 1 Hz and 1e-6 of the band's end all laws are constant or of no weight.
  const double first = std::clamp(low, std::min(lowest_frequency, 0.5 * high), high);
  double sum = noise_density(noise, 0.5 * (low + first)) * (first - low);
  if (!(high > first)) return sum;
  const double span = std::log(high / first);  // ∫S df = ∫S·f d(ln f)
  const auto pairs = static_cast<int>(std::ceil(32.0 * span / std::numbers::ln10)) + 1;
  const double step = span / (2.0 * pairs);
  for (int i = 0; i <= 2 * pairs; ++i) {
    const double f = first * std::exp(i * step);
    const double weight = i == 0 || i == 2 * pairs ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    sum += weight * step / 3.0 * noise_density(noise, f) * f;
  }
  return sum;
}

double noise_band_db(const NoiseSettings& noise, double centre, double width) noexcept {
  if (!noise.any()) return -infinity;
  if (!noise.law && !noise.thermal) return *noise.spectral_level_db + db_from_power(width);
  return db_from_power(
      noise_power(noise, std::max(0.0, centre - 0.5 * width), centre + 0.5 * width) /
      (micropascal * micropascal));
}

}  // namespace asdic
