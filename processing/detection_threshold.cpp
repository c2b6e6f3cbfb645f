#include "processing/detection_threshold.h"

#include <cmath>

#include "core/units.h"

namespace asdic::detail {

double fluctuation_shape(Fluctuation fluctuation) noexcept {
  switch (fluctuation) {
    case Fluctuation::none:
      break;
    case Fluctuation::swerling_1:
    case Fluctuation::swerling_2:
      return 1.0;
    case Fluctuation::swerling_3:
    case Fluctuation::swerling_4:
      return 2.0;
  }
  return infinity;
}

double detection_probability(double snr, double false_alarm_probability, double cells,
                             double shape) {
  const bool known = !std::isfinite(cells), steady = !std::isfinite(shape);
  const double x = -std::log(false_alarm_probability);
  const double q = known ? 0.0 : 1.0 - std::pow(false_alarm_probability, 1.0 / cells);
  double weight = false_alarm_probability;  // w_i; both laws begin with P_fa
  double passed = weight;                   // C_j
  double missed = 0.0;                      // Σ of the weights of j times (1 − C_j)
  // These weights in logarithms: e^{−S} alone would vanish for strong echoes.
  const double log_ratio = snr > 0.0 ? std::log(steady ? snr : snr / (snr + shape)) : -infinity;
  const double log_none = steady ? -snr : shape * std::log(shape / (snr + shape));
  const auto log_weight = [&](int j) {
    if (j == 0) return log_none;
    const double ways = steady ? 0.0 : std::lgamma(shape + j) - std::lgamma(shape);
    return log_none + j * log_ratio + ways - std::lgamma(j + 1.0);
  };
  // Beyond it less than 1e-16 is left. Of an echo that fluctuates the end of C_j ends the sum.
  constexpr double nothing = 1e-18;
  const double last = steady ? snr + 12.0 * std::sqrt(snr) + 50.0 : 1e5;
  for (int j = 0; j <= last && passed < 1.0 && (steady || weight > nothing); ++j) {
    missed += std::exp(log_weight(j)) * (1.0 - passed);
    weight *= known ? x / (j + 1) : q * (cells + j) / (j + 1);
    passed += weight;
  }
  return 1.0 - missed;
}

double detection_threshold_db(double false_alarm_probability, double cells, double probability,
                              double shape) {
  double low = -40.0, high = 60.0;  // [dB]; the probability rises with the SNR
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    const bool reached = detection_probability(power_from_db(middle), false_alarm_probability,
                                               cells, shape) >= probability;
    (reached ? high : low) = middle;
  }
  return high;
}

}  // namespace asdic::detail
