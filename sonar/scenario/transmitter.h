#pragma once
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "core/units.h"
#include "reverb/pairs/transmit_pattern.h"
#include "sonar/scenario/beams/beams.h"
#include "sonar/signal/pulse.h"

namespace asdic::detail {

/// A projector, or several that make one beam.
struct Transmitter {
  double source_level_db =
      220.0;  ///< SL [dB re 1 µPa rms at 1 m]: peak envelope/√2 of the pulse before its window
  double elevation = 0.0;  ///< of the beam's axis, positive up [rad]
  AnyBeam beam = LineBeam{};
  std::string name = "transmitter";
  int platform = 0;                    ///< that carries it, an index
  Vec3 offset = Vec3::Zero();          ///< from the platform [m]
  std::optional<PulseSettings> pulse;  ///< none: the scenario's
  double first_ping_time = 0.0;        ///< since the start of the scenario [s]
  std::optional<double> interval;      ///< from ping to ping [s]; none: the schedule's
  std::vector<double> elevations;      ///< of each ping [rad], repeated as needed; empty: the
                                       ///< schedule's, and without those `elevation`

  void describe(Fields& field);
};

/// Far-field amplitude pattern of a transmitter: its beam's (sonar/scenario/beams/).
class BeamPattern final : public TransmitPattern {
 public:
  /// \param wavelength  at the source [m]   \param sound_speed  there [m/s], for delays
  /// \param heading  of its platform [rad]
  /// \param reference  wavelength to which a line's beamwidth refers [m]; 0: `wavelength`
  BeamPattern(const Transmitter& transmitter, double wavelength, double sound_speed = 1500.0,
              double heading = 0.0, double reference = 0.0);

  /// Of one that is azimuthally symmetric; of others the root of the mean square over bearings.
  /// \param elevation  of launch, positive up [rad]
  [[nodiscard]] double operator()(double elevation) const noexcept;
  [[nodiscard]] std::complex<double> towards(double bearing,
                                             double elevation) const noexcept override;
  [[nodiscard]] bool azimuthally_symmetric() const noexcept override;
  [[nodiscard]] bool add_to(ExactKey& key) const override;
  /// Delay between its parts as the far field sees them, at most [s].
  [[nodiscard]] double longest_delay() const noexcept;
  [[nodiscard]] double line_length() const noexcept;  ///< of a vertical line, else 0 [m]

 private:
  AnyBeam beam_;  // what the pattern is made of: its key
  BeamMount mount_;
  AnyBeamPattern pattern_;
};

}  // namespace asdic::detail
