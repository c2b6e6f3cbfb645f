#pragma once
#include <optional>
#include <string>
#include <vector>

#include "sonar/noise_spectra/table.h"
#include "sonar/scenario/track.h"

namespace asdic::detail {

/// A line of a ship's spectrum.
struct Tonal {
  double frequency = 50.0;  ///< [Hz]
  double level_db = 150.0;  ///< of the source [dB re 1 µPa rms at 1 m]

  void describe(Fields& field);
};

/// A ship that makes noise of its own: it neither transmits nor echoes.
///
/// Broadband: L₁ + slope·lg f_kHz above 100 Hz and constant below, after Ross, Mechanics of
/// Underwater Noise (1976), whose merchant ships fall 20 dB a decade; or a table.
struct Interferer {
  std::string name = "interferer";
  Track track;                     ///< of its one point source
  std::optional<double> level_db;  ///< L₁, at 1 kHz [dB re 1 µPa²/Hz at 1 m]
  double slope_db_per_decade = -20.0;
  std::optional<NoiseTable> table;  ///< instead [dB re 1 µPa²/Hz at 1 m]
  std::vector<Tonal> tonals;

  void describe(Fields& field);
};

/// One-sided spectral density of its broadband noise at 1 m [Pa²/Hz].
[[nodiscard]] double source_density(const Interferer& ship, double frequency) noexcept;

}  // namespace asdic::detail
