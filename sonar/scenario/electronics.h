#pragma once
#include <optional>
#include <vector>

namespace asdic::detail {

class Fields;

/// What a phone's electronics do to its signal. Lists have one entry per phone, or are empty.
struct Electronics {
  std::vector<double> gain_db;  ///< [n] re the nominal gain
  std::vector<double> phase;    ///< [n] of frequencies above 0 [rad]
  double gain_std_db = 0.0;     ///< standard deviation of further, drawn gain errors [dB]
  double phase_std = 0.0;       ///< the same of phases [rad]
  std::vector<int> dead;        ///< phones, from 0, that give nothing

  /// Butterworth magnitude, no phase: |H|² = 1/(1 + ((f² − f_l·f_h)/((f_h − f_l)·f))^{2n}).
  struct BandPass {
    int order = 4;
    double low = 0.0, high = 0.0;  ///< −3 dB [Hz]
    void describe(Fields& field);
  };
  std::optional<BandPass> band_pass;

  struct Converter {
    int bits = 16;
    double full_scale = 1.0;  ///< peak pressure that is just not clipped [Pa]
    void describe(Fields& field);
  };
  std::optional<Converter> converter;

  void describe(Fields& field);
  [[nodiscard]] bool is_ideal() const noexcept {
    return gain_db.empty() && phase.empty() && gain_std_db == 0.0 && phase_std == 0.0 &&
           dead.empty() && !band_pass && !converter;
  }
};

}  // namespace asdic::detail
