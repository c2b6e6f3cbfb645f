#include "sonar/signal/waveforms/lfm.h"

#include "core/quantities.h"
#include "core/units.h"

namespace asdic::detail {

void describe_sweep(Fields& field, double& start_frequency, double& end_frequency) {
  field(required("start_frequency"), start_frequency, quantity::frequency, "at the leading edge");
  field(required("end_frequency"), end_frequency, quantity::frequency,
        "at the trailing edge; below start_frequency for a down-sweep");
  if (field.reads() && start_frequency == end_frequency)
    field.fault("end_frequency", "a frequency other than start_frequency (or kind \"cw\")");
}

void Lfm::describe(Fields& field) { describe_sweep(field, start_frequency, end_frequency); }

double Lfm::phase(double t, double duration) const noexcept {
  const double slope = (end_frequency - start_frequency) / duration;
  return 2.0 * pi * t * (start_frequency + 0.5 * slope * t);
}

}  // namespace asdic::detail
