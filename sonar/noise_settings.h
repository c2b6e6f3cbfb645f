#pragma once
#include <optional>

namespace asdic {

/// What the sea itself sounds like at the phones.
struct NoiseSettings {
  std::optional<double> spectral_level_db;  ///< NL [dB re 1 µPa²/Hz]; none: no noise
};

}  // namespace asdic
