#include "sonar/signal/waveforms/cw.h"

#include "core/quantities.h"
#include "core/units.h"

namespace asdic::detail {

void Cw::describe(Fields& field) {
  field(required("frequency"), frequency, quantity::frequency, "of the tone");
}

double Cw::phase(double t, double /*duration*/) const noexcept { return 2.0 * pi * frequency * t; }

}  // namespace asdic::detail
