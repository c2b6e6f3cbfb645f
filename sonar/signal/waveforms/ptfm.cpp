#include "sonar/signal/waveforms/ptfm.h"

#include <cmath>

#include "core/units.h"
#include "sonar/signal/waveforms/lfm.h"

namespace asdic::detail {

void Ptfm::describe(Fields& field) {
  describe_sweep(field, start_frequency, end_frequency);
  field(required("sweeps"), sweeps, 2, 10000, "one after another within the duration");
}

double Ptfm::phase(double t, double duration) const noexcept {
  const double one = duration / sweeps;
  const double k = std::clamp(std::floor(t / one), 0.0, sweeps - 1.0), u = t - k * one;
  const double width = end_frequency - start_frequency;
  // Every sweep adds its middle frequency times its length.
  return 2.0 * pi *
         (k * one * (start_frequency + 0.5 * width) +
          u * (start_frequency + 0.5 * width * u / one));
}

}  // namespace asdic::detail
