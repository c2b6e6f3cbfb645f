#pragma once
// The example of docs/develop/recipes.md, "A noise spectrum": the page has this struct word by
// word.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/fields.h"
#include "core/quantities.h"
#include "sonar/noise_spectra/spectrum.h"

namespace asdic::detail {

/// A level that falls by 10 dB a decade; below 1 Hz that of 1 Hz.
struct PinkNoise {
  static constexpr std::string_view name = "pink";
  double level_db = 60.0;  ///< at 1 kHz [dB re 1 µPa²/Hz]

  void describe(Fields& field) {
    field("level_db", level_db, quantity::level, "at 1 kHz, re 1 µPa²/Hz");
  }
  [[nodiscard]] double level_at(double frequency) const noexcept {
    return level_db - 10.0 * std::log10(std::max(frequency, 1.0) / 1000.0);
  }
  [[nodiscard]] static const Validity& validity() noexcept {
    static constexpr ValidRange ranges[] = {{"frequency", "Hz", 1.0, 1e5}};
    static constexpr Validity validity{"pink noise", "nobody's law", ranges};
    return validity;
  }
  [[nodiscard]] std::string text() const {
    char text[64];
    std::snprintf(text, sizeof text, "pink, %g dB at 1 kHz", level_db);
    return text;
  }
};
static_assert(NoiseSpectrum<PinkNoise>);

}  // namespace asdic::detail
