#pragma once
#include <complex>
#include <string>
#include <string_view>
#include <vector>

#include "sonar/scenario/beams/beam.h"

namespace asdic::detail {

/// Level over bearing and elevation, bilinear in dB; round the circle in bearing, the outer rows
/// going on in elevation.
struct BeamTable {
  std::vector<double> bearings = {};    ///< [n ≥ 1] strictly increasing within one turn [rad]
  std::vector<double> elevations = {};  ///< [m ≥ 1] strictly increasing, positive up [rad]
  std::vector<double> level_db = {};    ///< [n × m] re the source level

  void describe(Fields& field);
  [[nodiscard]] double level(double bearing, double elevation) const noexcept;  ///< [dB]
};

class TablePattern {
 public:
  static constexpr bool azimuthally_symmetric = false;
  /// \param turned  bearing of the table's zero [rad]
  TablePattern(BeamTable table, double turned);
  [[nodiscard]] std::complex<double> towards(double bearing, double elevation) const noexcept;
  [[nodiscard]] double longest_delay() const noexcept { return 0.0; }

 private:
  BeamTable table_;
  double turned_;
};

struct TableBeam {
  static constexpr std::string_view name = "table";
  static constexpr bool steers = false;
  BeamTable table = {};
  BeamBearing turned = {};  ///< its zero points there

  void describe(Fields& field);
  [[nodiscard]] TablePattern pattern(const BeamMount& mount) const {
    return {table, turned.north_of_frame(mount.heading) + turned.bearing};
  }
  [[nodiscard]] std::string text(double elevation) const;
};

}  // namespace asdic::detail
