#include "sonar/signal/waveforms/sampled_pulse.h"

namespace asdic::detail {

void SampledPulse::describe(Fields& field) {
  field.sound(required("file"), {&file, &samples, &sample_rate}, "the pulse");
}

}  // namespace asdic::detail
