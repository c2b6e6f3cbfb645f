#pragma once
#include <complex>
#include <string>
#include <string_view>
#include <vector>

#include "core/units.h"
#include "sonar/scenario/beams/beam.h"

namespace asdic::detail {

/// One of several projectors that send the same pulse.
struct Projector {
  Vec3 offset = Vec3::Zero();  ///< from the transmitter's place, in its frame [m]
  double amplitude = 1.0;
  double phase = 0.0;  ///< of what it sends [rad]
  double delay = 0.0;  ///< [s]

  void describe(Fields& field);
};

/// Σ w_n e^{ik(d − d₀)·x_n − iωt_n}/Σ|w_n|, d₀ the direction that it is steered to (by delays): 1
/// there, unless phases and delays of its own turn it away. λ is that at the source.
/// Source: docs/theory/projector.md
class ProjectorPattern {
 public:
  static constexpr bool azimuthally_symmetric = false;
  ProjectorPattern(const std::vector<Projector>& projectors, const BeamBearing& turned,
                   const BeamMount& mount);
  [[nodiscard]] std::complex<double> towards(double bearing, double elevation) const noexcept;
  [[nodiscard]] double longest_delay() const noexcept;

 private:
  struct Element {
    Vec3 place;  // on the map, over the wavelength
    std::complex<double> weight;
  };
  double wavelength_, sound_speed_;
  std::vector<Element> elements_;
};

struct ProjectorBeam {
  static constexpr std::string_view name = "projectors";
  static constexpr bool steers = true;
  std::vector<Projector> projectors = {};  ///< [n ≥ 1]
  BeamBearing turned = {};                 ///< steered there

  void describe(Fields& field);
  [[nodiscard]] ProjectorPattern pattern(const BeamMount& mount) const {
    return {projectors, turned, mount};
  }
  [[nodiscard]] std::string text(double elevation) const;
};

}  // namespace asdic::detail
