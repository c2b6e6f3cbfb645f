#include "sonar/noise/noise_spectrum.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail {
namespace {

constexpr double lowest_frequency = 1.0;  // that laws tell from lower ones [Hz]

}  // namespace

double thermal_level_db(double frequency) noexcept {
  return -15.0 + 20.0 * std::log10(std::max(frequency, lowest_frequency) / 1000.0);
}

double noise_level_db(const NoiseSettings& noise, double frequency) {
  if (!noise.any()) return -infinity;
  const double level =
      std::visit([&](const auto& law) { return law.level_at(frequency); }, *noise.law);
  if (!noise.thermal) return level;
  return db_from_power(power_from_db(level) + power_from_db(thermal_level_db(frequency)));
}

double noise_density(const NoiseSettings& noise, double frequency) {
  return power_from_db(noise_level_db(noise, frequency)) * micropascal * micropascal;
}

double noise_power(const NoiseSettings& noise, double low, double high) noexcept {
  if (!noise.any() || !(high > low)) return 0.0;
  if (noise.flat_level_db()) return noise_density(noise, low) * (high - low);
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
  if (const auto level = noise.flat_level_db()) return *level + db_from_power(width);
  return db_from_power(
      noise_power(noise, std::max(0.0, centre - 0.5 * width), centre + 0.5 * width) /
      (micropascal * micropascal));
}

}  // namespace asdic::detail
