#include "sonar/signal/waveforms/geometric_comb.h"

#include <cmath>

#include "core/quantities.h"
#include "core/text.h"
#include "core/units.h"

namespace asdic::detail {

void GeometricComb::describe(Fields& field) {
  field(required("start_frequency"), start_frequency, quantity::frequency,
        "of the line beside the smallest gap");
  field(required("end_frequency"), end_frequency, quantity::frequency,
        "of the line beside the largest gap; below start_frequency: gaps grow downwards");
  if (field.reads() && start_frequency == end_frequency)
    field.fault("end_frequency", "a frequency other than start_frequency (or kind \"cw\")");
  field(required("lines"), lines, 3, 100, "of one frequency each");
  field("gap_ratio", gap_ratio, {.noun = "ratio", .low = 1.0001, .high = 10.0},
        "of a gap between lines to the one before it");
}

void GeometricComb::check(Fields& field, double duration) const {
  const std::vector<Tone> all = tones();
  const double gap = std::abs(all[1].frequency - all[0].frequency);
  if (gap * duration < 1.0)
    field.fault("gap_ratio", "a smaller one, fewer lines or a longer pulse: the smallest gap is " +
                                 to_text(gap) + " Hz, below 1/duration, where lines melt into one");
}

std::vector<Tone> GeometricComb::tones() const {
  std::vector<Tone> all;
  const double whole = std::pow(gap_ratio, lines - 1) - 1.0;
  for (int n = 0; n < lines; ++n)
    all.push_back({.frequency = start_frequency + (end_frequency - start_frequency) *
                                                      (std::pow(gap_ratio, n) - 1.0) / whole,
                   .phase = pi * n * n / lines});
  return all;
}

}  // namespace asdic::detail
