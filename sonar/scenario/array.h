#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/units.h"

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

/// A towed line: its phones lie on the path of the tow point.
struct TowedLine {
  std::vector<double> behind;  ///< [n] along the path [m]
  double heading = 0.0;        ///< of a tow point that never moves [rad]
};

/// A hydrophone array: phones relative to where it is fixed to its platform, in the frame x east, y
/// north, z down. Its reference point is their middle (sonar/scenario/carried.h).
struct ReceiverArray {
  std::vector<Vec3> phones;    ///< [n] offsets from where it is fixed [m]
  Vec3 offset = Vec3::Zero();  ///< of that (towed: of the tow point) from the platform [m]
  std::string name = "array";
  int platform = 0;                       ///< that carries it, an index
  std::vector<std::vector<Vec3>> shapes;  ///< of each ping in turn, repeated as needed, in place of
                                          ///< `phones`; empty: it keeps its shape
  std::optional<TowedLine> towed;         ///< in place of `phones`
  Electronics electronics;

  void describe(Fields& field);
};

/// A straight line of n phones around its centre.
/// \param heading  of the line, clockwise from north [rad]; broadside is heading + 90°
/// \param pitch    of the line above the horizontal, positive up [rad]; π/2 is a vertical array
/// whose first phone is the deepest
[[nodiscard]] ReceiverArray line_array(int phones, double spacing, double heading, double pitch);

}  // namespace asdic::detail
