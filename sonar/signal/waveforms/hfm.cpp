#include "sonar/signal/waveforms/hfm.h"

#include <cmath>

#include "core/units.h"
#include "sonar/signal/waveforms/lfm.h"

namespace asdic::detail {

void Hfm::describe(Fields& field) { describe_sweep(field, start_frequency, end_frequency); }

double Hfm::phase(double t, double duration) const noexcept {
  const double slope = (end_frequency - start_frequency) / duration;
  // b f₁ t, b = −slope/(f₁ f₂); ln(1 + x)/x is written so that b = 0 is a tone.
  const double x = -slope / end_frequency * t;
  return 2.0 * pi * start_frequency * t * (std::abs(x) < 1e-8 ? 1.0 - 0.5 * x : std::log1p(x) / x);
}

}  // namespace asdic::detail
