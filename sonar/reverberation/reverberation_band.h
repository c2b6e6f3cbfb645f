#pragma once
#include <functional>
#include <span>
#include <vector>

#include "raytrace/places/propagation_paths.h"
#include "reverb/pairs/scattering_sheet.h"
#include "sonar/scenario/scenario.h"
#include "sonar/scenario/transmitter.h"
#include "sonar/signal/band_response.h"

namespace asdic::detail {

/// The few frequencies at which a ping's reverberation is known, and what differs there: the
/// water's absorption, the scattering laws, the transmitter's pattern.
///
/// A return's amplitude is A(f) ≈ Σ_k ℓ_k(f)·A(f_k), f_k Chebyshev points of the pulse's band: it
/// has an amplitude for every f_k, and the pulse goes through ℓ_k. As many points as interpolate
/// absorption times √σ to 10⁻⁴ of its largest value, found by trying (paths up to the longest, a
/// fan of angles), and those that the pattern asks for by its bound. A law with a kink in the band
/// may ask for more than there can be: reached() says what was. docs/theory/reverberation.md,
/// "Across the band"
class ReverberationBand {
 public:
  /// \param projector  as it pings   \param latest  end of the record, since the ping [s]
  /// \param half_band  of the pulse [Hz]
  ReverberationBand(const Scenario& scenario, const PropagationPaths& paths,
                    std::span<const ScatteringSheet::Law> laws, const Transmitter& projector,
                    const Kinematics& source, double heading, double centre, double half_band,
                    double latest);

  [[nodiscard]] std::span<const BandPoint> points() const noexcept { return points_; }
  /// ℓ_k over the frequency from the band's centre [Hz]: a synthesizer of these has the points for
  /// its frequency responses. They end with this.
  [[nodiscard]] std::vector<std::function<double(double)>> filters() const;

  /// The largest error of absorption times √σ between the points, over its largest value.
  [[nodiscard]] double reached() const noexcept { return reached_; }

  static constexpr double error = 1e-4;           ///< of the largest amplitude in the band
  static constexpr std::size_t most_points = 64;  ///< but for the pattern's

 private:
  BandNodes nodes_;
  std::vector<BeamPattern> patterns_;
  std::vector<BandPoint> points_;
  double reached_ = 0.0;
};

}  // namespace asdic::detail
