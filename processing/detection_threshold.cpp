#include "processing/detection_threshold.h"

#include <cmath>

#include "core/units.h"

namespace asdic::detail {

double detection_probability(double snr, double false_alarm_probability, double cells) {
  const bool known = !std::isfinite(cells);
  const double x = -std::log(false_alarm_probability);
  const double q = known ? 0.0 : 1.0 - std::pow(false_alarm_probability, 1.0 / cells);
  double weight = false_alarm_probability;  // w_i; both laws begin with P_fa
  double passed = weight;                   // C_j
  double missed = 0.0;                      // Σ of the Poisson weights times (1 − C_j)
  // Poisson's weights in logarithms: e^{−S} alone would vanish for strong echoes.
  const double log_snr = snr > 0.0 ? std::log(snr) : -infinity;
  const double last = snr + 12.0 * std::sqrt(snr) + 50.0;  // beyond it less than 1e-16 is left
  for (int j = 0; j <= last && passed < 1.0; ++j) {
    const double log_poisson = -snr + (j > 0 ? j * log_snr : 0.0) - std::lgamma(j + 1.0);
    missed += std::exp(log_poisson) * (1.0 - passed);
    weight *= known ? x / (j + 1) : q * (cells + j) / (j + 1);
    passed += weight;
  }
  return 1.0 - missed;
}

double detection_threshold_db(double false_alarm_probability, double cells, double probability) {
  double low = -40.0, high = 60.0;  // [dB]; the probability rises with the SNR
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    const bool reached =
        detection_probability(power_from_db(middle), false_alarm_probability, cells) >= probability;
    (reached ? high : low) = middle;
  }
  return high;
}

}  // namespace asdic::detail
