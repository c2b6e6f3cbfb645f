#include "sonar/signal/waveforms/pulse_train.h"

#include <cmath>

#include "core/quantities.h"
#include "core/text.h"
#include "core/units.h"
#include "sonar/signal/waveforms/lfm.h"

namespace asdic::detail {

void PulseTrain::describe(Fields& field) {
  Fields::Ways ways;
  if (const auto way = field.way(ways, {"frequency"}, start_frequency == end_frequency)) {
    field(required("frequency"), start_frequency, quantity::frequency, "of pulses of one tone");
    if (field.reads()) end_frequency = start_frequency;
  }
  if (const auto way = field.otherwise(ways, {"start_frequency", "end_frequency"}))
    describe_sweep(field, start_frequency, end_frequency);
  field(required("pulses"), pulses, 2, 10000, "within the duration");
  field(required("pulse_duration"), pulse_duration, quantity::pulse_duration,
        "of each, which the window shapes");
}

void PulseTrain::check(Fields& field, double duration) const {
  constexpr double most = 1e4;  // the spectrum's samples run through the pauses too
  if (duration > most * pulse_duration)
    field.fault("pulse_duration",
                "at least " + to_text(duration / most) + " s: the duration over " + to_text(most));
  if (pulses * pulse_duration > duration * (1.0 + 1e-9))
    field.fault("pulse_duration", "at most " + to_text(duration / pulses) +
                                      " s: " + std::to_string(pulses) +
                                      " pulses one after another within the duration");
}

double PulseTrain::phase(double t, double duration) const noexcept {
  const Repeats all = repeats(duration);
  const double begin = all.interval * static_cast<double>(all.at(t)), u = t - begin;
  const double width = end_frequency - start_frequency;
  return 2.0 * pi *
         (begin * (start_frequency + 0.5 * width) +
          u * (start_frequency + 0.5 * width * u / pulse_duration));
}

}  // namespace asdic::detail
