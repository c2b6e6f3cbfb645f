#pragma once
#include <vector>

#include "sonar/noise_spectra/spectrum.h"

namespace asdic::detail {

/// Measured levels: straight in dB over the logarithm of frequency, constant beyond the ends.
struct NoiseTable {
  static constexpr std::string_view name = "table";
  std::vector<double> frequency = {1000.0};  ///< [n ≥ 1] increasing, above 0 [Hz]
  std::vector<double> level_db = {0.0};      ///< [n] [dB re 1 µPa²/Hz]

  void describe(Fields& field);
  [[nodiscard]] double level_at(double frequency) const noexcept;
  [[nodiscard]] static const Validity& validity() noexcept;  ///< everywhere
  [[nodiscard]] std::string text() const { return "by a table"; }
};
static_assert(NoiseSpectrum<NoiseTable>);

}  // namespace asdic::detail
