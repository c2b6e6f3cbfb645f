#pragma once
#include <variant>

#include "sonar/signal/waveforms/costas.h"
#include "sonar/signal/waveforms/cw.h"
#include "sonar/signal/waveforms/geometric_comb.h"
#include "sonar/signal/waveforms/hfm.h"
#include "sonar/signal/waveforms/lfm.h"
#include "sonar/signal/waveforms/ptfm.h"
#include "sonar/signal/waveforms/pulse_train.h"
#include "sonar/signal/waveforms/sampled_pulse.h"
#include "sonar/signal/waveforms/sfm.h"
#include "sonar/signal/waveforms/waveform.h"

namespace asdic::detail {

/// Every waveform. A new one is its files and one name here (docs/develop/recipes.md).
using AnyWaveform =
    std::variant<Cw, Lfm, Hfm, Sfm, Costas, Ptfm, GeometricComb, PulseTrain, SampledPulse>;

}  // namespace asdic::detail
