#include "sonar/noise_spectra/white.h"

#include <cstdio>

#include "core/fields.h"
#include "core/quantities.h"

namespace asdic::detail {

void WhiteNoise::describe(Fields& field) {
  field(required("spectral_level_db"), spectral_level_db, quantity::level_re("1 µPa²/Hz"),
        "at all frequencies");
}

const Validity& WhiteNoise::validity() noexcept {
  static constexpr Validity everywhere{};
  return everywhere;
}

std::string WhiteNoise::text() const {
  char text[64];
  std::snprintf(text, sizeof text, "%g dB re 1 µPa²/Hz", spectral_level_db);
  return text;
}

}  // namespace asdic::detail
